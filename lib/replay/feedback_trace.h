/** Reader of "SLTRACE1" traces: textures, and feedback maps frame by frame. docs/replay.md has the
 * format. */
#ifndef SLC_REPLAY_FEEDBACK_TRACE_H
#define SLC_REPLAY_FEEDBACK_TRACE_H

#include "replay/byte_buffer.h"

#include <sluice/manager.h>

struct slc_trace_texture {
    SluiceStreamedTextureDesc desc;
    uint32_t primary; ///< index of the texture with its feedback; may be its own
    uint32_t feedback_width, feedback_height;
    size_t offset; ///< offset of its record
};

struct slc_feedback_trace {
    struct slc_cursor in;
    uint32_t texture_count, frame_count;
    struct slc_trace_texture *textures; ///< owned
};

/**
 * Reads header and textures; `in` is at the start of the trace. Errors: OUT_OF_HOST_MEMORY. A
 * damaged trace returns SUCCESS, with the error in trace->in.
 */
SluiceResult slc_feedback_trace_open(struct slc_feedback_trace *trace,
                                     const SluiceAllocationCallbacks *cb, struct slc_cursor in);
void slc_feedback_trace_close(struct slc_feedback_trace *trace,
                              const SluiceAllocationCallbacks *cb);

/** Reads the next frame's time and number of maps. Read all its maps before the next frame. */
void slc_next_frame(struct slc_feedback_trace *trace, uint64_t *micros, uint32_t *map_count);

/** Reads the next map: its texture, and its encoded contents for slc_get_run_pairs. */
struct slc_cursor slc_next_map(struct slc_feedback_trace *trace, uint32_t *texture);

#endif /* SLC_REPLAY_FEEDBACK_TRACE_H */
