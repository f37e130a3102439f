#include "support/gray_source.h"

#include "support/test.h"

#include <stdlib.h>
#include <string.h>

struct gray_image {
    SluiceImageSource base;
    SluiceImageSource *described; /* knows the info */
    uint32_t texel_size;
};

static SluiceResult get_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    return sluiceGetImageInfo(((struct gray_image *)base)->described, info);
}

static SluiceResult read_region(SluiceImageSource *base, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch)
{
    size_t row_size = (size_t)region->width * ((struct gray_image *)base)->texel_size;
    for (uint32_t y = 0; y < region->height; y++)
        memset((char *)texels + y * row_pitch, 128, row_size);
    return SLUICE_SUCCESS;
}

static void destroy(SluiceImageSource *base)
{
    sluiceDestroyImageSource(((struct gray_image *)base)->described);
    free(base);
}

static void texel(void *user, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
                  uint32_t height, float rgba[4])
{
    (void)user, (void)level, (void)x, (void)y, (void)width, (void)height, (void)rgba;
    abort(); /* read_region stands before it */
}

SluiceImageSource *gray_source_with(const SluiceImageInfo *info)
{
    static const SluiceImageSourceInterface interface = {sizeof interface, get_info, read_region,
                                                         destroy};
    const SluiceProceduralImage image = {NULL, texel};
    struct gray_image *source = calloc(1, sizeof *source);
    assert_non_null(source);
    source->base.pInterface = &interface;
    source->texel_size = sluiceGetFormatTexelSize(info->format);
    CHECK_OK(sluiceCreateProceduralImageSource(&image, info, NULL, &source->described));
    return &source->base;
}

SluiceImageSource *gray_source(uint32_t width, uint32_t height)
{
    const SluiceImageInfo info = {.structSize = sizeof info,
                                  .width = width,
                                  .height = height,
                                  .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                  .pName = "gray"};
    return gray_source_with(&info);
}
