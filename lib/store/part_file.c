#define _DEFAULT_SOURCE /* flock */
#define _FILE_OFFSET_BITS 64

#include "store/part_file.h"

#include "base/alloc.h"
#include "base/log.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

static bool is_still_there(const struct slc_store_part *part, const struct stat *status)
{
    struct stat named;
    return lstat(part->file.path, &named) == 0 && named.st_dev == status->st_dev &&
           named.st_ino == status->st_ino;
}

static void close_descriptor(struct slc_store_part *part)
{
    close(part->file.descriptor);
    part->file.descriptor = -1;
}

/* NOT_READY: what was opened was finished or removed by its writer before the lock was ours. */
static SluiceResult open_and_lock(struct slc_store_part *part)
{
    struct slc_store_file *file = &part->file;
    file->descriptor =
        open(file->path, O_RDWR | O_CREAT | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW, 0666);
    if (file->descriptor < 0) {
        bool absent = errno == ENOENT || errno == ENOTDIR;
        slc_store_fail_system(file, "create");
        return absent ? SLUICE_ERROR_FILE_NOT_FOUND : SLUICE_ERROR_IO;
    }
    if (flock(file->descriptor, LOCK_EX | LOCK_NB) != 0) {
        SluiceResult result = slc_store_fail_system(file, "lock; is another writer at work?");
        close_descriptor(part); /* or it would be removed as ours */
        return result;
    }
    struct stat status;
    if (fstat(file->descriptor, &status) != 0)
        return slc_store_fail_system(file, "stat");
    if (!S_ISREG(status.st_mode))
        return slc_store_fail_at(file, SLUICE_ERROR_IO, 0, "is not a regular file");
    file->size = (uint64_t)status.st_size;
    if (is_still_there(part, &status))
        return SLUICE_SUCCESS;
    close_descriptor(part);
    return SLUICE_NOT_READY;
}

/* While there is a path to cut off at the last slash. */
static SluiceResult open_folder(struct slc_store_part *part)
{
    char *slash = strrchr(part->target, '/'), end = '\0';
    if (slash) {
        slash += slash == part->target; /* the root keeps its slash */
        end = *slash;
        *slash = '\0';
    }
    part->folder = open(slash ? part->target : ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    int error = errno;
    if (slash)
        *slash = end;
    if (part->folder >= 0)
        return SLUICE_SUCCESS;
    errno = error;
    slc_store_fail_system(&part->file, "open the folder");
    return error == ENOENT || error == ENOTDIR ? SLUICE_ERROR_FILE_NOT_FOUND : SLUICE_ERROR_IO;
}

/* Devices, pipes and folders would be replaced by a file at the end, or refuse that then. */
static SluiceResult check_target(const struct slc_store_part *part)
{
    struct stat status;
    if (stat(part->target, &status) != 0 || S_ISREG(status.st_mode))
        return SLUICE_SUCCESS;
    slc_log(&part->file.log, SLUICE_LOG_ERROR, "%s: is there already and is no regular file",
            part->target);
    return SLUICE_ERROR_IO;
}

SluiceResult slc_store_part_open(struct slc_store_part *part, const char *path,
                                 const SluiceAllocationCallbacks *cb, const SluiceLogCallback *log)
{
    enum { MAX_ATTEMPTS = 1000 };
    size_t size = strlen(path) + sizeof ".part";
    *part = (struct slc_store_part){.file = {.allocator = *cb, .log = *log, .descriptor = -1},
                                    .folder = -1};
    part->target = slc_strdup(cb, path);
    part->file.path = slc_alloc(cb, size, 1);
    if (!part->target || !part->file.path)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    snprintf(part->file.path, size, "%s.part", path);
    SluiceResult result = check_target(part);
    if (result == SLUICE_SUCCESS)
        result = open_folder(part);
    if (result == SLUICE_SUCCESS)
        result = SLUICE_NOT_READY;
    for (int attempt = 0; result == SLUICE_NOT_READY && attempt < MAX_ATTEMPTS; attempt++)
        result = open_and_lock(part);
    if (result == SLUICE_NOT_READY)
        return slc_store_fail_at(&part->file, SLUICE_ERROR_IO, 0, "others keep removing it");
    return result;
}

SluiceResult slc_store_part_cut(const struct slc_store_part *part, uint64_t size)
{
    if (ftruncate(part->file.descriptor, (off_t)size) != 0)
        return slc_store_fail_system(&part->file, "set the length");
    return SLUICE_SUCCESS;
}

SluiceResult slc_store_part_reserve(const struct slc_store_part *part, uint64_t size)
{
    int error;
    do
        error = posix_fallocate(part->file.descriptor, 0, (off_t)size);
    while (error == EINTR);
    if (error == EOPNOTSUPP || error == EINVAL) /* of the file system: without a promise, then */
        return slc_store_part_cut(part, size);
    errno = error;
    return error ? slc_store_fail_system(&part->file, "make room for the index") : SLUICE_SUCCESS;
}

/* So that the new name outlives a crash of the system. Some file systems cannot, and need not. */
static SluiceResult sync_folder(const struct slc_store_part *part)
{
    if (fsync(part->folder) == 0 || errno == EINVAL)
        return SLUICE_SUCCESS;
    return slc_store_fail_system(&part->file, "sync the folder");
}

SluiceResult slc_store_part_publish(struct slc_store_part *part)
{
    if (fsync(part->file.descriptor) != 0) {
        SluiceResult result = slc_store_fail_system(&part->file, "sync");
        /* what was not written may be taken as written by the next sync: nothing here is resumed */
        (void)!ftruncate(part->file.descriptor, 0);
        return result;
    }
    if (rename(part->file.path, part->target) != 0)
        return slc_store_fail_system(&part->file, "rename to its name");
    return sync_folder(part);
}

void slc_store_part_remove(const struct slc_store_part *part)
{
    struct stat status;
    if (part->file.descriptor >= 0 && fstat(part->file.descriptor, &status) == 0 &&
        is_still_there(part, &status))
        unlink(part->file.path);
}

void slc_store_part_close(struct slc_store_part *part)
{
    const SluiceAllocationCallbacks *cb = &part->file.allocator;
    if (part->target)
        slc_free(cb, part->target, strlen(part->target) + 1, 1);
    part->target = NULL;
    if (part->folder >= 0)
        close(part->folder);
    part->folder = -1;
    slc_store_file_close(&part->file);
}
