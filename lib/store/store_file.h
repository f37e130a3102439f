/** File of a store that is being written: complete reads and writes. */
#ifndef SLC_STORE_STORE_FILE_H
#define SLC_STORE_STORE_FILE_H

#include <sluice/base.h>

/** A file that is being written: its path, log and allocator. */
struct slc_store_file {
    SluiceAllocationCallbacks allocator;
    SluiceLogCallback log;
    const char *path;
    int descriptor;
    uint64_t size; ///< bytes when the file was opened
};

/** Reads all of `size` bytes. Returns SLUICE_NOT_READY if the system says "try again". Errors: IO,
 *  also beyond the end; OUT_OF_HOST_MEMORY. Logs every failure. Any thread. */
SluiceResult slc_store_file_read(const struct slc_store_file *file, uint64_t offset, void *bytes,
                                 size_t size);
/** Writes all of `size` bytes. Errors: IO, logged; some of the bytes may be written then. */
SluiceResult slc_store_file_write(const struct slc_store_file *file, uint64_t offset,
                                  const void *bytes, size_t size);

/** Logs an error with the path and the offset in front and returns `result`. */
SluiceResult slc_store_fail_at(const struct slc_store_file *file, SluiceResult result,
                               uint64_t offset, const char *what);

#endif /* SLC_STORE_STORE_FILE_H */
