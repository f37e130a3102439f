#include <sluice/image.h>

#include "base/struct_size.h"
#include "image/format_size.h"
#include "image/region.h"
#include "image/start_read.h"

#include <stddef.h>

SluiceResult sluiceGetImageInfo(SluiceImageSource *source, SluiceImageInfo *pInfo)
{
    if (!source || !pInfo || !source->pInterface || !source->pInterface->pfnGetInfo)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceResult result =
        slc_struct_check(SLC_STRUCT(SluiceImageSourceInterface), source->pInterface, NULL);
    if (result == SLUICE_SUCCESS)
        result = slc_struct_check(SLC_STRUCT(SluiceImageInfo), pInfo, NULL);
    if (result == SLUICE_SUCCESS)
        result = source->pInterface->pfnGetInfo(source, &info);
    if (result == SLUICE_SUCCESS)
        slc_struct_write(SLC_STRUCT(SluiceImageInfo), pInfo, &info);
    return result;
}

/* True if a region has whole blocks. Only the right and lower edge of a level may cut a block. */
static bool region_is_aligned(const SluiceImageRegion *region, const SluiceImageInfo *info,
                              const SluiceFormatInfo *format)
{
    uint32_t right = region->x + region->width, bottom = region->y + region->height;
    return region->x % format->blockWidth == 0 && region->y % format->blockHeight == 0 &&
           (right % format->blockWidth == 0 ||
            right == slc_mip_size(info->width, region->mipLevel)) &&
           (bottom % format->blockHeight == 0 ||
            bottom == slc_mip_size(info->height, region->mipLevel));
}

static bool region_is_inside(const SluiceImageRegion *region, const SluiceImageInfo *info)
{
    if (region->arrayLayer >= slc_max_u32(1, info->arrayLayerCount) ||
        region->mipLevel >= info->mipLevelCount || region->width == 0 || region->height == 0)
        return false;
    uint32_t width = slc_mip_size(info->width, region->mipLevel);
    uint32_t height = slc_mip_size(info->height, region->mipLevel);
    return region->x < width && region->width <= width - region->x && region->y < height &&
           region->height <= height - region->y;
}

bool slc_region_is_valid(const SluiceImageRegion *region, const SluiceImageInfo *info)
{
    SluiceFormatInfo format = {.structSize = sizeof format};
    return sluiceGetFormatInfo(info->format, &format) == SLUICE_SUCCESS &&
           region_is_inside(region, info) && region_is_aligned(region, info, &format);
}

SluiceResult sluiceReadImageRegion(SluiceImageSource *source, const SluiceImageRegion *pRegion,
                                   void *pTexels, size_t rowPitch)
{
    SluiceImageFault fault;
    return sluiceReadImageRegionLocated(source, pRegion, pTexels, rowPitch, &fault);
}

SluiceResult sluiceReadImageRegionLocated(SluiceImageSource *source,
                                          const SluiceImageRegion *pRegion, void *pTexels,
                                          size_t rowPitch, SluiceImageFault *pFault)
{
    if (!source || !pRegion || !pTexels || !pFault)
        return SLUICE_ERROR_NULL_POINTER;
    *pFault = (SluiceImageFault){"", SLUICE_UNKNOWN_OFFSET};
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceResult result = sluiceGetImageInfo(source, &info);
    if (result != SLUICE_SUCCESS)
        return result;
    pFault->pName = info.pName ? info.pName : "";
    if (!slc_region_is_valid(pRegion, &info) ||
        rowPitch < sluiceGetFormatRegionSize(info.format, pRegion->width, 1))
        return SLUICE_ERROR_INVALID_ARGUMENT;
    const SluiceImageSourceInterface *source_interface = source->pInterface;
    if (!source_interface->pfnReadRegionLocated && !source_interface->pfnReadRegion)
        return SLUICE_ERROR_NULL_POINTER;
    return source_interface->pfnReadRegionLocated
               ? source_interface->pfnReadRegionLocated(source, pRegion, pTexels, rowPitch, pFault)
               : source_interface->pfnReadRegion(source, pRegion, pTexels, rowPitch);
}

/* Sources of older programs have a shorter interface. */
static bool can_start(const SluiceImageSourceInterface *source)
{
    size_t size = offsetof(SluiceImageSourceInterface, pfnStartRead) + sizeof source->pfnStartRead;
    return source->structSize >= size && source->pfnStartRead;
}

bool slc_starts_reads(const SluiceImageSource *source)
{
    return can_start(source->pInterface);
}

SluiceResult slc_start_read(SluiceImageSource *source, const SluiceImageInfo *info,
                            const SluiceImageRegion *region, void *texels, size_t row_pitch,
                            const SluiceImageReadToken *token)
{
    if (!can_start(source->pInterface))
        return SLUICE_ERROR_UNSUPPORTED;
    if (!slc_region_is_valid(region, info))
        return SLUICE_ERROR_INVALID_ARGUMENT;
    return source->pInterface->pfnStartRead(source, region, texels, row_pitch, token);
}

void slc_cancel_read(SluiceImageSource *source, const SluiceImageRegion *region,
                     const SluiceImageReadToken *token)
{
    size_t size = offsetof(SluiceImageSourceInterface, pfnCancelRead) +
                  sizeof source->pInterface->pfnCancelRead;
    if (source->pInterface->structSize >= size && source->pInterface->pfnCancelRead)
        source->pInterface->pfnCancelRead(source, region, token);
}

void sluiceDestroyImageSource(SluiceImageSource *source)
{
    if (source && source->pInterface && source->pInterface->pfnDestroy)
        source->pInterface->pfnDestroy(source);
}
