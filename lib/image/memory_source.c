#include "base/alloc.h"
#include "base/struct_size.h"
#include "image/info.h"
#include "image/mip.h"

#include <string.h>

struct memory_source {
    SluiceImageSource base;
    SluiceAllocationCallbacks allocator;
    SluiceImageInfo info;
    struct slc_mip_chain chain;
};

static SluiceResult get_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    *info = ((struct memory_source *)base)->info;
    return SLUICE_SUCCESS;
}

static SluiceResult read_region(SluiceImageSource *base, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch)
{
    slc_mip_chain_read(&((struct memory_source *)base)->chain, region, texels, row_pitch);
    return SLUICE_SUCCESS;
}

static void destroy(SluiceImageSource *base)
{
    struct memory_source *source = (struct memory_source *)base;
    SluiceAllocationCallbacks cb = source->allocator;
    slc_mip_chain_finish(&source->chain, &cb);
    if (source->info.pName)
        slc_image_info_finish(&cb, &source->info);
    slc_free(&cb, source, 1, sizeof *source);
}

static const SluiceImageSourceInterface memory_interface = {sizeof memory_interface, get_info,
                                                            read_region, destroy};

static SluiceResult fill(struct memory_source *source, const void *texels,
                         const SluiceImageInfo *info)
{
    SluiceResult result = slc_image_info_init(&source->allocator, info, &source->info);
    if (result != SLUICE_SUCCESS)
        return result;
    result = slc_mip_chain_init(&source->chain, &source->allocator, info->format, info->width,
                                info->height);
    if (result != SLUICE_SUCCESS)
        return result;
    size_t level0 = source->chain.level_count > 1 ? source->chain.offsets[1] : source->chain.size;
    memcpy(source->chain.texels, texels, level0);
    return slc_mip_chain_build(&source->chain, &source->allocator);
}

SluiceResult sluiceCreateMemoryImageSource(const void *pTexels, const SluiceImageInfo *pInfo,
                                           const SluiceAllocationCallbacks *pAllocator,
                                           SluiceImageSource **pSource)
{
    if (!pTexels || !pInfo || !pSource || !slc_allocator_is_valid(pAllocator))
        return SLUICE_ERROR_NULL_POINTER;
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceResult result = slc_struct_read(SLC_STRUCT(SluiceImageInfo), &info, pInfo, NULL);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceAllocationCallbacks cb = slc_allocator(pAllocator);
    struct memory_source *source = slc_calloc(&cb, 1, sizeof *source);
    if (!source)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    source->base.pInterface = &memory_interface;
    source->allocator = cb;
    result = fill(source, pTexels, &info);
    if (result != SLUICE_SUCCESS) {
        destroy(&source->base);
        return result;
    }
    *pSource = &source->base;
    return SLUICE_SUCCESS;
}
