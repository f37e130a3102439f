#define _DEFAULT_SOURCE /* flock */
#define _FILE_OFFSET_BITS 64

#include "base/part_file.h"

#include "base/alloc.h"
#include "base/log.h"
#include "base/system.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

static SluiceResult fail(const struct slc_part_file *part, const char *path, const char *why)
{
    slc_log(&part->log, SLUICE_LOG_ERROR, "%s: %s", path, why);
    return SLUICE_ERROR_IO;
}

static SluiceResult fail_system(const struct slc_part_file *part, const char *what)
{
    slc_log(&part->log, SLUICE_LOG_ERROR, "%s: cannot %s: %s", part->path, what, strerror(errno));
    return SLUICE_ERROR_IO;
}

/* As fail_system, with a result that says whether to try again. */
static SluiceResult fail_open(const struct slc_part_file *part, const char *what)
{
    SluiceResult result = slc_system_result(errno);
    fail_system(part, what);
    return result;
}

static SluiceResult fail_write(const struct slc_part_file *part, uint64_t offset, const char *why)
{
    slc_log(&part->log, SLUICE_LOG_ERROR, "%s: at %llu: %s", part->path, (unsigned long long)offset,
            why);
    return SLUICE_ERROR_IO;
}

static void close_descriptor(struct slc_part_file *part)
{
    if (part->descriptor >= 0)
        close(part->descriptor);
    part->descriptor = -1;
}

static bool is_still_there(const struct slc_part_file *part, const struct stat *status)
{
    struct stat named;
    return lstat(part->path, &named) == 0 && named.st_dev == status->st_dev &&
           named.st_ino == status->st_ino;
}

static SluiceResult lock(const struct slc_part_file *part)
{
    if (flock(part->descriptor, LOCK_EX | LOCK_NB) == 0)
        return SLUICE_SUCCESS;
    if (errno != EWOULDBLOCK)
        return fail_system(part, "lock");
    fail(part, part->target, "another writer is at work on this file");
    return SLUICE_ERROR_BUSY;
}

/* `*is_gone`: what was opened was finished or removed by its writer before the lock was ours. */
static SluiceResult check_part(struct slc_part_file *part, bool *is_gone)
{
    struct stat status;
    if (fstat(part->descriptor, &status) != 0)
        return fail_system(part, "stat");
    if (!S_ISREG(status.st_mode))
        return fail(part, part->path, "is there already and is no regular file");
    *is_gone = !is_still_there(part, &status);
    if (*is_gone)
        return SLUICE_ERROR_IO;
    if (status.st_nlink != 1)
        return fail(part, part->path, "has hard links, whose contents would be lost; remove it");
    part->size = (uint64_t)status.st_size;
    return SLUICE_SUCCESS;
}

/* Private files stay private, also while they are written. */
static mode_t wanted_mode(const struct slc_part_file *part, mode_t without_target)
{
    struct stat status;
    bool is_there = lstat(part->target, &status) == 0 && S_ISREG(status.st_mode);
    return is_there ? status.st_mode & 0777 : without_target;
}

/* File systems without permissions refuse this call, and need not. 0: as the system's mask says. */
static void set_mode(const struct slc_part_file *part, mode_t mode)
{
    if (mode != 0)
        (void)!fchmod(part->descriptor, mode);
}

/* Never 0 to 2: a program that was started without its standard output prints to 1. */
static int above_standard(int descriptor)
{
    if (descriptor < 0 || descriptor > STDERR_FILENO)
        return descriptor;
    int higher = fcntl(descriptor, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    int error = errno;
    close(descriptor);
    errno = error;
    return higher;
}

/* A descriptor is left only after a success, so that nothing else is ever taken for ours. */
static SluiceResult open_and_lock(struct slc_part_file *part, bool *is_gone)
{
    *is_gone = false;
    part->descriptor =
        above_standard(open(part->path, O_RDWR | O_CREAT | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW,
                            wanted_mode(part, 0666)));
    if (part->descriptor < 0 && errno == ELOOP)
        return fail(part, part->path, "is a symbolic link, which is not followed; remove it");
    if (part->descriptor < 0)
        return fail_open(part, "create");
    SluiceResult result = lock(part);
    if (result == SLUICE_SUCCESS)
        result = check_part(part, is_gone);
    if (result != SLUICE_SUCCESS)
        close_descriptor(part);
    return result;
}

/* While there is a path to cut off at the last slash. */
static SluiceResult open_folder(struct slc_part_file *part)
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
    return fail_open(part, "open the folder");
}

