/**
 * Binds tiles whose texels have arrived, and frees units that frames have read.
 *
 * A tile is bound when its texels have arrived, not when its load begins: a load that fails or is
 * canceled is then never bound
 * (docs/decisions/0020-tiles-are-bound-when-their-texels-arrive.md).
 */
#ifndef SLC_VULKAN_LOAD_BINDS_H
#define SLC_VULKAN_LOAD_BINDS_H

#include "vulkan/streamer.h"

/** Maps tiles whose texels have arrived in the residency. */
void slc_loads_bind(SluiceVulkanStreamer *s);
/** Notes the value of the submission that binds the mapped tiles. */
void slc_loads_bound(SluiceVulkanStreamer *s, uint64_t value);
/** Frees the staging slots of completed frames. */
void slc_loads_recycle(SluiceVulkanStreamer *s);
/** Unmaps a tile. False: its texels may not be on its page, because the frame that copies them is
 *  not complete, or was abandoned. */
bool slc_loads_unmap(SluiceVulkanStreamer *s, uint32_t texture, const SluiceTile *tile);
/** Lets the next frames repeat the copies of frames from `frame` on. */
void slc_loads_abandon(SluiceVulkanStreamer *s, uint64_t frame);

#endif /* SLC_VULKAN_LOAD_BINDS_H */
