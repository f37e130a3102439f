#define _XOPEN_SOURCE 700
#define _FILE_OFFSET_BITS 64

#include "store/fault_io.h"

#include <errno.h>
#include <signal.h>
#include <stddef.h>
#include <sys/types.h>

struct fault_io fault_io;

/* With 64-bit offsets the C library gives these calls other names on some systems. */
ssize_t __real_pread(int descriptor, void *bytes, size_t size, off_t offset);
ssize_t __real_pwrite(int descriptor, const void *bytes, size_t size, off_t offset);
int __real_fsync(int descriptor);
int __real_rename(const char *from, const char *to);
int __real_ftruncate(int descriptor, off_t size);
ssize_t __wrap_pread(int descriptor, void *bytes, size_t size, off_t offset);
ssize_t __wrap_pread64(int descriptor, void *bytes, size_t size, off_t offset);
ssize_t __wrap_pwrite(int descriptor, const void *bytes, size_t size, off_t offset);
ssize_t __wrap_pwrite64(int descriptor, const void *bytes, size_t size, off_t offset);
int __wrap_fsync(int descriptor);
int __wrap_rename(const char *from, const char *to);
int __wrap_ftruncate(int descriptor, off_t size);
int __wrap_ftruncate64(int descriptor, off_t size);

static bool fails(enum fault_call call)
{
    uint64_t number = ++fault_io.count[call], at = fault_io.fail_at[call];
    if (number == fault_io.kill_at[call])
        raise(SIGKILL);
    if (at == 0 || number < at || (number > at && !fault_io.is_lasting))
        return false;
    errno = fault_io.error;
    return true;
}

static bool is_interrupted(enum fault_call call)
{
    if (!fault_io.interrupts || fault_io.count[call] % 2 == 0)
        return false;
    errno = EINTR;
    return true;
}

static size_t cut(size_t size)
{
    return fault_io.longest && size > fault_io.longest ? fault_io.longest : size;
}

ssize_t __wrap_pread(int descriptor, void *bytes, size_t size, off_t offset)
{
    if (fails(FAULT_READ) || is_interrupted(FAULT_READ))
        return -1;
    ssize_t got = __real_pread(descriptor, bytes, cut(size), offset);
    if (got > 0) {
        fault_io.read_size += (uint64_t)got;
        if ((uint64_t)got > fault_io.largest_read)
            fault_io.largest_read = (uint64_t)got;
    }
    return got;
}

ssize_t __wrap_pwrite(int descriptor, const void *bytes, size_t size, off_t offset)
{
    if (fails(FAULT_WRITE)) {
        if (fault_io.writes_half)
            (void)!__real_pwrite(descriptor, bytes, size / 2, offset);
        errno = fault_io.error;
        return -1;
    }
    return is_interrupted(FAULT_WRITE) ? -1 : __real_pwrite(descriptor, bytes, cut(size), offset);
}

int __wrap_fsync(int descriptor)
{
    return fails(FAULT_SYNC) ? -1 : __real_fsync(descriptor);
}

int __wrap_rename(const char *from, const char *to)
{
    return fails(FAULT_RENAME) ? -1 : __real_rename(from, to);
}

int __wrap_ftruncate(int descriptor, off_t size)
{
    return fails(FAULT_CUT) ? -1 : __real_ftruncate(descriptor, size);
}

ssize_t __wrap_pread64(int descriptor, void *bytes, size_t size, off_t offset)
{
    return __wrap_pread(descriptor, bytes, size, offset);
}

ssize_t __wrap_pwrite64(int descriptor, const void *bytes, size_t size, off_t offset)
{
    return __wrap_pwrite(descriptor, bytes, size, offset);
}

int __wrap_ftruncate64(int descriptor, off_t size)
{
    return __wrap_ftruncate(descriptor, size);
}
