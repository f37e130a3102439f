#include "to_bytes.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

/* Returns the bytes per channel: 1, 2 or 4. 0 for formats without plain channels. */
static uint32_t channel_size(SluiceFormat format)
{
    switch (format) {
    case SLUICE_FORMAT_R8_UNORM:
    case SLUICE_FORMAT_R8G8_UNORM:
    case SLUICE_FORMAT_R8G8B8A8_UNORM:
    case SLUICE_FORMAT_R8G8B8A8_SRGB: return 1;
    case SLUICE_FORMAT_R16_SFLOAT:
    case SLUICE_FORMAT_R16G16_SFLOAT:
    case SLUICE_FORMAT_R16G16B16A16_SFLOAT: return 2;
    case SLUICE_FORMAT_R32_SFLOAT:
    case SLUICE_FORMAT_R32G32_SFLOAT:
    case SLUICE_FORMAT_R32G32B32A32_SFLOAT: return 4;
    default: return 0;
    }
}

bool can_become_bytes(SluiceFormat format)
{
    return channel_size(format) > 0;
}

static double half_value(uint16_t half)
{
    int exponent = half >> 10 & 31, mantissa = half & 1023;
    double value = exponent == 0    ? ldexp(mantissa, -24)
                   : exponent == 31 ? (mantissa ? 0.0 : (double)INFINITY)
                                    : ldexp(1024 + mantissa, exponent - 25);
    return half & 0x8000 ? -value : value;
}

static uint8_t quantize(double value, bool encode)
{
    if (!(value > 0.0))
        return 0;
    if (encode && value < 1.0)
        value = value <= 0.0031308 ? 12.92 * value : 1.055 * pow(value, 1 / 2.4) - 0.055;
    return value >= 1.0 ? 255 : (uint8_t)(255.0 * value + 0.5);
}

/* Table of sRGB bytes by half and by alpha or not. Large pictures have more texels than there are
 * halves. */
struct half_bytes {
    bool is_filled;
    uint8_t bytes[2][65536];
};

static uint8_t half_to_byte(uint16_t half, bool is_alpha)
{
    static struct half_bytes table;
    for (uint32_t i = 0; !table.is_filled && i < 65536; i++) {
        table.bytes[0][i] = quantize(half_value((uint16_t)i), true);
        table.bytes[1][i] = quantize(half_value((uint16_t)i), false);
    }
    table.is_filled = true;
    return table.bytes[is_alpha][half];
}

static uint8_t channel_to_byte(uint32_t size, const char *channel, bool is_alpha)
{
    uint16_t half;
    float value;
    if (size == 1)
        return (uint8_t)*channel;
    if (size == 2) {
        memcpy(&half, channel, 2);
        return half_to_byte(half, is_alpha);
    }
    memcpy(&value, channel, 4);
    return quantize((double)value, !is_alpha);
}

void texels_to_bytes(SluiceFormat format, const void *texels, uint8_t *rgba, size_t count)
{
    uint32_t size = channel_size(format), channels = sluiceGetFormatTexelSize(format) / size;
    const char *in = texels;
    for (size_t i = 0; i < count; i++, rgba += 4) {
        rgba[0] = rgba[1] = rgba[2] = 0;
        rgba[3] = 255;
        for (uint32_t c = 0; c < channels; c++, in += size)
            rgba[c] = channel_to_byte(size, in, c == 3);
        if (channels == 1)
            rgba[1] = rgba[2] = rgba[0];
    }
}
