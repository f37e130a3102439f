/**
 * Input files. A name may be that of a pipe or a device: opening it must not block, and reading it
 * must not use up memory.
 */
#ifndef TOOLS_COMMON_INPUT_H
#define TOOLS_COMMON_INPUT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/** Opens a regular file for reading, without blocking. Returns NULL and sets errno; see
 * input_reason. */
FILE *input_open(const char *path);

/**
 * Opens a regular file or a stream: "-" and /dev/stdin are the standard input, /dev/fd/N is the
 * open descriptor N. Returns NULL and sets errno.
 */
FILE *input_open_stream(const char *path);

/** Returns the path that input_open_stream opens: /dev/stdin for "-". */
const char *input_stream_path(const char *path);

/** Returns a text for an errno of these functions. */
const char *input_reason(int error);

/**
 * Reads the rest of a stream and appends it to the `*size` bytes of `*data` (malloc'd, less than 64
 * KiB, or NULL and 0), with a NUL that is not counted. Free `*data`. On failure sets it to NULL and
 * returns false with errno: EFBIG if there are more than `limit` bytes in all, ENOMEM, or an errno
 * of fread.
 */
bool input_read_rest(FILE *stream, uint64_t limit, char **data, size_t *size);

/** Reads a regular file of at most `limit` bytes, like input_read_rest. */
bool input_read_file(const char *path, uint64_t limit, char **data, size_t *size);

#endif /* TOOLS_COMMON_INPUT_H */
