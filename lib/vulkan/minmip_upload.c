/*
 * Publishes the MinMip maps. The manager's changed rectangles are targets, toward which texels move
 * step by step (fade.h). Words of moved texels, with the texels around them (around.h), are written
 * to the frame's staging memory and copied row by row. Staging memory grows with the number of
 * words. Without memory, words go through the command buffer.
 */
#include "vulkan/streamer.h"

#include "base/checked.h"
#include "vulkan/around.h"

#include <assert.h>
#include <stddef.h>
#include <string.h>

#define BATCH 64u
#define MIN_STAGING (64u << 10)
#define NOT_STAGED UINT64_MAX
#define UPDATE_WORDS 16384u /* most words of vkCmdUpdateBuffer */
#define REFUSED_FRAMES 60u  /* frames until the device is asked for memory again */

/* Returns the staging buffer of this frame. The last frame that used it is complete. */
static struct slc_buffer *staging_of(SluiceVulkanStreamer *s)
{
    return &s->min_mip_staging[s->slot];
}

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

static struct slc_around around_of(const SluiceVulkanStreamer *s, const struct slc_texture *texture)
{
    return (struct slc_around){
        .texels = s->min_mip_texels + texture->region_first,
        .width = texture->layout.minMipWidth,
        .height = texture->layout.minMipHeight,
        .radius = slc_texture_is_ragged(texture) ? SLUICE_AROUND_RAGGED : SLUICE_AROUND,
        .wraps_x = texture->sampler_kind.modes[0] == VK_SAMPLER_ADDRESS_MODE_REPEAT,
        .wraps_y = texture->sampler_kind.modes[1] == VK_SAMPLER_ADDRESS_MODE_REPEAT};
}

/* Finds the rows to write: those of the rectangle, and `radius` rows above and below. */
static void find_rows(const struct slc_around *around, const struct slc_fade_rect *rect,
                      uint32_t *y0, uint32_t *y1)
{
    *y0 = rect->y0 > around->radius ? rect->y0 - around->radius : 0;
    *y1 = slc_min_u32(rect->y1 + around->radius, around->height);
    if (around->wraps_y &&
        (rect->y0 < around->radius || rect->y1 + around->radius > around->height))
        *y0 = 0, *y1 = around->height;
}

/* Returns the bytes of staging memory for a texture. */
static uint64_t staged_size(const SluiceVulkanStreamer *s, const struct slc_texture *texture)
{
    struct slc_around around = around_of(s, texture);
    uint32_t y0, y1;
    find_rows(&around, &texture->fade, &y0, &y1);
    return (uint64_t)(y1 - y0) * around.width * sizeof(uint32_t);
}

/* Writes a row through the command buffer, if there is no staging memory: unmapped tiles must be
 * hidden in any case. */
static void update_row(SluiceVulkanStreamer *s, VkCommandBuffer commands, uint64_t offset,
                       uint32_t count)
{
    for (uint32_t done = 0; done < count; done += UPDATE_WORDS) {
        uint32_t piece = slc_min_u32(count - done, UPDATE_WORDS);
        s->vk.CmdUpdateBuffer(commands, s->min_mip.buffer, offset + done * sizeof(uint32_t),
                              piece * sizeof(uint32_t), s->around_words + done);
    }
}

/* Writes words to `offset` in the staging memory, and returns the copy. NOT_STAGED: writes them
 * through the command buffer, and returns an empty copy. */
static VkBufferCopy stage(SluiceVulkanStreamer *s, const struct slc_texture *texture,
                          const struct slc_fade_rect *rect, uint64_t offset,
                          VkCommandBuffer commands)
{
    struct slc_around around = around_of(s, texture);
    uint32_t y0, y1;
    find_rows(&around, rect, &y0, &y1);
    uint64_t first = texture->region_first + (uint64_t)y0 * around.width;
    uint64_t at = first * sizeof(uint32_t), row = around.width * sizeof(uint32_t);
    for (uint32_t y = y0; y < y1 && offset == NOT_STAGED; y++) {
        slc_around_row(&around, y, s->around_row, s->around_words);
        update_row(s, commands, at + (y - y0) * row, around.width);
    }
    if (offset == NOT_STAGED)
        return (VkBufferCopy){0};
    uint32_t *words = (uint32_t *)staging_of(s)->mapped + offset / sizeof(uint32_t);
    for (uint32_t y = y0; y < y1; y++, words += around.width)
        slc_around_row(&around, y, s->around_row, words);
    return (VkBufferCopy){offset, at, (y1 - y0) * row};
}

