#include "linear_source.h"

#include <stdlib.h>

struct linear_source {
    SluiceImageSource base;
    SluiceImageSource *source;
};

static const SluiceFormat twins[][2] =
    {/* linear, sRGB */
     {SLUICE_FORMAT_R8G8B8A8_UNORM, SLUICE_FORMAT_R8G8B8A8_SRGB},
     {SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK, SLUICE_FORMAT_BC1_RGB_SRGB_BLOCK},
     {SLUICE_FORMAT_BC1_RGBA_UNORM_BLOCK, SLUICE_FORMAT_BC1_RGBA_SRGB_BLOCK},
     {SLUICE_FORMAT_BC2_UNORM_BLOCK, SLUICE_FORMAT_BC2_SRGB_BLOCK},
     {SLUICE_FORMAT_BC3_UNORM_BLOCK, SLUICE_FORMAT_BC3_SRGB_BLOCK},
     {SLUICE_FORMAT_BC7_UNORM_BLOCK, SLUICE_FORMAT_BC7_SRGB_BLOCK}};

static SluiceFormat twin_of(SluiceFormat format, int wanted)
{
    for (size_t i = 0; i < sizeof twins / sizeof *twins; i++)
        if (twins[i][!wanted] == format)
            return twins[i][wanted];
    return format;
}

static SluiceResult get_linear_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    const SluiceResult result = sluiceGetImageInfo(linear_source_inner(base), info);
    info->format = twin_of(info->format, 0);
    return result;
}

static SluiceResult get_srgb_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    const SluiceResult result = sluiceGetImageInfo(linear_source_inner(base), info);
    info->format = twin_of(info->format, 1);
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
                                                            .pfnGetInfo = get_linear_info,
                                                            .pfnDestroy = destroy,
                                                            .pfnReadRegionLocated = read_region};

static const SluiceImageSourceInterface srgb_interface = {.structSize = sizeof srgb_interface,
                                                          .pfnGetInfo = get_srgb_info,
                                                          .pfnDestroy = destroy,
                                                          .pfnReadRegionLocated = read_region};

SluiceImageSource *linear_source_inner(SluiceImageSource *source)
{
    return source->pInterface == &linear_interface || source->pInterface == &srgb_interface
               ? ((struct linear_source *)source)->source
               : source;
}

static SluiceResult create(const SluiceImageSourceInterface *interface, SluiceImageSource *source,
                           SluiceImageSource **outer)
{
    struct linear_source *made = calloc(1, sizeof *made);
    if (!made)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    made->base.pInterface = interface;
    made->source = source;
    *outer = &made->base;
    return SLUICE_SUCCESS;
}

SluiceResult linear_source_create(SluiceImageSource *source, SluiceImageSource **linear)
{
    return create(&linear_interface, source, linear);
}

SluiceResult linear_source_create_srgb(SluiceImageSource *source, SluiceImageSource **srgb)
{
    return create(&srgb_interface, source, srgb);
}
