/** Reads of units: their regions, and their submission to the tile loader. */
#ifndef SLC_VULKAN_LOAD_READS_H
#define SLC_VULKAN_LOAD_READS_H

#include "vulkan/streamer.h"

/** Submits the unit to the tile loader. Call it again after SLUICE_NOT_READY. */
SluiceResult slc_unit_submit(SluiceVulkanStreamer *s, uint32_t unit);

/** Fills in the read of a tile into its staging slot. `read` points to `region` and `texels`. */
void slc_fill_tile_read(SluiceVulkanStreamer *s, uint32_t unit, SluiceTileRead *read,
                        SluiceImageRegion *region, void **texels);

/** Returns the texels of a tile, clipped to its level. */
SluiceImageRegion slc_tile_region(const struct slc_texture *texture, const SluiceTile *tile);

#endif /* SLC_VULKAN_LOAD_READS_H */
