#include "base/struct_size.h"
#include "image/info.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "image/convert.h"

#include <string.h>

struct procedural_source {
    SluiceImageSource base;
    SluiceAllocationCallbacks allocator;
    SluiceProceduralImage image;
    SluiceImageInfo info;
};

static SluiceResult get_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    *info = ((struct procedural_source *)base)->info;
    return SLUICE_SUCCESS;
}

static SluiceResult read_region(SluiceImageSource *base, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch)
{
    enum { BATCH = 64 }; /* so that no memory is needed */
    struct procedural_source *source = (struct procedural_source *)base;
    uint32_t width = slc_mip_size(source->info.width, region->mipLevel);
    uint32_t height = slc_mip_size(source->info.height, region->mipLevel);
    uint32_t texel_size = sluiceGetFormatTexelSize(source->info.format);
    float rgba[BATCH][4];
    for (uint32_t y = 0; y < region->height; y++) {
        char *row = (char *)texels + y * row_pitch;
        for (uint32_t x = 0; x < region->width; x += BATCH) {
            uint32_t count = slc_min_u32(BATCH, region->width - x);
            for (uint32_t i = 0; i < count; i++)
                source->image.pfnTexel(source->image.pUserData, region->mipLevel, region->x + x + i,
                                       region->y + y, width, height, rgba[i]);
            slc_texels_from_rgba(source->info.format, rgba[0], row + (size_t)x * texel_size, count);
        }
    }
    return SLUICE_SUCCESS;
}

static void destroy(SluiceImageSource *base)
{
    struct procedural_source *source = (struct procedural_source *)base;
    SluiceAllocationCallbacks cb = source->allocator;
    slc_image_info_finish(&cb, &source->info);
    slc_free(&cb, source, 1, sizeof *source);
}

static const SluiceImageSourceInterface procedural_interface = {sizeof procedural_interface,
                                                                get_info, read_region, destroy};

SluiceResult sluiceCreateProceduralImageSource(const SluiceProceduralImage *pImage,
                                               const SluiceImageInfo *pInfo,
                                               const SluiceAllocationCallbacks *pAllocator,
                                               SluiceImageSource **pSource)
{
    if (!pImage || !pInfo || !pSource || !pImage->pfnTexel || !slc_allocator_is_valid(pAllocator))
        return SLUICE_ERROR_NULL_POINTER;
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceResult result = slc_struct_read(SLC_STRUCT(SluiceImageInfo), &info, pInfo, NULL);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceAllocationCallbacks cb = slc_allocator(pAllocator);
    struct procedural_source *source = slc_calloc(&cb, 1, sizeof *source);
    if (!source)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    result = slc_image_info_init(&cb, &info, &source->info);
    if (result != SLUICE_SUCCESS) {
        slc_free(&cb, source, 1, sizeof *source);
        return result;
    }
    source->base.pInterface = &procedural_interface;
    source->allocator = cb;
    source->image = *pImage;
    *pSource = &source->base;
    return SLUICE_SUCCESS;
}
