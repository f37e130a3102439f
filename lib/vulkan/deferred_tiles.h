/**
 * Tiles that the manager gave a slot and that have no page, because the device has no memory for
 * more. They keep their slots, so that the manager knows how many there really are: it asks for
 * coarser tiles, and takes those away that are needed least. Nothing is read for them until there
 * is a page.
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

/** A zeroed struct is fine. */
void slc_deferred_tiles_finish(struct slc_deferred_tiles *deferred,
                               const SluiceAllocationCallbacks *cb);

/** False: there is no memory for it. */
bool slc_deferred_tiles_add(struct slc_deferred_tiles *deferred,
                            const SluiceAllocationCallbacks *cb, uint32_t texture,
                            const SluiceTile *tile);
void slc_deferred_tiles_remove_at(struct slc_deferred_tiles *deferred, uint32_t at);
/** False: it is not there. */
bool slc_deferred_tiles_remove(struct slc_deferred_tiles *deferred, uint32_t texture,
                               uint32_t tile_index);
/** All of a texture. */
void slc_deferred_tiles_drop(struct slc_deferred_tiles *deferred, uint32_t texture);

#endif /* SLC_VULKAN_DEFERRED_TILES_H */
