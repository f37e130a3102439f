/*
 * On worker threads: the image source "opener" is read at one texel, which is the base color of
 * the image that the texel's memory is part of. So opening is a read like others.
 */
#include "demand_vulkan/opening.h"

#include "image/convert.h"
#include "image/info.h"

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

static const char *find_trouble(const struct slc_demand_image *image)
{
    const SluiceImageInfo *info = &image->info;
    const char *trouble = slc_image_info_trouble(info, SLC_LEVELS_ALL);
    if (trouble)
        return trouble;
    if (info->arrayLayerCount > 1)
        return "arrayLayerCount is beyond 1";
    if (!image->loader->usable[info->format])
        return "the device does not sample and filter its format";
    SluiceFormatInfo format = {.structSize = sizeof format};
    (void)sluiceGetFormatInfo(info->format, &format);
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
    image->trouble = find_trouble(image);
    return image->trouble ? SLUICE_ERROR_UNSUPPORTED : SLUICE_SUCCESS;
}

static SluiceResult read_region(SluiceImageSource *source, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch)
{
    (void)source, (void)region, (void)row_pitch;
    struct slc_demand_image *image =
        (void *)((char *)texels - offsetof(struct slc_demand_image, read_color));
    _Alignas(16) uint8_t texel[16]; /* of any format, or a block */
    if (image->trouble)
        return SLUICE_ERROR_UNSUPPORTED;
    SluiceResult result = open_source(image);
    if (result != SLUICE_SUCCESS)
        return result;
    const SluiceImageRegion last = {
        .mipLevel = image->info.mipLevelCount - 1, .width = 1, .height = 1};
    result = sluiceReadImageRegion(image->source, &last, texel, sizeof texel);
    if (result == SLUICE_SUCCESS)
        slc_base_color(image->info.format, texel, image->read_color);
    return result;
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
