/**
 * Counts the different tiles that were ever bound. A software device keeps one memory map per tile
 * until the image is destroyed, and the number of memory maps of a process is limited.
 */
#ifndef SLC_VULKAN_TOUCHED_TILES_H
#define SLC_VULKAN_TOUCHED_TILES_H

#include <sluice/base.h>

/** Tiles of one image that were bound. */
struct slc_touched_tiles {
    uint32_t *bits; ///< owned; NULL if there is no limit
    uint32_t tile_count, count;
};

struct slc_touch_budget {
    uint32_t limit; ///< 0: none
    uint32_t count; ///< tiles of all images
};

/**
 * Counts the tiles from `first_packed` on at once, since they are always needed. Errors:
 * LIMIT_EXCEEDED if they are too many; OUT_OF_HOST_MEMORY.
 */
SluiceResult slc_touched_tiles_init(struct slc_touched_tiles *tiles,
                                    const SluiceAllocationCallbacks *cb,
                                    struct slc_touch_budget *budget, uint32_t tile_count,
                                    uint32_t first_packed);
/** Ends the count for an image that was destroyed. */
void slc_touched_tiles_finish(struct slc_touched_tiles *tiles, const SluiceAllocationCallbacks *cb,
                              struct slc_touch_budget *budget);

/** Counts a tile that is about to be bound. False: it was never bound, and the limit is reached. */
bool slc_touched_tiles_touch(struct slc_touched_tiles *tiles, struct slc_touch_budget *budget,
                             uint32_t tile);

/** True if slc_touched_tiles_touch would return true. */
bool slc_touched_tiles_may_touch(const struct slc_touched_tiles *tiles,
                                 const struct slc_touch_budget *budget, uint32_t tile);

#endif /* SLC_VULKAN_TOUCHED_TILES_H */
