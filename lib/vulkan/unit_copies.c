#include "vulkan/unit_copies.h"

#include "vulkan/load_reads.h"

#include <assert.h>

static VkBufferImageCopy copy_of(uint64_t offset, const SluiceImageRegion *region, uint32_t layer)
{
    return (VkBufferImageCopy){
        .bufferOffset = offset,
        .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, region->mipLevel, layer, 1},
        .imageOffset = {(int32_t)region->x, (int32_t)region->y, 0},
        .imageExtent = {region->width, region->height, 1}};
}

/* Writes the copies of one unit. Returns their number. */
static uint32_t unit_copies(const SluiceVulkanStreamer *s, uint32_t index,
                            VkBufferImageCopy *copies)
{
    const struct slc_unit *unit = &s->units[index];
    const struct slc_texture *texture = &s->textures[unit->texture];
    uint64_t base = slc_staging_offset(index);
    if (unit->packed_unit != SLC_NONE) {
        const struct slc_packed_unit *packed = &texture->packed.units[unit->packed_unit];
        for (uint32_t i = 0; i < packed->rect_count; i++) {
            const struct slc_packed_rect *rect = &texture->packed.rects[packed->first_rect + i];
            copies[i] = copy_of(base + rect->offset, &rect->region, texture->layer);
        }
        return packed->rect_count;
    }
    const SluiceImageRegion region = slc_tile_region(texture, &unit->tile);
    copies[0] = copy_of(base, &region, texture->layer);
    return 1;
}

uint32_t slc_unit_group(const SluiceVulkanStreamer *s, const uint32_t *units, uint32_t count)
{
    uint32_t size = 1;
    const struct slc_unit *first = &s->units[units[0]];
    while (size < count && s->units[units[size]].texture == first->texture &&
           s->units[units[size]].copied == first->copied &&
           slc_staging_block(units[size]) == slc_staging_block(units[0]))
        size++;
    return size;
}

void slc_record_group(SluiceVulkanStreamer *s, VkCommandBuffer commands, const uint32_t *units,
                      uint32_t count, uint32_t parts)
{
    uint32_t texture = s->units[units[0]].texture, copy_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        const struct slc_unit *unit = &s->units[units[i]];
        uint32_t added = unit_copies(s, units[i], &s->copies[copy_count]);
        bool counts = parts & SLC_UPLOAD_COPY && (!unit->published || unit->reload);
        for (uint32_t j = copy_count; j < copy_count + added && counts; j++)
            s->counts.bytesUploaded += sluiceGetFormatRegionSize(s->textures[texture].info.format,
                                                                 s->copies[j].imageExtent.width,
                                                                 s->copies[j].imageExtent.height);
        copy_count += added;
        assert(copy_count <= s->copy_capacity);
    }
    struct slc_residency *residency = slc_residency_of(s, texture);
    residency->interface->record_uploads(residency, texture, commands,
                                         slc_staging_buffer(&s->staging, units[0]), copy_count,
                                         s->copies, parts);
}

/* Copies of a texture are disjoint and need no barrier. But synchronization validation (1.3.239)
 * treats block-compressed texels as rows of texels, and reports disjoint copies of two commands to
 * an ordinary image as overlapping. */
bool slc_copies_need_barriers(const SluiceVulkanStreamer *s, uint32_t texture)
{
    return slc_residency_of(s, texture)->interface->ordinary_images &&
           sluiceGetFormatTexelSize(s->textures[texture].info.format) == 0;
}

/* Shell sort: a few hundred entries, no allocation. */
void slc_sort_units(const SluiceVulkanStreamer *s, uint32_t *units, uint32_t count,
                    uint64_t (*key)(const SluiceVulkanStreamer *s, uint32_t unit))
{
    for (uint32_t gap = count / 2; gap > 0; gap /= 2)
        for (uint32_t i = gap; i < count; i++) {
            uint32_t unit = units[i], at = i;
            for (; at >= gap && key(s, units[at - gap]) > key(s, unit); at -= gap)
                units[at] = units[at - gap];
            units[at] = unit;
        }
}
