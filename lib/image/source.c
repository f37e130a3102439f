#include <sluice/image.h>

#include "base/checked.h"

SluiceResult sluiceGetImageInfo(SluiceImageSource *source, SluiceImageInfo *pInfo)
{
    if (!source || !pInfo)
        return SLUICE_ERROR_NULL_POINTER;
    return source->pInterface->pfnGetInfo(source, pInfo);
}

static bool region_is_inside(const SluiceImageRegion *region, const SluiceImageInfo *info)
{
    if (region->mipLevel >= info->mipLevelCount || region->width == 0 || region->height == 0)
        return false;
    uint32_t width = slc_mip_size(info->width, region->mipLevel);
    uint32_t height = slc_mip_size(info->height, region->mipLevel);
    return region->x < width && region->width <= width - region->x && region->y < height &&
           region->height <= height - region->y;
}

SluiceResult sluiceReadImageRegion(SluiceImageSource *source, const SluiceImageRegion *pRegion,
                                   void *pTexels, size_t rowPitch)
{
    if (!source || !pRegion || !pTexels)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceImageInfo info;
    SluiceResult result = source->pInterface->pfnGetInfo(source, &info);
    if (result != SLUICE_SUCCESS)
        return result;
    size_t row;
    if (!region_is_inside(pRegion, &info) ||
        !slc_mul_size(pRegion->width, sluiceFormatTexelSize(info.format), &row) || rowPitch < row)
        return SLUICE_ERROR_INVALID_ARGUMENT;
    return source->pInterface->pfnReadRegion(source, pRegion, pTexels, rowPitch);
}

void sluiceDestroyImageSource(SluiceImageSource *source)
{
    if (source)
        source->pInterface->pfnDestroy(source);
}
