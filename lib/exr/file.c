#define _POSIX_C_SOURCE 200809L
#define _FILE_OFFSET_BITS 64

#include "exr/file.h"

#include "base/alloc.h"
#include "base/log.h"

#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

SluiceResult slc_exr_fail(const struct slc_exr_file *file, SluiceResult result, const char *format,
                          ...)
{
    char message[768];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    slc_log(&file->log, SLUICE_LOG_ERROR, "%s: %s", file->path, message);
    return result;
}

void slc_exr_printable(const char *text, char *printable, size_t size)
{
    size_t i = 0;
    for (; text[i] && i + 1 < size; i++)
        printable[i] = text[i] >= ' ' && text[i] <= '~' ? text[i] : '?';
    printable[i] = '\0';
}

SluiceResult slc_exr_result(const struct slc_exr_file *file, exr_result_t result)
{
    switch (result) {
    case EXR_ERR_SUCCESS: return SLUICE_SUCCESS;
    case EXR_ERR_OUT_OF_MEMORY: return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    case EXR_ERR_FEATURE_NOT_IMPLEMENTED: return SLUICE_ERROR_UNSUPPORTED;
    case EXR_ERR_READ_IO:
        return atomic_load(&file->system_failed) ? SLUICE_ERROR_IO : SLUICE_ERROR_CORRUPT_DATA;
    default: return SLUICE_ERROR_CORRUPT_DATA;
    }
}

/* As many bytes as there are up to the end of the file, or -1 with errno set. */
static int64_t read_at(int descriptor, void *buffer, uint64_t size, uint64_t offset)
{
    uint64_t done = 0;
    while (done < size) {
        uint64_t rest = size - done;
        size_t step = rest < 1u << 30 ? (size_t)rest : 1u << 30; /* a read is at most 2^31 */
        ssize_t got = pread(descriptor, (char *)buffer + done, step, (off_t)(offset + done));
        if (got == 0)
            break;
        if (got > 0)
            done += (uint64_t)got;
        else if (errno != EINTR)
            return -1;
    }
    return (int64_t)done;
}

/* Our own stream, because OpenEXRCore's does not tell a damaged disk from a short file. */
static int64_t on_read(exr_const_context_t context, void *user, void *buffer, uint64_t size,
                       uint64_t offset, exr_stream_error_func_ptr_t error)
{
    struct slc_exr_file *file = user;
    if (offset > INT64_MAX - size)
        return -1;
    int64_t got = read_at(file->descriptor, buffer, size, offset);
    if (got < 0) {
        atomic_store(&file->system_failed, true);
        error(context, EXR_ERR_READ_IO, "cannot read %llu bytes at %llu: %s",
              (unsigned long long)size, (unsigned long long)offset, strerror(errno));
    }
    return got;
}

static int64_t on_query_size(exr_const_context_t context, void *user)
{
    (void)context;
    return (int64_t)((struct slc_exr_file *)user)->size;
}

/* Warnings, because OpenEXRCore goes on after some of them; our own error follows if it does not.
 */
static void on_error(exr_const_context_t context, exr_result_t code, const char *message)
{
    void *user = NULL;
    (void)code;
    if (!context || exr_get_user_data(context, &user) != EXR_ERR_SUCCESS || !user)
        return;
    const struct slc_exr_file *file = user;
    char printable[512];
    slc_exr_printable(message, printable, sizeof printable);
    slc_log(&file->log, SLUICE_LOG_WARNING, "%s: OpenEXR: %s", file->path, printable);
}

SluiceResult slc_exr_file_read(struct slc_exr_file *file, uint64_t offset, void *bytes, size_t size)
{
    if (offset > file->size || size > file->size - offset)
        return slc_exr_fail(file, SLUICE_ERROR_CORRUPT_DATA,
                            "%zu bytes at %llu lie beyond the end of the file", size,
                            (unsigned long long)offset);
    int64_t got = read_at(file->descriptor, bytes, size, offset);
    if (got == (int64_t)size)
        return SLUICE_SUCCESS;
    return slc_exr_fail(file, SLUICE_ERROR_IO, "cannot read %zu bytes at %llu: %s", size,
                        (unsigned long long)offset,
                        got < 0 ? strerror(errno) : "the file has become shorter");
}

static SluiceResult open_descriptor(struct slc_exr_file *file)
{
    /* Not blocking, so that the name of a pipe cannot stop the program. */
    file->descriptor = open(file->path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file->descriptor < 0) {
        bool absent = errno == ENOENT || errno == ENOTDIR;
        return slc_exr_fail(file, absent ? SLUICE_ERROR_FILE_NOT_FOUND : SLUICE_ERROR_IO,
                            "cannot open: %s", strerror(errno));
    }
    struct stat status;
    if (fstat(file->descriptor, &status) != 0)
        return slc_exr_fail(file, SLUICE_ERROR_IO, "cannot stat: %s", strerror(errno));
    if (!S_ISREG(status.st_mode))
        return slc_exr_fail(file, SLUICE_ERROR_IO, "is not a regular file");
    file->size = (uint64_t)status.st_size;
    return SLUICE_SUCCESS;
}

static SluiceResult open_context(struct slc_exr_file *file)
{
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.error_handler_fn = on_error;
    init.user_data = file;
    init.read_fn = on_read;
    init.size_fn = on_query_size;
    /* A table that was never completed is an error here, not something to search the file for. */
    init.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    exr_result_t result = exr_start_read(&file->context, file->path, &init);
    if (result == EXR_ERR_SUCCESS)
        return SLUICE_SUCCESS;
    file->context = NULL;
    return slc_exr_fail(file, slc_exr_result(file, result), "cannot read the header: %s",
                        exr_get_default_error_message(result));
}

SluiceResult slc_exr_file_open(struct slc_exr_file *file, const char *path,
                               const SluiceAllocationCallbacks *cb, const SluiceLogCallback *log)
{
    memset(file, 0, sizeof *file);
    file->allocator = *cb;
    file->log = *log;
    file->descriptor = -1;
    file->path = slc_strdup(cb, path);
    if (!file->path)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    SluiceResult result = open_descriptor(file);
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
    if (file->descriptor >= 0)
        close(file->descriptor);
    if (file->path)
        slc_free(&file->allocator, file->path, strlen(file->path) + 1, 1);
    file->path = NULL;
}
