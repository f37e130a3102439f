#include "base/checked.h"
#include "demand_vulkan/opening.h"
#include "image/convert.h"
#include "image/format_size.h"
#include "image/srgb.h"

#include <string.h>

static uint32_t little(const uint8_t *bytes, uint32_t count)
{
    uint32_t value = 0;
    for (uint32_t i = 0; i < count; i++)
        value |= (uint32_t)bytes[i] << 8 * i;
    return value;
}

static void from_565(uint32_t color, float rgb[3])
{
    rgb[0] = (float)(color >> 11 & 31) / 31;
    rgb[1] = (float)(color >> 5 & 63) / 63;
    rgb[2] = (float)(color & 31) / 31;
}

/* The first texel of a BC1 block; `four`: as in BC2 and BC3, never three colors. */
static void bc1_texel(const uint8_t block[8], bool four, bool alpha, float rgba[4])
{
    uint32_t c0 = little(block, 2), c1 = little(block + 2, 2), index = block[4] & 3;
    static const float weights[2][4] = {{0, 1, 0.5f, 0}, {0, 1, 1.0f / 3, 2.0f / 3}};
    four = four || c0 > c1;
    float a[3], b[3], w = weights[four][index];
    from_565(c0, a);
    from_565(c1, b);
    bool black = !four && index == 3;
    for (uint32_t i = 0; i < 3; i++)
        rgba[i] = black ? 0 : a[i] * (1 - w) + b[i] * w;
    rgba[3] = black && alpha ? 0 : 1;
}

/* The first texel of a BC4 block. */
static float bc4_texel(const uint8_t block[8], bool is_signed)
{
    float a = (float)block[0] / 255, b = (float)block[1] / 255, low = 0;
    if (is_signed) {
        low = -1;
        a = (float)(block[0] < 128 ? block[0] : block[0] == 128 ? -127 : block[0] - 256) / 127;
        b = (float)(block[1] < 128 ? block[1] : block[1] == 128 ? -127 : block[1] - 256) / 127;
    }
    uint32_t index = block[2] & 7;
    if (index < 2)
        return index ? b : a;
    if (a > b)
        return (a * (float)(8 - index) + b * (float)(index - 1)) / 7;
    if (index >= 6)
        return index == 6 ? low : 1;
    return (a * (float)(6 - index) + b * (float)(index - 1)) / 5;
}

/* Gets the color of a block. False for formats that take a full decoder. */
static bool block_color(SluiceFormat format, const uint8_t *block, float rgba[4])
{
    switch (format) {
    case SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK:
    case SLUICE_FORMAT_BC1_RGB_SRGB_BLOCK: bc1_texel(block, false, false, rgba); return true;
    case SLUICE_FORMAT_BC1_RGBA_UNORM_BLOCK:
    case SLUICE_FORMAT_BC1_RGBA_SRGB_BLOCK: bc1_texel(block, false, true, rgba); return true;
    case SLUICE_FORMAT_BC2_UNORM_BLOCK:
    case SLUICE_FORMAT_BC2_SRGB_BLOCK:
        bc1_texel(block + 8, true, false, rgba);
        rgba[3] = (float)(block[0] & 15) / 15;
        return true;
    case SLUICE_FORMAT_BC3_UNORM_BLOCK:
    case SLUICE_FORMAT_BC3_SRGB_BLOCK:
        bc1_texel(block + 8, true, false, rgba);
        rgba[3] = bc4_texel(block, false);
        return true;
    case SLUICE_FORMAT_BC5_UNORM_BLOCK:
    case SLUICE_FORMAT_BC5_SNORM_BLOCK:
        rgba[1] = bc4_texel(block + 8, format == SLUICE_FORMAT_BC5_SNORM_BLOCK);
        rgba[0] = bc4_texel(block, format == SLUICE_FORMAT_BC5_SNORM_BLOCK);
        return true;
    case SLUICE_FORMAT_BC4_UNORM_BLOCK:
    case SLUICE_FORMAT_BC4_SNORM_BLOCK:
        rgba[0] = bc4_texel(block, format == SLUICE_FORMAT_BC4_SNORM_BLOCK);
        return true;
    case SLUICE_FORMAT_BC7_UNORM_BLOCK:
    case SLUICE_FORMAT_BC7_SRGB_BLOCK: slc_bc7_texel(block, rgba); return true;
    default: return false;
    }
}

void slc_base_color(SluiceFormat format, const void *texel, float rgba[4])
{
    SluiceFormatInfo info = {.structSize = sizeof info};
    rgba[0] = rgba[1] = rgba[2] = 0;
    rgba[3] = 1;
    if (sluiceGetFormatInfo(format, &info) == SLUICE_SUCCESS && info.blockWidth == 1)
        slc_texels_to_rgba(format, texel, rgba, 1);
    else if (!block_color(format, texel, rgba))
        rgba[0] = rgba[1] = rgba[2] = 0.5f;
    bool is_srgb_block = info.blockWidth > 1 && slc_format_is_srgb(format);
    for (uint32_t i = 0; i < 3 && is_srgb_block; i++)
        rgba[i] = slc_srgb_to_linear[slc_unorm8_from_float(rgba[i])];
}
