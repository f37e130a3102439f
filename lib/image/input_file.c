#include "image/input_file.h"

#include "base/alloc.h"
#include "base/log.h"
#include "base/shown_url.h"
#include "base/struct_size.h"
#include "base/system.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static SluiceResult say(const struct slc_input_file *file, SluiceResult result, uint64_t key,
                        const char *message)
{
    slc_said_log(file->said, &file->log, file->path, key, message);
    return result;
}

/* Logs a failed read without its offset: during an outage every read fails. */
static SluiceResult fail_read(const struct slc_input_file *file, SluiceResult result,
                              uint64_t offset, size_t size, const char *why)
{
    char message[512];
    snprintf(message, sizeof message, "cannot read %llu bytes at %llu: %s",
             (unsigned long long)size, (unsigned long long)offset, why);
    return say(file, result, slc_said_key(why), message);
}

SluiceResult slc_input_fail(const struct slc_input_file *file, SluiceResult result,
                            const char *format, ...)
{
    char message[768];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    return say(file, result, slc_said_key(message), message);
}

void slc_printable(const char *text, char *printable, size_t size)
{
    size_t i = 0;
    for (; text[i] && i + 1 < size; i++)
        printable[i] = text[i] >= ' ' && text[i] <= '~' ? text[i] : '?';
    printable[i] = '\0';
}

SluiceResult slc_input_file_init(struct slc_input_file *file, const char *path,
                                 const SluiceAllocationCallbacks *cb, const SluiceLogCallback *log)
{
    *file = (struct slc_input_file){.allocator = *cb, .log = *log, .descriptor = -1};
    file->path = slc_strdup(cb, path);
    file->said = slc_calloc(cb, 1, sizeof *file->said);
    return file->path && file->said ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

static SluiceResult check_input(struct slc_input_file *file, const SluiceInput *input)
{
    SluiceResult result = slc_struct_read(SLC_STRUCT(SluiceInput), &file->input, input, &file->log);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!file->input.pBytes && !file->input.pfnRead)
        return slc_input_fail(file, SLUICE_ERROR_NULL_POINTER,
                              "SluiceInput has neither pBytes nor pfnRead");
    if (file->input.size == 0 || file->input.size > INT64_MAX)
        return slc_input_fail(file, SLUICE_ERROR_INVALID_ARGUMENT,
                              "SluiceInput::size is %llu, not 1 to 2^63 - 1",
                              (unsigned long long)file->input.size);
    return SLUICE_SUCCESS;
}

