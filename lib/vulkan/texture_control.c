#include "vulkan/texture_control.h"

#include "base/alloc.h"
#include "vulkan/due_maps.h"
#include "vulkan/texture_requests.h"

#include <assert.h>
#include <string.h>

void slc_control_drop(SluiceVulkanStreamer *s, struct slc_texture *texture)
{
    slc_texture_requests_drop(s, texture);
    slc_due_map_drop(s, texture);
}

const uint8_t *slc_control_map(SluiceVulkanStreamer *s, const struct slc_texture *texture)
{
    if (!texture->first_request)
        return texture->feedback.levels;
    assert(texture->feedback.region_count <= s->control_room);
    memcpy(s->control_map, texture->feedback.levels, texture->feedback.region_count);
    slc_texture_requests_merge(s, texture, s->control_map);
    return s->control_map;
}

void slc_control_finish(SluiceVulkanStreamer *s)
{
    slc_texture_requests_finish(&s->requests, &s->cb);
    slc_free(&s->cb, s->control_map, s->control_room, 1);
    slc_free(&s->cb, s->due_maps, s->info.maxTextureCount, sizeof *s->due_maps);
}
