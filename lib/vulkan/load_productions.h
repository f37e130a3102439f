/**
 * Tiles that commands of the application fill. The manager gives a tile a slot, the residency gives
 * it a page, and the producer records its commands. The manager maps the tile when that frame is
 * complete.
 *
 * An uploaded tile is published in the frame that copies it, a produced tile only after its frame.
 * So no frame has shown the tile if its frame is abandoned, and the producer may answer differently
 * when it is asked again
 * (docs/decisions/0058-producers-record-into-pages.md).
 */
#ifndef SLC_VULKAN_LOAD_PRODUCTIONS_H
#define SLC_VULKAN_LOAD_PRODUCTIONS_H

#include "vulkan/streamer.h"

/** Starts a tile that has a slot. Its texture has a producer. Requires a free unit. */
void slc_production_start(SluiceVulkanStreamer *s, uint32_t texture, const SluiceTile *tile);
/** Starts all packed tiles of the texture, which have slots. Requires a free unit. */
void slc_production_start_packed(SluiceVulkanStreamer *s, uint32_t texture);
/** Asks producers for the tiles that are bound. Call it after the uploads are recorded. */
SluiceResult slc_productions_record(SluiceVulkanStreamer *s, VkCommandBuffer commands);
/** Tells the manager of tiles that complete frames wrote. */
SluiceResult slc_productions_publish(SluiceVulkanStreamer *s);
/** Asks again for tiles that `frame` or later frames recorded: these frames never run. */
void slc_productions_abandon(SluiceVulkanStreamer *s, uint64_t frame);

#endif /* SLC_VULKAN_LOAD_PRODUCTIONS_H */
