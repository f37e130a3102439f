#include "extremes/values.h"

#include "base/checked.h"

#include <math.h>
#include <string.h>

#define TINY 0x1p-24f         /* the smallest half */
#define DENORMAL 0x1.ff8p-15f /* the largest denormal half */
#define FAR 0x1p120f          /* an infinity in 32-bit floats, baked */

const struct value values[VALUES_COUNT] = {
    {"0", 0x0000, 0.0f, 0.0f, 0.0f, 0},
    {"-0", 0x8000, -0.0f, -0.0f, -0.0f, 0},
    {"least", 0x0001, TINY, TINY, TINY, 0},
    {"-least", 0x8001, -TINY, -TINY, -TINY, 0},
    {"largest denormal", 0x03FF, DENORMAL, DENORMAL, DENORMAL, 0},
    {"least normal", 0x0400, 0x1p-14f, 0x1p-14f, 0x1p-14f, 0},
    {"1/3", 0x3555, 0x1.554p-2f, 0x1.554p-2f, 0x1.554p-2f, 85 / 255.0f},
    {"1 - step", 0x3BFF, 0x1.ffcp-1f, 0x1.ffcp-1f, 0x1.ffcp-1f, 1},
    {"1", 0x3C00, 1, 1, 1, 1},
    {"1 + step", 0x3C01, 0x1.004p0f, 0x1.004p0f, 0x1.004p0f, 1},
    {"-1", 0xBC00, -1, -1, -1, 0},
    {"65504 - step", 0x7BFE, 65472, 65472, 65472, 1},
    {"65504", 0x7BFF, 65504, 65504, 65504, 1},
    {"-65504", 0xFBFF, -65504, -65504, -65504, 0},
    {"infinity", 0x7C00, INFINITY, 65504, FAR, 1},
    {"-infinity", 0xFC00, -INFINITY, -65504, -FAR, 0},
    {"NaN", 0x7E00, NAN, 0, 0, 0},
    {"-NaN", 0xFE01, NAN, 0, 0, 0},
    {"signaling NaN", 0x7C01, NAN, 0, 0, 0},
};

/* Neighbors differ, and each value has many neighbors. */
uint32_t value_at(uint32_t level, uint32_t x, uint32_t y)
{
    return (x * (1 + y % 7) + y * 5 + level * 3) % VALUES_COUNT;
}

static SluiceResult get_info(SluiceImageSource *source, SluiceImageInfo *info)
{
    (void)source;
    *info = (SluiceImageInfo){.structSize = sizeof(SluiceImageInfo),
                              .width = VALUES_WIDTH,
                              .height = VALUES_HEIGHT,
                              .mipLevelCount = VALUES_LEVELS,
                              .format = SLUICE_FORMAT_R16G16B16A16_SFLOAT,
                              .pName = "values"};
    return SLUICE_SUCCESS;
}

static SluiceResult read_region(SluiceImageSource *source, const SluiceImageRegion *region,
                                void *texels, size_t pitch)
{
    (void)source;
    for (uint32_t y = 0; y < region->height; y++)
        for (uint32_t x = 0; x < region->width; x++) {
            uint16_t half = values[value_at(region->mipLevel, region->x + x, region->y + y)].half;
            const uint16_t texel[4] = {half, half, 0x3C00, 0x3C00};
            memcpy((char *)texels + y * pitch + x * sizeof texel, texel, sizeof texel);
        }
    return SLUICE_SUCCESS;
}

static void destroy(SluiceImageSource *source)
{
    (void)source;
}

void values_source_init(SluiceImageSource *source)
{
    static const SluiceImageSourceInterface interface = {sizeof interface, get_info, read_region,
                                                         destroy};
    *source = (SluiceImageSource){&interface};
}
