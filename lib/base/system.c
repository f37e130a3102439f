#include "base/system.h"

#include "platform/file.h"

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
    uint64_t limit = slc_get_descriptor_limit(), quarter = limit / 4;
    uint64_t reserve = quarter < SLC_RESERVED_DESCRIPTORS ? quarter : SLC_RESERVED_DESCRIPTORS;
    return (uint64_t)descriptor >= limit - reserve;
}

int slc_open_input(const char *path)
{
    int descriptor = slc_file_open(path);
    if (descriptor < 0 || !is_reserved(descriptor))
        return descriptor;
    slc_file_close(descriptor);
    errno = EMFILE;
    return -1;
}
