/** Files by position: whole reads and writes, whatever the system does in between. */
#ifndef SLC_STORE_FILE_H
#define SLC_STORE_FILE_H

#include <sluice/base.h>

/** What messages and reads need of an open file. */
struct slc_store_file {
    SluiceAllocationCallbacks allocator;
    SluiceLogCallback log;
    char *path; ///< owned
    int descriptor;
    uint64_t size; ///< when it was opened
};

/** Opens a regular file for reading. Errors: FILE_NOT_FOUND, IO, logged; OUT_OF_HOST_MEMORY. */
SluiceResult slc_store_file_open(struct slc_store_file *file, const char *path,
                                 const SluiceAllocationCallbacks *cb, const SluiceLogCallback *log);
/** Also after a failed open. */
void slc_store_file_close(struct slc_store_file *file);

/** All of `size` bytes. Errors: IO, also beyond the end; logged. Any thread. */
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

#endif /* SLC_STORE_FILE_H */
