/* Which feedback maps are read back in a frame, and what the manager gets of them. */
#include "vulkan/streamer.h"

#include "base/checked.h"
#include "base/log.h"

static SluiceResult give_map(SluiceVulkanStreamer *s, SluiceTextureId id, const uint8_t *map,
                             uint32_t width, uint32_t height, uint64_t time_stamp, uint64_t timeout)
{
    SluiceFeedbackDesc desc = {.pMinMip = map, .width = width, .height = height};
    SluiceResult result =
        sluiceUpdateWithSamplerFeedback(s->manager, id, &desc, time_stamp, timeout);
    if (result == SLUICE_ERROR_STALE_TEXTURE || result == SLUICE_ERROR_UNKNOWN_TEXTURE)
        return SLUICE_SUCCESS; /* removed while its map was on its way */
    if (result == SLUICE_ERROR_OUT_OF_HOST_MEMORY) {
        slc_log(&s->info.log, SLUICE_LOG_WARNING, "no memory to take in a feedback map");
        return SLUICE_SUCCESS; /* nothing has changed, and there will be another one */
    }
    if (result < 0)
        return slc_streamer_check(s, result, "sluiceUpdateWithSamplerFeedback");
    s->manager_time = time_stamp;
    s->counts.feedbackMaps++;
    return SLUICE_SUCCESS;
}

/* The next primaries in turn, each at most once a frame. */
static uint32_t next_primary(SluiceVulkanStreamer *s)
{
    if (s->primary_cursor >= s->primary_count)
        s->primary_cursor = 0;
    return s->primaries[s->primary_cursor++];
}

static uint32_t share_of_frame(const SluiceVulkanStreamer *s)
{
    return slc_min_u32(s->info.texturesPerFrame, s->primary_count);
}

/* Everything is wanted always: no map has to come from the GPU. */
static SluiceResult want_everything(SluiceVulkanStreamer *s)
{
    for (uint32_t i = share_of_frame(s); i > 0; i--) {
        const struct slc_texture *texture = &s->textures[next_primary(s)];
        SluiceResult result = give_map(s, texture->id, s->zero_map, texture->layout.feedbackWidth,
                                       texture->layout.feedbackHeight, s->time_stamp, UINT64_MAX);
        if (result < 0)
            return result;
    }
    return SLUICE_SUCCESS;
}

SluiceResult slc_feedback_read(SluiceVulkanStreamer *s)
{
    if (s->info.mapEverything)
        return want_everything(s);
    struct slc_readback_slot *slot;
    while ((slot = slc_readback_oldest(&s->readback, s->completed_frame))) {
        for (uint32_t i = 0; i < slot->item_count; i++) {
            const struct slc_readback_item *item = &slot->items[i];
            SluiceResult result =
                give_map(s, item->id, slc_readback_map(&s->readback, slot, i), item->width,
                         item->height, slot->time_stamp, s->info.feedbackTimeout);
            if (result < 0)
                return result;
        }
        slot->frame = 0;
    }
    return SLUICE_SUCCESS;
}

static void barrier(const SluiceVulkanStreamer *s, VkCommandBuffer commands,
                    VkPipelineStageFlags from, VkAccessFlags written, VkPipelineStageFlags to,
                    VkAccessFlags used)
{
    VkMemoryBarrier memory = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER, .srcAccessMask = written, .dstAccessMask = used};
    s->vk.CmdPipelineBarrier(commands, from, to, 0, 1, &memory, 0, NULL, 0, NULL);
}

void slc_feedback_record(SluiceVulkanStreamer *s, VkCommandBuffer commands)
{
    uint32_t share = share_of_frame(s);
    if (share == 0 || s->info.mapEverything)
        return;
    struct slc_readback_slot *slot = slc_readback_begin(&s->readback, s->frame, s->time_stamp);
    barrier(s, commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_SHADER_WRITE_BIT,
            VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
            VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
    slc_resolve_bind(&s->resolve, &s->vk, commands);
    for (uint32_t i = 0; i < share; i++) {
        const struct slc_texture *texture = &s->textures[next_primary(s)];
        if (texture->added_frame == s->frame)
            continue; /* the next frame clears what an older texture left in its regions */
        uint32_t word;
        if (!slc_readback_add(&s->readback, slot, texture->id, texture->layout.feedbackWidth,
                              texture->layout.feedbackHeight, &word))
            break; /* cannot be: a slot holds all maps */
        slc_resolve_record(&s->resolve, &s->vk, commands, texture->region_first,
                           texture->layout.feedbackWidth * texture->layout.feedbackHeight, word);
    }
    barrier(s, commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
            VK_PIPELINE_STAGE_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_HOST_BIT,
            VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_HOST_READ_BIT);
}
