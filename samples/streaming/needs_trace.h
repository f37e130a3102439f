/**
 * Writes what frames need as an SLTRACE1 trace (docs/replay.md): the maps of all textures in every
 * frame. Each texture is its own primary there, because the map of each is exact.
 */
#ifndef SAMPLES_STREAMING_NEEDS_TRACE_H
#define SAMPLES_STREAMING_NEEDS_TRACE_H

#include <stdio.h>

#include "needs.h"

struct needs_trace {
    struct output_file *output; ///< owned; NULL: no trace is written
    FILE *file;                 ///< stream of `output`
    uint8_t *runs;              ///< owned; room for an encoded map
};

/** Begins a trace. The caller must add `frame_count` frames. Reports errors on stderr, like
 * needs_trace_end. */
bool needs_trace_begin(struct needs_trace *trace, const char *path, const struct needs *needs,
                       uint32_t frame_count, uint32_t frame_microseconds);
/** Writes the maps of the newest frame in `needs`. */
void needs_trace_add_frame(struct needs_trace *trace, const struct needs *needs,
                           uint64_t microseconds);
/** Ends the trace. It gets its name if `keep` is set and all of it was written; otherwise it is
 * removed. Returns false if it was not written or not kept. A zeroed struct is allowed. */
bool needs_trace_end(struct needs_trace *trace, bool keep);

#endif /* SAMPLES_STREAMING_NEEDS_TRACE_H */
