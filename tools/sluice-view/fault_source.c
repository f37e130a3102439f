#include "fault_source.h"

#include <stdint.h>
#include <stdlib.h>

struct fault_source {
    SluiceImageSource base;
    SluiceImageSource *inner;
    const atomic_uint *one_in;
};

static SluiceResult get_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    return sluiceGetImageInfo(((struct fault_source *)base)->inner, info);
}

/* FNV-1a over what names the region. */
static uint32_t hash(const SluiceImageRegion *region)
{
    const uint32_t words[] = {region->mipLevel, region->x, region->y, region->arrayLayer};
    uint32_t value = 0x811c9dc5u;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        value = (value ^ words[i]) * 0x01000193u;
    return value ^ value >> 15;
}

static SluiceResult read_region(SluiceImageSource *base, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch, SluiceImageFault *fault)
{
    const struct fault_source *source = (const struct fault_source *)base;
    const unsigned one_in = atomic_load(source->one_in);
    if (one_in > 0 && hash(region) % one_in == 0)
        return SLUICE_ERROR_IO;
    return sluiceReadImageRegionLocated(source->inner, region, texels, row_pitch, fault);
}

static void destroy(SluiceImageSource *base)
{
    free(base);
}

static const SluiceImageSourceInterface fault_interface = {.structSize = sizeof fault_interface,
                                                           .pfnGetInfo = get_info,
                                                           .pfnDestroy = destroy,
                                                           .pfnReadRegionLocated = read_region};

SluiceResult fault_source_create(const atomic_uint *one_in, SluiceImageSource *inner,
                                 SluiceImageSource **source)
{
    struct fault_source *made = calloc(1, sizeof *made);
    if (!made)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    *made = (struct fault_source){{.pInterface = &fault_interface}, inner, one_in};
    *source = &made->base;
    return SLUICE_SUCCESS;
}
