#include "exposure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define EXPOSURE_LEVEL_SIZE 64 ///< largest width and height of the measured level

static float half_to_float(uint16_t half)
{
    int exponent = half >> 10 & 31;
    float magnitude = exponent == 0 ? ldexpf((float)(half & 1023), -24)
                                    : ldexpf((float)((half & 1023) | 1024), exponent - 25);
    return exponent == 31 ? NAN : half & 0x8000 ? -magnitude : magnitude;
}

static float luminance(float red, float green, float blue)
{
    return 0.2126f * red + 0.7152f * green + 0.0722f * blue;
}

/* Decodes sRGB roughly. NaN for other formats. */
static float texel_luminance(const uint8_t *texel, SluiceFormat format)
{
    uint16_t half[4];
    float number[4];
    switch (format) {
    case SLUICE_FORMAT_R16_SFLOAT: memcpy(half, texel, 2); return half_to_float(half[0]);
    case SLUICE_FORMAT_R16G16B16A16_SFLOAT:
        memcpy(half, texel, 8);
        return luminance(half_to_float(half[0]), half_to_float(half[1]), half_to_float(half[2]));
    case SLUICE_FORMAT_R32_SFLOAT: memcpy(number, texel, 4); return number[0];
    case SLUICE_FORMAT_R32G32B32A32_SFLOAT:
        memcpy(number, texel, 16);
        return luminance(number[0], number[1], number[2]);
    case SLUICE_FORMAT_R8_UNORM: return (float)texel[0] / 255.0f;
    case SLUICE_FORMAT_R8G8B8A8_UNORM: return luminance(texel[0], texel[1], texel[2]) / 255.0f;
    case SLUICE_FORMAT_R8G8B8A8_SRGB:
        return powf(luminance(texel[0], texel[1], texel[2]) / 255.0f, 2.2f);
    default: return NAN;
    }
}

/** Computes the factor from the arithmetic and the geometric mean of the luminance. 1 for
 * well-exposed pictures. */
static float exposure_for(const uint8_t *texels, uint32_t count, SluiceFormat format)
{
    uint32_t texel_size = sluiceGetFormatTexelSize(format);
    double sum = 0.0, log_sum = 0.0;
    uint32_t used = 0;
    for (uint32_t i = 0; i < count; i++) {
        float luminance = texel_luminance(texels + (size_t)i * texel_size, format);
        if (!(luminance > 1e-6f))
            continue;
        sum += fminf(luminance, 65504.0f);
        log_sum += log2(luminance);
        used++;
    }
    if (used == 0)
        return 1.0f;
    /* Average both means: the geometric one alone makes a dark picture with a few lights far too
     * bright. */
    double mean = 0.5 * (sum / used) + 0.5 * exp2(log_sum / used);
    return mean > 0.34   ? (float)(0.34 / mean)
           : mean < 0.09 ? (float)fmin(0.09 / mean, 4096.0)
                         : 1.0f;
}

static SluiceImageRegion small_level(const SluiceImageInfo *info)
{
    SluiceImageRegion region = {.width = info->width, .height = info->height};
    while ((region.width > EXPOSURE_LEVEL_SIZE || region.height > EXPOSURE_LEVEL_SIZE) &&
           region.mipLevel + 1 < info->mipLevelCount) {
        region.mipLevel++;
        region.width = region.width > 1 ? region.width / 2 : 1;
        region.height = region.height > 1 ? region.height / 2 : 1;
    }
    return region;
}

SluiceResult exposure_measure(SluiceImageSource *source, const SluiceImageInfo *info,
                              float *exposure)
{
    SluiceImageRegion region = small_level(info);
    size_t pitch = (size_t)region.width * sluiceGetFormatTexelSize(info->format);
    *exposure = 1.0f;
    if (pitch == 0) /* blocks */
        return SLUICE_SUCCESS;
    uint8_t *texels = malloc(pitch * region.height);
    if (!texels)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    SluiceResult result = sluiceReadImageRegion(source, &region, texels, pitch);
    if (result == SLUICE_SUCCESS)
        *exposure = exposure_for(texels, region.width * region.height, info->format);
    free(texels);
    return result;
}
