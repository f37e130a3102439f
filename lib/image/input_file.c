#define _POSIX_C_SOURCE 200809L
#define _FILE_OFFSET_BITS 64

#include "image/input_file.h"

#include "base/alloc.h"
#include "base/log.h"
#include "base/system.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static SluiceResult say(const struct slc_input_file *file, SluiceResult result, uint64_t key,
                        const char *message)
{
    slc_said_log(file->said, &file->log, file->path, key, message);
    return result;
}

/* Where does not matter: during an outage every read fails. */
static SluiceResult fail_read(const struct slc_input_file *file, SluiceResult result,
                              uint64_t offset, size_t size, const char *why)
{
    char message[512];
    snprintf(message, sizeof message, "cannot read %zu bytes at %llu: %s", size,
             (unsigned long long)offset, why);
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

static SluiceResult check_status(struct slc_input_file *file)
{
    struct stat status;
    if (fstat(file->descriptor, &status) != 0)
        return slc_input_fail(file, slc_system_result(errno), "cannot stat: %s", strerror(errno));
    if (!S_ISREG(status.st_mode))
        return slc_input_fail(file, SLUICE_ERROR_IO, "is not a regular file");
    file->size = (uint64_t)status.st_size;
    return SLUICE_SUCCESS;
}

SluiceResult slc_input_file_open(struct slc_input_file *file)
{
    if (file->descriptor >= 0)
        return SLUICE_SUCCESS;
    file->descriptor = slc_open_input(file->path);
    if (file->descriptor < 0)
        return slc_input_fail(file, slc_system_result(errno), "cannot open: %s", strerror(errno));
    SluiceResult result = check_status(file);
    if (result != SLUICE_SUCCESS)
        slc_input_file_close(file);
    return result;
}

void slc_input_file_close(struct slc_input_file *file)
{
    if (file->descriptor >= 0)
        close(file->descriptor);
    file->descriptor = -1;
}

void slc_input_file_finish(struct slc_input_file *file)
{
    if (file->path) {
        slc_input_file_close(file);
        slc_free(&file->allocator, file->path, strlen(file->path) + 1, 1);
    }
    if (file->said)
        slc_free(&file->allocator, file->said, 1, sizeof *file->said);
    file->path = NULL;
    file->said = NULL;
}

int64_t slc_input_file_read_some(const struct slc_input_file *file, uint64_t offset, void *bytes,
                                 uint64_t size)
{
    uint64_t done = 0;
    while (done < size) {
        uint64_t rest = size - done;
        size_t step = rest < 1u << 30 ? (size_t)rest : 1u << 30; /* a read is at most 2^31 */
        ssize_t got = pread(file->descriptor, (char *)bytes + done, step, (off_t)(offset + done));
        if (got == 0)
            break;
        if (got > 0)
            done += (uint64_t)got;
        else if (errno != EINTR)
            return -1;
    }
    return (int64_t)done;
}

SluiceResult slc_input_file_read(const struct slc_input_file *file, uint64_t offset, void *bytes,
                                 size_t size)
{
    if (offset > file->size || size > file->size - offset)
        return slc_input_fail(file, SLUICE_ERROR_CORRUPT_DATA,
                              "%zu bytes at %llu lie beyond the end of the file", size,
                              (unsigned long long)offset);
    int64_t got = slc_input_file_read_some(file, offset, bytes, size);
    if (got == (int64_t)size)
        return SLUICE_SUCCESS;
    if (got < 0)
        return fail_read(file, slc_system_result(errno), offset, size, strerror(errno));
    return fail_read(file, SLUICE_ERROR_IO, offset, size, "the file has become shorter");
}

struct slc_file_stamp slc_input_file_stamp(const struct slc_input_file *file)
{
    struct stat status;
    if (fstat(file->descriptor, &status) != 0)
        return (struct slc_file_stamp){0};
    return (struct slc_file_stamp){{status.st_mtim.tv_sec, status.st_ctim.tv_sec},
                                   {status.st_mtim.tv_nsec, status.st_ctim.tv_nsec},
                                   (uint64_t)status.st_size};
}
