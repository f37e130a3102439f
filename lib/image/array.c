#include "base/alloc.h"
#include "base/checked.h"
#include "image/identity.h"
#include "image/info.h"
#include "image/start_read.h"

#include <sluice/image.h>

#define LAYER_SHIFT 48u /* the layer is in the upper bits of an identity */

struct array_source {
    SluiceImageSource base;
    SluiceAllocationCallbacks allocator;
    SluiceImageInfo info;
    SluiceImageSource **layers; ///< owned, what they point to is not
};

static SluiceResult get_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    *info = ((struct array_source *)base)->info;
    return SLUICE_SUCCESS;
}

static SluiceResult read_region(SluiceImageSource *base, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch, SluiceImageFault *fault)
{
    SluiceImageRegion inner = *region;
    inner.arrayLayer = 0;
    return sluiceReadImageRegionLocated(((struct array_source *)base)->layers[region->arrayLayer],
                                        &inner, texels, row_pitch, fault);
}

static SluiceResult start_read(SluiceImageSource *base, const SluiceImageRegion *region,
                               void *texels, size_t row_pitch, const SluiceImageReadToken *token)
{
    const struct array_source *source = (struct array_source *)base;
    SluiceImageRegion inner = *region;
    inner.arrayLayer = 0;
    return slc_start_read(source->layers[region->arrayLayer], &source->info, &inner, texels,
                          row_pitch, token);
}

static void cancel_read(SluiceImageSource *base, const SluiceImageRegion *region,
                        const SluiceImageReadToken *token)
{
    SluiceImageRegion inner = *region;
    inner.arrayLayer = 0;
    slc_cancel_read(((struct array_source *)base)->layers[region->arrayLayer], &inner, token);
}

/* Regions of different layers are not compared. */
static bool identify(SluiceImageSource *base, const SluiceImageRegion *region, uint64_t *identity)
{
    SluiceImageRegion inner = *region;
    inner.arrayLayer = 0;
    uint64_t number = 0;
    if (!slc_identify_region(((struct array_source *)base)->layers[region->arrayLayer], &inner,
                             &number) ||
        number >> LAYER_SHIFT != 0)
        return false;
    *identity = (uint64_t)region->arrayLayer << LAYER_SHIFT | number;
    return true;
}

static void destroy(SluiceImageSource *base)
{
    struct array_source *source = (struct array_source *)base;
    SluiceAllocationCallbacks cb = source->allocator;
    slc_free(&cb, source->layers, source->info.arrayLayerCount, sizeof *source->layers);
    slc_free(&cb, source, 1, sizeof *source);
}

static const SluiceImageSourceInterface array_interface = {.structSize = sizeof array_interface,
                                                           .pfnGetInfo = get_info,
                                                           .pfnDestroy = destroy,
                                                           .pfnReadRegionLocated = read_region,
                                                           .pfnIdentifyRegion = identify,
                                                           .pfnStartRead = start_read,
                                                           .pfnCancelRead = cancel_read};

static SluiceResult check_layers(SluiceImageSource *const *layers, uint32_t count,
                                 SluiceImageInfo *info)
{
    info->structSize = sizeof *info;
    for (uint32_t i = 0; i < count; i++) {
        SluiceImageInfo other = {.structSize = sizeof other};
        SluiceResult result = sluiceGetImageInfo(layers[i], i ? &other : info);
        if (result != SLUICE_SUCCESS)
            return result;
        result = slc_image_info_check(i ? &other : info, SLC_LEVELS_ANY, NULL);
        if (result != SLUICE_SUCCESS)
            return result;
        if (i == 0)
            other = *info;
        if (other.width != info->width || other.height != info->height ||
            other.format != info->format || other.mipLevelCount != info->mipLevelCount ||
            other.arrayLayerCount > 1)
            return SLUICE_ERROR_INVALID_ARGUMENT;
    }
    info->arrayLayerCount = count;
    return SLUICE_SUCCESS;
}

SluiceResult sluiceCreateArrayImageSource(SluiceImageSource *const *ppLayers, uint32_t layerCount,
                                          const SluiceAllocationCallbacks *pAllocator,
                                          SluiceImageSource **pSource)
{
    if (!ppLayers || !pSource || !slc_allocator_is_valid(pAllocator))
        return SLUICE_ERROR_NULL_POINTER;
    SluiceImageInfo info = {.structSize = sizeof info};
    if (layerCount == 0 || layerCount > SLC_MAX_IMAGE_LAYERS)
        return SLUICE_ERROR_INVALID_ARGUMENT;
    SluiceResult result = check_layers(ppLayers, layerCount, &info);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceAllocationCallbacks cb = slc_allocator(pAllocator);
    struct array_source *source = slc_calloc(&cb, 1, sizeof *source);
    if (!source)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    *source = (struct array_source){.base = {&array_interface}, .allocator = cb, .info = info};
    source->layers = slc_alloc(&cb, layerCount, sizeof *source->layers);
    if (!source->layers) {
        slc_free(&cb, source, 1, sizeof *source);
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    for (uint32_t i = 0; i < layerCount; i++)
        source->layers[i] = ppLayers[i];
    *pSource = &source->base;
    return SLUICE_SUCCESS;
}
