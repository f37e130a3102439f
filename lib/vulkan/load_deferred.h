/** Tiles that wait because no page or staging slot is free. */
#ifndef SLC_VULKAN_LOAD_DEFERRED_H
#define SLC_VULKAN_LOAD_DEFERRED_H

#include "vulkan/streamer.h"

/** The manager knows of slots alone. If pages are short, evicts standby tiles for those that wait.
 *  Before tiles are unmapped. */
SluiceResult slc_loads_make_room(SluiceVulkanStreamer *s);
/** Lets the tile wait for a page; gives it back if the manager has canceled it. */
SluiceResult slc_load_defer(SluiceVulkanStreamer *s, uint32_t texture, const SluiceTile *tile);
/** Lets the tile wait for another front end; gives it back if the manager has canceled it. */
SluiceResult slc_load_await(SluiceVulkanStreamer *s, uint32_t texture, const SluiceTile *tile);
/** Tells the manager that the tile is not loaded. */
SluiceResult slc_load_give_back(SluiceVulkanStreamer *s, uint32_t texture, const SluiceTile *tile);
/** Pages for further loads of the texture's format; UINT32_MAX if there is no known limit. Counted
 *  once a frame. */
uint32_t slc_pages_left(SluiceVulkanStreamer *s, uint32_t texture);
/** Counts them again. */
void slc_pages_left_forget(SluiceVulkanStreamer *s);

#endif /* SLC_VULKAN_LOAD_DEFERRED_H */
