#include "image/convert.h"

#include "image/format_size.h"
#include "image/half.h"
#include "image/small_float.h"
#include "image/srgb.h"

#include <assert.h>
#include <math.h>
#include <string.h>

uint32_t slc_format_channel_count(SluiceFormat format)
{
    SluiceFormatInfo info = {.structSize = sizeof info};
    bool known = sluiceGetFormatInfo(format, &info) == SLUICE_SUCCESS;
    return known && !slc_format_is_compressed(&info) ? info.channelCount : 0;
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

static uint32_t unorm_from_float(float value, uint32_t max)
{
    if (!(value > 0.0f))
        return 0;
    return value >= 1.0f ? max : (uint32_t)((double)value * max + 0.5);
}

static void unorm16_from_rgba(uint32_t channels, const float *rgba, char *out, size_t count)
{
    for (size_t i = 0; i < count; i++)
        for (uint32_t c = 0; c < channels; c++, out += 2) {
            uint16_t word = slc_unorm16_from_float(rgba[4 * i + c]);
            memcpy(out, &word, 2);
        }
}

/* SNORM of 1 or 2 bytes: -1 is -127 or -32767. */
static void snorm_from_rgba(uint32_t channels, uint32_t size, const float *rgba, char *out,
                            size_t count)
{
    const double max = size == 1 ? 127 : 32767;
    for (size_t i = 0; i < count; i++)
        for (uint32_t c = 0; c < channels; c++, out += size) {
            float value = rgba[4 * i + c];
            double clamped = isnan(value) ? 0.0 : fmin(fmax(value, -1.0), 1.0);
            int16_t word = (int16_t)lround(clamped * max);
            int8_t byte = (int8_t)word;
            memcpy(out, size == 1 ? (const void *)&byte : &word, size);
        }
}

static void put_word(char *out, uint32_t value, uint32_t size)
{
    uint8_t byte = (uint8_t)value;
    uint16_t half = (uint16_t)value;
    memcpy(out, size == 1 ? (const void *)&byte : size == 2 ? (const void *)&half : &value, size);
}

static uint32_t word_at(const char *in, uint32_t size)
{
    uint8_t byte = 0;
    uint16_t half = 0;
    uint32_t word = 0;
    memcpy(size == 1 ? (void *)&byte : size == 2 ? (void *)&half : &word, in, size);
    return byte | half | word;
}

static void integers_from_rgba(SluiceFormat format, uint32_t channels, const float *rgba, char *out,
                               size_t count)
{
    uint32_t size = sluiceGetFormatTexelSize(format) / channels;
    bool is_signed = slc_format_is_sint(format);
    double span = ldexp(1.0, 8 * (int)size), least = is_signed ? -span / 2 : 0;
    for (size_t i = 0; i < count; i++)
        for (uint32_t c = 0; c < channels; c++, out += size) {
            double value = isnan(rgba[4 * i + c]) ? 0 : (double)rgba[4 * i + c];
            int64_t integer = llround(fmin(fmax(value, least), least + span - 1));
            put_word(out, (uint32_t)integer, size);
        }
}

static void rgba_from_integers(SluiceFormat format, uint32_t channels, const char *in, float *rgba,
                               size_t count)
{
    uint32_t size = sluiceGetFormatTexelSize(format) / channels;
    uint32_t sign = slc_format_is_sint(format) ? 1u << (8 * size - 1) : 0;
    for (size_t i = 0; i < count; i++, rgba += 4) {
        rgba[0] = rgba[1] = rgba[2] = 0.0f;
        rgba[3] = 1.0f;
        for (uint32_t c = 0; c < channels; c++, in += size) {
            uint32_t word = word_at(in, size);
            rgba[c] = (float)((int64_t)(word ^ sign) - (int64_t)sign);
        }
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

static uint32_t word_from_rgba(SluiceFormat format, const float *rgba)
{
    if (format == SLUICE_FORMAT_E5B9G9R9_UFLOAT_PACK32)
        return slc_e5b9g9r9_from_float(rgba);
    if (format == SLUICE_FORMAT_B10G11R11_UFLOAT_PACK32)
        return slc_ufloat_from_float(rgba[0], 6) | slc_ufloat_from_float(rgba[1], 6) << 11 |
               slc_ufloat_from_float(rgba[2], 5) << 22;
    return unorm_from_float(rgba[0], 1023) | unorm_from_float(rgba[1], 1023) << 10 |
           unorm_from_float(rgba[2], 1023) << 20 | unorm_from_float(rgba[3], 3) << 30;
}

static void words_from_rgba(SluiceFormat format, const float *rgba, char *out, size_t count)
{
    for (size_t i = 0; i < count; i++, rgba += 4, out += 4) {
        uint32_t word = word_from_rgba(format, rgba);
        memcpy(out, &word, 4);
    }
}

void slc_texels_from_rgba(SluiceFormat format, const float *rgba, void *texels, size_t count)
{
    uint32_t channels = slc_format_channel_count(format);
    if (slc_format_is_integer(format)) {
        integers_from_rgba(format, channels, rgba, texels, count);
        return;
    }
    switch (format) {
    case SLUICE_FORMAT_R8_UNORM:
    case SLUICE_FORMAT_R8G8_UNORM:
    case SLUICE_FORMAT_R8G8B8A8_UNORM: unorm8_from_rgba(channels, rgba, texels, count); return;
    case SLUICE_FORMAT_R8G8B8A8_SRGB: srgb_from_rgba(rgba, texels, count); return;
    case SLUICE_FORMAT_R16_SFLOAT:
    case SLUICE_FORMAT_R16G16_SFLOAT:
    case SLUICE_FORMAT_R16G16B16A16_SFLOAT: half_from_rgba(channels, rgba, texels, count); return;
    case SLUICE_FORMAT_R16_UNORM:
    case SLUICE_FORMAT_R16G16_UNORM:
    case SLUICE_FORMAT_R16G16B16A16_UNORM: unorm16_from_rgba(channels, rgba, texels, count); return;
    case SLUICE_FORMAT_R32_SFLOAT:
    case SLUICE_FORMAT_R32G32_SFLOAT:
    case SLUICE_FORMAT_R32G32B32A32_SFLOAT: float_from_rgba(channels, rgba, texels, count); return;
    case SLUICE_FORMAT_A2B10G10R10_UNORM_PACK32:
    case SLUICE_FORMAT_B10G11R11_UFLOAT_PACK32:
    case SLUICE_FORMAT_E5B9G9R9_UFLOAT_PACK32: words_from_rgba(format, rgba, texels, count); return;
    case SLUICE_FORMAT_R8_SNORM:
    case SLUICE_FORMAT_R8G8_SNORM:
    case SLUICE_FORMAT_R8G8B8A8_SNORM: snorm_from_rgba(channels, 1, rgba, texels, count); return;
    case SLUICE_FORMAT_R16_SNORM:
    case SLUICE_FORMAT_R16G16_SNORM:
    case SLUICE_FORMAT_R16G16B16A16_SNORM:
        snorm_from_rgba(channels, 2, rgba, texels, count);
        return;
    default: assert(!"a format without texels"); /* sources refuse such formats */
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

static void rgba_from_unorm16(uint32_t channels, const char *in, float *rgba, size_t count)
{
    for (size_t i = 0; i < count; i++, rgba += 4) {
        set_defaults(rgba);
        for (uint32_t c = 0; c < channels; c++, in += 2) {
            uint16_t word;
            memcpy(&word, in, 2);
            rgba[c] = (float)word / 65535.0f;
        }
    }
}

/* The least value, -128 or -32768, also means -1. */
static void rgba_from_snorm(uint32_t channels, uint32_t size, const char *in, float *rgba,
                            size_t count)
{
    const float max = size == 1 ? 127.0f : 32767.0f;
    for (size_t i = 0; i < count; i++, rgba += 4) {
        set_defaults(rgba);
        for (uint32_t c = 0; c < channels; c++, in += size) {
            int8_t byte;
            int16_t word;
            memcpy(size == 1 ? (void *)&byte : &word, in, size);
            rgba[c] = fmaxf((float)(size == 1 ? byte : word) / max, -1.0f);
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

static void rgba_from_word(SluiceFormat format, uint32_t word, float *rgba)
{
    if (format == SLUICE_FORMAT_E5B9G9R9_UFLOAT_PACK32) {
        slc_float_from_e5b9g9r9(word, rgba);
    } else if (format == SLUICE_FORMAT_B10G11R11_UFLOAT_PACK32) {
        rgba[0] = slc_float_from_ufloat(word & 0x7FF, 6);
        rgba[1] = slc_float_from_ufloat(word >> 11 & 0x7FF, 6);
        rgba[2] = slc_float_from_ufloat(word >> 22, 5);
    } else {
        for (uint32_t c = 0; c < 3; c++)
            rgba[c] = (float)(word >> (10 * c) & 1023) / 1023.0f;
        rgba[3] = (float)(word >> 30) / 3.0f;
    }
}

static void rgba_from_words(SluiceFormat format, const char *in, float *rgba, size_t count)
{
    for (size_t i = 0; i < count; i++, rgba += 4, in += 4) {
        uint32_t word;
        memcpy(&word, in, 4);
        set_defaults(rgba);
        rgba_from_word(format, word, rgba);
    }
}

void slc_texels_to_rgba(SluiceFormat format, const void *texels, float *rgba, size_t count)
{
    uint32_t channels = slc_format_channel_count(format);
    if (slc_format_is_integer(format)) {
        rgba_from_integers(format, channels, texels, rgba, count);
        return;
    }
    switch (format) {
    case SLUICE_FORMAT_R8_UNORM:
    case SLUICE_FORMAT_R8G8_UNORM:
    case SLUICE_FORMAT_R8G8B8A8_UNORM: rgba_from_unorm8(channels, texels, rgba, count); return;
    case SLUICE_FORMAT_R8G8B8A8_SRGB: rgba_from_srgb(texels, rgba, count); return;
    case SLUICE_FORMAT_R16_SFLOAT:
    case SLUICE_FORMAT_R16G16_SFLOAT:
    case SLUICE_FORMAT_R16G16B16A16_SFLOAT: rgba_from_half(channels, texels, rgba, count); return;
    case SLUICE_FORMAT_R16_UNORM:
    case SLUICE_FORMAT_R16G16_UNORM:
    case SLUICE_FORMAT_R16G16B16A16_UNORM: rgba_from_unorm16(channels, texels, rgba, count); return;
    case SLUICE_FORMAT_R32_SFLOAT:
    case SLUICE_FORMAT_R32G32_SFLOAT:
    case SLUICE_FORMAT_R32G32B32A32_SFLOAT: rgba_from_float(channels, texels, rgba, count); return;
    case SLUICE_FORMAT_A2B10G10R10_UNORM_PACK32:
    case SLUICE_FORMAT_B10G11R11_UFLOAT_PACK32:
    case SLUICE_FORMAT_E5B9G9R9_UFLOAT_PACK32: rgba_from_words(format, texels, rgba, count); return;
    case SLUICE_FORMAT_R8_SNORM:
    case SLUICE_FORMAT_R8G8_SNORM:
    case SLUICE_FORMAT_R8G8B8A8_SNORM: rgba_from_snorm(channels, 1, texels, rgba, count); return;
    case SLUICE_FORMAT_R16_SNORM:
    case SLUICE_FORMAT_R16G16_SNORM:
    case SLUICE_FORMAT_R16G16B16A16_SNORM:
        rgba_from_snorm(channels, 2, texels, rgba, count);
        return;
    default: assert(!"a format without texels");
    }
}
