/** Tiles of textures as entries of the residency machine. */
#ifndef SLC_CORE_TEXTURE_TILES_H
#define SLC_CORE_TEXTURE_TILES_H

#include "core/state.h"

/** Told by the machine what becomes of entries. */
struct slc_machine_user slc_tiles_user(slc_manager *m);

/** A FREE tile becomes REQUESTED. `cell` is where the tile keeps its node; needs a node. */
void slc_tile_requested(slc_manager *m, struct slc_managed_texture *t, uint32_t *cell,
                        uint32_t tile, uint32_t level, uint32_t need);
/** A tile that is not wanted, in whatever state. `level` is the class of packed ones. */
void slc_tile_wanted(slc_manager *m, struct slc_managed_texture *t, uint32_t *cell, uint32_t tile,
                     uint32_t level);
/** The class of a texture's packed tiles. */
static inline uint32_t slc_packed_class(const struct slc_managed_texture *t)
{
    return t->shape->desc.packedTilesOutside ? SLC_OUTSIDE_CLASS : SLC_PACKED_CLASS;
}
/** All packed tiles of a texture; as slc_tile_wanted. */
void slc_packed_tiles_wanted(slc_manager *m, struct slc_managed_texture *t);
void slc_packed_tiles_unwanted(slc_manager *m, struct slc_managed_texture *t);
/** A FREE tile gets a node as if it had been handed out and then no longer wanted. */
uint32_t slc_tile_prefetch(slc_manager *m, struct slc_managed_texture *t, uint32_t tile,
                           uint32_t level);
SluiceTile slc_node_tile(const slc_manager *m, uint32_t node);

#endif /* SLC_CORE_TEXTURE_TILES_H */
