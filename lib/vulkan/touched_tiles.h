/**
 * How many different tiles were ever bound: a software device keeps one memory map for each until
 * its image goes, and a process has only so many.
 */
#ifndef SLC_VULKAN_TOUCHED_TILES_H
#define SLC_VULKAN_TOUCHED_TILES_H

#include <sluice/base.h>

/** Of one image. */
struct slc_touched_tiles {
    uint32_t *bits; ///< owned; NULL where there is no limit
    uint32_t tile_count, count;
};

struct slc_touch_budget {
    uint32_t limit; ///< 0: none
    uint32_t count; ///< of all images
};

/**
 * Touches the tiles from `first_packed` on at once, since they are always needed. Errors:
 * LIMIT_EXCEEDED if they are too many; OUT_OF_HOST_MEMORY.
 */
SluiceResult slc_touched_tiles_init(struct slc_touched_tiles *tiles,
                                    const SluiceAllocationCallbacks *cb,
                                    struct slc_touch_budget *budget, uint32_t tile_count,
                                    uint32_t first_packed);
/** The image is gone. */
void slc_touched_tiles_finish(struct slc_touched_tiles *tiles, const SluiceAllocationCallbacks *cb,
                              struct slc_touch_budget *budget);

/** False if the tile was never touched and must not be now. */
bool slc_touched_tiles_touch(struct slc_touched_tiles *tiles, struct slc_touch_budget *budget,
                             uint32_t tile);

/** Whether that call would return true. */
bool slc_touched_tiles_may_touch(const struct slc_touched_tiles *tiles,
                                 const struct slc_touch_budget *budget, uint32_t tile);

#endif /* SLC_VULKAN_TOUCHED_TILES_H */
