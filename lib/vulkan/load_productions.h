/**
 * Tiles that commands of the application fill: from a slot of the manager to a page, to the
 * producer, and to the manager again when the frame that wrote them is complete.
 *
 * Such a tile is published later than one that is uploaded. If its frame is abandoned nobody has
 * shown it, and the producer may answer otherwise when it is asked again
 * (docs/decisions/0058-producers-record-into-pages.md).
 */
#ifndef SLC_VULKAN_LOAD_PRODUCTIONS_H
#define SLC_VULKAN_LOAD_PRODUCTIONS_H

#include "vulkan/streamer.h"

/** A tile of a texture with a producer has a slot. There is a free unit. */
void slc_production_start(SluiceVulkanStreamer *s, uint32_t texture, const SluiceTile *tile);
/** So have all of its packed tiles. */
void slc_production_start_packed(SluiceVulkanStreamer *s, uint32_t texture);
/** Asks producers for tiles whose pages are there. Behind the uploads. */
SluiceResult slc_productions_record(SluiceVulkanStreamer *s, VkCommandBuffer commands);
/** Tells the manager of tiles that complete frames wrote. */
SluiceResult slc_productions_publish(SluiceVulkanStreamer *s);
/** What frames from `frame` on wrote was never written. */
void slc_productions_abandon(SluiceVulkanStreamer *s, uint64_t frame);

#endif /* SLC_VULKAN_LOAD_PRODUCTIONS_H */
