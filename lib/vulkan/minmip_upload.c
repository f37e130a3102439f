/*
 * Publishes the MinMip maps. The manager's changed rectangles are what texels are to become; what
 * they are moves there step by step (fade.h). What moved goes through this frame's staging memory,
 * which has the layout of the buffer, and is copied word by word.
 */
#include "vulkan/streamer.h"

#include <assert.h>
#include <string.h>

#define BATCH 64u

static void add_to_fades(SluiceVulkanStreamer *s, uint32_t index, const SluiceMinMipRect *rect)
{
    struct slc_fade_rect *fade = &s->textures[index].fade;
    struct slc_fade_rect more = {rect->x, rect->y, rect->x + rect->width, rect->y + rect->height};
    if (fade->y1 == 0) {
        *fade = more;
        s->fades[s->fade_count++] = index;
        return;
    }
    fade->x0 = more.x0 < fade->x0 ? more.x0 : fade->x0;
    fade->y0 = more.y0 < fade->y0 ? more.y0 : fade->y0;
    fade->x1 = more.x1 > fade->x1 ? more.x1 : fade->x1;
    fade->y1 = more.y1 > fade->y1 ? more.y1 : fade->y1;
}

static SluiceResult take_update(SluiceVulkanStreamer *s, const SluiceMinMipRect *rect)
{
    const struct slc_texture *texture = slc_streamer_texture(s, rect->textureId);
    assert(texture->layout.minMipWidth * texture->layout.minMipHeight <= texture->region_count);
    uint32_t width = texture->layout.minMipWidth;
    uint8_t *levels = s->min_mip_levels + texture->region_first + rect->y * width + rect->x;
    size_t size = (size_t)(rect->height - 1) * width + rect->width;
    SluiceResult result = sluiceWriteMinMipRect(s->manager, rect, width, size, levels);
    if (result == SLUICE_SUCCESS)
        add_to_fades(s, (uint32_t)(texture - s->textures), rect);
    return slc_streamer_check(s, result, "sluiceWriteMinMipRect");
}

static SluiceResult take_updates(SluiceVulkanStreamer *s)
{
    SluiceMinMipRect rects[BATCH];
    for (;;) {
        uint32_t count = BATCH;
        SluiceResult result = sluiceGetMinMipUpdates(s->manager, &count, rects);
        if (result < 0)
            return slc_streamer_check(s, result, "sluiceGetMinMipUpdates");
        for (uint32_t i = 0; i < count; i++) {
            result = take_update(s, &rects[i]);
            if (result < 0)
                return result;
        }
        if (count < BATCH)
            return SLUICE_SUCCESS;
    }
}

/* From the rectangle's first byte to its last, whole words. Rows between are copied as they are. */
static VkBufferCopy stage(SluiceVulkanStreamer *s, const struct slc_texture *texture,
                          const struct slc_fade_rect *rect)
{
    uint32_t width = texture->layout.minMipWidth;
    uint32_t first = texture->region_first + rect->y0 * width + rect->x0;
    uint32_t end = texture->region_first + (rect->y1 - 1) * width + rect->x1;
    first &= ~1u;
    end = (end + 1) & ~1u;
    uint64_t size = (uint64_t)(end - first) * sizeof *s->min_mip_texels;
    uint64_t to = (uint64_t)first * sizeof *s->min_mip_texels;
    uint64_t from =
        s->frame % s->info.framesInFlight * s->regions.size * (uint64_t)sizeof *s->min_mip_texels +
        to;
    memcpy((uint8_t *)s->min_mip_staging.mapped + from, s->min_mip_texels + first, size);
    return (VkBufferCopy){from, to, size};
}

/* One step of all that moves in a texture; the rectangle shrinks to the rows that move on. */
static VkBufferCopy move(SluiceVulkanStreamer *s, struct slc_texture *texture, uint16_t steps)
{
    struct slc_fade_rect moved = texture->fade, *fade = &texture->fade;
    uint32_t width = texture->layout.minMipWidth;
    fade->y1 = 0;
    for (uint32_t y = moved.y0; y < moved.y1; y++) {
        uint32_t first = texture->region_first + y * width + moved.x0;
        if (!slc_fade_row(s->min_mip_levels + first, s->min_mip_texels + first, moved.x1 - moved.x0,
                          steps))
            continue;
        if (fade->y1 == 0)
            fade->y0 = y;
        fade->y1 = y + 1;
    }
    return stage(s, texture, &moved);
}

static void copy(SluiceVulkanStreamer *s, VkCommandBuffer commands, const VkBufferCopy *copies,
                 uint32_t *count)
{
    if (*count)
        s->vk.CmdCopyBuffer(commands, s->min_mip_staging.buffer, s->min_mip.buffer, *count, copies);
    *count = 0;
}

SluiceResult slc_min_mip_record(SluiceVulkanStreamer *s, VkCommandBuffer commands)
{
    VkBufferCopy copies[BATCH];
    uint32_t copy_count = 0, kept = 0;
    SluiceResult result = take_updates(s);
    uint16_t steps = slc_fade_clock_advance(&s->fade_clock, s->time_stamp);
    for (uint32_t i = 0; i < s->fade_count; i++) {
        struct slc_texture *texture = &s->textures[s->fades[i]];
        if (texture->state != SLC_TEXTURE_LIVE) {
            texture->fade.y1 = 0;
            continue;
        }
        copies[copy_count++] = move(s, texture, steps);
        if (texture->fade.y1)
            s->fades[kept++] = s->fades[i];
        if (copy_count == BATCH)
            copy(s, commands, copies, &copy_count);
    }
    copy(s, commands, copies, &copy_count);
    s->fade_count = kept;
    return result;
}
