/*
 * Blocks with equal endpoints and all indices 0, so that the color follows from the format's
 * definition without an encoder. Source: Khronos Data Format Specification, "S3TC", "RGTC", "BPTC".
 */
#include "device/blocks.h"

#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct block_source {
    SluiceImageSource base;
    SluiceImageInfo info;
};

/* Returns 8 bits per channel. Each format uses as many as it can hold. */
static uint32_t seed_of(uint32_t level, uint32_t x, uint32_t y)
{
    uint32_t h = (x / 4) * 0x9E3779B1u ^ (y / 4) * 0x85EBCA77u ^ (level + 1) * 0xC2B2AE3Du;
    h ^= h >> 15;
    h *= 0x2C1B3C6Du;
    return h ^ h >> 13;
}

static void put_bits(uint8_t *block, uint32_t first, uint32_t count, uint32_t value)
{
    for (uint32_t i = 0; i < count; i++)
        if (value >> i & 1)
            block[(first + i) / 8] |= (uint8_t)(1u << (first + i) % 8);
}

static bool is_signed(SluiceFormat format)
{
    return format == SLUICE_FORMAT_BC4_SNORM_BLOCK || format == SLUICE_FORMAT_BC5_SNORM_BLOCK ||
           format == SLUICE_FORMAT_BC6H_SFLOAT_BLOCK;
}

static void put_color(uint8_t *block, uint32_t seed)
{
    uint32_t rgb565 = (seed & 31) << 11 | (seed >> 8 & 63) << 5 | (seed >> 16 & 31);
    put_bits(block, 0, 16, rgb565);
    put_bits(block, 16, 16, rgb565);
}

static void put_channel(uint8_t *block, uint32_t value)
{
    put_bits(block, 0, 8, value);
    put_bits(block, 8, 8, value);
}

/* Mode 11: two endpoints of 10 bits per channel. */
static void put_bc6h(uint8_t *block, uint32_t seed)
{
    put_bits(block, 0, 5, 3);
    for (uint32_t c = 0; c < 3; c++) {
        uint32_t value = (seed >> (8 * c) & 255) + 100; /* below 512: positive when signed */
        put_bits(block, 5 + 10 * c, 10, value);
        put_bits(block, 35 + 10 * c, 10, value);
    }
}

/* Mode 6: two endpoints of 7 bits per channel and a common lowest bit. */
static void put_bc7(uint8_t *block, uint32_t seed)
{
    put_bits(block, 6, 1, 1);
    for (uint32_t c = 0; c < 4; c++) {
        put_bits(block, 7 + 14 * c, 7, seed >> (8 * c) & 127);
        put_bits(block, 14 + 14 * c, 7, seed >> (8 * c) & 127);
    }
    put_bits(block, 63, 2, 3);
}

/* A value that signed channels hold, too. */
static uint32_t channel_value(SluiceFormat format, uint32_t seed)
{
    return is_signed(format) ? seed & 127 : seed & 255;
}

static void put_block(SluiceFormat format, uint32_t seed, uint8_t block[16])
{
    memset(block, 0, 16);
    if (format <= SLUICE_FORMAT_BC1_RGBA_SRGB_BLOCK) {
        put_color(block, seed);
    } else if (format <= SLUICE_FORMAT_BC2_SRGB_BLOCK) {
        for (uint32_t i = 0; i < 16; i++)
            put_bits(block, 4 * i, 4, seed >> 24 & 15);
        put_color(block + 8, seed);
    } else if (format <= SLUICE_FORMAT_BC3_SRGB_BLOCK) {
        put_channel(block, seed >> 24);
        put_color(block + 8, seed);
    } else if (format <= SLUICE_FORMAT_BC4_SNORM_BLOCK) {
        put_channel(block, channel_value(format, seed));
    } else if (format <= SLUICE_FORMAT_BC5_SNORM_BLOCK) {
        put_channel(block, channel_value(format, seed));
        put_channel(block + 8, channel_value(format, seed >> 8));
    } else if (format <= SLUICE_FORMAT_BC6H_SFLOAT_BLOCK) {
        put_bc6h(block, seed);
    } else {
        put_bc7(block, seed);
    }
}

/* The positive half with these bits; BC6H interpolates bit patterns. */
static float half_value(uint32_t bits)
{
    int exponent = (int)(bits >> 10);
    return exponent ? ldexpf((float)(1024 + (bits & 1023)), exponent - 25)
                    : ldexpf((float)bits, -24);
}

static float bc6h_value(SluiceFormat format, uint32_t seed)
{
    uint32_t q = (seed & 255) + 100;
    if (is_signed(format))
        return half_value((((q << 15) + 0x4000) >> 9) * 31 >> 5);
    return half_value((((q << 16) + 0x8000) >> 10) * 31 >> 6);
}

