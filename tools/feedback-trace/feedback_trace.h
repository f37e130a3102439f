/**
 * Reads feedback traces of the format SLTRACE1 (docs/replay.md): textures, and feedback maps frame
 * by frame. A trace is checked as a whole when it is opened, so reading it on cannot fail.
 */
#ifndef FEEDBACK_TRACE_H
#define FEEDBACK_TRACE_H

#include <sluice/manager.h>

/** Regions of one map at most. The format knows no limit, and a few bytes can ask for 2^32. */
#define FEEDBACK_TRACE_MAX_REGIONS (1u << 20)
/** Tiles of one texture at most, for the same reason: enough for 65536 x 65536 texels, 4 bytes
 * each.
 */
#define FEEDBACK_TRACE_MAX_TILES (1u << 20)

struct feedback_texture {
    SluiceStreamedTextureLayout layout;
    uint32_t primary; ///< its own index, or that of the texture whose feedback drives it
};

/** Zeroed is closed. */
struct feedback_trace {
    uint32_t texture_count, frame_count;
    struct feedback_texture *textures; ///< owned
    uint8_t *map;                      ///< owned; as large as the largest one
    uint8_t *data;                     ///< owned; the file
    size_t size, at;                   ///< bytes; where reading goes on
    size_t first_frame;                ///< byte
    const char *why;                   ///< what is wrong with it, NULL if nothing
    size_t why_at;                     ///< byte
};

/** Says on stderr what is wrong, and at which byte; the trace is closed then. */
bool feedback_trace_open(struct feedback_trace *trace, const char *path);
void feedback_trace_close(struct feedback_trace *trace);

/** Goes back to the first frame. */
void feedback_trace_rewind(struct feedback_trace *trace);
/** The next frame's time and the number of its maps, each of which is to be read before the next
 *  frame. At most frame_count times. */
void feedback_trace_next_frame(struct feedback_trace *trace, uint64_t *micros, uint32_t *map_count);
/** The next map, [feedbackHeight][feedbackWidth]; it stays until the next call. */
const uint8_t *feedback_trace_next_map(struct feedback_trace *trace, uint32_t *texture);

/** Whether both have the same tiles, so that one can follow the other's feedback. */
bool feedback_trace_same_shape(const SluiceStreamedTextureDesc *a,
                               const SluiceStreamedTextureDesc *b);

#endif /* FEEDBACK_TRACE_H */
