/**
 * Reads feedback traces of the format SLTRACE1 (docs/replay.md): textures, then feedback maps frame
 * by frame. Opening checks the whole trace, so later reads cannot fail.
 */
#ifndef FEEDBACK_TRACE_H
#define FEEDBACK_TRACE_H

#include <sluice/manager.h>

/** Limit of regions per map. The format has no limit, and a few bytes can ask for 2^32. */
#define FEEDBACK_TRACE_MAX_REGIONS (1u << 20)
/** Limit of tiles per texture, for the same reason. Suffices for 65536 x 65536 texels of 4
 * bytes. */
#define FEEDBACK_TRACE_MAX_TILES (1u << 20)

struct feedback_texture {
    SluiceStreamedTextureLayout layout;
    uint32_t primary; ///< its own index, or the texture whose feedback it follows
};

/** Zeroed is closed. */
struct feedback_trace {
    uint32_t texture_count, frame_count;
    struct feedback_texture *textures; ///< owned
    uint8_t *map;                      ///< owned; size of the largest map
    uint8_t *data;                     ///< owned; the file
    size_t size, at;                   ///< bytes; `at`: position of the reader
    size_t first_frame;                ///< offset in bytes
    const char *why;                   ///< description of an error; NULL: none
    size_t why_at;                     ///< offset of the error in bytes
};

/** Opens and checks a trace. Reports errors and their byte on stderr; the trace is closed then. */
bool feedback_trace_open(struct feedback_trace *trace, const char *path);
void feedback_trace_close(struct feedback_trace *trace);

/** Returns to the first frame. */
void feedback_trace_rewind(struct feedback_trace *trace);
/** Reads the next frame's time and number of maps. Read all its maps before the next frame. Call at
 * most frame_count times. */
void feedback_trace_next_frame(struct feedback_trace *trace, uint64_t *micros, uint32_t *map_count);
/** Reads the next map, [feedbackHeight][feedbackWidth]. Valid until the next call. */
const uint8_t *feedback_trace_next_map(struct feedback_trace *trace, uint32_t *texture);

/** Returns whether both have equal tiles, so that one can follow the other's feedback. */
bool feedback_trace_same_shape(const SluiceStreamedTextureDesc *a,
                               const SluiceStreamedTextureDesc *b);

#endif /* FEEDBACK_TRACE_H */