SluiceResult slc_input_file_init_choice(struct slc_input_file *file,
                                        const struct slc_input_choice *choice,
                                        const SluiceAllocationCallbacks *cb,
                                        const SluiceLogCallback *log)
{
    if (!choice->path && !choice->input) {
        *file = (struct slc_input_file){.allocator = *cb, .descriptor = -1};
        return SLUICE_ERROR_NULL_POINTER;
    }
    /* The name of an input may be a URL, and messages have it. */
    bool is_named = choice->input && choice->path;
    char *shown = is_named ? slc_shown_url(cb, choice->path) : NULL;
    if (is_named && !shown) {
        *file = (struct slc_input_file){.allocator = *cb, .descriptor = -1};
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    const char *path = choice->path ? choice->path : "(memory)";
    SluiceResult result = slc_input_file_init(file, shown ? shown : path, cb, log);
    if (shown)
        slc_free(cb, shown, strlen(shown) + 1, 1);
    if (result == SLUICE_SUCCESS && choice->input)
        return check_input(file, choice->input);
    if (result != SLUICE_SUCCESS || !choice->pool)
        return result;
    file->pool = choice->pool;
    file->pooled = slc_alloc(cb, 1, sizeof *file->pooled);
    if (!file->pooled)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    *file->pooled = SLC_POOLED_FILE_CLOSED;
    return SLUICE_SUCCESS;
}

static bool is_in_file(const struct slc_input_file *file)
{
    return file->input.size == 0;
}

/* Borrows a descriptor until it is returned. -1 with errno set after an error. */
static int borrow_descriptor(const struct slc_input_file *file)
{
    return file->pool ? slc_file_pool_acquire(file->pool, file->pooled, file->path)
                      : file->descriptor;
}

static void return_descriptor(const struct slc_input_file *file)
{
    if (file->pool)
        slc_file_pool_release(file->pool, file->pooled);
}

static SluiceResult check_status(struct slc_input_file *file, int descriptor)
{
    struct slc_file_status status;
    if (!slc_file_get_status(descriptor, &status))
        return slc_input_fail(file, slc_system_result(errno), "cannot stat: %s", strerror(errno));
    if (status.kind != SLC_NODE_FILE)
        return slc_input_fail(file, SLUICE_ERROR_IO, "is not a regular file");
    file->size = status.size;
    return SLUICE_SUCCESS;
}

static SluiceResult open_descriptor(struct slc_input_file *file)
{
    if (!file->pool)
        file->descriptor = slc_open_input(file->path);
    int descriptor = borrow_descriptor(file);
    if (descriptor < 0)
        return slc_input_fail(file, slc_system_result(errno), "cannot open: %s", strerror(errno));
    SluiceResult result = check_status(file, descriptor);
    return_descriptor(file);
    return result;
}

SluiceResult slc_input_file_open(struct slc_input_file *file)
{
    if (file->is_open)
        return SLUICE_SUCCESS;
    file->is_open = true;
    file->size = file->input.size;
    if (!is_in_file(file))
        return SLUICE_SUCCESS;
    SluiceResult result = open_descriptor(file);
    if (result != SLUICE_SUCCESS)
        slc_input_file_close(file);
    return result;
}

void slc_input_file_close(struct slc_input_file *file)
{
    if (file->descriptor >= 0)
        slc_file_close(file->descriptor);
    else if (file->is_open && file->pool)
        slc_file_pool_remove(file->pool, file->pooled);
    file->descriptor = -1;
    file->is_open = false;
}

void slc_input_file_finish(struct slc_input_file *file)
{
    if (file->path) {
        slc_input_file_close(file);
        slc_free(&file->allocator, file->path, strlen(file->path) + 1, 1);
    }
    slc_free(&file->allocator, file->said, 1, sizeof *file->said);
    slc_free(&file->allocator, file->pooled, 1, sizeof *file->pooled);
    file->path = NULL;
    file->pooled = NULL;
    file->said = NULL;
}

/* Turns a callback's result into a value of errno. slc_system_result turns it back. */
static int callback_error(SluiceResult result)
{
    return result == SLUICE_NOT_READY                  ? EAGAIN
           : result == SLUICE_ERROR_OUT_OF_HOST_MEMORY ? ENOMEM
                                                       : EIO;
}

static int64_t read_input(const struct slc_input_file *file, uint64_t offset, void *bytes,
                          uint64_t size)
{
    const SluiceInput *input = &file->input;
    if (offset >= input->size)
        return 0;
    if (size > input->size - offset)
        size = input->size - offset;
    if (input->pBytes) {
        memcpy(bytes, (const char *)input->pBytes + offset, (size_t)size);
        return (int64_t)size;
    }
    SluiceResult result = SLUICE_SUCCESS;
    if (size > 0)
        result = input->pfnRead(input->pUserData, offset, bytes, (size_t)size);
    if (result == SLUICE_SUCCESS)
        return (int64_t)size;
    errno = callback_error(result);
    return -1;
}

static int64_t read_descriptor(int descriptor, uint64_t offset, void *bytes, uint64_t size)
{
    uint64_t done = 0;
    while (done < size) {
        int64_t got = slc_file_read_at(descriptor, offset + done, (char *)bytes + done,
                                       (size_t)(size - done));
        if (got == 0)
            break;
        if (got > 0)
            done += (uint64_t)got;
        else if (errno != EINTR)
            return -1;
    }
    return (int64_t)done;
}

int64_t slc_input_file_read_some(const struct slc_input_file *file, uint64_t offset, void *bytes,
                                 uint64_t size)
{
    if (!is_in_file(file))
        return read_input(file, offset, bytes, size);
    int descriptor = borrow_descriptor(file);
    if (descriptor < 0)
        return -1;
    int64_t got = read_descriptor(descriptor, offset, bytes, size);
    int error = errno;
    return_descriptor(file);
    errno = error;
    return got;
}

const char *slc_input_error_text(int error)
{
    return error == ESTALE ? "another file has taken its place since it was opened, or it was "
                             "written again; open it again"
                           : strerror(error);
}

SluiceResult slc_input_file_read(const struct slc_input_file *file, uint64_t offset, void *bytes,
                                 size_t size)
{
    if (offset > file->size || size > file->size - offset)
        return slc_input_fail(file, SLUICE_ERROR_CORRUPT_DATA,
                              "%llu bytes at %llu lie beyond the end of the file",
                              (unsigned long long)size, (unsigned long long)offset);
    int64_t got = slc_input_file_read_some(file, offset, bytes, size);
    if (got == (int64_t)size)
        return SLUICE_SUCCESS;
    if (got < 0)
        return fail_read(file, slc_system_result(errno), offset, size, slc_input_error_text(errno));
    return fail_read(file, SLUICE_ERROR_IO, offset, size, "the file has become shorter");
}

SluiceResult slc_input_fail_at(const struct slc_input_file *file, SluiceResult result,
                               uint64_t offset, const char *text)
{
    return slc_input_fail(file, result, "at %llu: %s", (unsigned long long)offset, text);
}

struct slc_file_stamp slc_input_file_stamp(const struct slc_input_file *file)
{
    struct slc_file_status status;
    int descriptor = is_in_file(file) ? borrow_descriptor(file) : -1;
    if (descriptor < 0)
        return (struct slc_file_stamp){0};
    bool is_known = slc_file_get_status(descriptor, &status);
    return_descriptor(file);
    if (!is_known)
        return (struct slc_file_stamp){0};
    return (struct slc_file_stamp){{status.modified.seconds, status.changed.seconds},
                                   {status.modified.nanoseconds, status.changed.nanoseconds},
                                   status.size};
}
