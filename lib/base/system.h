/** Errors of the operating system as results, and opening of input files. */
#ifndef SLC_BASE_SYSTEM_H
#define SLC_BASE_SYSTEM_H

#include <sluice/base.h>

/** Descriptors below the soft limit that inputs leave to outputs, devices and the application. */
#define SLC_RESERVED_DESCRIPTORS 16

/**
 * Returns the result for a value of errno. NOT_READY: try again later (EMFILE, ENFILE, EAGAIN,
 * EINTR). OUT_OF_HOST_MEMORY: ENOMEM. FILE_NOT_FOUND: ENOENT, ENOTDIR. IO: everything else.
 */
SluiceResult slc_system_result(int error);

/**
 * Opens a file for reading and returns its descriptor, or -1 with errno set. Never waits for the
 * writer of a pipe.
 *
 * Fails with EMFILE before the last SLC_RESERVED_DESCRIPTORS below the soft limit are used, at most
 * a quarter of all. Thread safety: any thread.
 */
int slc_open_input(const char *path);

#endif /* SLC_BASE_SYSTEM_H */
