/* Queries: page of a texel, residency, and pages that launches missed. */
#include "base/checked.h"
#include "base/struct_size.h"
#include "demand_vulkan/opening.h"
#include "demand_vulkan/pages.h"
#include "demand_vulkan/queries.h"
#include "demand_vulkan/refused_arguments.h"
#include "demand_vulkan/tiles.h"

#include <sluice/demand_query.h>
#include <sluice/shared/demand.h>

static SluiceDemandPageState state_of(const SluiceDemandLoader *loader, uint32_t page)
{
    uint32_t place;
    if (slc_residency_is_resident(loader->residency, page, &place))
        return SLUICE_DEMAND_PAGE_RESIDENT;
    return slc_residency_is_absent(loader->residency, page) ? SLUICE_DEMAND_PAGE_ABSENT
                                                            : SLUICE_DEMAND_PAGE_PENDING;
}

static void describe(const SluiceDemandLoader *loader, const struct slc_demand_image *image,
                     uint32_t level, uint32_t x, uint32_t y, SluiceDemandTileInfo *out)
{
    out->isOpen = true;
    out->isTail = level >= image->regular_count;
    out->level = slc_min_u32(level, image->regular_count);
    uint32_t width = slc_mip_size(image->info.width, out->level);
    uint32_t height = slc_mip_size(image->info.height, out->level);
    uint32_t column = out->isTail ? 0 : x / image->tile_width;
    uint32_t row = out->isTail ? 0 : y / image->tile_height;
    out->x = column * image->tile_width;
    out->y = row * image->tile_height;
    out->width = out->isTail ? width : slc_min_u32(image->tile_width, width - out->x);
    out->height = out->isTail ? height : slc_min_u32(image->tile_height, height - out->y);
    out->page = out->isTail ? image->tail_page
                            : image->first_pages[level] +
                                  row * slc_image_level_width(image, level) + column;
    out->state = state_of(loader, out->page);
}

SluiceResult sluiceGetDemandTileInfo(SluiceDemandLoader *loader, SluiceDemandTextureId textureId,
                                     uint32_t level, uint32_t x, uint32_t y,
                                     SluiceDemandTileInfo *pInfo)
{
    if (!loader || !pInfo)
        return SLUICE_ERROR_NULL_POINTER;
    const struct slc_struct *type = SLC_STRUCT(SluiceDemandTileInfo);
    SluiceDemandTileInfo out = {.structSize = sizeof out};
    uint32_t index = 0;
    SluiceResult result = slc_struct_check(type, pInfo, &loader->vk.log);
    if (result == SLUICE_SUCCESS)
        result = slc_texture_find(loader, textureId, &index);
    if (result != SLUICE_SUCCESS)
        return result;
    if (loader->textures[index].kind == SLC_TEXTURE_VARIANT)
        index = loader->textures[index].base;
    if (loader->textures[index].kind == SLC_TEXTURE_GRID)
        return slc_demand_refuse_grid(loader, __func__, textureId);
    uint32_t slot = loader->textures[index].image;
    if (slot != SLC_NONE && loader->images[slot]->state == SLC_IMAGE_OPEN) {
        const struct slc_demand_image *image = loader->images[slot];
        level = slc_min_u32(level, image->info.mipLevelCount - 1);
        uint32_t width = slc_mip_size(image->info.width, level);
        uint32_t height = slc_mip_size(image->info.height, level);
        if (x >= width || y >= height)
            return slc_demand_refuse(loader, __func__,
                                     "texel %u, %u is outside of level %u, %u x %u texels", x, y,
                                     level, width, height);
        describe(loader, image, level, x, y, &out);
    }
    slc_struct_write(type, pInfo, &out);
    return SLUICE_SUCCESS;
}

static bool is_open(const SluiceDemandLoader *loader, uint32_t slot)
{
    return slot < loader->image_high && loader->images[slot]->state == SLC_IMAGE_OPEN;
}

static SluiceDemandMiss miss_of_image(const SluiceDemandLoader *loader, uint32_t slot,
                                      uint32_t page)
{
    if (!is_open(loader, slot))
        return (SluiceDemandMiss){.kind = SLUICE_DEMAND_MISS_GONE, .page = page};
    const struct slc_demand_image *image = loader->images[slot];
    uint32_t index, level = slc_tile_level(image, page, &index);
    SluiceDemandMiss miss = {.kind = SLUICE_DEMAND_MISS_TAIL,
                             .page = page,
                             .id = slc_texture_id(loader, image->texture),
                             .level = level};
    if (level < image->regular_count) {
        miss.kind = SLUICE_DEMAND_MISS_TILE;
        miss.x = index % slc_image_level_width(image, level);
        miss.y = index / slc_image_level_width(image, level);
    }
    return miss;
}

static SluiceDemandMiss miss_of_texture(const SluiceDemandLoader *loader, uint32_t page)
{
    bool live = page < loader->texture_high && loader->textures[page].kind == SLC_TEXTURE_IMAGE;
    return live ? (SluiceDemandMiss){.kind = SLUICE_DEMAND_MISS_OPENING,
                                     .page = page,
                                     .id = slc_texture_id(loader, page)}
                : (SluiceDemandMiss){.kind = SLUICE_DEMAND_MISS_GONE, .page = page};
}

static SluiceDemandMiss miss_of_resource(const SluiceDemandLoader *loader, uint32_t index,
                                         uint32_t page)
{
    const struct slc_demand_resource *resource = loader->resources[index];
    if (resource->state != SLC_RESOURCE_LIVE)
        return (SluiceDemandMiss){.kind = SLUICE_DEMAND_MISS_GONE, .page = page};
    return (SluiceDemandMiss){.kind = SLUICE_DEMAND_MISS_RESOURCE,
                              .page = page - resource->first_page,
                              .id = slc_resource_id(resource)};
}

SluiceDemandMiss slc_demand_miss_of(const SluiceDemandLoader *loader, uint32_t page)
{
    uint32_t index;
    switch (slc_pages_find(loader, page, &index)) {
    case SLC_OWNER_OPENING: return miss_of_texture(loader, index);
    case SLC_OWNER_LEVEL: return miss_of_image(loader, index, page);
    case SLC_OWNER_TAIL:
        return miss_of_image(loader, SLUICE_DEMAND_BLOCK_PAGES * index + page % 32u, page);
    case SLC_OWNER_RESOURCE: return miss_of_resource(loader, index, page);
    case SLC_OWNER_NOBODY: break;
    }
    return (SluiceDemandMiss){.kind = SLUICE_DEMAND_MISS_GONE, .page = page};
}

SluiceResult sluiceGetDemandMisses(const SluiceDemandLoader *loader, uint32_t *pMissCount,
                                   SluiceDemandMiss *pMisses)
{
    if (!loader || !pMissCount)
        return SLUICE_ERROR_NULL_POINTER;
    uint32_t room = pMisses ? *pMissCount : 0;
    *pMissCount = pMisses ? slc_min_u32(room, loader->miss_count) : loader->miss_count;
    for (uint32_t i = 0; pMisses && i < *pMissCount; i++)
        pMisses[i] = slc_demand_miss_of(loader, loader->misses[i]);
    return pMisses && room < loader->miss_count ? SLUICE_INCOMPLETE : SLUICE_SUCCESS;
}
