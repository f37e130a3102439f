/** Batch of tile reads that are submitted together, with one lock and one wake-up. */
#ifndef SLC_VULKAN_READ_BATCH_H
#define SLC_VULKAN_READ_BATCH_H

#include "vulkan/streamer.h"

#define SLC_BATCH_READS 64u

struct slc_read_batch {
    uint32_t count;
    uint32_t units[SLC_BATCH_READS];
    SluiceTileRead reads[SLC_BATCH_READS]; ///< point to `regions` and `texels`
    SluiceImageRegion regions[SLC_BATCH_READS];
    void *texels[SLC_BATCH_READS];
};

/** Adds the read of a tile's unit to the batch. A full batch is submitted; submit the last one with
 *  slc_read_batch_submit. Errors: those of answers to the manager. */
SluiceResult slc_read_batch_add(SluiceVulkanStreamer *s, struct slc_read_batch *batch,
                                uint32_t unit);
SluiceResult slc_read_batch_submit(SluiceVulkanStreamer *s, struct slc_read_batch *batch);

#endif /* SLC_VULKAN_READ_BATCH_H */
