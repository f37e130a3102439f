/** Which texels a unit reads. */
#ifndef SLC_VULKAN_LOAD_READS_H
#define SLC_VULKAN_LOAD_READS_H

#include "vulkan/streamer.h"

/** Gives the unit to the tile loader; again, if its source was not ready. */
SluiceResult slc_unit_submit(SluiceVulkanStreamer *s, uint32_t unit);

/** The read of a tile into its staging slot. `read` points to `region` and `texels`. */
void slc_fill_tile_read(SluiceVulkanStreamer *s, uint32_t unit, SluiceTileRead *read,
                        SluiceImageRegion *region, void **texels);

/** Texels of a tile. Tiles at the edge end with their level. */
SluiceImageRegion slc_tile_region(const struct slc_texture *texture, const SluiceTile *tile);

#endif /* SLC_VULKAN_LOAD_READS_H */