static bool takes_a_stream(const struct stat *status)
{
    return S_ISCHR(status->st_mode) || S_ISFIFO(status->st_mode);
}

/* Root may write to files that are read-only: the mode says what their owner wants. */
static bool is_read_only(const char *path, const struct stat *status)
{
    return (status->st_mode & 0222) == 0 ||
           (faccessat(AT_FDCWD, path, W_OK, AT_EACCESS) != 0 && errno == EACCES);
}

/* A file at the target is replaced; whatever else is there stays, and the call is refused. */
static SluiceResult check_target(const struct slc_part_file *part)
{
    struct stat status;
    if (lstat(part->target, &status) != 0)
        return SLUICE_SUCCESS;
    if (S_ISLNK(status.st_mode))
        return fail(part, part->target,
                    "is a symbolic link, which is neither followed nor replaced; name the file "
                    "that it stands for");
    if (S_ISDIR(status.st_mode))
        return fail(part, part->target, "is there already and is a folder");
    if (!S_ISREG(status.st_mode))
        return fail(part, part->target, "is there already and is no regular file");
    if (is_read_only(part->target, &status))
        return fail(part, part->target, "is there already and is read-only");
    return SLUICE_SUCCESS;
}

static bool find_stream(const struct slc_part_file *part)
{
    struct stat status;
    return stat(part->target, &status) == 0 && takes_a_stream(&status);
}

/* Nothing is created and nothing cut: it may have become another file since it was looked at. */
static SluiceResult open_direct(struct slc_part_file *part)
{
    struct stat status;
    part->is_direct = true;
    part->path[strlen(part->target)] = '\0';
    part->descriptor = above_standard(open(part->target, O_WRONLY | O_CLOEXEC | O_NOCTTY));
    if (part->descriptor < 0)
        return fail_open(part, "open");
    if (fstat(part->descriptor, &status) == 0 && takes_a_stream(&status))
        return SLUICE_SUCCESS;
    close_descriptor(part);
    return fail(part, part->target, "is no pipe and no character device any more");
}

static SluiceResult open_beside(struct slc_part_file *part, bool resume)
{
    enum { MAX_ATTEMPTS = 1000 };
    SluiceResult result = check_target(part);
    if (result == SLUICE_SUCCESS)
        result = open_folder(part);
    if (result != SLUICE_SUCCESS)
        return result;
    bool is_gone = true;
    for (int attempt = 0; is_gone && attempt < MAX_ATTEMPTS; attempt++)
        result = open_and_lock(part, &is_gone);
    if (is_gone)
        return fail(part, part->path, "others keep removing it");
    mode_t mode = wanted_mode(part, 0);
    if (result == SLUICE_SUCCESS && mode != 0) /* which the next writer can open, too */
        set_mode(part, mode | S_IRUSR | S_IWUSR);
    if (result == SLUICE_SUCCESS && !resume && part->size > 0) {
        part->size = 0;
        result = slc_part_file_cut(part, 0);
    }
    return result;
}

SluiceResult slc_part_file_open(struct slc_part_file *part, const char *name, uint32_t flags,
                                const SluiceAllocationCallbacks *cb, const SluiceLogCallback *log)
{
    *part = (struct slc_part_file){.allocator = *cb,
                                   .log = *log,
                                   .path_size = strlen(name) + sizeof ".sluice-part",
                                   .descriptor = -1,
                                   .folder = -1,
                                   .is_open = true,
                                   .is_unsynced = (flags & SLC_PART_FILE_UNSYNCED) != 0};
    part->target = slc_strdup(cb, name);
    part->path = slc_alloc(cb, part->path_size, 1);
    if (!part->target || !part->path)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    snprintf(part->path, part->path_size, "%s.sluice-part", name);
    if ((flags & SLC_PART_FILE_STREAM) && find_stream(part))
        return open_direct(part);
    return open_beside(part, (flags & SLC_PART_FILE_RESUME) != 0);
}

