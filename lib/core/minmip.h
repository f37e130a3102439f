/** What the MinMip maps show. */
#ifndef SLC_CORE_MINMIP_H
#define SLC_CORE_MINMIP_H

#include "core/state.h"

/** The tile of a node became resident (MAPPED or STANDBY) or stopped to be. */
void slc_min_mip_changed(slc_manager *m, struct slc_managed_texture *t, const struct slc_node *n,
                         bool resident);
/** The tiles of level 0 under a tile, which are the texels of the map. */
struct slc_tile_range slc_area(const struct slc_managed_texture *t, struct slc_place p);
/** That is going to be called for a tile. */
void slc_min_mip_prefetch(const struct slc_managed_texture *t, const struct slc_node *n);
void slc_min_mip_dirty_all(slc_manager *m, struct slc_managed_texture *t);
void slc_min_mip_drop_update(slc_manager *m, struct slc_managed_texture *t);
/** What the map is where no regular tile is resident. */
uint8_t slc_min_mip_floor(const struct slc_managed_texture *t);

#endif /* SLC_CORE_MINMIP_H */