static void set_exact(struct block_range *range, uint32_t channel, float value)
{
    range->low[channel] = range->high[channel] = value;
}

/* The fraction, or 8 bits that repeat the bits of the code: for 28 of 31, 231 of 255. */
static void set_code(struct block_range *range, uint32_t channel, uint32_t code, uint32_t bits)
{
    float fraction = (float)code / (float)((1u << bits) - 1);
    float widened = (float)(code << (8 - bits) | code >> (2 * bits - 8)) / 255.0f;
    range->low[channel] = fminf(fraction, widened);
    range->high[channel] = fmaxf(fraction, widened);
}

static void set_color(uint32_t seed, struct block_range *range)
{
    set_code(range, 0, seed & 31, 5);
    set_code(range, 1, seed >> 8 & 63, 6);
    set_code(range, 2, seed >> 16 & 31, 5);
}

static float decode_srgb(float c)
{
    return c <= 0.04045f ? c / 12.92f : powf((c + 0.055f) / 1.055f, 2.4f);
}

static void decode_range(struct block_range *range)
{
    const float half = 0.5f / 255.0f;
    for (uint32_t c = 0; c < 3; c++) {
        range->low[c] = decode_srgb(fmaxf(range->low[c] - half, 0));
        range->high[c] = decode_srgb(fminf(range->high[c] + half, 1));
    }
}

static void set_bc1_to_3(SluiceFormat format, uint32_t seed, struct block_range *range)
{
    set_color(seed, range);
    if (format >= SLUICE_FORMAT_BC3_UNORM_BLOCK)
        set_exact(range, 3, (float)(seed >> 24) / 255.0f);
    else if (format >= SLUICE_FORMAT_BC2_UNORM_BLOCK)
        set_code(range, 3, seed >> 24 & 15, 4);
}

/* Half a step of a 16-bit float near 1, which a decoder may hand on: an eighth of a code's step. */
#define ROUNDING (1.0f / 2048)

struct block_range block_texel(SluiceFormat format, uint32_t level, uint32_t x, uint32_t y)
{
    uint32_t seed = seed_of(level, x, y);
    float one = is_signed(format) ? 127.0f : 255.0f;
    struct block_range range = {{0, 0, 0, 1}, {0, 0, 0, 1}};
    if (format <= SLUICE_FORMAT_BC3_SRGB_BLOCK) {
        set_bc1_to_3(format, seed, &range);
    } else if (format <= SLUICE_FORMAT_BC5_SNORM_BLOCK) {
        set_exact(&range, 0, (float)channel_value(format, seed) / one);
        if (format >= SLUICE_FORMAT_BC5_UNORM_BLOCK)
            set_exact(&range, 1, (float)channel_value(format, seed >> 8) / one);
    } else if (format <= SLUICE_FORMAT_BC6H_SFLOAT_BLOCK) {
        for (uint32_t c = 0; c < 3; c++)
            set_exact(&range, c, bc6h_value(format, seed >> (8 * c)));
    } else {
        for (uint32_t c = 0; c < 4; c++)
            set_exact(&range, c, (float)((seed >> (8 * c) & 127) * 2 + 1) / 255.0f);
    }
    if (strstr(sluiceGetFormatName(format), "SRGB"))
        decode_range(&range);
    for (uint32_t c = 0; c < 4; c++) {
        range.low[c] -= ROUNDING * fmaxf(1, range.low[c]);
        range.high[c] += ROUNDING * fmaxf(1, range.high[c]);
    }
    return range;
}

static SluiceResult get_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    *info = ((struct block_source *)base)->info;
    return SLUICE_SUCCESS;
}

static SluiceResult read_region(SluiceImageSource *base, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch)
{
    SluiceFormat format = ((struct block_source *)base)->info.format;
    SluiceFormatInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceGetFormatInfo(format, &info));
    for (uint32_t y = 0; y < region->height; y += 4)
        for (uint32_t x = 0; x < region->width; x += 4) {
            uint8_t block[16];
            put_block(format, seed_of(region->mipLevel, region->x + x, region->y + y), block);
            memcpy((char *)texels + y / 4 * row_pitch + (size_t)(x / 4) * info.blockSize, block,
                   info.blockSize);
        }
    return SLUICE_SUCCESS;
}

static void destroy(SluiceImageSource *base)
{
    free(base);
}

SluiceImageSource *block_source(uint32_t width, uint32_t height, SluiceFormat format)
{
    static const SluiceImageSourceInterface interface = {sizeof interface, get_info, read_region,
                                                         destroy};
    struct block_source *source = malloc(sizeof *source);
    uint32_t levels = 1;
    while ((width > height ? width : height) >> levels)
        levels++;
    *source = (struct block_source){
        {&interface}, {sizeof(SluiceImageInfo), width, height, levels, format, "blocks"}};
    return &source->base;
}
