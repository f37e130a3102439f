#define _POSIX_C_SOURCE 200809L
#define _FILE_OFFSET_BITS 64

#include "store/store_file.h"

#include "base/alloc.h"
#include "base/log.h"
#include "base/system.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static SluiceResult say(const struct slc_store_file *file, SluiceResult result, uint64_t key,
                        const char *message)
{
    slc_said_log(file->said, &file->log, file->path, key, message);
    return result;
}

/* Where does not matter: during an outage every read fails. */
static SluiceResult fail_read(const struct slc_store_file *file, SluiceResult result,
                              uint64_t offset, const char *why)
{
    char message[512];
    snprintf(message, sizeof message, "at %llu: %s", (unsigned long long)offset, why);
    return say(file, result, slc_said_key(why), message);
}

SluiceResult slc_store_fail_at(const struct slc_store_file *file, SluiceResult result,
                               uint64_t offset, const char *what)
{
    char message[512];
    snprintf(message, sizeof message, "at %llu: %s", (unsigned long long)offset, what);
    return say(file, result, slc_said_key(message), message);
}

SluiceResult slc_store_fail_system(const struct slc_store_file *file, const char *what)
{
    slc_log(&file->log, SLUICE_LOG_ERROR, "%s: cannot %s: %s", file->path, what, strerror(errno));
    return SLUICE_ERROR_IO;
}

/* As slc_store_fail_system, with a result that says whether to try again. */
static SluiceResult fail_for_now(const struct slc_store_file *file, const char *what)
{
    SluiceResult result = slc_system_result(errno);
    slc_store_fail_system(file, what);
    return result;
}

static SluiceResult open_descriptor(struct slc_store_file *file)
{
    file->descriptor = slc_open_input(file->path);
    if (file->descriptor < 0)
        return fail_for_now(file, "open");
    struct stat status;
    if (fstat(file->descriptor, &status) != 0)
        return fail_for_now(file, "stat");
    if (!S_ISREG(status.st_mode))
        return slc_store_fail_at(file, SLUICE_ERROR_IO, 0, "is not a regular file");
    file->size = (uint64_t)status.st_size;
    return SLUICE_SUCCESS;
}

SluiceResult slc_store_file_open(struct slc_store_file *file, const char *path,
                                 const SluiceAllocationCallbacks *cb, const SluiceLogCallback *log)
{
    *file = (struct slc_store_file){.allocator = *cb, .log = *log, .descriptor = -1};
    file->path = slc_strdup(cb, path);
    return file->path ? open_descriptor(file) : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

void slc_store_file_close(struct slc_store_file *file)
{
    if (!file->path)
        return;
    if (file->descriptor >= 0)
        close(file->descriptor);
    slc_free(&file->allocator, file->path, strlen(file->path) + 1, 1);
    file->path = NULL;
}

SluiceResult slc_store_file_read(const struct slc_store_file *file, uint64_t offset, void *bytes,
                                 size_t size)
{
    size_t done = 0;
    while (done < size) {
        ssize_t got =
            pread(file->descriptor, (char *)bytes + done, size - done, (off_t)(offset + done));
        if (got == 0)
            return fail_read(file, SLUICE_ERROR_IO, offset + done,
                             "the file ends here; it has become shorter");
        if (got > 0)
            done += (size_t)got;
        else if (errno != EINTR)
            return fail_read(file, slc_system_result(errno), offset + done, strerror(errno));
    }
    return SLUICE_SUCCESS;
}

SluiceResult slc_store_file_write(const struct slc_store_file *file, uint64_t offset,
                                  const void *bytes, size_t size)
{
    size_t done = 0;
    while (done < size) {
        ssize_t put = pwrite(file->descriptor, (const char *)bytes + done, size - done,
                             (off_t)(offset + done));
        if (put > 0)
            done += (size_t)put;
        else if (put == 0 || errno != EINTR)
            return slc_store_fail_at(file, SLUICE_ERROR_IO, offset + done,
                                     put ? strerror(errno) : "nothing can be written");
    }
    return SLUICE_SUCCESS;
}
