/** The trace that is played. */
#ifndef TOOLS_SLUICE_REPLAY_TRACE_H
#define TOOLS_SLUICE_REPLAY_TRACE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** Says on stderr why an input could not be read: an errno of input_read_rest, asked for `memory`
 *  bytes at most. */
void say_unread(const char *path, int error, uint64_t memory);

/**
 * Reads a trace of at most `memory` bytes from a file or a stream, see input_open_stream. Looks
 * at the first bytes before it reads the rest. On failure says why on stderr. `*data` is to be
 * freed.
 */
bool read_trace(const char *path, uint64_t memory, char **data, size_t *size);

#endif /* TOOLS_SLUICE_REPLAY_TRACE_H */
