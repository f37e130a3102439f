/**
 * Files that somebody named as input. A name may be that of a pipe or a device: opening it must not
 * make the program wait, and reading it must not take all memory.
 */
#ifndef TOOLS_COMMON_INPUT_H
#define TOOLS_COMMON_INPUT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/** Opens a regular file for reading, without waiting. NULL with errno set; see input_reason. */
FILE *input_open(const char *path);

/**
 * Opens a regular file, or takes a stream that the program was given on purpose: "-" and /dev/stdin
 * are the standard input, /dev/fd/N is the open descriptor N. NULL with errno set.
 */
FILE *input_open_stream(const char *path);

/** The path of what input_open_stream opens for a name: /dev/stdin for "-". */
const char *input_stream_path(const char *path);

/** Words for an errno of these functions. */
const char *input_reason(int error);

/**
 * Reads the rest of a stream behind the `*size` bytes of `*data` (malloc'd, less than 64 KiB, or
 * NULL and 0) and appends a NUL that is not counted. `*data` is to be freed; NULL after a failure.
 * False with errno set: EFBIG if there are more than `limit` bytes in all, ENOMEM, or as fread.
 */
bool input_read_rest(FILE *stream, uint64_t limit, char **data, size_t *size);

/** Reads a regular file of at most `limit` bytes in the same way. */
bool input_read_file(const char *path, uint64_t limit, char **data, size_t *size);

#endif /* TOOLS_COMMON_INPUT_H */
