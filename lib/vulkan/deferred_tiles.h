/**
 * Deferred tiles: the manager gave them slots, but the device has no memory for their pages. They
 * keep their slots, so that the manager finds its slots used up: it requests coarser tiles, and
 * evicts others. A deferred tile is not read until there is a page.
 */
#ifndef SLC_VULKAN_DEFERRED_TILES_H
#define SLC_VULKAN_DEFERRED_TILES_H

#include <sluice/manager.h>

struct slc_deferred_tile {
    uint32_t texture; ///< the streamer's index
    SluiceTile tile;
};

struct slc_deferred_tiles {
    struct slc_deferred_tile *tiles; ///< owned; in the order in which they came
    uint32_t count, room;
};

/** Frees the list. `deferred` may be zeroed. */
void slc_deferred_tiles_finish(struct slc_deferred_tiles *deferred,
                               const SluiceAllocationCallbacks *cb);

/** Adds a tile at the end. False: there is no host memory. */
bool slc_deferred_tiles_add(struct slc_deferred_tiles *deferred,
                            const SluiceAllocationCallbacks *cb, uint32_t texture,
                            const SluiceTile *tile);
void slc_deferred_tiles_remove_at(struct slc_deferred_tiles *deferred, uint32_t at);
/** Removes a tile. False: it is not in the list. */
bool slc_deferred_tiles_remove(struct slc_deferred_tiles *deferred, uint32_t texture,
                               uint32_t tile_index);
/** Removes all tiles of a texture. */
void slc_deferred_tiles_drop(struct slc_deferred_tiles *deferred, uint32_t texture);

#endif /* SLC_VULKAN_DEFERRED_TILES_H */
