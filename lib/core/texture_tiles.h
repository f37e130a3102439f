/** Tiles of textures as entries of the residency machine. */
#ifndef SLC_CORE_TEXTURE_TILES_H
#define SLC_CORE_TEXTURE_TILES_H

#include "core/state.h"

/** Returns the callbacks by which the residency machine reports changes of tiles. */
struct slc_machine_user slc_tiles_user(slc_manager *m);

/** Makes a FREE tile REQUESTED. `cell` holds the tile's node. A node must be reserved. */
void slc_tile_requested(slc_manager *m, struct slc_managed_texture *t, uint32_t *cell,
                        uint32_t tile, uint32_t level, uint32_t need);
/** Makes a tile wanted, in whatever state it is. `level` is the class for packed tiles. */
void slc_tile_wanted(slc_manager *m, struct slc_managed_texture *t, uint32_t *cell, uint32_t tile,
                     uint32_t level);
/** Returns the class of a texture's packed tiles. */
static inline uint32_t slc_packed_class(const struct slc_managed_texture *t)
{
    return t->shape->desc.packedTilesOutside ? SLC_OUTSIDE_CLASS : SLC_PACKED_CLASS;
}
/** Makes all packed tiles of a texture wanted, like slc_tile_wanted, or unwanted. */
void slc_packed_tiles_wanted(slc_manager *m, struct slc_managed_texture *t);
void slc_packed_tiles_unwanted(slc_manager *m, struct slc_managed_texture *t);
/** Makes a FREE tile CANCELED, as if it had been handed out and then become unwanted. */
uint32_t slc_tile_prefetch(slc_manager *m, struct slc_managed_texture *t, uint32_t tile,
                           uint32_t level);
SluiceTile slc_node_tile(const slc_manager *m, uint32_t node);

#endif /* SLC_CORE_TEXTURE_TILES_H */
