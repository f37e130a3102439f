#include "vulkan/sparse_layout.h"

#include "image/format_size.h"

/* Returns the first level that fits into one tile. Pages of coarser levels would be mostly empty.
 */
static uint32_t own_packed_level(const SluiceImageInfo *info, VkExtent3D tile)
{
    uint32_t level = 0;
    while (slc_mip_size(info->width, level) > tile.width ||
           slc_mip_size(info->height, level) > tile.height)
        level++;
    return level;
}

/* True if no level is rounded down. Tiles of rounded levels begin behind the regions under them. */
static bool halves_evenly(uint32_t size, uint32_t level_count)
{
    for (uint32_t level = 1; level < level_count; level++)
        if (slc_mip_size(size, level) * 2 != slc_mip_size(size, level - 1) &&
            slc_mip_size(size, level - 1) > 1)
            return false;
    return true;
}

static void set_regions(SluiceStreamedTextureDesc *desc)
{
    /* Without regular levels one region suffices: packed levels are wanted as a whole. */
    desc->feedbackRegionWidth = desc->regularMipCount ? desc->tileWidth : desc->width;
    desc->feedbackRegionHeight = desc->regularMipCount ? desc->tileHeight : desc->height;
}

static uint64_t tile_size(const SluiceFormatInfo *format, VkExtent3D tile)
{
    return slc_format_row_size(format, tile.width) * slc_format_row_count(format, tile.height) *
           tile.depth;
}

VkExtent3D slc_sparse_tile_extent(const SluiceFormatInfo *format, VkExtent3D granularity)
{
    /* Lavapipe's granularity counts blocks: taken as texels it would be a sixteenth of a page. */
    if (slc_format_is_compressed(format) &&
        (uint64_t)granularity.width * granularity.height * granularity.depth * format->blockSize ==
            SLC_TILE_SIZE) {
        granularity.width *= format->blockWidth;
        granularity.height *= format->blockHeight;
    }
    return granularity;
}

static void set_own_packed_levels(SluiceStreamedTextureDesc *desc, const SluiceImageInfo *info,
                                  VkExtent3D tile)
{
    desc->regularMipCount = slc_min_u32(own_packed_level(info, tile), info->mipLevelCount);
    desc->packedTileCount = info->mipLevelCount - desc->regularMipCount;
}

static bool has_driver_tail(const SluiceImageInfo *info,
                            const VkSparseImageMemoryRequirements *color)
{
    return color->imageMipTailFirstLod < info->mipLevelCount && color->imageMipTailSize;
}

bool slc_sparse_layers_share_tail(const SluiceImageInfo *info,
                                  const VkSparseImageMemoryRequirements *color)
{
    return info->arrayLayerCount > 1 && has_driver_tail(info, color) &&
           color->formatProperties.flags & VK_SPARSE_IMAGE_FORMAT_SINGLE_MIPTAIL_BIT;
}

SluiceResult slc_sparse_layout_init(struct slc_sparse_layout *layout, const SluiceImageInfo *info,
                                    const VkMemoryRequirements *memory,
                                    const VkSparseImageMemoryRequirements *color,
                                    const VkSparseImageMemoryRequirements *metadata,
                                    uint64_t address_space_size)
{
    SluiceFormatInfo format = {.structSize = sizeof format};
    if (sluiceGetFormatInfo(info->format, &format) != SLUICE_SUCCESS)
        return SLUICE_ERROR_UNSUPPORTED;
    VkExtent3D tile = slc_sparse_tile_extent(&format, color->formatProperties.imageGranularity);
    if (tile_size(&format, tile) != SLC_TILE_SIZE || tile.depth != 1 || memory->alignment == 0 ||
        SLC_TILE_SIZE % memory->alignment != 0 || memory->size > address_space_size)
        return SLUICE_ERROR_UNSUPPORTED;

    if (slc_sparse_layers_share_tail(info, color))
        return SLUICE_ERROR_UNSUPPORTED;

    *layout = (struct slc_sparse_layout){0};
    SluiceStreamedTextureDesc *desc = &layout->desc;
    desc->width = info->width;
    desc->height = info->height;
    desc->mipLevelCount = info->mipLevelCount;
    desc->tileWidth = tile.width;
    desc->tileHeight = tile.height;
    layout->opaque_tail = has_driver_tail(info, color);
    if (layout->opaque_tail) {
        uint64_t pages = (color->imageMipTailSize + SLC_TILE_SIZE - 1) / SLC_TILE_SIZE;
        if (pages > SLUICE_MAX_TILES_PER_TEXTURE)
            return SLUICE_ERROR_UNSUPPORTED;
        desc->regularMipCount = color->imageMipTailFirstLod;
        desc->packedTileCount = (uint32_t)pages;
        layout->tail_offset = color->imageMipTailOffset;
        layout->tail_size = color->imageMipTailSize;
        layout->tail_stride = color->imageMipTailStride;
    } else {
        set_own_packed_levels(desc, info, tile);
    }
    if (metadata) {
        layout->metadata_offset = metadata->imageMipTailOffset;
        layout->metadata_size = metadata->imageMipTailSize;
        layout->metadata_stride = metadata->imageMipTailStride;
    }
    set_regions(desc);
    layout->uneven = !halves_evenly(info->width, info->mipLevelCount) ||
                     !halves_evenly(info->height, info->mipLevelCount);
    return SLUICE_SUCCESS;
}

