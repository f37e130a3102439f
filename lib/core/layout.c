#include "core/layout.h"

#include "base/checked.h"
#include "base/struct_size.h"

static SluiceResult check_desc(const SluiceStreamedTextureDesc *d)
{
    if (d->width == 0 || d->height == 0 || d->tileWidth == 0 || d->tileHeight == 0 ||
        d->mipLevelCount == 0)
        return SLUICE_ERROR_ZERO_TILES;
    if (d->regularMipCount > d->mipLevelCount ||
        (d->regularMipCount < d->mipLevelCount) != (d->packedTileCount > 0))
        return SLUICE_ERROR_INVALID_PACKED_MIPS;
    if (d->width > SLUICE_MAX_TEXTURE_SIZE || d->height > SLUICE_MAX_TEXTURE_SIZE)
        return SLUICE_ERROR_INVALID_ARGUMENT;
    if (d->mipLevelCount > slc_mip_count(slc_max_u32(d->width, d->height)))
        return SLUICE_ERROR_INVALID_ARGUMENT;
    return SLUICE_SUCCESS;
}

/** log2 of the regions per tile along one axis where they are 1, 2, 4...: see tiles_of in wants.c
 */
static uint8_t region_shift(uint32_t region, uint32_t tile)
{
    uint8_t shift = 0;
    while (shift < 31 && (uint64_t)region << shift < tile)
        shift++;
    return (uint64_t)region << shift == tile ? shift : SLC_UNALIGNED;
}

SluiceResult slc_layout_texture(const SluiceStreamedTextureDesc *desc, struct slc_shape *s)
{
    SluiceResult result = check_desc(desc);
    if (result != SLUICE_SUCCESS)
        return result;
    s->desc = *desc;
    if (s->desc.feedbackRegionWidth == 0)
        s->desc.feedbackRegionWidth = desc->tileWidth;
    if (s->desc.feedbackRegionHeight == 0)
        s->desc.feedbackRegionHeight = desc->tileHeight;
    s->feedback_width = slc_div_up_u32(desc->width, s->desc.feedbackRegionWidth);
    s->feedback_height = slc_div_up_u32(desc->height, s->desc.feedbackRegionHeight);

    s->region_shift_x = region_shift(s->desc.feedbackRegionWidth, desc->tileWidth);
    s->region_shift_y = region_shift(s->desc.feedbackRegionHeight, desc->tileHeight);

    uint64_t tiles = 0; /* at most 2 * 2^40 regular ones, so it fits */
    for (uint32_t l = 0; l < desc->regularMipCount; l++) {
        uint64_t width = slc_div_up_u32(slc_mip_size(desc->width, l), desc->tileWidth);
        uint64_t height = slc_div_up_u32(slc_mip_size(desc->height, l), desc->tileHeight);
        s->levels[l] = (struct slc_level){(uint32_t)width, (uint32_t)height, (uint32_t)tiles};
        tiles += width * height;
    }
    uint64_t all = tiles + desc->packedTileCount;
    if (all > SLUICE_MAX_TILES_PER_TEXTURE ||
        (uint64_t)s->feedback_width * s->feedback_height > SLUICE_MAX_TILES_PER_TEXTURE)
        return SLUICE_ERROR_LIMIT_EXCEEDED;
    s->region_count = s->feedback_width * s->feedback_height;
    s->regular_tile_count = (uint32_t)tiles;
    s->tile_count = (uint32_t)all;
    s->min_mip_width = desc->regularMipCount ? s->levels[0].width : 1;
    s->min_mip_height = desc->regularMipCount ? s->levels[0].height : 1;
    return SLUICE_SUCCESS;
}

SluiceResult slc_write_layout(const struct slc_shape *s, const SluiceLogCallback *log,
                              SluiceStreamedTextureLayout *out)
{
    SluiceResult result = slc_struct_check(SLC_STRUCT(SluiceStreamedTextureLayout), out, log);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceStreamedTextureLayout layout = {
        .structSize = sizeof layout,
        .desc = s->desc,
        .regularTileCount = s->regular_tile_count,
        .tileCount = s->tile_count,
        .feedbackWidth = s->feedback_width,
        .feedbackHeight = s->feedback_height,
        .minMipWidth = s->min_mip_width,
        .minMipHeight = s->min_mip_height,
    };
    for (uint32_t l = 0; l < s->desc.regularMipCount; l++) {
        layout.levelWidthInTiles[l] = s->levels[l].width;
        layout.levelHeightInTiles[l] = s->levels[l].height;
        layout.levelFirstTile[l] = s->levels[l].first_tile;
    }
    slc_struct_write(SLC_STRUCT(SluiceStreamedTextureLayout), out, &layout);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceGetStreamedTextureLayout(const SluiceStreamedTextureDesc *pDesc,
                                            SluiceStreamedTextureLayout *pLayout)
{
    if (!pDesc || !pLayout)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_shape shape = {0};
    SluiceResult result = slc_layout_texture(pDesc, &shape);
    return result == SLUICE_SUCCESS ? slc_write_layout(&shape, NULL, pLayout) : result;
}

struct slc_place slc_tile_place(const struct slc_managed_texture *t, uint32_t tile)
{
    if (tile >= t->shape->regular_tile_count)
        return (struct slc_place){t->shape->desc.regularMipCount,
                                  tile - t->shape->regular_tile_count, 0};
    uint32_t l = 0;
    while (l + 1 < t->shape->desc.regularMipCount && tile >= t->shape->levels[l + 1].first_tile)
        l++;
    tile -= t->shape->levels[l].first_tile;
    return (struct slc_place){l, tile % t->shape->levels[l].width,
                              tile / t->shape->levels[l].width};
}
