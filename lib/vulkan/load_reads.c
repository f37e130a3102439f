#include "vulkan/load_reads.h"

#include "base/checked.h"
#include "vulkan/load_units.h"

#include <assert.h>

static uint8_t *unit_memory(SluiceVulkanStreamer *s, uint32_t unit)
{
    return slc_staging_memory(&s->staging, unit);
}

SluiceImageRegion slc_tile_region(const struct slc_texture *texture, const SluiceTile *tile)
{
    const SluiceStreamedTextureDesc *desc = &texture->image.desc;
    uint32_t x = tile->x * desc->tileWidth, y = tile->y * desc->tileHeight;
    return (SluiceImageRegion){
        tile->mipLevel,
        x,
        y,
        slc_min_u32(desc->tileWidth, slc_mip_size(desc->width, tile->mipLevel) - x),
        slc_min_u32(desc->tileHeight, slc_mip_size(desc->height, tile->mipLevel) - y),
        texture->layer};
}

void slc_fill_tile_read(SluiceVulkanStreamer *s, uint32_t index, SluiceTileRead *read,
                        SluiceImageRegion *region, void **texels)
{
    struct slc_unit *unit = &s->units[index];
    const struct slc_texture *texture = &s->textures[unit->texture];
    unit->source = texture->source;
    *region = slc_tile_region(texture, &unit->tile);
    *texels = unit_memory(s, index);
    *read = (SluiceTileRead){.source = texture->source,
                             .regionCount = 1,
                             .pRegions = region,
                             .ppTexels = texels,
                             .priority = unit->tile.mipLevel, /* coarse first */
                             .userValue = index};
}

/* Submits a unit to the loader, for the first time or after SLUICE_NOT_READY. */
SluiceResult slc_unit_submit(SluiceVulkanStreamer *s, uint32_t index)
{
    struct slc_unit *unit = &s->units[index];
    struct slc_texture *texture = &s->textures[unit->texture];
    SluiceImageRegion regions[SLUICE_MAX_READ_REGIONS];
    void *texels[SLUICE_MAX_READ_REGIONS];
    SluiceTileRead read = {.source = texture->source,
                           .pRegions = regions,
                           .ppTexels = texels,
                           .priority = SLUICE_MAX_MIP_LEVELS,
                           .userValue = index};
    if (unit->packed_unit == SLC_NONE) {
        slc_fill_tile_read(s, index, &read, regions, texels);
    } else {
        const struct slc_packed_unit *packed = &texture->packed.units[unit->packed_unit];
        assert(packed->rect_count <= SLUICE_MAX_READ_REGIONS);
        read.regionCount = packed->rect_count;
        for (uint32_t i = 0; i < packed->rect_count; i++) {
            regions[i] = texture->packed.rects[packed->first_rect + i].region;
            regions[i].arrayLayer = texture->layer;
            texels[i] =
                unit_memory(s, index) + texture->packed.rects[packed->first_rect + i].offset;
        }
    }
    unit->state = SLC_UNIT_READING;
    unit->source = texture->source;
    return sluiceSubmitTileRead(s->loader, &read, &unit->ticket);
}
