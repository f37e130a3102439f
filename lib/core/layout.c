#include "core/internal.h"

#include "base/checked.h"

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

SluiceResult slc_layout_texture(const SluiceStreamedTextureDesc *desc, struct slc_texture *t)
{
    SluiceResult result = check_desc(desc);
    if (result != SLUICE_SUCCESS)
        return result;
    t->desc = *desc;
    if (t->desc.feedbackRegionWidth == 0)
        t->desc.feedbackRegionWidth = desc->tileWidth;
    if (t->desc.feedbackRegionHeight == 0)
        t->desc.feedbackRegionHeight = desc->tileHeight;
    t->feedback_width = slc_div_up_u32(desc->width, t->desc.feedbackRegionWidth);
    t->feedback_height = slc_div_up_u32(desc->height, t->desc.feedbackRegionHeight);

    t->region_shift_x = region_shift(t->desc.feedbackRegionWidth, desc->tileWidth);
    t->region_shift_y = region_shift(t->desc.feedbackRegionHeight, desc->tileHeight);

    uint64_t tiles = 0; /* at most 2 * 2^40 regular ones, so it fits */
    for (uint32_t l = 0; l < desc->regularMipCount; l++) {
        uint64_t width = slc_div_up_u32(slc_mip_size(desc->width, l), desc->tileWidth);
        uint64_t height = slc_div_up_u32(slc_mip_size(desc->height, l), desc->tileHeight);
        t->levels[l] = (struct slc_level){(uint32_t)width, (uint32_t)height, (uint32_t)tiles};
        tiles += width * height;
    }
    uint64_t all = tiles + desc->packedTileCount;
    if (all > SLUICE_MAX_TILES_PER_TEXTURE ||
        (uint64_t)t->feedback_width * t->feedback_height > SLUICE_MAX_TILES_PER_TEXTURE)
        return SLUICE_ERROR_LIMIT_EXCEEDED;
    t->regular_tile_count = (uint32_t)tiles;
    t->tile_count = (uint32_t)all;
    t->min_mip_width = desc->regularMipCount ? t->levels[0].width : 1;
    t->min_mip_height = desc->regularMipCount ? t->levels[0].height : 1;
    return SLUICE_SUCCESS;
}

void slc_write_layout(const struct slc_texture *t, SluiceStreamedTextureLayout *layout)
{
    *layout = (SluiceStreamedTextureLayout){
        .desc = t->desc,
        .regularTileCount = t->regular_tile_count,
        .tileCount = t->tile_count,
        .feedbackWidth = t->feedback_width,
        .feedbackHeight = t->feedback_height,
        .minMipWidth = t->min_mip_width,
        .minMipHeight = t->min_mip_height,
    };
    for (uint32_t l = 0; l < t->desc.regularMipCount; l++) {
        layout->levelWidthInTiles[l] = t->levels[l].width;
        layout->levelHeightInTiles[l] = t->levels[l].height;
        layout->levelFirstTile[l] = t->levels[l].first_tile;
    }
}

SluiceResult sluiceGetStreamedTextureLayout(const SluiceStreamedTextureDesc *pDesc,
                                            SluiceStreamedTextureLayout *pLayout)
{
    if (!pDesc || !pLayout)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_texture t = {0};
    SluiceResult result = slc_layout_texture(pDesc, &t);
    if (result == SLUICE_SUCCESS)
        slc_write_layout(&t, pLayout);
    return result;
}

struct slc_place slc_tile_place(const struct slc_texture *t, uint32_t tile)
{
    if (tile >= t->regular_tile_count)
        return (struct slc_place){t->desc.regularMipCount, tile - t->regular_tile_count, 0};
    uint32_t l = 0;
    while (l + 1 < t->desc.regularMipCount && tile >= t->levels[l + 1].first_tile)
        l++;
    tile -= t->levels[l].first_tile;
    return (struct slc_place){l, tile % t->levels[l].width, tile / t->levels[l].width};
}
