/** A file that is complete under its name or not there at all: written beside it, then renamed. */
#ifndef SLC_EXR_WRITE_FILE_H
#define SLC_EXR_WRITE_FILE_H

#include <sluice/base.h>

struct slc_write_file {
    SluiceAllocationCallbacks allocator;
    SluiceLogCallback log;
    const char *path; ///< the caller's
    char *temporary_path;
    size_t temporary_size; ///< of the string's memory
    int descriptor;
    bool has_failed; ///< a write failed and was logged
};

/** Creates the file under a temporary name. Errors: IO, logged; OUT_OF_HOST_MEMORY. */
SluiceResult slc_write_file_open(struct slc_write_file *file, const char *path,
                                 const SluiceAllocationCallbacks *cb, const SluiceLogCallback *log);

/** False, logged and remembered, if not all bytes could be written. */
bool slc_write_file_put(struct slc_write_file *file, const void *bytes, uint64_t size,
                        uint64_t offset);

/** Closes the file and, if `keep`, gives it its name; otherwise or on errors removes it. Errors:
 * IO, logged. */
SluiceResult slc_write_file_finish(struct slc_write_file *file, bool keep);

#endif /* SLC_EXR_WRITE_FILE_H */
