/** Reads a whole file to memory. */
#ifndef TOOLS_SLUICE_REPLAY_FILE_H
#define TOOLS_SLUICE_REPLAY_FILE_H

#include <stdbool.h>
#include <stddef.h>

/**
 * Reads a regular file of at most 4 GiB. Free `*data`, which ends with a NUL that is not counted.
 * On failure sets errno; input_reason (tools/common/input.h) has its text.
 */
bool read_file(const char *path, char **data, size_t *size);

#endif /* TOOLS_SLUICE_REPLAY_FILE_H */
