/** Descriptions that textures share. */
#ifndef SLC_CORE_SHAPE_H
#define SLC_CORE_SHAPE_H

#include "core/state.h"

SluiceResult slc_shape_take(slc_manager *m, const SluiceStreamedTextureDesc *desc,
                            struct slc_shape **shape);
void slc_shape_give(slc_manager *m, struct slc_shape *shape);

/** Bytes of two rows of tiles. */
size_t slc_shape_rows_size(const struct slc_shape *s);
/** True if the regions are the tiles of level 0. */
static inline bool slc_regions_are_tiles(const struct slc_shape *s)
{
    return s->desc.feedbackRegionWidth == s->desc.tileWidth &&
           s->desc.feedbackRegionHeight == s->desc.tileHeight;
}

#endif /* SLC_CORE_SHAPE_H */
