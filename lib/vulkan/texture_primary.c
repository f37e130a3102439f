/* Textures that begin to follow another one while they stream, and that end it. */
#include "vulkan/due_maps.h"
#include "vulkan/texture_control.h"
#include "vulkan/texture_forgetting.h"
#include "vulkan/texture_rect.h"

/* What it had of its own ends: its primary's maps count from now on. */
static void begin_to_follow(SluiceVulkanStreamer *s, struct slc_texture *texture,
                            SluiceTextureId primary)
{
    uint32_t index = (uint32_t)(texture - s->textures);
    texture->primary_id = primary;
    texture->finest_level = 0;
    texture->mip_bias = 0;
    texture->hidden = texture->drop_due = false;
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
    result = sluiceSetPrimaryTexture(s->manager, textureId, primaryId); /* logs what it refuses */
    s->manager_locked = true;
    if (result != SLUICE_SUCCESS)
        return result;
    if (primaryId == SLUICE_NO_TEXTURE)
        end_to_follow(s, texture);
    else
        begin_to_follow(s, texture, primaryId);
    return SLUICE_SUCCESS;
}
