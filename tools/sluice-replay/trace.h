/** Reader of the trace to play. */
#ifndef TOOLS_SLUICE_REPLAY_TRACE_H
#define TOOLS_SLUICE_REPLAY_TRACE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** Reports on stderr why an input could not be read. `error`: errno of input_read_rest, called with
 * a limit of `memory` bytes. */
void say_unread(const char *path, int error, uint64_t memory);

/**
 * Reads a trace of at most `memory` bytes from a file or a stream (input_open_stream). Checks the
 * first bytes before it reads the rest. Reports errors on stderr. Free `*data`.
 */
bool read_trace(const char *path, uint64_t memory, char **data, size_t *size);

#endif /* TOOLS_SLUICE_REPLAY_TRACE_H */
