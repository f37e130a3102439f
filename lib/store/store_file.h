/** Files by position: whole reads and writes, whatever the system does in between. */
#ifndef SLC_STORE_STORE_FILE_H
#define SLC_STORE_STORE_FILE_H

#include <sluice/base.h>

#include "base/said.h"

/** What messages and reads need of an open file. */
struct slc_store_file {
    SluiceAllocationCallbacks allocator;
    SluiceLogCallback log;
    char *path; ///< owned
    int descriptor;
    uint64_t size;         ///< when it was opened
    struct slc_said *said; ///< of faults that are read again and again; NULL: all are logged
};

/**
 * Opens a regular file for reading. Logs every failure of the system.
 *
 * Returns SLUICE_NOT_READY for want of file descriptors: close the file and open it again later.
 * Errors: FILE_NOT_FOUND, IO, OUT_OF_HOST_MEMORY.
 */
SluiceResult slc_store_file_open(struct slc_store_file *file, const char *path,
                                 const SluiceAllocationCallbacks *cb, const SluiceLogCallback *log);
/** Also after a failed open. */
void slc_store_file_close(struct slc_store_file *file);

/** Reads all of `size` bytes. Returns SLUICE_NOT_READY if the system says "try again". Errors: IO,
 *  also beyond the end; OUT_OF_HOST_MEMORY. Logs every failure. Any thread. */
SluiceResult slc_store_file_read(const struct slc_store_file *file, uint64_t offset, void *bytes,
                                 size_t size);
/** All of `size` bytes. Errors: IO, logged; any number of the bytes may be written then. */
SluiceResult slc_store_file_write(const struct slc_store_file *file, uint64_t offset,
                                  const void *bytes, size_t size);

/** Logs an error with the path and the offset in front and returns `result`. */
SluiceResult slc_store_fail_at(const struct slc_store_file *file, SluiceResult result,
                               uint64_t offset, const char *what);
/** The same for a call of the system that failed: IO, with what errno says. */
SluiceResult slc_store_fail_system(const struct slc_store_file *file, const char *what);

#endif /* SLC_STORE_STORE_FILE_H */
