#include "vulkan/early_uploads.h"

#include "base/checked.h"
#include "vulkan/load_reads.h"
#include "vulkan/load_stages.h"
#include "vulkan/load_units.h"
#include "vulkan/unit_copies.h"

/* True if a range of texels, along one axis of a level, starts and ends at multiples of `step`, or
 * ends with the level. */
static bool is_aligned(uint32_t first, uint32_t size, uint32_t step, uint32_t level_size)
{
    if (first == 0 && size == level_size)
        return true;
    return step && first % step == 0 && (size % step == 0 || first + size == level_size);
}

/* True if the family can copy this part of a level. Its granularity counts blocks of texels. */
static bool may_copy(const SluiceVulkanStreamer *s, const struct slc_texture *texture,
                     const SluiceImageRegion *region)
{
    const VkExtent3D g = s->context->upload_granularity;
    SluiceFormatInfo format = {.structSize = sizeof format};
    SluiceImageRegion at = *region;
    if (g.width == 1 && g.height == 1)
        return true;
    if (sluiceGetFormatInfo(texture->info.format, &format) != SLUICE_SUCCESS)
        return false;
    const SluiceStreamedTextureDesc *desc = &texture->image.desc;
    uint32_t width = slc_mip_size(texture->info.width, region->mipLevel);
    uint32_t height = slc_mip_size(texture->info.height, region->mipLevel);
    if (texture->residency->interface->page_table && region->mipLevel < desc->regularMipCount) {
        at.x = at.y = 0; /* in a page, which a tile at the edge does not fill */
        at.width = slc_div_up_u32(at.width, format.blockWidth) * format.blockWidth;
        at.height = slc_div_up_u32(at.height, format.blockHeight) * format.blockHeight;
        width = desc->tileWidth;
        height = desc->tileHeight;
    }
    return is_aligned(at.x, at.width, g.width * format.blockWidth, width) &&
           is_aligned(at.y, at.height, g.height * format.blockHeight, height);
}

static bool may_copy_unit(const SluiceVulkanStreamer *s, const struct slc_texture *texture,
                          const struct slc_unit *unit)
{
    if (unit->packed_unit == SLC_NONE) {
        const SluiceImageRegion region = slc_tile_region(texture, &unit->tile);
        return may_copy(s, texture, &region);
    }
    const struct slc_packed_unit *packed = &texture->packed.units[unit->packed_unit];
    for (uint32_t i = 0; i < packed->rect_count; i++)
        if (!may_copy(s, texture, &texture->packed.rects[packed->first_rect + i].region))
            return false;
    return true;
}

/* The frame that records the layout of a new image copies its first texels, too. */
bool slc_upload_is_early(const SluiceVulkanStreamer *s, const struct slc_unit *unit)
{
    const struct slc_texture *texture = &s->textures[unit->texture];
    if (!s->uploads.queue || unit->reload || unit->produced || unit->published || unit->dropped ||
        unit->copied)
        return false;
    return texture->state == SLC_TEXTURE_LIVE && texture->presence == SLC_PRESENT &&
           texture->recorded_frame && texture->recorded_frame <= s->completed_frame &&
           may_copy_unit(s, texture, unit);
}

/* True if no frame in progress can read the tile's memory. */
static bool is_unread(const SluiceVulkanStreamer *s, const struct slc_unit *unit)
{
    return slc_residency_of(s, unit->texture)->interface->maps_unread ||
           unit->bound_frame <= s->completed_frame;
}

/* Collects units into frame_units. Returns how many. */
static uint32_t take_units(SluiceVulkanStreamer *s)
{
    uint64_t bound = s->residency->interface->completed_value(s->residency);
    struct slc_unit_list kept = {SLC_NONE, SLC_NONE};
    uint32_t count = 0;
    for (uint32_t index; (index = slc_unit_list_pop(s, &s->binding)) != SLC_NONE;) {
        const struct slc_unit *unit = &s->units[index];
        if (count < s->info.tilesPerFrame && unit->value <= bound && is_unread(s, unit) &&
            slc_upload_is_early(s, unit))
            s->frame_units[count++] = index;
        else
            slc_unit_list_append(s, &kept, index);
    }
    s->binding = kept;
    return count;
}

static uint64_t by_texture_and_slot(const SluiceVulkanStreamer *s, uint32_t unit)
{
    return (uint64_t)s->units[unit].texture << 32 | unit;
}

static void record(SluiceVulkanStreamer *s, VkCommandBuffer commands, uint32_t count)
{
    const uint32_t *units = s->frame_units;
    slc_sort_units(s, s->frame_units, count, by_texture_and_slot);
    for (uint32_t i = 0, size; i < count; i += size) {
        size = slc_unit_group(s, units + i, count - i);
        uint32_t texture = s->units[units[i]].texture;
        if (i > 0 && s->units[units[i - 1]].texture == texture &&
            slc_copies_need_barriers(s, texture))
            slc_record_transfer_barrier(&s->vk, commands);
        slc_record_group(s, commands, units + i, size, SLC_UPLOAD_COPY);
    }
    for (uint32_t i = 0; i < count; i++) {
        struct slc_unit *unit = &s->units[units[i]];
        slc_load_stage_unit(s, unit, SLUICE_LOAD_STAGE_BIND);
        unit->copied = true;
        unit->value = s->uploads.submitted + 1;
        slc_unit_list_append(s, &s->copying, units[i]);
    }
    s->counts.uploadQueueCopies += count;
}

SluiceResult slc_early_uploads_start(SluiceVulkanStreamer *s)
{
    VkCommandBuffer commands;
    uint32_t count = slc_upload_queue_is_free(&s->uploads) ? take_units(s) : 0;
    if (count == 0)
        return SLUICE_SUCCESS;
    SluiceResult result = slc_upload_queue_begin(&s->uploads, &s->vk, &commands);
    if (result != SLUICE_SUCCESS) {
        for (uint32_t i = 0; i < count; i++)
            slc_unit_list_append(s, &s->binding, s->frame_units[i]);
        return result;
    }
    record(s, commands, count);
    return slc_upload_queue_submit(&s->uploads, &s->vk, s->semaphore, s->completed_frame);
}

uint32_t slc_early_uploads_next(const SluiceVulkanStreamer *s)
{
    uint32_t first = s->copying.first;
    return first != SLC_NONE && s->units[first].value <= s->uploads.completed ? first : SLC_NONE;
}
