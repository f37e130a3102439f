#define _DEFAULT_SOURCE /* flock */
#define _FILE_OFFSET_BITS 64
#ifdef __APPLE__
#define _DARWIN_C_SOURCE
#define st_atim st_atimespec
#define st_mtim st_mtimespec
#define st_ctim st_ctimespec
#endif

#include "platform/file.h"

#include "platform/status_posix.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <unistd.h>

#define MAX_TRANSFER ((size_t)1 << 30) /* Linux and macOS move at most 2^31 bytes in a call. */

int slc_file_open(const char *path)
{
    int descriptor;
    do
        descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    while (descriptor < 0 && errno == EINTR);
    return descriptor;
}

/* Moves a descriptor above 2. Otherwise, output of a process without standard output would go to
 * it. */
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

int slc_file_create(const char *path, uint32_t permissions)
{
    return above_standard(
        open(path, O_RDWR | O_CREAT | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW, (mode_t)permissions));
}

int slc_file_open_stream(const char *path)
{
    return above_standard(open(path, O_WRONLY | O_CLOEXEC | O_NOCTTY));
}

void slc_file_close(int descriptor)
{
    close(descriptor);
}

uint64_t slc_get_descriptor_limit(void)
{
    struct rlimit limit;
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
        return UINT64_MAX;
    return (uint64_t)limit.rlim_cur;
}

static enum slc_node_kind kind_of(mode_t mode)
{
    if (S_ISREG(mode))
        return SLC_NODE_FILE;
    if (S_ISDIR(mode))
        return SLC_NODE_FOLDER;
    if (S_ISLNK(mode))
        return SLC_NODE_LINK;
    return S_ISCHR(mode) || S_ISFIFO(mode) ? SLC_NODE_STREAM : SLC_NODE_OTHER;
}

static struct slc_file_time time_of(struct timespec time)
{
    return (struct slc_file_time){(int64_t)time.tv_sec, (int64_t)time.tv_nsec};
}

void slc_read_stat(const struct stat *from, struct slc_file_status *status)
{
    *status = (struct slc_file_status){.kind = kind_of(from->st_mode),
                                       .permissions = from->st_mode & 0777,
                                       .device = (uint64_t)from->st_dev,
                                       .inode = (uint64_t)from->st_ino,
                                       .link_count = (uint64_t)from->st_nlink,
                                       .size = (uint64_t)from->st_size,
                                       .read = time_of(from->st_atim),
                                       .modified = time_of(from->st_mtim),
                                       .changed = time_of(from->st_ctim)};
}

static bool read_answer(int result, const struct stat *from, struct slc_file_status *status)
{
    if (result == 0)
        slc_read_stat(from, status);
    return result == 0;
}

bool slc_file_get_status(int descriptor, struct slc_file_status *status)
{
    struct stat answer;
    return read_answer(fstat(descriptor, &answer), &answer, status);
}

bool slc_path_get_status(const char *path, struct slc_file_status *status)
{
    struct stat answer;
    return read_answer(stat(path, &answer), &answer, status);
}

bool slc_path_get_link_status(const char *path, struct slc_file_status *status)
{
    struct stat answer;
    return read_answer(lstat(path, &answer), &answer, status);
}

static size_t at_once(size_t size)
{
    return size < MAX_TRANSFER ? size : MAX_TRANSFER;
}

int64_t slc_file_read_at(int descriptor, uint64_t offset, void *bytes, size_t size)
{
    return pread(descriptor, bytes, at_once(size), (off_t)offset);
}

int64_t slc_file_write_at(int descriptor, uint64_t offset, const void *bytes, size_t size)
{
    return pwrite(descriptor, bytes, at_once(size), (off_t)offset);
}

int64_t slc_file_append(int descriptor, const void *bytes, size_t size)
{
    return write(descriptor, bytes, at_once(size));
}

bool slc_file_lock(int descriptor)
{
    return flock(descriptor, LOCK_EX | LOCK_NB) == 0;
}

bool slc_file_set_size(int descriptor, uint64_t size)
{
    return ftruncate(descriptor, (off_t)size) == 0;
}

bool slc_file_reserve(int descriptor, uint64_t size)
{
#ifdef __APPLE__
    (void)descriptor, (void)size; /* this system has no posix_fallocate */
    errno = EOPNOTSUPP;
#else
    do
        errno = posix_fallocate(descriptor, 0, (off_t)size);
    while (errno == EINTR);
#endif
    return errno == 0;
}

bool slc_file_sync(int descriptor)
{
#ifdef F_FULLFSYNC /* macOS: fsync leaves bytes in the drive's memory. Not all file systems know   \
                      it. */
    if (fcntl(descriptor, F_FULLFSYNC) == 0)
        return true;
#endif
    return fsync(descriptor) == 0;
}

void slc_file_set_permissions(int descriptor, uint32_t permissions)
{
    (void)!fchmod(descriptor, (mode_t)permissions);
}

const char *slc_path_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

bool slc_path_is_writable(const char *path)
{
    return faccessat(AT_FDCWD, path, W_OK, AT_EACCESS) == 0;
}

bool slc_path_replace(const char *from, const char *to)
{
    return rename(from, to) == 0;
}

bool slc_path_remove(const char *path)
{
    return unlink(path) == 0;
}

void slc_path_touch(const char *path)
{
    const struct timespec times[2] = {{.tv_nsec = UTIME_NOW}, {.tv_nsec = UTIME_OMIT}};
    (void)!utimensat(AT_FDCWD, path, times, 0);
}

char *slc_path_resolve(const char *path)
{
    return realpath(path, NULL);
}

uint64_t slc_get_process_id(void)
{
    return (uint64_t)getpid();
}