/* Returns the packed tiles of an image that has memory of its own, not one page per tile. */
static uint32_t packed_pages(const SluiceStreamedTextureDesc *desc, const SluiceImageInfo *info)
{
    uint64_t size = 0;
    for (uint32_t level = desc->regularMipCount; level < desc->mipLevelCount; level++)
        size += sluiceGetFormatRegionSize(info->format, slc_mip_size(info->width, level),
                                          slc_mip_size(info->height, level));
    return (uint32_t)((size + SLC_TILE_SIZE - 1) / SLC_TILE_SIZE);
}

/* Marks packed tiles as outside: their memory belongs to the image. */
static void put_outside(SluiceStreamedTextureDesc *desc)
{
    desc->regularMipCount = 0;
    desc->packedTileCount = 1;
    desc->packedTilesOutside = true;
}

static SluiceResult init(struct slc_sparse_layout *layout, const SluiceImageInfo *info, bool whole)
{
    VkExtent3D tile = {.depth = 1};
    SluiceResult result = sluiceGetStandardTileShape(info->format, &tile.width, &tile.height);
    if (result != SLUICE_SUCCESS)
        return result;
    *layout = (struct slc_sparse_layout){.desc = {.width = info->width,
                                                  .height = info->height,
                                                  .mipLevelCount = info->mipLevelCount,
                                                  .tileWidth = tile.width,
                                                  .tileHeight = tile.height}};
    set_own_packed_levels(&layout->desc, info, tile);
    layout->desc.packedTileCount = packed_pages(&layout->desc, info);
    if (whole || layout->desc.regularMipCount == 0)
        put_outside(&layout->desc);
    set_regions(&layout->desc);
    layout->uneven = !halves_evenly(info->width, info->mipLevelCount) ||
                     !halves_evenly(info->height, info->mipLevelCount);
    return SLUICE_SUCCESS;
}

SluiceResult slc_standard_layout_init(struct slc_sparse_layout *layout, const SluiceImageInfo *info)
{
    return init(layout, info, false);
}

SluiceResult slc_whole_layout_init(struct slc_sparse_layout *layout, const SluiceImageInfo *info)
{
    return init(layout, info, true);
}

bool slc_fits_into_tile(const SluiceImageInfo *info)
{
    VkExtent3D tile;
    return sluiceGetStandardTileShape(info->format, &tile.width, &tile.height) == SLUICE_SUCCESS &&
           own_packed_level(info, tile) == 0;
}

struct slc_tile_place slc_sparse_layout_place(const struct slc_sparse_layout *layout,
                                              const SluiceTile *tile)
{
    if (tile->mipLevel < layout->desc.regularMipCount)
        return (struct slc_tile_place){tile->mipLevel, tile->x, tile->y};
    if (layout->opaque_tail)
        return (struct slc_tile_place){SLC_TAIL_LEVEL, tile->x, 0};
    return (struct slc_tile_place){layout->desc.regularMipCount + tile->x, 0, 0};
}
