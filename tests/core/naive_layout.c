/* Layouts and MinMip maps, texel by texel. */
#include "core/naive_manager.h"

#include <string.h>

static uint64_t divide_up(uint64_t a, uint64_t b)
{
    return (a + b - 1) / b;
}

static uint32_t level_size(uint32_t size, uint32_t level)
{
    return size >> level ? size >> level : 1;
}

static SluiceResult check_desc(const SluiceStreamedTextureDesc *d)
{
    if (!d->width || !d->height || !d->tileWidth || !d->tileHeight || !d->mipLevelCount)
        return SLUICE_ERROR_ZERO_TILES;
    if (d->regularMipCount > d->mipLevelCount)
        return SLUICE_ERROR_INVALID_PACKED_MIPS;
    if ((d->regularMipCount < d->mipLevelCount) != (d->packedTileCount > 0))
        return SLUICE_ERROR_INVALID_PACKED_MIPS;
    if (d->width > SLUICE_MAX_TEXTURE_SIZE || d->height > SLUICE_MAX_TEXTURE_SIZE)
        return SLUICE_ERROR_INVALID_ARGUMENT;
    uint32_t levels = 1;
    for (uint32_t size = d->width > d->height ? d->width : d->height; size > 1; size /= 2)
        levels++;
    return d->mipLevelCount > levels ? SLUICE_ERROR_INVALID_ARGUMENT : SLUICE_SUCCESS;
}

SluiceResult naive_layout(const SluiceStreamedTextureDesc *desc, SluiceStreamedTextureLayout *out)
{
    SluiceResult result = check_desc(desc);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceStreamedTextureLayout l = {
        .structSize = sizeof l, .desc = *desc, .minMipWidth = 1, .minMipHeight = 1};
    if (!l.desc.feedbackRegionWidth)
        l.desc.feedbackRegionWidth = desc->tileWidth;
    if (!l.desc.feedbackRegionHeight)
        l.desc.feedbackRegionHeight = desc->tileHeight;
    uint64_t regions_x = divide_up(desc->width, l.desc.feedbackRegionWidth);
    uint64_t regions_y = divide_up(desc->height, l.desc.feedbackRegionHeight);
    uint64_t tiles = 0;
    for (uint32_t level = 0; level < desc->regularMipCount; level++) {
        uint64_t w = divide_up(level_size(desc->width, level), desc->tileWidth);
        uint64_t h = divide_up(level_size(desc->height, level), desc->tileHeight);
        l.levelWidthInTiles[level] = (uint32_t)w;
        l.levelHeightInTiles[level] = (uint32_t)h;
        l.levelFirstTile[level] = (uint32_t)tiles;
        tiles += w * h;
    }
    if (tiles + desc->packedTileCount > SLUICE_MAX_TILES_PER_TEXTURE ||
        regions_x * regions_y > SLUICE_MAX_TILES_PER_TEXTURE)
        return SLUICE_ERROR_LIMIT_EXCEEDED;
    l.regularTileCount = (uint32_t)tiles;
    l.tileCount = (uint32_t)tiles + desc->packedTileCount;
    l.feedbackWidth = (uint32_t)regions_x;
    l.feedbackHeight = (uint32_t)regions_y;
    if (desc->regularMipCount) {
        l.minMipWidth = l.levelWidthInTiles[0];
        l.minMipHeight = l.levelHeightInTiles[0];
    }
    *out = l;
    return SLUICE_SUCCESS;
}

static bool resident(const struct naive_tile *tile)
{
    return tile->state == SLUICE_TILE_STATE_MAPPED || tile->state == SLUICE_TILE_STATE_STANDBY;
}

static uint8_t minmip_texel(const struct naive_texture *t, uint32_t x, uint32_t y)
{
    const SluiceStreamedTextureLayout *l = &t->layout;
    const uint32_t levels = l->desc.regularMipCount;
    for (uint32_t i = l->regularTileCount; i < l->tileCount; i++)
        if (!resident(&t->tiles[i]))
            return SLUICE_MIP_UNTOUCHED;
    bool over[SLUICE_MAX_MIP_LEVELS];
    for (uint32_t level = 0; level < levels; level++) {
        if (level > 0) {
            x = x / 2 < l->levelWidthInTiles[level] ? x / 2 : l->levelWidthInTiles[level] - 1;
            y = y / 2 < l->levelHeightInTiles[level] ? y / 2 : l->levelHeightInTiles[level] - 1;
        }
        uint32_t index = l->levelFirstTile[level] + y * l->levelWidthInTiles[level] + x;
        over[level] = resident(&t->tiles[index]);
    }
    uint32_t finest = levels;
    while (finest > 0 && over[finest - 1])
        finest--;
    if (finest == l->desc.mipLevelCount) /* no packed levels, and the coarsest is not there */
        return SLUICE_MIP_UNTOUCHED;
    return (uint8_t)finest;
}

void naive_update_minmip(struct naive_manager *n, struct naive_texture *t)
{
    if (!t->minmip_stale)
        return;
    t->minmip_stale = false;
    for (uint32_t y = 0; y < t->layout.minMipHeight; y++)
        for (uint32_t x = 0; x < t->layout.minMipWidth; x++) {
            uint32_t at = y * t->layout.minMipWidth + x;
            uint8_t texel = minmip_texel(t, x, y);
            if (texel == t->minmip[at])
                continue;
            t->minmip[at] = texel;
            t->changed[at] = 1;
            if (!t->dirty_since)
                t->dirty_since = ++n->stamp;
        }
}
