#include "bake/blocks.h"

#include "bake/bc6h_encode.h"
#include "bake/bc7_encode.h"
#include "bake/block_squish.h"
#include "base/checked.h"
#include "image/format_size.h"

#include <assert.h>
#include <string.h>

/* Number of blocks that are encoded in one call. */
#define RUN 64u

enum encoder { NONE, SQUISH, BC7, BC6H, ASTC };

struct encoding {
    enum encoder encoder;
    enum slc_block_kind kind; ///< SQUISH
    bool is_opaque;           ///< SQUISH: alpha becomes 255
    bool is_signed;           ///< BC6H
    uint32_t block_size;
};

static const struct encoding encodings[SLUICE_FORMAT_COUNT] = {
#ifdef SLC_HAVE_SQUISH
    [SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK] = {SQUISH, SLC_BLOCK_BC1, true, false, 8},
    [SLUICE_FORMAT_BC1_RGB_SRGB_BLOCK] = {SQUISH, SLC_BLOCK_BC1, true, false, 8},
    [SLUICE_FORMAT_BC1_RGBA_UNORM_BLOCK] = {SQUISH, SLC_BLOCK_BC1, false, false, 8},
    [SLUICE_FORMAT_BC1_RGBA_SRGB_BLOCK] = {SQUISH, SLC_BLOCK_BC1, false, false, 8},
    [SLUICE_FORMAT_BC3_UNORM_BLOCK] = {SQUISH, SLC_BLOCK_BC3, false, false, 16},
    [SLUICE_FORMAT_BC3_SRGB_BLOCK] = {SQUISH, SLC_BLOCK_BC3, false, false, 16},
    [SLUICE_FORMAT_BC4_UNORM_BLOCK] = {SQUISH, SLC_BLOCK_BC4, false, false, 8},
    [SLUICE_FORMAT_BC5_UNORM_BLOCK] = {SQUISH, SLC_BLOCK_BC5, false, false, 16},
#endif
#ifdef SLC_HAVE_ASTC
    [SLUICE_FORMAT_ASTC_4x4_UNORM_BLOCK] = {.encoder = ASTC},
    [SLUICE_FORMAT_ASTC_4x4_SRGB_BLOCK] = {.encoder = ASTC},
    [SLUICE_FORMAT_ASTC_8x8_UNORM_BLOCK] = {.encoder = ASTC},
    [SLUICE_FORMAT_ASTC_8x8_SRGB_BLOCK] = {.encoder = ASTC},
#endif
    [SLUICE_FORMAT_BC7_UNORM_BLOCK] = {.encoder = BC7, .block_size = 16},
    [SLUICE_FORMAT_BC7_SRGB_BLOCK] = {.encoder = BC7, .block_size = 16},
    [SLUICE_FORMAT_BC6H_UFLOAT_BLOCK] = {.encoder = BC6H, .block_size = 16},
    [SLUICE_FORMAT_BC6H_SFLOAT_BLOCK] = {.encoder = BC6H, .is_signed = true, .block_size = 16},
};

bool slc_can_encode_blocks(SluiceFormat format)
{
    return (uint32_t)format < SLUICE_FORMAT_COUNT && encodings[format].encoder != NONE;
}

const char *slc_block_encoder_hint(SluiceFormat format)
{
    if (format >= SLUICE_FORMAT_ASTC_4x4_UNORM_BLOCK && format <= SLUICE_FORMAT_ASTC_8x8_SRGB_BLOCK)
        return "; build it with astcenc (libastcenc-dev)";
    return format >= SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK && format <= SLUICE_FORMAT_BC5_UNORM_BLOCK &&
                   format != SLUICE_FORMAT_BC2_UNORM_BLOCK &&
                   format != SLUICE_FORMAT_BC2_SRGB_BLOCK && format != SLUICE_FORMAT_BC4_SNORM_BLOCK
               ? "; build it with libsquish"
               : "";
}

SluiceFormat slc_block_texel_format(SluiceFormat format)
{
    return encodings[format].encoder == BC6H ? SLUICE_FORMAT_R16G16B16A16_SFLOAT
                                             : SLUICE_FORMAT_R8G8B8A8_UNORM;
}

/* Texels of RUN blocks. */
union run {
    uint8_t bytes[RUN][64];
    uint16_t halves[RUN][64];
};

/* Copies a block. Texels outside repeat the last one inside. Bit 4 y + x of the returned mask: the
 * texel is inside. */
