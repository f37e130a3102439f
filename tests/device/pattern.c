#include "device/pattern.h"

#include "support/test.h"

#include <math.h>

static uint32_t mix(uint32_t level, uint32_t x, uint32_t y, uint32_t channel)
{
    uint32_t h = x * 0x9E3779B1u ^ y * 0x85EBCA77u ^ level * 0xC2B2AE3Du ^ channel * 0x27D4EB2Fu;
    h ^= h >> 15;
    h *= 0x2C1B3C6Du;
    h ^= h >> 12;
    h *= 0x297A2D39u;
    return h ^ h >> 15;
}

void pattern_texel(enum pattern_kind kind, uint32_t level, uint32_t x, uint32_t y, float rgba[4])
{
    for (uint32_t channel = 0; channel < 4; channel++) {
        uint32_t value =
            kind == PATTERN_LEVEL ? mix(level, x / 64, y / 64, channel) : mix(level, x, y, channel);
        rgba[channel] = kind == PATTERN_SIGNED_HASH ? (float)(value % 255) / 127.0f - 1.0f
                                                    : (float)(value & 255) / 255.0f;
    }
    if (kind == PATTERN_LEVEL) {
        rgba[0] = (float)(level + 1) / 16.0f;
        rgba[3] = 1.0f;
    }
}

/* Sixteen waves across, flatter where a level has too few texels for them. */
static void waves(double u, double v, double texels, float rgba[4])
{
    double height = fmin(texels / 128, 1) * 0.5;
    for (int channel = 0; channel < 4; channel++)
        rgba[channel] =
            (float)(0.5 + height * sin(6.283185307 * (16 * u + (channel + 3) * v) + channel));
}

static void texel(void *user, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
                  uint32_t height, float rgba[4])
{
    if (*(enum pattern_kind *)user == PATTERN_WAVES)
        waves((x + 0.5) / width, (y + 0.5) / height, fmin(width, 3.0 * height), rgba);
    else
        pattern_texel(*(enum pattern_kind *)user, level, x, y, rgba);
}

static enum pattern_kind kinds[] = {PATTERN_LEVEL, PATTERN_WAVES, PATTERN_HASH,
                                    PATTERN_SIGNED_HASH}; /* never written to */

struct SluiceImageSource *pattern_source(enum pattern_kind kind, uint32_t width, uint32_t height,
                                         SluiceFormat format)
{
    SluiceProceduralImage image = {&kinds[kind], texel};
    SluiceImageInfo info = {.structSize = sizeof info,
                            .width = width,
                            .height = height,
                            .format = format,
                            .pName = "pattern"};
    SluiceImageSource *source;
    CHECK_OK(sluiceCreateProceduralImageSource(&image, &info, NULL, &source));
    return source;
}

float pattern_tolerance(SluiceFormat format)
{
    switch (format) {
    case SLUICE_FORMAT_R8G8B8A8_SRGB:
        return 0.01f; /* half a step at the bright end, and an H200 decodes to 8 bits */
    case SLUICE_FORMAT_R16_SFLOAT:
    case SLUICE_FORMAT_R16G16_SFLOAT:
    case SLUICE_FORMAT_R16G16B16A16_SFLOAT: return 0.0005f;
    case SLUICE_FORMAT_R16_UNORM:
    case SLUICE_FORMAT_R16G16_UNORM:
    case SLUICE_FORMAT_R16G16B16A16_UNORM:
    case SLUICE_FORMAT_R8_UNORM:
    case SLUICE_FORMAT_R8G8B8A8_UNORM: return 0.0001f; /* k / 255 is exact but for the division */
    default: return 0.0f;
    }
}

uint32_t pattern_channel_count(SluiceFormat format)
{
    switch (format) {
    case SLUICE_FORMAT_R8_UNORM:
    case SLUICE_FORMAT_R16_UNORM:
    case SLUICE_FORMAT_R16_SFLOAT:
    case SLUICE_FORMAT_R32_SFLOAT: return 1;
    case SLUICE_FORMAT_R16G16_UNORM:
    case SLUICE_FORMAT_R16G16_SFLOAT:
    case SLUICE_FORMAT_R32G32_SFLOAT: return 2;
    default: return 4;
    }
}
