#include "exr/exr_file.h"

#include "base/log.h"
#include "base/system.h"

#include <errno.h>
#include <string.h>

SluiceResult slc_exr_result(const struct slc_exr_file *file, exr_result_t result)
{
    switch (result) {
    case EXR_ERR_SUCCESS: return SLUICE_SUCCESS;
    case EXR_ERR_OUT_OF_MEMORY: return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    case EXR_ERR_FEATURE_NOT_IMPLEMENTED: return SLUICE_ERROR_UNSUPPORTED;
    case EXR_ERR_READ_IO: {
        SluiceResult failure = (SluiceResult)atomic_load(&file->system_failure);
        return failure != SLUICE_SUCCESS ? failure : SLUICE_ERROR_CORRUPT_DATA;
    }
    default: return SLUICE_ERROR_CORRUPT_DATA;
    }
}

/* Reads for OpenEXRCore, whose own stream does not tell a damaged disk from a short file. */
static int64_t on_read(exr_const_context_t context, void *user, void *buffer, uint64_t size,
                       uint64_t offset, exr_stream_error_func_ptr_t error)
{
    struct slc_exr_file *file = user;
    if (offset > INT64_MAX - size)
        return -1;
    int64_t got = slc_input_file_read_some(&file->input, offset, buffer, size);
    if (got < 0) {
        int why = errno;
        atomic_store(&file->system_failure, slc_system_result(why));
        error(context, EXR_ERR_READ_IO, "cannot read %llu bytes at %llu: %s",
              (unsigned long long)size, (unsigned long long)offset, slc_input_error_text(why));
    }
    return got;
}

static int64_t on_query_size(exr_const_context_t context, void *user)
{
    (void)context;
    return (int64_t)((struct slc_exr_file *)user)->input.size;
}

/* Logs messages of OpenEXRCore as warnings, because decoding continues after some. Otherwise Sluice
 * logs its own error. */
static void on_error(exr_const_context_t context, exr_result_t code, const char *message)
{
    void *user = NULL;
    (void)code;
    if (!context || exr_get_user_data(context, &user) != EXR_ERR_SUCCESS || !user)
        return;
    const struct slc_exr_file *file = user;
    char printable[512];
    slc_printable(message, printable, sizeof printable);
    slc_log(&file->input.log, SLUICE_LOG_WARNING, "%s: OpenEXR: %s", file->input.path, printable);
}

static SluiceResult open_context(struct slc_exr_file *file)
{
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.error_handler_fn = on_error;
    init.user_data = file;
    init.read_fn = on_read;
    init.size_fn = on_query_size;
    /* An incomplete chunk table is an error; do not search the file for chunks. */
    init.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    exr_result_t result = exr_start_read(&file->context, file->input.path, &init);
    if (result == EXR_ERR_SUCCESS)
        return SLUICE_SUCCESS;
    file->context = NULL;
    return slc_input_fail(&file->input, slc_exr_result(file, result), "cannot read the header: %s",
                          exr_get_default_error_message(result));
}

SluiceResult slc_exr_file_open(struct slc_exr_file *file, const struct slc_input_choice *choice,
                               const SluiceAllocationCallbacks *cb, const SluiceLogCallback *log)
{
    memset(file, 0, sizeof *file);
    SluiceResult result = slc_input_file_init_choice(&file->input, choice, cb, log);
    if (result == SLUICE_SUCCESS)
        result = slc_input_file_open(&file->input);
    if (result == SLUICE_SUCCESS)
        result = open_context(file);
    if (result == SLUICE_SUCCESS)
        result = slc_exr_read_header(file);
    return result;
}

void slc_exr_file_close(struct slc_exr_file *file)
{
    if (file->context)
        exr_finish(&file->context);
    slc_input_file_finish(&file->input);
}
