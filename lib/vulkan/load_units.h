/** Units (staging slots) of the streamer: free ones, and lists of units in use. */
#ifndef SLC_VULKAN_LOAD_UNITS_H
#define SLC_VULKAN_LOAD_UNITS_H

#include "vulkan/streamer.h"

void slc_unit_list_append(SluiceVulkanStreamer *s, struct slc_unit_list *list, uint32_t unit);
/** Removes the first unit of a list; SLC_NONE if the list is empty. */
uint32_t slc_unit_list_pop(SluiceVulkanStreamer *s, struct slc_unit_list *list);

/** True if `count` units can be taken. Allocates staging memory for them. If that fails, puts units
 *  with memory first. */
bool slc_units_are_ready(SluiceVulkanStreamer *s, uint32_t count);
/** Takes any free unit, without staging memory. */
uint32_t slc_unit_take_empty(SluiceVulkanStreamer *s, uint32_t texture, uint32_t packed_unit);
/** Takes a unit that is ready. `packed_unit`: SLC_NONE for a tile. */
uint32_t slc_unit_take(SluiceVulkanStreamer *s, uint32_t texture, uint32_t packed_unit);
void slc_unit_free(SluiceVulkanStreamer *s, uint32_t unit);
/** Removes the unit's tile from tile_units. */
void slc_unit_forget_tile(SluiceVulkanStreamer *s, const struct slc_unit *unit);

void slc_packed_queue_remove(SluiceVulkanStreamer *s, uint32_t at);

static inline bool slc_tile_is_packed(const SluiceVulkanStreamer *s, uint32_t texture,
                                      const SluiceTile *tile)
{
    return tile->tileIndex >= s->textures[texture].layout.regularTileCount;
}

#endif /* SLC_VULKAN_LOAD_UNITS_H */
