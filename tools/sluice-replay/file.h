/** A whole file in memory. */
#ifndef TOOLS_SLUICE_REPLAY_FILE_H
#define TOOLS_SLUICE_REPLAY_FILE_H

#include <stdbool.h>
#include <stddef.h>

/**
 * Reads a regular file of at most 4 GiB. `*data` is to be freed, and ends with a NUL that is not
 * counted. On failure errno says why; input_reason (tools/common/input.h) has the words.
 */
bool read_file(const char *path, char **data, size_t *size);

#endif /* TOOLS_SLUICE_REPLAY_FILE_H */
