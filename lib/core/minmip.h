/** MinMip maps: per tile of level 0, the finest level that shaders may sample. */
#ifndef SLC_CORE_MINMIP_H
#define SLC_CORE_MINMIP_H

#include "core/state.h"

/** Updates the map after a node's tile became resident (MAPPED or STANDBY) or ceased to be. */
void slc_min_mip_changed(slc_manager *m, struct slc_managed_texture *t, const struct slc_node *n,
                         bool resident);
/** Returns the tiles of level 0 under a tile. They are texels of the map. */
struct slc_tile_range slc_area(const struct slc_managed_texture *t, struct slc_place p);
/** Prefetches memory for slc_min_mip_changed. */
void slc_min_mip_prefetch(const struct slc_managed_texture *t, const struct slc_node *n);
void slc_min_mip_dirty_all(slc_manager *m, struct slc_managed_texture *t);
void slc_min_mip_drop_update(slc_manager *m, struct slc_managed_texture *t);
/** Returns the value of texels without a resident regular tile. */
uint8_t slc_min_mip_floor(const struct slc_managed_texture *t);

#endif /* SLC_CORE_MINMIP_H */
