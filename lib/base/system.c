#define _POSIX_C_SOURCE 200809L
#define _FILE_OFFSET_BITS 64

#include "base/system.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

SluiceResult slc_system_result(int error)
{
    if (error == EAGAIN || error == EWOULDBLOCK) /* may be one value, so not in the switch */
        return SLUICE_NOT_READY;
    switch (error) {
    case EMFILE:
    case ENFILE:
    case EINTR: return SLUICE_NOT_READY;
    case ENOMEM: return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    case ENOENT:
    case ENOTDIR: return SLUICE_ERROR_FILE_NOT_FOUND;
    default: return SLUICE_ERROR_IO;
    }
}

/* The system gives the lowest free number, so a high one means that all lower ones are in use. */
static bool is_reserved(int descriptor)
{
    struct rlimit limit;
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
        return false;
    rlim_t quarter = limit.rlim_cur / 4;
    rlim_t reserve = quarter < SLC_RESERVED_DESCRIPTORS ? quarter : SLC_RESERVED_DESCRIPTORS;
    return (rlim_t)descriptor >= limit.rlim_cur - reserve;
}

int slc_open_input(const char *path)
{
    int descriptor;
    do
        descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    while (descriptor < 0 && errno == EINTR);
    if (descriptor < 0 || !is_reserved(descriptor))
        return descriptor;
    close(descriptor);
    errno = EMFILE;
    return -1;
}
