#include "image/convert.h"

#include "image/half.h"
#include "image/srgb.h"

uint32_t slc_format_channel_count(SluiceFormat format)
{
    switch (format) {
    case SLUICE_FORMAT_UNDEFINED: return 0;
    case SLUICE_FORMAT_R8_UNORM: return 1;
    case SLUICE_FORMAT_R8G8B8A8_UNORM: return 4;
    case SLUICE_FORMAT_R8G8B8A8_SRGB: return 4;
    case SLUICE_FORMAT_R16_SFLOAT: return 1;
    case SLUICE_FORMAT_R16G16_SFLOAT: return 2;
    case SLUICE_FORMAT_R16G16B16A16_SFLOAT: return 4;
    case SLUICE_FORMAT_R32_SFLOAT: return 1;
    case SLUICE_FORMAT_R32G32_SFLOAT: return 2;
    case SLUICE_FORMAT_R32G32B32A32_SFLOAT: return 4;
    }
    return 0;
}

static void unorm8_from_rgba(uint32_t channels, const float *rgba, uint8_t *out, size_t count)
{
    for (size_t i = 0; i < count; i++)
        for (uint32_t c = 0; c < channels; c++)
            *out++ = slc_unorm8_from_float(rgba[4 * i + c]);
}

static void srgb_from_rgba(const float *rgba, uint8_t *out, size_t count)
{
    for (size_t i = 0; i < count; i++, rgba += 4, out += 4) {
        for (uint32_t c = 0; c < 3; c++)
            out[c] = slc_srgb_from_linear(rgba[c]);
        out[3] = slc_unorm8_from_float(rgba[3]);
    }
}

/* Half and float texels go through memcpy: a caller's row pitch may leave them unaligned. */
static void half_from_rgba(uint32_t channels, const float *rgba, char *out, size_t count)
{
    for (size_t i = 0; i < count; i++)
        for (uint32_t c = 0; c < channels; c++, out += 2) {
            uint16_t half = slc_half_from_float(rgba[4 * i + c]);
            memcpy(out, &half, 2);
        }
}

static void float_from_rgba(uint32_t channels, const float *rgba, char *out, size_t count)
{
    for (size_t i = 0; i < count; i++, out += 4 * channels)
        memcpy(out, rgba + 4 * i, 4 * channels);
}

void slc_texels_from_rgba(SluiceFormat format, const float *rgba, void *texels, size_t count)
{
    uint32_t channels = slc_format_channel_count(format);
    switch (format) {
    case SLUICE_FORMAT_UNDEFINED: return;
    case SLUICE_FORMAT_R8_UNORM:
    case SLUICE_FORMAT_R8G8B8A8_UNORM: unorm8_from_rgba(channels, rgba, texels, count); return;
    case SLUICE_FORMAT_R8G8B8A8_SRGB: srgb_from_rgba(rgba, texels, count); return;
    case SLUICE_FORMAT_R16_SFLOAT:
    case SLUICE_FORMAT_R16G16_SFLOAT:
    case SLUICE_FORMAT_R16G16B16A16_SFLOAT: half_from_rgba(channels, rgba, texels, count); return;
    case SLUICE_FORMAT_R32_SFLOAT:
    case SLUICE_FORMAT_R32G32_SFLOAT:
    case SLUICE_FORMAT_R32G32B32A32_SFLOAT: float_from_rgba(channels, rgba, texels, count); return;
    }
}

static void set_defaults(float rgba[4])
{
    rgba[0] = rgba[1] = rgba[2] = 0.0f;
    rgba[3] = 1.0f;
}

static void rgba_from_unorm8(uint32_t channels, const uint8_t *in, float *rgba, size_t count)
{
    for (size_t i = 0; i < count; i++, rgba += 4) {
        set_defaults(rgba);
        for (uint32_t c = 0; c < channels; c++)
            rgba[c] = (float)*in++ / 255.0f;
    }
}

static void rgba_from_srgb(const uint8_t *in, float *rgba, size_t count)
{
    for (size_t i = 0; i < count; i++, rgba += 4, in += 4) {
        for (uint32_t c = 0; c < 3; c++)
            rgba[c] = slc_srgb_to_linear[in[c]];
        rgba[3] = (float)in[3] / 255.0f;
    }
}

static void rgba_from_half(uint32_t channels, const char *in, float *rgba, size_t count)
{
    for (size_t i = 0; i < count; i++, rgba += 4) {
        set_defaults(rgba);
        for (uint32_t c = 0; c < channels; c++, in += 2) {
            uint16_t half;
            memcpy(&half, in, 2);
            rgba[c] = slc_float_from_half(half);
        }
    }
}

static void rgba_from_float(uint32_t channels, const char *in, float *rgba, size_t count)
{
    for (size_t i = 0; i < count; i++, rgba += 4, in += 4 * channels) {
        set_defaults(rgba);
        memcpy(rgba, in, 4 * channels);
    }
}

void slc_texels_to_rgba(SluiceFormat format, const void *texels, float *rgba, size_t count)
{
    uint32_t channels = slc_format_channel_count(format);
    switch (format) {
    case SLUICE_FORMAT_UNDEFINED: return;
    case SLUICE_FORMAT_R8_UNORM:
    case SLUICE_FORMAT_R8G8B8A8_UNORM: rgba_from_unorm8(channels, texels, rgba, count); return;
    case SLUICE_FORMAT_R8G8B8A8_SRGB: rgba_from_srgb(texels, rgba, count); return;
    case SLUICE_FORMAT_R16_SFLOAT:
    case SLUICE_FORMAT_R16G16_SFLOAT:
    case SLUICE_FORMAT_R16G16B16A16_SFLOAT: rgba_from_half(channels, texels, rgba, count); return;
    case SLUICE_FORMAT_R32_SFLOAT:
    case SLUICE_FORMAT_R32G32_SFLOAT:
    case SLUICE_FORMAT_R32G32B32A32_SFLOAT: rgba_from_float(channels, texels, rgba, count); return;
    }
}
