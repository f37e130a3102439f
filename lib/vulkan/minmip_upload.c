/*
 * Publishes the MinMip maps: the manager's changed rectangles go through a shadow copy into this
 * frame's staging memory, which has the layout of the buffer, and are copied word by word.
 */
#include "vulkan/streamer.h"

#include <assert.h>
#include <string.h>

#define BATCH 64u

/* From the rectangle's first byte to its last, whole words. Rows between are copied as they are. */
static VkBufferCopy stage_rect(SluiceVulkanStreamer *s, const struct slc_texture *texture,
                               const SluiceMinMipRect *rect)
{
    uint32_t width = texture->layout.minMipWidth;
    uint32_t first = texture->region_first + rect->y * width + rect->x;
    uint32_t end = first + (rect->height - 1) * width + rect->width;
    first &= ~3u;
    end = (end + 3) & ~3u;
    uint64_t slot = (s->frame % s->info.framesInFlight) * (uint64_t)s->regions.size;
    memcpy((uint8_t *)s->min_mip_staging.mapped + slot + first, s->min_mip_shadow + first,
           end - first);
    return (VkBufferCopy){slot + first, first, end - first};
}

static SluiceResult stage(SluiceVulkanStreamer *s, const SluiceMinMipRect *rect, VkBufferCopy *copy)
{
    const struct slc_texture *texture = slc_streamer_texture(s, rect->textureId);
    assert(texture->layout.minMipWidth * texture->layout.minMipHeight <= texture->region_count);
    uint32_t width = texture->layout.minMipWidth;
    uint8_t *shadow = s->min_mip_shadow + texture->region_first + rect->y * width + rect->x;
    size_t size = (size_t)(rect->height - 1) * width + rect->width;
    SluiceResult result = sluiceWriteMinMipRect(s->manager, rect, width, size, shadow);
    if (result == SLUICE_SUCCESS)
        *copy = stage_rect(s, texture, rect);
    return slc_streamer_check(s, result, "sluiceWriteMinMipRect");
}

SluiceResult slc_min_mip_record(SluiceVulkanStreamer *s, VkCommandBuffer commands)
{
    SluiceMinMipRect rects[BATCH];
    VkBufferCopy copies[BATCH];
    for (;;) {
        uint32_t count = BATCH;
        SluiceResult result = sluiceGetMinMipUpdates(s->manager, &count, rects);
        if (result < 0)
            return slc_streamer_check(s, result, "sluiceGetMinMipUpdates");
        for (uint32_t i = 0; i < count; i++) {
            result = stage(s, &rects[i], &copies[i]);
            if (result < 0)
                return result;
        }
        if (count)
            s->vk.CmdCopyBuffer(commands, s->min_mip_staging.buffer, s->min_mip.buffer, count,
                                copies);
        if (count < BATCH)
            return SLUICE_SUCCESS;
    }
}
