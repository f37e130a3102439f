#include "vulkan/due_maps.h"

#include "base/alloc.h"

SluiceResult slc_due_map_reserve(SluiceVulkanStreamer *s, const struct slc_texture *texture)
{
    uint32_t room = texture->feedback.region_count;
    if (room <= s->control_room)
        return SLUICE_SUCCESS;
    uint8_t *map = slc_regrow(&s->cb, s->control_map, s->control_room, room, 1);
    if (!map)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    s->control_map = map;
    s->control_room = room;
    return SLUICE_SUCCESS;
}

void slc_due_map_add(SluiceVulkanStreamer *s, struct slc_texture *texture)
{
    if (texture->map_due)
        return;
    texture->map_due = true;
    s->due_maps[s->due_map_count++] = (uint32_t)(texture - s->textures);
}

void slc_due_map_drop(SluiceVulkanStreamer *s, struct slc_texture *texture)
{
    for (uint32_t i = 0; texture->map_due && i < s->due_map_count; i++)
        if (s->due_maps[i] == (uint32_t)(texture - s->textures)) {
            s->due_maps[i] = s->due_maps[--s->due_map_count];
            texture->map_due = false;
        }
}
