#define _POSIX_C_SOURCE 200809L
#define _FILE_OFFSET_BITS 64

#include "exr/write_file.h"

#include "base/alloc.h"
#include "base/log.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static SluiceResult fail(const struct slc_write_file *file, const char *what)
{
    slc_log(&file->log, SLUICE_LOG_ERROR, "%s: cannot %s: %s", file->path, what, strerror(errno));
    return SLUICE_ERROR_IO;
}

SluiceResult slc_write_file_open(struct slc_write_file *file, const char *path,
                                 const SluiceAllocationCallbacks *cb, const SluiceLogCallback *log)
{
    enum { MAX_ATTEMPTS = 1000 };
    *file = (struct slc_write_file){
        .allocator = *cb, .log = *log, .path = path, .temporary_size = strlen(path) + 16};
    file->temporary_path = slc_alloc(cb, file->temporary_size, 1);
    if (!file->temporary_path)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    /* Names that others may be writing to at the same moment are passed over. */
    for (int attempt = 0; attempt < MAX_ATTEMPTS; attempt++) {
        snprintf(file->temporary_path, file->temporary_size, "%s.part%d", path, attempt);
        file->descriptor =
            open(file->temporary_path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file->descriptor >= 0)
            return SLUICE_SUCCESS;
        if (errno != EEXIST)
            break;
    }
    SluiceResult result = fail(file, "create");
    slc_free(cb, file->temporary_path, file->temporary_size, 1);
    return result;
}

bool slc_write_file_put(struct slc_write_file *file, const void *bytes, uint64_t size,
                        uint64_t offset)
{
    uint64_t done = 0;
    while (done < size) {
        uint64_t rest = size - done;
        size_t step = rest < 1u << 30 ? (size_t)rest : 1u << 30; /* a write is at most 2^31 */
        ssize_t put =
            pwrite(file->descriptor, (const char *)bytes + done, step, (off_t)(offset + done));
        if (put >= 0) {
            done += (uint64_t)put;
        } else if (errno != EINTR) {
            fail(file, "write");
            file->has_failed = true;
            return false;
        }
    }
    return true;
}

SluiceResult slc_write_file_finish(struct slc_write_file *file, bool keep)
{
    SluiceResult result = file->has_failed ? SLUICE_ERROR_IO : SLUICE_SUCCESS;
    if (close(file->descriptor) != 0 && result == SLUICE_SUCCESS)
        result = fail(file, "close");
    if (keep && result == SLUICE_SUCCESS && rename(file->temporary_path, file->path) != 0)
        result = fail(file, "rename to its name");
    if (!keep || result != SLUICE_SUCCESS)
        unlink(file->temporary_path);
    slc_free(&file->allocator, file->temporary_path, file->temporary_size, 1);
    return result;
}
