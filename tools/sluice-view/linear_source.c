#include "linear_source.h"

#include <stdlib.h>

struct linear_source {
    SluiceImageSource base;
    SluiceImageSource *source;
};

static SluiceFormat linear_format(SluiceFormat format)
{
    switch (format) {
    case SLUICE_FORMAT_R8G8B8A8_SRGB: return SLUICE_FORMAT_R8G8B8A8_UNORM;
    case SLUICE_FORMAT_BC1_RGB_SRGB_BLOCK: return SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK;
    case SLUICE_FORMAT_BC1_RGBA_SRGB_BLOCK: return SLUICE_FORMAT_BC1_RGBA_UNORM_BLOCK;
    case SLUICE_FORMAT_BC3_SRGB_BLOCK: return SLUICE_FORMAT_BC3_UNORM_BLOCK;
    case SLUICE_FORMAT_BC7_SRGB_BLOCK: return SLUICE_FORMAT_BC7_UNORM_BLOCK;
    default: return format;
    }
}

static SluiceResult get_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    const SluiceResult result = sluiceGetImageInfo(linear_source_inner(base), info);
    info->format = linear_format(info->format);
    return result;
}

static SluiceResult read_region(SluiceImageSource *base, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch, SluiceImageFault *fault)
{
    return sluiceReadImageRegionLocated(linear_source_inner(base), region, texels, row_pitch,
                                        fault);
}

static void destroy(SluiceImageSource *base)
{
    sluiceDestroyImageSource(((struct linear_source *)base)->source);
    free(base);
}

static const SluiceImageSourceInterface linear_interface = {.structSize = sizeof linear_interface,
                                                            .pfnGetInfo = get_info,
                                                            .pfnDestroy = destroy,
                                                            .pfnReadRegionLocated = read_region};

SluiceImageSource *linear_source_inner(SluiceImageSource *source)
{
    return source->pInterface == &linear_interface ? ((struct linear_source *)source)->source
                                                   : source;
}

SluiceResult linear_source_create(SluiceImageSource *source, SluiceImageSource **linear)
{
    struct linear_source *made = calloc(1, sizeof *made);
    if (!made)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    made->base.pInterface = &linear_interface;
    made->source = source;
    *linear = &made->base;
    return SLUICE_SUCCESS;
}
