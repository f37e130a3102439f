/**
 * Input file: a regular file, or bytes of the application, read at offsets by any number of
 * threads. All reads of untrusted files use it: it never reads beyond the end, and distinguishes
 * errors of the system from files that are too short.
 */
#ifndef SLC_IMAGE_INPUT_FILE_H
#define SLC_IMAGE_INPUT_FILE_H

#include <sluice/input.h>

#include "base/said.h"
#include "image/file_pool.h"

/** Input file. Constant while open. */
struct slc_input_file {
    SluiceAllocationCallbacks allocator;
    SluiceLogCallback log;
    char *path;                     ///< owned; only for messages if there is no file
    SluiceInput input;              ///< zeroed: a file
    SluiceFilePool *pool;           ///< borrowed; NULL: the file stays open
    struct slc_pooled_file *pooled; ///< owned; NULL: no pool
    bool is_open;
    int descriptor;        ///< -1: not open, or opened by `pool`
    uint64_t size;         ///< bytes when the file was opened
    struct slc_said *said; ///< owned; messages that were logged
};

/** Copies the path, without opening. Errors: OUT_OF_HOST_MEMORY; slc_input_file_finish is allowed
 * then. */
SluiceResult slc_input_file_init(struct slc_input_file *file, const char *path,
                                 const SluiceAllocationCallbacks *cb, const SluiceLogCallback *log);

/** Choice of a create-info between a path and an input. */
struct slc_input_choice {
    const char *path; ///< with `input`: a name, or NULL
    const SluiceInput *input;
    SluiceFilePool *pool; ///< NULL: the file stays open; ignored with `input`
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
 * Returns SLUICE_NOT_READY for lack of file descriptors: call again later.
 * Errors: FILE_NOT_FOUND; IO, also if it is not a regular file; OUT_OF_HOST_MEMORY.
 */
SluiceResult slc_input_file_open(struct slc_input_file *file);

/** Closes the file if it is open. No read may be in progress. */
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
 * Reads up to `size` bytes, fewer only at the end of the file. Returns the number, or -1 with errno
 * set; not logged. Thread safety: any thread.
 */
int64_t slc_input_file_read_some(const struct slc_input_file *file, uint64_t offset, void *bytes,
                                 uint64_t size);

/** Stamp of a file, which differs after its contents were changed in place. Zeros if the system
 * does not tell, and for inputs. */
struct slc_file_stamp {
    int64_t seconds[2],
        nanoseconds[2]; ///< times of the last change: [0] of contents, [1] of anything
    uint64_t size;
};
struct slc_file_stamp slc_input_file_stamp(const struct slc_input_file *file);

/** Logs an error with the path in front, once per text. Returns `result`. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
SluiceResult
slc_input_fail(const struct slc_input_file *file, SluiceResult result, const char *format, ...);

/** Fails like slc_input_fail, with "at OFFSET: " before the text. */
SluiceResult slc_input_fail_at(const struct slc_input_file *file, SluiceResult result,
                               uint64_t offset, const char *text);

/** Returns the reason for a failed read in words. `error` is a value of errno. */
const char *slc_input_error_text(int error);

/** Copies as much text of a file as fits, with ? for characters that messages must not have. */
void slc_printable(const char *text, char *printable, size_t size);

#endif /* SLC_IMAGE_INPUT_FILE_H */
