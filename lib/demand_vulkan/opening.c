/*
 * On worker threads: the image source "opener" is read at one texel, which is the base color of
 * the image that the texel's memory is part of. So opening is a read like others.
 */
#include "demand_vulkan/opening.h"

#include "base/checked.h"
#include "demand/tail_place.h"
#include "image/convert.h"
#include "image/format_size.h"
#include "image/info.h"
#include "vulkan/sparse_layout.h"

#include <assert.h>
#include <string.h>

static SluiceResult get_info(SluiceImageSource *source, SluiceImageInfo *info)
{
    (void)source;
    *info = (SluiceImageInfo){.structSize = sizeof(SluiceImageInfo),
                              .width = 1,
                              .height = 1,
                              .mipLevelCount = 1,
                              .format = SLUICE_FORMAT_R32G32B32A32_SFLOAT,
                              .pName = ""};
    return SLUICE_SUCCESS;
}

const char *slc_image_trouble(const SluiceDemandLoader *loader, const SluiceImageInfo *info,
                              uint32_t array_layer)
{
    const char *trouble = slc_image_info_trouble(info, SLC_LEVELS_TO_TAIL);
    if (trouble)
        return trouble;
    if (array_layer >= slc_max_u32(info->arrayLayerCount, 1))
        return "arrayLayer is not below its arrayLayerCount";
    if (!loader->usable[info->format])
        return "the device does not sample and filter its format";
    uint32_t tile_width = 0, tile_height = 0;
    SluiceFormatInfo format = {.structSize = sizeof format};
    (void)sluiceGetFormatInfo(info->format, &format);
    (void)sluiceGetStandardTileShape(info->format, &tile_width, &tile_height);
    if (slc_demand_regular_count(info->width, info->height, tile_width, tile_height) >=
        info->mipLevelCount)
        return format.blockWidth > 1
                   ? "mipLevelCount ends before a level fits into half a tile; write the file "
                     "again with all levels"
                   : "mipLevelCount ends before a level fits into half a tile; build the others "
                     "with sluiceCreateCompleteChainSource";
    if (format.blockWidth > 4) /* levels of a mip tail lie at multiples of 4 texels */
        return "its format has blocks larger than 4x4, which demand loading does not read";
    return NULL;
}

static SluiceResult open_source(struct slc_demand_image *image)
{
    if (!image->source) {
        SluiceImageSource *source = NULL;
        SluiceResult result = image->origin.pfnOpen(image->origin.pUserData, &source);
        if (result != SLUICE_SUCCESS)
            return result;
        if (!source)
            return SLUICE_ERROR_NULL_POINTER;
        image->source = source;
    }
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceResult result = sluiceGetImageInfo(image->source, &info);
    if (result != SLUICE_SUCCESS || image->info.width)
        return result;
    image->info = info;
    image->trouble = slc_image_trouble(image->loader, &image->info, image->origin.arrayLayer);
    return image->trouble ? SLUICE_ERROR_UNSUPPORTED : SLUICE_SUCCESS;
}

/* The mean of the last level, by one texel of each block. A full chain has one texel there. */
static void find_base_color(const SluiceImageInfo *info, const uint8_t *texels, uint32_t count,
                            float rgba[4])
{
    SluiceFormatInfo format = {.structSize = sizeof format};
    double sum[4] = {0};
    (void)sluiceGetFormatInfo(info->format, &format);
    for (uint32_t i = 0; i < count; i++) {
        slc_base_color(info->format, texels + (size_t)i * format.blockSize, rgba);
        for (uint32_t c = 0; c < 4; c++)
            sum[c] += rgba[c];
    }
    for (uint32_t c = 0; c < 4 && count > 1; c++)
        rgba[c] = (float)(sum[c] / count);
}

static SluiceResult read_base_color(struct slc_demand_image *image)
{
    /* The last level fits into half a tile in both directions. */
    _Alignas(16) uint8_t texels[SLC_TILE_SIZE / 4];
    const SluiceImageInfo *info = &image->info;
    SluiceFormatInfo format = {.structSize = sizeof format};
    (void)sluiceGetFormatInfo(info->format, &format);
    SluiceImageRegion last = {.mipLevel = info->mipLevelCount - 1,
                              .arrayLayer = image->origin.arrayLayer};
    last.width = slc_mip_size(info->width, last.mipLevel);
    last.height = slc_mip_size(info->height, last.mipLevel);
    size_t pitch = (size_t)slc_format_row_size(&format, last.width);
    size_t size = pitch * slc_format_row_count(&format, last.height);
    assert(size <= sizeof texels);
    SluiceResult result = sluiceReadImageRegion(image->source, &last, texels, pitch);
    if (result == SLUICE_SUCCESS)
        find_base_color(info, texels, (uint32_t)(size / format.blockSize), image->read_color);
    return result;
}

static SluiceResult read_region(SluiceImageSource *source, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch)
{
    (void)source, (void)region, (void)row_pitch;
    struct slc_demand_image *image =
        (void *)((char *)texels - offsetof(struct slc_demand_image, read_color));
    if (image->trouble)
        return SLUICE_ERROR_UNSUPPORTED;
    SluiceResult result = open_source(image);
    return result == SLUICE_SUCCESS ? read_base_color(image) : result;
}

static void destroy(SluiceImageSource *source)
{
    (void)source;
}

static const SluiceImageSourceInterface interface = {sizeof interface, get_info, read_region,
                                                     destroy};

void slc_image_opener_init(SluiceImageSource *opener)
{
    opener->pInterface = &interface;
}
