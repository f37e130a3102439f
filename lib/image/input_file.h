/**
 * A regular file, or bytes that stand for one, read at offsets by any number of threads at once.
 * Whoever reads files that are not to be trusted goes through here: nothing beyond the end is asked
 * for, and an error of the system is told from a file that is too short.
 */
#ifndef SLC_IMAGE_INPUT_FILE_H
#define SLC_IMAGE_INPUT_FILE_H

#include <sluice/input.h>

#include "base/said.h"
#include "image/file_pool.h"

/** Constant while it is open. */
struct slc_input_file {
    SluiceAllocationCallbacks allocator;
    SluiceLogCallback log;
    char *path;                     ///< owned; for messages alone if the bytes are in no file
    SluiceInput input;              ///< zeroed: a file
    SluiceFilePool *pool;           ///< borrowed; NULL: the file stays open
    struct slc_pooled_file *pooled; ///< owned; NULL: no pool
    bool is_open;
    int descriptor;        ///< -1: not open, or not by itself
    uint64_t size;         ///< when it was opened
    struct slc_said *said; ///< owned; what the log was told
};

/** Keeps a copy of the path and opens nothing. Errors: OUT_OF_HOST_MEMORY; finish is allowed then.
 */
SluiceResult slc_input_file_init(struct slc_input_file *file, const char *path,
                                 const SluiceAllocationCallbacks *cb, const SluiceLogCallback *log);

/** Where bytes come from, as create-infos say it. */
struct slc_input_choice {
    const char *path; ///< may be NULL if `input` is set, and is a name then
    const SluiceInput *input;
    SluiceFilePool *pool; ///< NULL: the file stays open; without effect on `input`
};

/** Opens a path or an input. Errors: those of slc_input_file_init; NULL_POINTER, INVALID_ARGUMENT
 *  and UNSUPPORTED if `input` is wrong. All are logged. */
SluiceResult slc_input_file_init_choice(struct slc_input_file *file,
                                        const struct slc_input_choice *choice,
                                        const SluiceAllocationCallbacks *cb,
                                        const SluiceLogCallback *log);

/**
 * Opens the file unless it is open. Logs every failure.
 *
 * Returns SLUICE_NOT_READY for want of file descriptors: call again later.
 * Errors: FILE_NOT_FOUND; IO, also for what is no regular file; OUT_OF_HOST_MEMORY.
 */
SluiceResult slc_input_file_open(struct slc_input_file *file);

/** The opposite of open; what is not open stays so. No read may be under way. */
void slc_input_file_close(struct slc_input_file *file);

/** Closes and frees. A zeroed struct is allowed. */
void slc_input_file_finish(struct slc_input_file *file);

/**
 * Reads `size` bytes at `offset`. Logs every failure. Returns SLUICE_NOT_READY if the system says
 * "try again". Errors: CORRUPT_DATA beyond the end of the file; IO, also for a file that has become
 * shorter; OUT_OF_HOST_MEMORY. Thread safety: any thread.
 */
SluiceResult slc_input_file_read(const struct slc_input_file *file, uint64_t offset, void *bytes,
                                 size_t size);

/**
 * Reads up to `size` bytes, fewer at the end of the file alone. The number, or -1 with errno set;
 * not logged. Thread safety: any thread.
 */
int64_t slc_input_file_read_some(const struct slc_input_file *file, uint64_t offset, void *bytes,
                                 uint64_t size);

/** Differs after the contents were changed in place. Zeros if the system does not say, and for
 * bytes in no file. */
struct slc_file_stamp {
    int64_t seconds[2], nanoseconds[2]; ///< of the last change of contents, and of anything
    uint64_t size;
};
struct slc_file_stamp slc_input_file_stamp(const struct slc_input_file *file);

/** Logs an error, once for each text, with the path in front and returns `result`. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
SluiceResult
slc_input_fail(const struct slc_input_file *file, SluiceResult result, const char *format, ...);

/** Fails like slc_input_fail, with "at OFFSET: " before the text. */
SluiceResult slc_input_fail_at(const struct slc_input_file *file, SluiceResult result,
                               uint64_t offset, const char *text);

/** The reason for a failed read in words. `error` is a value of errno. */
const char *slc_input_error_text(int error);

/** Copies as much of a file's own words as fits, with ? for what may not stand in a message. */
void slc_printable(const char *text, char *printable, size_t size);

#endif /* SLC_IMAGE_INPUT_FILE_H */
