#include "needs_pass.h"

#include <string.h>

static VkDeviceSize table_size(const struct needs_pass *pass)
{
    return (VkDeviceSize)pass->texture_count * sizeof(struct SluiceTextureEntry);
}

bool needs_pass_create(const struct gpu *gpu, const struct renderer *renderer,
                       const SluiceVulkanBuffers *buffers, uint32_t region_count,
                       uint32_t texture_count, struct needs_pass *pass)
{
    const VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                     VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                                     VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
    *pass = (struct needs_pass){.gpu = gpu,
                                .renderer = renderer,
                                .buffers = *buffers,
                                .texture_count = texture_count,
                                .word_count = region_count};
    if (gpu_create_device_buffer(gpu, (VkDeviceSize)region_count * sizeof(uint32_t), usage,
                                 &pass->feedback) &&
        gpu_create_device_buffer(gpu, sizeof(struct GalleryCounts), usage, &pass->counts))
        return true;
    needs_pass_destroy(pass);
    return false;
}

void needs_pass_destroy(struct needs_pass *pass)
{
    if (!pass->gpu)
        return;
    gpu_destroy_buffer(pass->gpu, &pass->feedback);
    gpu_destroy_buffer(pass->gpu, &pass->counts);
    *pass = (struct needs_pass){0};
}

bool needs_slot_create(const struct needs_pass *pass, VkDescriptorSet frame_set, VkBuffer frame,
                       struct needs_slot *slot)
{
    renderer_write_frame_set(pass->renderer, frame_set, frame, pass->counts.buffer,
                             pass->feedback.buffer);
    slot->frame_set = frame_set;
    VkDeviceSize size = sizeof(struct GalleryCounts) + table_size(pass) +
                        2 * (VkDeviceSize)pass->word_count * sizeof(uint32_t);
    return gpu_create_buffer(pass->gpu, size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, &slot->host);
}

void needs_slot_destroy(const struct needs_pass *pass, struct needs_slot *slot)
{
    if (pass->gpu)
        gpu_destroy_buffer(pass->gpu, &slot->host);
    *slot = (struct needs_slot){0};
}

static void record_copies(const struct needs_pass *pass, const struct needs_slot *slot,
                          VkCommandBuffer commands)
{
    const VkDeviceSize words = (VkDeviceSize)slot->word_count * sizeof(uint32_t);
    const VkBuffer from[] = {pass->counts.buffer, pass->buffers.textureTable, pass->feedback.buffer,
                             pass->buffers.minMip};
    const VkDeviceSize sizes[] = {sizeof(struct GalleryCounts), table_size(pass), words, words};
    VkDeviceSize offset = 0;
    for (int i = 0; i < 4; i++) {
        VkBufferCopy copy = {0, offset, sizes[i]};
        vkCmdCopyBuffer(commands, from[i], slot->host.buffer, 1, &copy);
        offset += sizes[i];
    }
}

void needs_pass_record(const struct needs_pass *pass, const struct target *target,
                       const struct renderer_surface *surfaces, VkDescriptorSet streamer_set,
                       struct needs_slot *slot, VkCommandBuffer commands)
{
    const struct renderer_sets sets = {streamer_set, slot->frame_set};
    static const float black[4] = {0, 0, 0, 0};
    slot->word_count = pass->word_count;
    /* Order the clears after the copies of the previous frame. */
    gpu_barrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, VK_PIPELINE_STAGE_TRANSFER_BIT,
                VK_ACCESS_TRANSFER_WRITE_BIT);
    vkCmdFillBuffer(commands, pass->feedback.buffer, 0,
                    (VkDeviceSize)slot->word_count * sizeof(uint32_t), SLUICE_MIP_UNTOUCHED);
    vkCmdFillBuffer(commands, pass->counts.buffer, 0, VK_WHOLE_SIZE, 0);
    gpu_barrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
    target_begin(target, commands, black);
    renderer_draw(pass->renderer, commands, &sets, surfaces, RENDERER_NEEDS);
    target_end(target, commands);
    /* Wait for the streamer's copies to its buffers. */
    gpu_barrier(commands, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT,
                VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT,
                VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
    record_copies(pass, slot, commands);
    /* Make all later commands wait, so that the next frame's time begins after this pass. */
    gpu_barrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                VK_PIPELINE_STAGE_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_HOST_BIT,
                VK_ACCESS_HOST_READ_BIT);
}

/* Once the table is known, only what textures use of the buffers is copied. */
static void fit(struct needs_pass *pass, const struct SluiceTextureEntry *table)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < pass->texture_count; i++) {
        uint32_t regions = table[i].regionCountX * table[i].regionCountY;
        uint32_t feedback = table[i].feedbackOffset + regions;
        uint32_t min_mip = table[i].minMipOffset + regions;
        count = feedback > count ? feedback : count;
        count = min_mip > count ? min_mip : count;
    }
    pass->word_count = count < pass->word_count ? count : pass->word_count;
}

struct needs_words needs_pass_words(struct needs_pass *pass, const struct needs_slot *slot,
                                    struct GalleryCounts *counts)
{
    const char *at = slot->host.mapped;
    memcpy(counts, at, sizeof *counts);
    at += sizeof *counts;
    struct needs_words words = {.table = (const struct SluiceTextureEntry *)at};
    words.feedback = (const uint32_t *)(at + table_size(pass));
    words.min_mip = words.feedback + slot->word_count;
    fit(pass, words.table);
    return words;
}
