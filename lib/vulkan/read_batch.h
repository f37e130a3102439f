/** Reads of tiles that are submitted together: one lock and one wake-up for all of them. */
#ifndef SLC_VULKAN_READ_BATCH_H
#define SLC_VULKAN_READ_BATCH_H

#include "vulkan/streamer.h"

#define SLC_BATCH_READS 64u

struct slc_read_batch {
    uint32_t count;
    uint32_t units[SLC_BATCH_READS];
    SluiceTileRead reads[SLC_BATCH_READS]; ///< that point to the next two
    SluiceImageRegion regions[SLC_BATCH_READS];
    void *texels[SLC_BATCH_READS];
};

/** Gives the unit of a tile to the tile loader with the batch. A batch that is full is submitted;
 *  the last one needs slc_read_batch_submit. Errors are those of answering the manager. */
SluiceResult slc_read_batch_add(SluiceVulkanStreamer *s, struct slc_read_batch *batch,
                                uint32_t unit);
SluiceResult slc_read_batch_submit(SluiceVulkanStreamer *s, struct slc_read_batch *batch);

#endif /* SLC_VULKAN_READ_BATCH_H */
