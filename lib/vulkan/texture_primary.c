/* Changes of a texture's primary while it streams. */
#include "vulkan/texture_primary.h"

#include "base/log.h"
#include "vulkan/due_maps.h"
#include "vulkan/texture_control.h"
#include "vulkan/texture_forgetting.h"
#include "vulkan/texture_rect.h"

/* Ends a texture's own feedback, requests and control: the primary's maps count from now on. */
static void begin_to_follow(SluiceVulkanStreamer *s, struct slc_texture *texture,
                            SluiceTextureId primary)
{
    uint32_t index = (uint32_t)(texture - s->textures);
    texture->primary_id = primary;
    texture->finest_level = 0;
    texture->mip_bias = 0;
    texture->hidden = texture->drop_due = false;
    slc_control_set_priority(s, texture, 0);
    slc_control_drop(s, texture);
    slc_feedback_leave(s, index);
    slc_forgetting_keep(s, index);
    slc_forgetting_keep(s, s->by_manager_index[(uint32_t)primary]);
    slc_due_map_add(s, slc_streamer_texture(s, primary));
}

static void end_to_follow(SluiceVulkanStreamer *s, struct slc_texture *texture)
{
    if (texture->primary_id == SLUICE_NO_TEXTURE)
        return;
    texture->primary_id = SLUICE_NO_TEXTURE;
    slc_feedback_join(s, (uint32_t)(texture - s->textures));
}

static SluiceUvWrap wrap_of(VkSamplerAddressMode mode)
{
    switch (mode) {
    case VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT: return SLUICE_UV_WRAP_MIRROR;
    case VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE:
    case VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER: return SLUICE_UV_WRAP_CLAMP;
    case VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE: return SLUICE_UV_WRAP_MIRROR_CLAMP;
    default: return SLUICE_UV_WRAP_REPEAT;
    }
}

SluiceResult slc_texture_set_uv(SluiceVulkanStreamer *s, const struct slc_texture *texture,
                                const SluiceUvTransform *transform)
{
    if (!transform)
        return sluiceSetUvTransform(s->manager, texture->id, NULL);
    if (texture->info.cube)
        return slc_log_refusal(&s->vk.log, "%s: a cube map has no UVs to transform",
                               texture->info.pName ? texture->info.pName : "image");
    SluiceUvTransform uv = *transform;
    uv.wrapU = wrap_of(texture->sampler_kind.modes[0]);
    uv.wrapV = wrap_of(texture->sampler_kind.modes[1]);
    return sluiceSetUvTransform(s->manager, texture->id, &uv);
}

SluiceResult sluiceSetVulkanUvTransform(SluiceVulkanStreamer *streamer, SluiceTextureId textureId,
                                        const SluiceUvTransform *pTransform)
{
    SluiceVulkanStreamer *s = streamer;
    if (!s)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_texture *texture;
    SluiceResult result = slc_streamer_find(s, textureId, &texture);
    if (result != SLUICE_SUCCESS)
        return result;
    s->manager_locked = false;
    result = slc_texture_set_uv(s, texture, pTransform);
    s->manager_locked = true;
    if (result == SLUICE_SUCCESS && texture->primary_id != SLUICE_NO_TEXTURE)
        slc_due_map_add(s, slc_streamer_texture(s, texture->primary_id));
    return result;
}

SluiceResult sluiceSetVulkanPrimaryTexture(SluiceVulkanStreamer *streamer,
                                           SluiceTextureId textureId, SluiceTextureId primaryId)
{
    SluiceVulkanStreamer *s = streamer;
    if (!s)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_texture *texture;
    SluiceResult result = slc_streamer_find(s, textureId, &texture);
    if (result != SLUICE_SUCCESS || texture->primary_id == primaryId)
        return result;
    s->manager_locked = false;
    result = sluiceSetPrimaryTexture(s->manager, textureId, primaryId); /* logs refusals */
    s->manager_locked = true;
    if (result != SLUICE_SUCCESS)
        return result;
    if (primaryId == SLUICE_NO_TEXTURE)
        end_to_follow(s, texture);
    else
        begin_to_follow(s, texture, primaryId);
    return SLUICE_SUCCESS;
}
