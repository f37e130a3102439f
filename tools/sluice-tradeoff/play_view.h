/**
 * Simulates what the viewer of a trace would have seen. For each region that a map reports, records
 * the requested level and the level in the manager's MinMip map.
 */
#ifndef SLUICE_TRADEOFF_PLAY_VIEW_H
#define SLUICE_TRADEOFF_PLAY_VIEW_H

#include <feedback_trace.h>

/** Sums over maps. */
struct view_counts {
    uint64_t touched_regions;
    uint64_t missing_regions; ///< touched regions that got a coarser level than requested
    uint64_t missing_levels;  ///< sum over regions; if even the packed levels are missing, counts
                              ///< one more than to them
    /** Regions in view that lost tiles: they had the level of the previous map's request, and now
     * get a coarser level than either map requests. */
    uint64_t wrong_evictions;
    uint64_t needed_tiles; ///< distinct tiles in one frame
};

struct view_texture {
    uint32_t member_count; ///< the texture and its followers; 0 for followers
    uint32_t last_map;     ///< frame + 1 of its latest map; 0: none
    /* owned; NULL until a map touches the texture */
    uint8_t *asked;     ///< by region: request of its latest map, a level or SLUICE_MIP_UNTOUCHED
    uint8_t *had;       ///< by touched region: resident level
    uint32_t *sharp_in; ///< by region: frame + 1 in which it began to wait for its level; else 0
    uint32_t *needed;   ///< by tile, all packed ones as one: frame + 1 of its last request; 0: none
};

/** Zeroed is finished. */
struct view {
    const struct feedback_trace *trace;
    struct view_texture *textures; ///< owned
    uint8_t *min_mip;              ///< owned; size of the largest map
    struct view_counts now;        ///< counts of the frame
    uint64_t needed_tiles;         ///< distinct tiles over all frames
    uint64_t *waits; ///< owned; [frame_count + 1]: number of regions by frames until sharp
    uint64_t wait_count;
};

/** Returns false when out of memory, or if a follower's shape differs from its primary's; with a
 * message on stderr. `trace` must outlive the view. */
bool view_init(struct view *view, const struct feedback_trace *trace);
void view_finish(struct view *view);

void view_begin_frame(struct view *view);
/** Adds the map of texture `index`. Call before the frame's maps are processed. Returns false when
 * out of memory, with a message on stderr. */
bool view_add_map(struct view *view, const SluiceStreamedTextureManager *manager,
                  SluiceTextureId id, uint32_t index, const uint8_t *map, uint32_t frame);

/** Returns whether the latest map of the texture, or of its primary, does not require the tile. */
bool view_is_stale(const struct view *view, uint32_t index, uint32_t tile);

/** Returns the number of frames after which a share of all regions had its requested level. NaN if
 * no region was touched. Call after view_end_waits. */
double view_wait(const struct view *view, double share);
/** Ends all waits. Call once after the last frame. */
void view_end_waits(struct view *view);

#endif /* SLUICE_TRADEOFF_PLAY_VIEW_H */
