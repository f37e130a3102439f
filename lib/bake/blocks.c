#include "bake/blocks.h"

#include "bake/bc7_encode.h"
#include "bake/block_squish.h"
#include "base/checked.h"

#include <assert.h>
#include <string.h>

/* Blocks that are encoded in one call. */
#define RUN 64u

enum encoder { NONE, SQUISH, BC7 };

struct encoding {
    enum encoder encoder;
    enum slc_block_kind kind; ///< SQUISH
    bool is_opaque;           ///< alpha becomes 255
    uint32_t block_size;
};

static const struct encoding encodings[SLUICE_FORMAT_COUNT] = {
#ifdef SLC_HAVE_SQUISH
    [SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK] = {SQUISH, SLC_BLOCK_BC1, true, 8},
    [SLUICE_FORMAT_BC1_RGB_SRGB_BLOCK] = {SQUISH, SLC_BLOCK_BC1, true, 8},
    [SLUICE_FORMAT_BC1_RGBA_UNORM_BLOCK] = {SQUISH, SLC_BLOCK_BC1, false, 8},
    [SLUICE_FORMAT_BC1_RGBA_SRGB_BLOCK] = {SQUISH, SLC_BLOCK_BC1, false, 8},
    [SLUICE_FORMAT_BC3_UNORM_BLOCK] = {SQUISH, SLC_BLOCK_BC3, false, 16},
    [SLUICE_FORMAT_BC3_SRGB_BLOCK] = {SQUISH, SLC_BLOCK_BC3, false, 16},
    [SLUICE_FORMAT_BC4_UNORM_BLOCK] = {SQUISH, SLC_BLOCK_BC4, false, 8},
    [SLUICE_FORMAT_BC5_UNORM_BLOCK] = {SQUISH, SLC_BLOCK_BC5, false, 16},
#endif
    [SLUICE_FORMAT_BC7_UNORM_BLOCK] = {.encoder = BC7, .block_size = 16},
    [SLUICE_FORMAT_BC7_SRGB_BLOCK] = {.encoder = BC7, .block_size = 16},
};

bool slc_can_encode_blocks(SluiceFormat format)
{
    return (uint32_t)format < SLUICE_FORMAT_COUNT && encodings[format].encoder != NONE;
}

/* Bit 4 y + x of the mask: the texel is inside. Those outside repeat the last one inside. */
static uint32_t load_block(const char *texels, size_t pitch, uint32_t width, uint32_t height,
                           uint8_t rgba[64])
{
    uint32_t mask = 0;
    for (uint32_t y = 0; y < 4; y++) {
        const char *row = texels + slc_min_u32(y, height - 1) * pitch;
        for (uint32_t x = 0; x < 4; x++)
            memcpy(rgba + 16 * y + 4 * x, row + 4 * (size_t)slc_min_u32(x, width - 1), 4);
        if (y < height)
            mask |= ((1u << slc_min_u32(4, width)) - 1) << (4 * y);
    }
    return mask;
}

static void encode_run(const struct encoding *encoding, SluiceBakeQuality quality,
                       uint8_t (*rgba)[64], const uint32_t *masks, uint32_t count, char *out)
{
    for (uint32_t b = 0; b < count && encoding->is_opaque; b++)
        for (uint32_t t = 0; t < 16; t++)
            rgba[b][4 * t + 3] = 255;
#ifdef SLC_HAVE_SQUISH
    for (uint32_t b = 0; b < count && encoding->encoder == SQUISH; b++)
        slc_squish_block(encoding->kind, rgba[b], masks[b], out + b * encoding->block_size);
#else
    (void)masks;
#endif
    if (encoding->encoder == BC7)
        slc_encode_bc7(quality, (const uint8_t(*)[64])rgba, count, (uint8_t *)out);
}

void slc_encode_blocks(SluiceFormat format, SluiceBakeQuality quality, const void *texels,
                       size_t pitch, uint32_t width, uint32_t height, void *blocks)
{
    assert(slc_can_encode_blocks(format));
    const struct encoding *encoding = &encodings[format];
    uint8_t rgba[RUN][64];
    uint32_t masks[RUN], count = 0;
    char *out = blocks;
    for (uint32_t y = 0; y < height; y += 4)
        for (uint32_t x = 0; x < width; x += 4) {
            const char *first = (const char *)texels + y * pitch + 4 * (size_t)x;
            masks[count] = load_block(first, pitch, width - x, height - y, rgba[count]);
            bool is_last = y + 4 >= height && x + 4 >= width;
            if (++count < RUN && !is_last)
                continue;
            encode_run(encoding, quality, rgba, masks, count, out);
            out += (size_t)count * encoding->block_size;
            count = 0;
        }
}
