/* Copies texels from staging slots to the images whose bindings are over, and tells the manager. */
#include "vulkan/streamer.h"

#include "base/alloc.h"
#include "base/checked.h"

#include <assert.h>

static VkBufferImageCopy copy_of(uint64_t offset, const SluiceImageRegion *region, uint32_t layer)
{
    return (VkBufferImageCopy){
        .bufferOffset = offset,
        .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, region->mipLevel, layer, 1},
        .imageOffset = {(int32_t)region->x, (int32_t)region->y, 0},
        .imageExtent = {region->width, region->height, 1}};
}

/* The copies of one unit; how many. */
static uint32_t unit_copies(const SluiceVulkanStreamer *s, uint32_t index,
                            VkBufferImageCopy *copies)
{
    const struct slc_unit *unit = &s->units[index];
    const struct slc_texture *texture = &s->textures[unit->texture];
    uint64_t base = (uint64_t)index * SLC_TILE_SIZE;
    if (unit->packed_unit != SLC_NONE) {
        const struct slc_packed_unit *packed = &texture->packed.units[unit->packed_unit];
        for (uint32_t i = 0; i < packed->rect_count; i++) {
            const struct slc_packed_rect *rect = &texture->packed.rects[packed->first_rect + i];
            copies[i] = copy_of(base + rect->offset, &rect->region, texture->layer);
        }
        return packed->rect_count;
    }
    const SluiceStreamedTextureDesc *desc = &texture->image.desc;
    const SluiceTile *tile = &unit->tile;
    uint32_t x = tile->x * desc->tileWidth, y = tile->y * desc->tileHeight;
    SluiceImageRegion region = {
        tile->mipLevel, x, y,
        slc_min_u32(desc->tileWidth, slc_mip_size(desc->width, tile->mipLevel) - x),
        slc_min_u32(desc->tileHeight, slc_mip_size(desc->height, tile->mipLevel) - y)};
    copies[0] = copy_of(base, &region, texture->layer);
    return 1;
}

/* What is published: whole tiles at once, packed levels when their last unit is copied. */
static SluiceResult publish(SluiceVulkanStreamer *s, uint32_t index, uint32_t packed_units,
                            uint32_t tile_count)
{
    struct slc_texture *texture = &s->textures[index];
    SluiceResult result = SLUICE_SUCCESS;
    texture->packed_done += packed_units;
    if (packed_units && texture->packed_done == texture->packed.unit_count) {
        for (uint32_t i = 0; i < texture->layout.desc.packedTileCount; i++) {
            result = sluiceUpdateTilesMapping(s->manager, texture->id, 1,
                                              &texture->packed_tiles[i].tileIndex);
            if (result < 0)
                return slc_streamer_check(s, result, "sluiceUpdateTilesMapping");
        }
        s->counts.tilesMapped += texture->layout.desc.packedTileCount;
        texture->packed_state = SLC_PACKED_COLLECTING;
        texture->packed_done = 0;
    }
    if (tile_count) {
        result = sluiceUpdateTilesMapping(s->manager, texture->id, tile_count, s->tile_indices);
        s->counts.tilesMapped += tile_count;
    }
    return slc_streamer_check(s, result, "sluiceUpdateTilesMapping");
}

/* Units of one texture: frame_units[0..count). */
static SluiceResult upload_texture(SluiceVulkanStreamer *s, VkCommandBuffer commands,
                                   const uint32_t *units, uint32_t count)
{
    uint32_t texture = s->units[units[0]].texture, copy_count = 0, tile_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        struct slc_unit *unit = &s->units[units[i]];
        uint32_t added = unit_copies(s, units[i], &s->copies[copy_count]);
        for (uint32_t j = copy_count; j < copy_count + added; j++)
            s->counts.bytesUploaded += sluiceFormatRegionSize(s->textures[texture].info.format,
                                                              s->copies[j].imageExtent.width,
                                                              s->copies[j].imageExtent.height);
        copy_count += added;
        assert(copy_count <= s->copy_capacity);
        if (unit->packed_unit == SLC_NONE) {
            s->tile_indices[tile_count++] = unit->tile.tileIndex;
            slc_map_remove(&s->tile_units, slc_pair_key(texture, unit->tile.tileIndex));
        }
        unit->state = SLC_UNIT_UPLOADED;
        unit->value = s->frame;
        slc_unit_list_append(s, &s->uploaded, units[i]);
    }
    s->residency->interface->record_uploads(s->residency, texture, commands, s->staging.buffer,
                                            copy_count, s->copies);
    return publish(s, texture, count - tile_count, tile_count);
}

/* Shell sort by texture: a few hundred entries, stable enough, no allocation. */
static void sort_by_texture(const SluiceVulkanStreamer *s, uint32_t *units, uint32_t count)
{
    for (uint32_t gap = count / 2; gap > 0; gap /= 2)
        for (uint32_t i = gap; i < count; i++) {
            uint32_t unit = units[i], at = i;
            for (; at >= gap && s->units[units[at - gap]].texture > s->units[unit].texture;
                 at -= gap)
                units[at] = units[at - gap];
            units[at] = unit;
        }
}

SluiceResult slc_tile_uploads_record(SluiceVulkanStreamer *s, VkCommandBuffer commands)
{
    uint64_t completed = s->residency->interface->completed_value(s->residency);
    uint32_t count = 0;
    while (count < s->info.tilesPerFrame && s->binding.first != SLC_NONE &&
           s->units[s->binding.first].value <= completed) {
        uint32_t unit = slc_unit_list_pop(s, &s->binding);
        if (s->textures[s->units[unit].texture].state == SLC_TEXTURE_REMOVED)
            slc_unit_free(s, unit);
        else
            s->frame_units[count++] = unit;
    }
    sort_by_texture(s, s->frame_units, count);
    for (uint32_t i = 0, next; i < count; i = next) {
        for (next = i + 1; next < count; next++)
            if (s->units[s->frame_units[next]].texture != s->units[s->frame_units[i]].texture)
                break;
        SluiceResult result = upload_texture(s, commands, &s->frame_units[i], next - i);
        if (result < 0)
            return result;
    }
    return SLUICE_SUCCESS;
}
