/*
 * Publishes the MinMip maps. The manager's changed rectangles are what texels are to become; what
 * they are moves there step by step (fade.h). What moved goes through this frame's staging memory,
 * which has the layout of the buffer, with what is around (around.h), and is copied row by row.
 */
#include "vulkan/streamer.h"

#include "base/checked.h"
#include "vulkan/around.h"

#include <assert.h>
#include <stddef.h>
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

/* Whole rows, and as many beside those of the rectangle as their words look around. */
static VkBufferCopy stage(SluiceVulkanStreamer *s, const struct slc_texture *texture,
                          const struct slc_fade_rect *rect)
{
    struct slc_around around = {
        .texels = s->min_mip_texels + texture->region_first,
        .width = texture->layout.minMipWidth,
        .height = texture->layout.minMipHeight,
        .radius = slc_texture_is_ragged(texture) ? SLUICE_AROUND_RAGGED : SLUICE_AROUND,
        .wraps_x = texture->address_modes[0] == VK_SAMPLER_ADDRESS_MODE_REPEAT,
        .wraps_y = texture->address_modes[1] == VK_SAMPLER_ADDRESS_MODE_REPEAT};
    uint32_t y0 = rect->y0 > around.radius ? rect->y0 - around.radius : 0;
    uint32_t y1 = slc_min_u32(rect->y1 + around.radius, around.height);
    if (around.wraps_y && (rect->y0 < around.radius || rect->y1 + around.radius > around.height))
        y0 = 0, y1 = around.height;
    uint64_t first = texture->region_first + (uint64_t)y0 * around.width;
    uint64_t size = (uint64_t)(y1 - y0) * around.width * sizeof(uint32_t);
    uint64_t slot = s->frame % s->info.framesInFlight * (uint64_t)s->regions.size;
    uint32_t *words = (uint32_t *)s->min_mip_staging.mapped + slot + first;
    for (uint32_t y = y0; y < y1; y++, words += around.width)
        slc_around_row(&around, y, s->around_row, words);
    return (VkBufferCopy){(slot + first) * sizeof *words, first * sizeof *words, size};
}

/* What shaders look at before they look at the map. */
static void publish_whole(SluiceVulkanStreamer *s, uint32_t index, VkCommandBuffer commands)
{
    struct slc_texture *texture = &s->textures[index];
    const uint16_t *texels = s->min_mip_texels + texture->region_first;
    uint32_t count = texture->layout.minMipWidth * texture->layout.minMipHeight;
    uint16_t most = 0;
    for (uint32_t i = 0; i < count; i++)
        most = texels[i] > most ? texels[i] : most;
    if (most == texture->whole_shown)
        return;
    texture->whole_shown = most;
    uint32_t word = most;
    s->vk.CmdUpdateBuffer(commands, s->texture_table.buffer,
                          (uint64_t)index * sizeof(struct SluiceTextureEntry) +
                              offsetof(struct SluiceTextureEntry, wholeShown),
                          sizeof word, &word);
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
        publish_whole(s, s->fades[i], commands);
        if (texture->fade.y1)
            s->fades[kept++] = s->fades[i];
        if (copy_count == BATCH)
            copy(s, commands, copies, &copy_count);
    }
    copy(s, commands, copies, &copy_count);
    s->fade_count = kept;
    return result;
}