/* Publishes whole_shown, which shaders read before the map. */
static void publish_whole(SluiceVulkanStreamer *s, uint32_t index, VkCommandBuffer commands)
{
    struct slc_texture *texture = &s->textures[index];
    const uint16_t *texels = s->min_mip_texels + texture->region_first;
    uint32_t count = texture->layout.minMipWidth * texture->layout.minMipHeight;
    uint16_t most = 0;
    for (uint32_t i = 0; i < count; i++)
        most = texels[i] > most ? texels[i] : most;
    if (most == texture->whole_shown && !texture->whole_stale)
        return;
    texture->whole_shown = most;
    texture->whole_stale = false;
    uint32_t word = most;
    s->vk.CmdUpdateBuffer(commands, s->texture_table.buffer,
                          (uint64_t)index * sizeof(struct SluiceTextureEntry) +
                              offsetof(struct SluiceTextureEntry, wholeShown),
                          sizeof word, &word);
}

/* Moves a texture's texels by one step. The rectangle shrinks to the rows that still fade. */
static VkBufferCopy move(SluiceVulkanStreamer *s, struct slc_texture *texture, uint16_t steps,
                         uint64_t offset, VkCommandBuffer commands)
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
    return stage(s, texture, &moved, offset, commands);
}

static void copy(SluiceVulkanStreamer *s, VkCommandBuffer commands, const VkBufferCopy *copies,
                 uint32_t *count)
{
    if (*count)
        s->vk.CmdCopyBuffer(commands, staging_of(s)->buffer, s->min_mip.buffer, *count, copies);
    *count = 0;
}

/* Reserves staging memory for all words of this frame, if there is memory. */
static void reserve(SluiceVulkanStreamer *s)
{
    struct slc_buffer *staging = staging_of(s);
    uint64_t needed = 0, size = MIN_STAGING;
    for (uint32_t i = 0; i < s->fade_count; i++)
        if (s->textures[s->fades[i]].state == SLC_TEXTURE_LIVE)
            needed += staged_size(s, &s->textures[s->fades[i]]);
    if (needed <= staging->size ||
        (s->min_mip_refused && s->frame < s->min_mip_refused + REFUSED_FRAMES))
        return;
    while (size < needed)
        size *= 2;
    struct slc_buffer larger;
    if (slc_buffer_init(&larger, &s->vk, &s->caps, size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                        SLC_BUFFER_UPLOAD) != SLUICE_SUCCESS) {
        s->min_mip_refused = s->frame;
        return;
    }
    s->min_mip_refused = 0;
    slc_buffer_finish(staging, &s->vk);
    *staging = larger;
}

SluiceResult slc_min_mip_record(SluiceVulkanStreamer *s, VkCommandBuffer commands)
{
    VkBufferCopy copies[BATCH];
    uint32_t copy_count = 0, kept = 0;
    uint64_t offset = 0;
    SluiceResult result = take_updates(s);
    reserve(s);
    uint16_t steps = slc_fade_clock_advance(&s->fade_clock, s->time_stamp);
    for (uint32_t i = 0; i < s->fade_count; i++) {
        struct slc_texture *texture = &s->textures[s->fades[i]];
        if (texture->state != SLC_TEXTURE_LIVE) {
            texture->fade.y1 = 0;
            continue;
        }
        bool fits = offset + staged_size(s, texture) <= staging_of(s)->size;
        copies[copy_count] = move(s, texture, steps, fits ? offset : NOT_STAGED, commands);
        offset += copies[copy_count].size;
        copy_count += fits;
        texture->shown_frame = s->frame;
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

void slc_min_mip_abandon(SluiceVulkanStreamer *s, uint64_t frame)
{
    for (uint32_t i = 0; i < s->texture_high; i++) {
        struct slc_texture *texture = &s->textures[i];
        if (texture->state != SLC_TEXTURE_LIVE || texture->shown_frame < frame)
            continue;
        const SluiceMinMipRect all = {.textureId = texture->id,
                                      .width = texture->layout.minMipWidth,
                                      .height = texture->layout.minMipHeight};
        texture->whole_stale = true;
        add_to_fades(s, i, &all);
    }
}
