/**
 * A regular file that is read at offsets, by any number of threads at once. Whoever reads files
 * that are not to be trusted goes through here: nothing beyond the end is asked for, and an error
 * of the system is told from a file that is too short.
 */
#ifndef SLC_IMAGE_INPUT_FILE_H
#define SLC_IMAGE_INPUT_FILE_H

#include <sluice/base.h>

/** Constant while it is open. */
struct slc_input_file {
    SluiceAllocationCallbacks allocator;
    SluiceLogCallback log;
    char *path;     ///< owned
    int descriptor; ///< -1: not open
    uint64_t size;  ///< when it was opened
};

/** Keeps a copy of the path and opens nothing. Errors: OUT_OF_HOST_MEMORY; finish is allowed then.
 */
SluiceResult slc_input_file_init(struct slc_input_file *file, const char *path,
                                 const SluiceAllocationCallbacks *cb, const SluiceLogCallback *log);

/** Opens what is not open. Errors: FILE_NOT_FOUND; IO, also for what is no regular file. Logged. */
SluiceResult slc_input_file_open(struct slc_input_file *file);

/** The opposite of open; what is not open stays so. No read may be under way. */
void slc_input_file_close(struct slc_input_file *file);

/** Closes and frees. A zeroed struct is allowed. */
void slc_input_file_finish(struct slc_input_file *file);

/**
 * Reads `size` bytes at `offset`. Errors: CORRUPT_DATA beyond the end of the file; IO, also for a
 * file that has become shorter. Logged. Thread safety: any thread.
 */
SluiceResult slc_input_file_read(const struct slc_input_file *file, uint64_t offset, void *bytes,
                                 size_t size);

/**
 * Reads up to `size` bytes, fewer at the end of the file alone. The number, or -1 with errno set;
 * not logged. Thread safety: any thread.
 */
int64_t slc_input_file_read_some(const struct slc_input_file *file, uint64_t offset, void *bytes,
                                 uint64_t size);

/** Logs an error with the path in front and returns `result`. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
SluiceResult
slc_input_fail(const struct slc_input_file *file, SluiceResult result, const char *format, ...);

/** Copies as much of a file's own words as fits, with ? for what may not stand in a message. */
void slc_printable(const char *text, char *printable, size_t size);

#endif /* SLC_IMAGE_INPUT_FILE_H */
