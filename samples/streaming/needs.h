/**
 * What frames need: the tiles that every sample of every pixel asks for, nothing chosen at random
 * and nothing held back. It is what a streamer's work is measured by. Knows the manager's layouts
 * and the shaders' buffers, no Vulkan: needs_pass.h draws what is read here.
 */
#ifndef SAMPLES_STREAMING_NEEDS_H
#define SAMPLES_STREAMING_NEEDS_H

#include <sluice/manager.h>

#include <stdbool.h>

#include "needs_wait.h"
#include "sluice/shared/texture_table.h"

/** A texture of a streamer. */
struct needs_id {
    SluiceTextureId id;
    uint32_t table_index; ///< in the texture table
};

struct needs_texture {
    SluiceStreamedTextureLayout layout;
    struct needs_id id;
    size_t first_region;   ///< in the maps of struct needs
    uint64_t *tile_frames; ///< owned; per tile, packed ones last: the last frame to need it, or 0
    bool *tile_loaded;     ///< owned; per tile: it was in memory in some frame
    bool sampled;          ///< by any frame
};

/** What one frame needed, and what of it was not to be seen. */
struct needs_frame {
    uint32_t needed_tiles;    ///< different ones, with all coarser ones and packed levels
    uint32_t missing_regions; ///< that show coarser levels than they need
    uint32_t sampled_pixels, missing_pixels;
};

struct needs {
    struct needs_texture *textures; ///< owned
    uint32_t texture_count;
    size_t region_count;   ///< of all textures
    uint8_t *levels;       ///< owned; per region, what the last frame needed: as SluiceFeedbackDesc
    uint16_t *shown;       ///< owned; per region, what the last frame showed: as the MinMip buffer
    uint64_t frame_count;  ///< read so far
    uint64_t needed_tiles; ///< different ones, of all frames together
    struct needs_wait wait;
};

/** The buffers of a frame: texture table, a feedback buffer of LEVELS, the MinMip buffer. */
struct needs_words {
    const struct SluiceTextureEntry *table;
    const uint32_t *feedback, *min_mip;
};

/** False if there is no memory. */
bool needs_begin(struct needs *needs, const SluiceStreamedTextureManager *manager,
                 const struct needs_id *ids, uint32_t count);
/** A zeroed struct is fine. */
void needs_finish(struct needs *needs);

/** Fills needed_tiles and missing_regions. Frames come in order. False if there is no memory. */
bool needs_add_frame(struct needs *needs, const struct needs_words *words,
                     struct needs_frame *frame);

/** Notes what is in memory in the frame that was begun last. */
void needs_add_loaded(struct needs *needs, const SluiceStreamedTextureManager *manager);

/** Different tiles of all frames together that were loaded or not, and needed or not. */
uint64_t needs_count_tiles(const struct needs *needs, bool loaded, bool needed);
uint32_t needs_count_never_sampled(const struct needs *needs);

#endif /* SAMPLES_STREAMING_NEEDS_H */
