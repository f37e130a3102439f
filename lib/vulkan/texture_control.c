#include "vulkan/texture_control.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "vulkan/due_maps.h"
#include "vulkan/texture_requests.h"

#include <assert.h>
#include <string.h>

#define MAX_MIP_BIAS 32

void slc_control_drop(SluiceVulkanStreamer *s, struct slc_texture *texture)
{
    slc_texture_requests_drop(s, texture);
    slc_due_map_drop(s, texture);
}

/* Applies bias and limit to a requested level. UNTOUCHED stays. */
static uint8_t controlled(const struct slc_texture *texture, uint8_t level, int32_t bias)
{
    int32_t last = (int32_t)texture->layout.desc.mipLevelCount - 1, finest = texture->finest_level;
    if (level == SLUICE_MIP_UNTOUCHED)
        return level;
    int32_t biased = (level < last ? level : last) + bias;
    biased = biased < last ? biased : last;
    return (uint8_t)(biased > finest ? biased : finest);
}

static void control_map(const struct slc_texture *texture, const uint8_t *from, int32_t bias,
                        uint8_t *to)
{
    for (uint32_t i = 0; i < texture->feedback.region_count; i++)
        to[i] = controlled(texture, from[i], bias);
}

const uint8_t *slc_control_map(SluiceVulkanStreamer *s, const struct slc_texture *texture)
{
    const uint8_t *levels = texture->feedback.levels;
    if (!texture->first_request && !texture->finest_level && !texture->mip_bias && !texture->hidden)
        return levels;
    assert(texture->feedback.region_count <= s->control_room);
    if (texture->hidden)
        memset(s->control_map, SLUICE_MIP_UNTOUCHED, texture->feedback.region_count);
    else
        control_map(texture, levels, texture->mip_bias, s->control_map);
    if (texture->first_request) {
        slc_texture_requests_merge(s, texture, s->control_map);
        control_map(texture, s->control_map, 0, s->control_map);
    }
    return s->control_map;
}

static SluiceVulkanTextureControl get_control(const struct slc_texture *texture)
{
    return (SluiceVulkanTextureControl){.structSize = sizeof(SluiceVulkanTextureControl),
                                        .finestLevel = texture->finest_level,
                                        .mipBias = texture->mip_bias,
                                        .hidden = texture->hidden,
                                        .priority = texture->priority};
}

SluiceResult sluiceGetVulkanTextureControl(const SluiceVulkanStreamer *streamer,
                                           SluiceTextureId textureId,
                                           SluiceVulkanTextureControl *pControl)
{
    if (!streamer || !pControl)
        return SLUICE_ERROR_NULL_POINTER;
    const struct slc_struct *type = SLC_STRUCT(SluiceVulkanTextureControl);
    struct slc_texture *texture;
    SluiceResult result = slc_struct_check(type, pControl, &streamer->vk.log);
    if (result == SLUICE_SUCCESS)
        result = slc_streamer_find_primary(streamer, textureId, &texture);
    if (result != SLUICE_SUCCESS)
        return result;
    const SluiceVulkanTextureControl control = get_control(texture);
    slc_struct_write(type, pControl, &control);
    return SLUICE_SUCCESS;
}

void slc_control_set_priority(SluiceVulkanStreamer *s, struct slc_texture *texture,
                              int32_t priority)
{
    s->manager_locked = false;
    slc_streamer_check(s, sluiceSetTexturePriority(s->manager, texture->id, priority),
                       "sluiceSetTexturePriority");
    s->manager_locked = true;
    texture->priority = (int8_t)priority;
}

static void set_control(SluiceVulkanStreamer *s, struct slc_texture *texture,
                        const SluiceVulkanTextureControl *control)
{
    const SluiceVulkanTextureControl before = get_control(texture);
    uint32_t index = (uint32_t)(texture - s->textures);
    texture->finest_level =
        (uint8_t)slc_min_u32(control->finestLevel, texture->layout.desc.mipLevelCount - 1);
    texture->mip_bias = (int8_t)control->mipBias;
    texture->hidden = control->hidden;
    slc_control_set_priority(s, texture, control->priority);
    if (before.hidden && !control->hidden)
        slc_feedback_join(s, index);
    else if (!before.hidden && control->hidden)
        slc_feedback_leave(s, index);
    texture->drop_due |= texture->finest_level > before.finestLevel ||
                         control->mipBias > before.mipBias || (control->hidden && !before.hidden);
    if (!before.hidden || control->hidden) /* marks from before the texture was hidden are old */
        slc_due_map_add(s, texture);
}

SluiceResult sluiceSetVulkanTextureControl(SluiceVulkanStreamer *streamer,
                                           SluiceTextureId textureId,
                                           const SluiceVulkanTextureControl *pControl)
{
    SluiceVulkanStreamer *s = streamer;
    if (!s || !pControl)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceVulkanTextureControl control = {.structSize = sizeof control};
    struct slc_texture *texture = NULL;
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceVulkanTextureControl), &control, pControl, &s->vk.log);
    if (result == SLUICE_SUCCESS)
        result = slc_streamer_find_primary(s, textureId, &texture);
    if (result == SLUICE_SUCCESS &&
        (control.mipBias < -MAX_MIP_BIAS || control.mipBias > MAX_MIP_BIAS))
        result = slc_log_refusal(&s->vk.log, "mipBias is %d; it must be %d to %d", control.mipBias,
                                 -MAX_MIP_BIAS, MAX_MIP_BIAS);
    if (result == SLUICE_SUCCESS &&
        (control.priority < -SLUICE_MAX_PRIORITY || control.priority > SLUICE_MAX_PRIORITY))
        result = slc_log_refusal(&s->vk.log, "priority is %d; it must be %d to %d",
                                 control.priority, -SLUICE_MAX_PRIORITY, SLUICE_MAX_PRIORITY);
    if (result == SLUICE_SUCCESS)
        result = slc_due_map_reserve(s, texture);
    if (result == SLUICE_SUCCESS)
        set_control(s, texture, &control);
    return result;
}

SluiceResult sluiceEvictVulkanTexture(SluiceVulkanStreamer *streamer, SluiceTextureId textureId,
                                      uint32_t keepTileCount)
{
    SluiceVulkanStreamer *s = streamer;
    if (!s)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_texture *texture;
    SluiceResult result = slc_streamer_find(s, textureId, &texture);
    if (result != SLUICE_SUCCESS)
        return result;
    s->manager_locked = false;
    result = sluiceEvictStreamedTexture(s->manager, textureId, keepTileCount);
    s->manager_locked = true;
    if (texture->first_request)
        slc_due_map_add(s, texture);
    return slc_streamer_check(s, result, "sluiceEvictStreamedTexture");
}

void slc_control_finish(SluiceVulkanStreamer *s)
{
    slc_texture_requests_finish(&s->requests, &s->cb);
    slc_free(&s->cb, s->control_map, s->control_room, 1);
    slc_free(&s->cb, s->due_maps, s->info.maxTextureCount, sizeof *s->due_maps);
}
