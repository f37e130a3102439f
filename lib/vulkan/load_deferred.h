/** Tiles that wait because no page or staging slot is free. */
#ifndef SLC_VULKAN_LOAD_DEFERRED_H
#define SLC_VULKAN_LOAD_DEFERRED_H

#include "vulkan/streamer.h"

/** Evicts standby tiles for tiles that wait for pages: the manager knows only slots. Call it before
 *  tiles are unmapped. */
SluiceResult slc_loads_make_room(SluiceVulkanStreamer *s);
/** Lets the tile wait for a page; gives it back if the manager has canceled it. */
SluiceResult slc_load_defer(SluiceVulkanStreamer *s, uint32_t texture, const SluiceTile *tile);
/** Lets the tile wait for another front end; gives it back if the manager has canceled it. */
SluiceResult slc_load_await(SluiceVulkanStreamer *s, uint32_t texture, const SluiceTile *tile);
/** Tells the manager that the tile is not loaded. */
SluiceResult slc_load_give_back(SluiceVulkanStreamer *s, uint32_t texture, const SluiceTile *tile);
/** Returns the pages for further loads of the texture's format; UINT32_MAX if there is no known
 *  limit. Counted once per frame. */
uint32_t slc_pages_left(SluiceVulkanStreamer *s, uint32_t texture);
/** Lets slc_pages_left count the pages again. */
void slc_pages_left_forget(SluiceVulkanStreamer *s);

#endif /* SLC_VULKAN_LOAD_DEFERRED_H */
