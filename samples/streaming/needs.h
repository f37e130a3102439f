/**
 * Required tiles of frames: the tiles that every sample of every pixel requests, without random
 * choice or limits. Measures a streamer's work. Uses the manager's layouts and the shaders'
 * buffers, but no Vulkan: needs_pass.h draws the buffers.
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
    size_t first_region;   ///< index of the first region in the maps of struct needs
    uint64_t *tile_frames; ///< owned; by tile, packed ones last: last frame that required it, or 0
    bool *tile_loaded;     ///< owned; by tile: was resident in some frame
    bool sampled;          ///< true: some frame sampled it
};

/** Required tiles of one frame, and regions and pixels that were coarser than required. */
struct needs_frame {
    uint32_t needed_tiles;    ///< distinct tiles, including all coarser ones and packed levels
    uint32_t missing_regions; ///< regions that show coarser levels than required
    uint32_t sampled_pixels, missing_pixels;
};

struct needs {
    struct needs_texture *textures; ///< owned
    uint32_t texture_count;
    size_t region_count;  ///< regions of all textures
    uint8_t *levels;      ///< owned; by region: level that the last frame required, encoded as in
                          ///< SluiceFeedbackDesc
    uint16_t *shown;      ///< owned; by region: level that the last frame showed, encoded as in the
                          ///< MinMip buffer
    uint64_t frame_count; ///< frames added so far
    uint64_t needed_tiles; ///< distinct tiles over all frames
    struct needs_wait wait;
};

/** Buffers of a frame: texture table, feedback buffer of LEVELS, MinMip buffer. */
struct needs_words {
    const struct SluiceTextureEntry *table;
    const uint32_t *feedback, *min_mip;
};

/** Returns false when out of memory. */
bool needs_begin(struct needs *needs, const SluiceStreamedTextureManager *manager,
                 const struct needs_id *ids, uint32_t count);
/** Accepts a zeroed struct. */
void needs_finish(struct needs *needs);

/** Fills needed_tiles and missing_regions. Add frames in order. Returns false when out of
 * memory. */
bool needs_add_frame(struct needs *needs, const struct needs_words *words,
                     struct needs_frame *frame);

/** Notes the resident tiles of the frame that was begun last. */
void needs_add_loaded(struct needs *needs, const SluiceStreamedTextureManager *manager);

/** Counts distinct tiles over all frames by whether they were loaded and required. */
uint64_t needs_count_tiles(const struct needs *needs, bool loaded, bool needed);
uint32_t needs_count_never_sampled(const struct needs *needs);

#endif /* SAMPLES_STREAMING_NEEDS_H */
