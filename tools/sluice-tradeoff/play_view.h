/**
 * What the maps of a trace would have shown: each region that a map says was sampled, the level
 * that it asked for and the one that the manager's MinMip map let it have.
 */
#ifndef SLUICE_TRADEOFF_PLAY_VIEW_H
#define SLUICE_TRADEOFF_PLAY_VIEW_H

#include <feedback_trace.h>

/** Sums over maps. */
struct view_counts {
    uint64_t touched_regions;
    uint64_t missing_regions; ///< of them, those that got a coarser level than they asked for
    uint64_t
        missing_levels; ///< summed; one more than to the packed levels if not even these are there
    /** Regions in view that lost tiles: they had the level that the previous map asked for, and now
     * get a coarser level than either map asks for. */
    uint64_t wrong_evictions;
    uint64_t needed_tiles; ///< distinct ones in one frame
};

struct view_texture {
    uint32_t member_count; ///< the texture and those that follow it; 0 for these
    uint32_t last_map;     ///< frame + 1 of its latest map, 0: none
    /* owned; NULL until a map touches the texture */
    uint8_t *asked;     ///< per region, by its latest map: SLUICE_MIP_UNTOUCHED or a level
    uint8_t *had;       ///< per region that was touched: the level that was there
    uint32_t *sharp_in; ///< per region that waits for its level: frame + 1 since when; else 0
    uint32_t *needed;   ///< per tile, the packed ones as one: frame + 1 of the latest need, 0: none
};

/** Zeroed is finished. */
struct view {
    const struct feedback_trace *trace;
    struct view_texture *textures; ///< owned
    uint8_t *min_mip;              ///< owned; as large as the largest
    struct view_counts now;        ///< of the frame
    uint64_t needed_tiles;         ///< distinct ones in all frames
    uint64_t *waits;               ///< owned; [frame_count + 1] regions by frames until sharp
    uint64_t wait_count;
};

/** False, with a message on stderr, if memory is short or a texture is of another shape than the
 * one it follows. `trace` must stay. */
bool view_init(struct view *view, const struct feedback_trace *trace);
void view_finish(struct view *view);

void view_begin_frame(struct view *view);
/** `map` is of texture `index`, whose id is given; called before the frame's maps are processed.
 * False, with a message, if memory is short. */
bool view_add_map(struct view *view, const SluiceStreamedTextureManager *manager,
                  SluiceTextureId id, uint32_t index, const uint8_t *map, uint32_t frame);

/** Whether the latest map of the texture (or of the one it follows) does not need the tile. */
bool view_is_stale(const struct view *view, uint32_t index, uint32_t tile);

/** Frames that a share of all regions needed at most until they were as sharp as they asked to be;
 *  NaN if no region was ever touched. Once: view_end_waits. */
double view_wait(const struct view *view, double share);
/** After the last frame: those that wait have waited until then. */
void view_end_waits(struct view *view);

#endif /* SLUICE_TRADEOFF_PLAY_VIEW_H */