SluiceResult slc_part_file_write(const struct slc_part_file *part, uint64_t offset,
                                 const void *bytes, size_t size)
{
    size_t done = 0;
    while (done < size) {
        ssize_t put = pwrite(part->descriptor, (const char *)bytes + done, size - done,
                             (off_t)(offset + done));
        if (put > 0)
            done += (size_t)put;
        else if (put == 0 || errno != EINTR)
            return fail_write(part, offset + done, put ? strerror(errno) : "nothing is written");
    }
    return SLUICE_SUCCESS;
}

SluiceResult slc_part_file_append(const struct slc_part_file *part, const void *bytes, size_t size)
{
    size_t done = 0;
    while (done < size) {
        ssize_t put = write(part->descriptor, (const char *)bytes + done, size - done);
        if (put > 0)
            done += (size_t)put;
        else if (put < 0 && errno != EINTR)
            return fail_system(part, "write");
        else if (put == 0)
            return fail(part, part->path, "cannot write: nothing is taken");
    }
    return SLUICE_SUCCESS;
}

SluiceResult slc_part_file_cut(const struct slc_part_file *part, uint64_t size)
{
    if (ftruncate(part->descriptor, (off_t)size) != 0)
        return fail_system(part, "set the length");
    return SLUICE_SUCCESS;
}

SluiceResult slc_part_file_reserve(const struct slc_part_file *part, uint64_t size)
{
    int error;
    do
        error = posix_fallocate(part->descriptor, 0, (off_t)size);
    while (error == EINTR);
    if (error == EOPNOTSUPP || error == EINVAL) /* of the file system: without a promise, then */
        return slc_part_file_cut(part, size);
    errno = error;
    return error ? fail_system(part, "make room for the index") : SLUICE_SUCCESS;
}

/* So that the new name outlives a crash of the system. Some file systems cannot, and need not. */
static SluiceResult sync_folder(const struct slc_part_file *part)
{
    if (fsync(part->folder) == 0 || errno == EINVAL)
        return SLUICE_SUCCESS;
    return fail_system(part, "sync the folder");
}

/* A NAME.sluice-part that was removed meanwhile may be half a file of the next writer by now. */
static SluiceResult check_ours(const struct slc_part_file *part)
{
    struct stat status;
    if (fstat(part->descriptor, &status) == 0 && is_still_there(part, &status))
        return SLUICE_SUCCESS;
    return fail(part, part->path, "was removed or replaced while it was written");
}

SluiceResult slc_part_file_publish(struct slc_part_file *part)
{
    if (part->is_direct)
        return SLUICE_SUCCESS;
    set_mode(part, wanted_mode(part, 0));
    if (!part->is_unsynced && fsync(part->descriptor) != 0) {
        SluiceResult result = fail_system(part, "sync");
        /* what was not written may be taken as written by the next sync: nothing here is resumed */
        (void)!ftruncate(part->descriptor, 0);
        return result;
    }
    /* Once more: a device that has come since the start would be replaced. */
    SluiceResult result = check_target(part);
    if (result == SLUICE_SUCCESS)
        result = check_ours(part);
    if (result != SLUICE_SUCCESS)
        return result;
    if (rename(part->path, part->target) != 0)
        return fail_system(part, "rename to its name");
    return part->is_unsynced ? SLUICE_SUCCESS : sync_folder(part);
}

void slc_part_file_remove(const struct slc_part_file *part)
{
    struct stat status;
    if (part->is_open && !part->is_direct && part->descriptor >= 0 &&
        fstat(part->descriptor, &status) == 0 && is_still_there(part, &status))
        unlink(part->path);
}

void slc_part_file_close(struct slc_part_file *part)
{
    const SluiceAllocationCallbacks *cb = &part->allocator;
    if (!part->is_open)
        return;
    slc_free(cb, part->path, part->path_size, 1);
    if (part->target)
        slc_free(cb, part->target, strlen(part->target) + 1, 1);
    if (part->folder >= 0)
        close(part->folder);
    close_descriptor(part);
    *part = (struct slc_part_file){.descriptor = -1, .folder = -1};
}

SluiceResult slc_part_file_finish(struct slc_part_file *part, bool keep)
{
    SluiceResult result = keep ? slc_part_file_publish(part) : SLUICE_SUCCESS;
    if (!keep || result != SLUICE_SUCCESS)
        slc_part_file_remove(part);
    slc_part_file_close(part);
    return result;
}
