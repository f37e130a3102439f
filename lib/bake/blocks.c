#include "bake/blocks.h"

#include "bake/block_squish.h"
#include "base/checked.h"
#include "image/format_size.h"

#include <assert.h>
#include <string.h>

static bool find_kind(SluiceFormat format, enum slc_block_kind *kind)
{
    switch (format) {
    case SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK:
    case SLUICE_FORMAT_BC1_RGB_SRGB_BLOCK:
    case SLUICE_FORMAT_BC1_RGBA_UNORM_BLOCK:
    case SLUICE_FORMAT_BC1_RGBA_SRGB_BLOCK: *kind = SLC_BLOCK_BC1; return true;
    case SLUICE_FORMAT_BC3_UNORM_BLOCK:
    case SLUICE_FORMAT_BC3_SRGB_BLOCK: *kind = SLC_BLOCK_BC3; return true;
    case SLUICE_FORMAT_BC4_UNORM_BLOCK: *kind = SLC_BLOCK_BC4; return true;
    case SLUICE_FORMAT_BC5_UNORM_BLOCK: *kind = SLC_BLOCK_BC5; return true;
    default: return false;
    }
}

bool slc_can_encode_blocks(SluiceFormat format)
{
    enum slc_block_kind kind;
#ifdef SLC_HAVE_SQUISH
    return find_kind(format, &kind);
#else
    (void)find_kind;
    (void)kind;
    (void)format;
    return false;
#endif
}

#ifdef SLC_HAVE_SQUISH
static bool is_opaque(SluiceFormat format)
{
    return format == SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK ||
           format == SLUICE_FORMAT_BC1_RGB_SRGB_BLOCK;
}

/* Bit 4 y + x of the mask: the texel is inside. */
static uint32_t load_block(const char *texels, size_t pitch, uint32_t width, uint32_t height,
                           uint8_t rgba[64])
{
    uint32_t mask = 0;
    memset(rgba, 0, 64);
    for (uint32_t y = 0; y < slc_min_u32(4, height); y++) {
        uint32_t columns = slc_min_u32(4, width);
        memcpy(rgba + 16 * y, texels + y * pitch, 4 * (size_t)columns);
        mask |= ((1u << columns) - 1) << (4 * y);
    }
    return mask;
}

void slc_encode_blocks(SluiceFormat format, const void *texels, size_t pitch, uint32_t width,
                       uint32_t height, void *blocks)
{
    enum slc_block_kind kind = SLC_BLOCK_BC1;
    SluiceFormatInfo info = {.structSize = sizeof info};
    uint8_t rgba[64];
    char *out = blocks;
    if (!find_kind(format, &kind) || sluiceGetFormatInfo(format, &info) != SLUICE_SUCCESS)
        assert(!"a format that is not encoded");
    for (uint32_t y = 0; y < height; y += 4)
        for (uint32_t x = 0; x < width; x += 4, out += info.blockSize) {
            const char *first = (const char *)texels + y * pitch + 4 * (size_t)x;
            uint32_t mask = load_block(first, pitch, width - x, height - y, rgba);
            for (uint32_t t = 0; t < 16 && is_opaque(format); t++)
                rgba[4 * t + 3] = 255;
            slc_squish_block(kind, rgba, mask, out);
        }
}
#else
void slc_encode_blocks(SluiceFormat format, const void *texels, size_t pitch, uint32_t width,
                       uint32_t height, void *blocks)
{
    (void)format, (void)texels, (void)pitch, (void)width, (void)height, (void)blocks;
    assert(!"this build makes no blocks");
}
#endif