static uint32_t load_block(const char *texels, size_t texel_size, size_t pitch, uint32_t width,
                           uint32_t height, char *block)
{
    uint32_t mask = 0;
    for (uint32_t y = 0; y < 4; y++) {
        const char *row = texels + slc_min_u32(y, height - 1) * pitch;
        for (uint32_t x = 0; x < 4; x++, block += texel_size)
            memcpy(block, row + texel_size * slc_min_u32(x, width - 1), texel_size);
        if (y < height)
            mask |= ((1u << slc_min_u32(4, width)) - 1) << (4 * y);
    }
    return mask;
}

static void squish_run(const struct encoding *encoding, uint8_t (*rgba)[64], const uint32_t *masks,
                       uint32_t count, uint8_t *out)
{
    for (uint32_t b = 0; b < count && encoding->is_opaque; b++)
        for (uint32_t t = 0; t < 16; t++)
            rgba[b][4 * t + 3] = 255;
#ifdef SLC_HAVE_SQUISH
    for (uint32_t b = 0; b < count; b++)
        slc_squish_block(encoding->kind, rgba[b], masks[b], out + b * encoding->block_size);
#else
    (void)masks;
    (void)out;
#endif
}

#ifdef SLC_HAVE_AVX2
void slc_encode_bc7_avx2(SluiceBakeQuality quality, const uint8_t (*rgba)[64], size_t count,
                         uint8_t *blocks);
void slc_encode_bc6h_avx2(bool is_signed, SluiceBakeQuality quality, const uint16_t (*rgba)[64],
                          size_t count, uint8_t *blocks);
#endif

static void encode_bc7(SluiceBakeQuality quality, union run *run, uint32_t count, uint8_t *out)
{
#ifdef SLC_HAVE_AVX2
    if (__builtin_cpu_supports("avx2")) {
        slc_encode_bc7_avx2(quality, (const uint8_t(*)[64])run->bytes, count, out);
        return;
    }
#endif
    slc_encode_bc7(quality, (const uint8_t(*)[64])run->bytes, count, out);
}

static void encode_bc6h(bool is_signed, SluiceBakeQuality quality, union run *run, uint32_t count,
                        uint8_t *out)
{
#ifdef SLC_HAVE_AVX2
    if (__builtin_cpu_supports("avx2")) {
        slc_encode_bc6h_avx2(is_signed, quality, (const uint16_t(*)[64])run->halves, count, out);
        return;
    }
#endif
    slc_encode_bc6h(is_signed, quality, (const uint16_t(*)[64])run->halves, count, out);
}

static void encode_run(const struct encoding *encoding, SluiceBakeQuality quality, union run *run,
                       const uint32_t *masks, uint32_t count, uint8_t *out)
{
    switch (encoding->encoder) {
    case SQUISH: squish_run(encoding, run->bytes, masks, count, out); break;
    case BC7: encode_bc7(quality, run, count, out); break;
    case BC6H: encode_bc6h(encoding->is_signed, quality, run, count, out); break;
    case ASTC:
    case NONE: break;
    }
}

/* Encodes all blocks in one call of astcenc. */
static SluiceResult encode_astc(const struct slc_block_encoder *encoder, const void *texels,
                                size_t pitch, uint32_t width, uint32_t height, void *blocks)
{
    SluiceFormatInfo info = {.structSize = sizeof info};
    (void)sluiceGetFormatInfo(encoder->format, &info);
    return slc_astc_pool_encode(encoder->astc, info.blockWidth, slc_format_is_srgb(encoder->format),
                                encoder->quality, texels, pitch, width, height, blocks);
}

SluiceResult slc_encode_blocks(const struct slc_block_encoder *encoder, const void *texels,
                               size_t pitch, uint32_t width, uint32_t height, void *blocks)
{
    assert(slc_can_encode_blocks(encoder->format));
    const struct encoding *encoding = &encodings[encoder->format];
    if (encoding->encoder == ASTC)
        return encode_astc(encoder, texels, pitch, width, height, blocks);
    size_t texel_size = sluiceGetFormatTexelSize(slc_block_texel_format(encoder->format));
    union run run;
    uint32_t masks[RUN], count = 0;
    uint8_t *out = blocks;
    for (uint32_t y = 0; y < height; y += 4)
        for (uint32_t x = 0; x < width; x += 4) {
            const char *first = (const char *)texels + y * pitch + texel_size * x;
            masks[count] = load_block(first, texel_size, pitch, width - x, height - y,
                                      (char *)&run + count * 16 * texel_size);
            bool is_last = y + 4 >= height && x + 4 >= width;
            if (++count < RUN && !is_last)
                continue;
            encode_run(encoding, encoder->quality, &run, masks, count, out);
            out += (size_t)count * encoding->block_size;
            count = 0;
        }
    return SLUICE_SUCCESS;
}
