/**
 * Writes what frames need as an SLTRACE1 trace (docs/replay.md): the maps of all textures in every
 * frame. Each texture is its own primary there, because the map of each is exact.
 */
#ifndef SAMPLES_STREAMING_NEEDS_TRACE_H
#define SAMPLES_STREAMING_NEEDS_TRACE_H

#include <stdio.h>

#include "needs.h"

struct needs_trace {
    struct output_file *output; ///< Owned. NULL: nothing is written.
    FILE *file;                 ///< Of `output`.
    uint8_t *runs;              ///< owned; room for an encoded map
};

/** Says on stderr what is wrong, as does needs_trace_end. `frame_count` frames have to follow. */
bool needs_trace_begin(struct needs_trace *trace, const char *path, const struct needs *needs,
                       uint32_t frame_count, uint32_t frame_microseconds);
/** The maps of the frame that was added to `needs` last. */
void needs_trace_add_frame(struct needs_trace *trace, const struct needs *needs,
                           uint64_t microseconds);
/** The trace gets its name only now, if `keep` and all of it is written; otherwise it is removed.
 *  False if something was not written or not kept. A zeroed struct is fine. */
bool needs_trace_end(struct needs_trace *trace, bool keep);

#endif /* SAMPLES_STREAMING_NEEDS_TRACE_H */
