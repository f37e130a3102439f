#include "core/wanted_tiles.h"

#include <stdlib.h>
#include <string.h>

static uint32_t divide_up(uint32_t size, uint32_t part)
{
    return size / part + (size % part != 0);
}

/* Tiles of a level along one axis. */
static uint32_t grid(uint32_t size, uint32_t level, uint32_t tile_size)
{
    return divide_up(size >> level ? size >> level : 1, tile_size);
}

uint32_t region_count(const SluiceStreamedTextureDesc *desc)
{
    return divide_up(desc->width, desc->feedbackRegionWidth) *
           divide_up(desc->height, desc->feedbackRegionHeight);
}

void asked_levels(const SluiceStreamedTextureDesc *desc, const SluiceFeedbackDesc *feedback,
                  uint8_t *asked)
{
    int64_t last = (int64_t)desc->mipLevelCount - 1, finest = 0;
    if (feedback->streamedMipLevels && feedback->streamedMipLevels < desc->regularMipCount)
        finest = (int64_t)desc->regularMipCount - feedback->streamedMipLevels;
    for (uint32_t i = 0; i < feedback->width * feedback->height; i++) {
        int64_t level = feedback->pMinMip[i];
        asked[i] = SLUICE_MIP_UNTOUCHED;
        if (level == SLUICE_MIP_UNTOUCHED)
            continue;
        level = (level < last ? level : last) + feedback->mipBias;
        level = level < finest ? finest : level;
        asked[i] = (uint8_t)(level < last ? level : last);
    }
}

/* Marks the tiles of a level under the texels of one region, along one axis. */
static void mark_axis(uint32_t region, uint32_t region_size, uint32_t size, uint32_t tile_size,
                      uint32_t level, bool *tiles)
{
    uint32_t count = grid(size, level, tile_size);
    memset(tiles, 0, count * sizeof *tiles);
    uint64_t begin = (uint64_t)region * region_size;
    for (uint64_t p = begin; p < begin + region_size && p < size; p++) {
        uint64_t tile = (p >> level) / tile_size;
        tiles[tile < count ? tile : count - 1] = true;
    }
}

/* The tiles of one region's level: rows times columns. */
static void mark_region(const SluiceStreamedTextureDesc *d, uint32_t region, uint32_t level,
                        bool *columns, bool *rows, bool *wanted)
{
    uint32_t regions_x = divide_up(d->width, d->feedbackRegionWidth);
    mark_axis(region % regions_x, d->feedbackRegionWidth, d->width, d->tileWidth, level, columns);
    mark_axis(region / regions_x, d->feedbackRegionHeight, d->height, d->tileHeight, level, rows);
    uint32_t width = grid(d->width, level, d->tileWidth);
    uint32_t height = grid(d->height, level, d->tileHeight);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; rows[y] && x < width; x++)
            wanted[y * width + x] |= columns[x];
}

/* Marks the parents of wanted tiles at `level`. `wanted` and `above`: flags of the two levels. */
static void mark_parents(const SluiceStreamedTextureDesc *d, uint32_t level, const bool *wanted,
                         bool *above)
{
    uint32_t width = grid(d->width, level, d->tileWidth);
    uint32_t height = grid(d->height, level, d->tileHeight);
    uint32_t up_width = grid(d->width, level + 1, d->tileWidth);
    uint32_t up_height = grid(d->height, level + 1, d->tileHeight);
    for (uint32_t y = 0; y < height; y++) {
        for (uint32_t x = 0; x < width; x++) {
            uint32_t px = x / 2 < up_width ? x / 2 : up_width - 1;
            uint32_t py = y / 2 < up_height ? y / 2 : up_height - 1;
            above[py * up_width + px] |= wanted[y * width + x];
        }
    }
}

void wanted_tiles(const SluiceStreamedTextureDesc *desc, const uint8_t *asked, bool *wanted)
{
    uint32_t first[SLUICE_MAX_MIP_LEVELS + 1] = {0}, regular = desc->regularMipCount;
    for (uint32_t l = 0; l < regular; l++)
        first[l + 1] = first[l] + grid(desc->width, l, desc->tileWidth) *
                                      grid(desc->height, l, desc->tileHeight);
    bool *columns = malloc((size_t)desc->width * sizeof *columns);
    bool *rows = malloc((size_t)desc->height * sizeof *rows), anything = false;
    assert_true(columns && rows);
    memset(wanted, 0, (first[regular] + desc->packedTileCount) * sizeof *wanted);
    for (uint32_t i = 0; i < region_count(desc); i++) {
        anything |= asked[i] != SLUICE_MIP_UNTOUCHED;
        if (asked[i] < regular)
            mark_region(desc, i, asked[i], columns, rows, wanted + first[asked[i]]);
    }
    for (uint32_t l = 0; l + 1 < regular; l++)
        mark_parents(desc, l, wanted + first[l], wanted + first[l + 1]);
    for (uint32_t i = 0; i < desc->packedTileCount; i++)
        wanted[first[regular] + i] = anything;
    free(columns);
    free(rows);
}

/* Returns which regions overlap along an axis. Cuts [0, 1) into one cell per pair of texels. */
static bool *meetings(uint32_t from_size, uint32_t from_region, uint32_t to_size,
                      uint32_t to_region)
{
    uint32_t from_count = divide_up(from_size, from_region),
             to_count = divide_up(to_size, to_region);
    bool *meet = calloc((size_t)from_count * to_count, sizeof *meet);
    assert_non_null(meet);
    for (uint64_t cell = 0; cell < (uint64_t)from_size * to_size; cell++)
        meet[cell / to_size / from_region * to_count + cell / from_size / to_region] = true;
    return meet;
}

/* Finds the shift by trial: the follower must stay at least as large as the scaled primary. */
static int level_shift(const SluiceStreamedTextureDesc *from, const SluiceStreamedTextureDesc *to)
{
    int shift = 0;
    uint64_t w = from->width, h = from->height, W = to->width, H = to->height;
    for (; W >= 2 * w && H >= 2 * h; shift++)
        w *= 2, h *= 2;
    for (; W < w || H < h; shift--)
        W *= 2, H *= 2;
    return shift;
}

void follower_levels(const SluiceStreamedTextureDesc *from, const uint8_t *from_asked,
                     const SluiceStreamedTextureDesc *to, uint8_t *to_asked)
{
    bool *meet_x =
        meetings(from->width, from->feedbackRegionWidth, to->width, to->feedbackRegionWidth);
    bool *meet_y =
        meetings(from->height, from->feedbackRegionHeight, to->height, to->feedbackRegionHeight);
    uint32_t from_x = divide_up(from->width, from->feedbackRegionWidth);
    uint32_t to_x = divide_up(to->width, to->feedbackRegionWidth);
    uint32_t to_y = divide_up(to->height, to->feedbackRegionHeight);
    int shift = level_shift(from, to), last = (int)to->mipLevelCount - 1;
    for (uint32_t i = 0; i < region_count(from); i++) {
        if (from_asked[i] == SLUICE_MIP_UNTOUCHED)
            continue;
        int level = from_asked[i] + shift;
        level = level < 0 ? 0 : level > last ? last : level;
        for (uint32_t k = 0; k < to_x * to_y; k++)
            if (meet_x[i % from_x * to_x + k % to_x] && meet_y[i / from_x * to_y + k / to_x] &&
                level < to_asked[k])
                to_asked[k] = (uint8_t)level;
    }
    free(meet_x);
    free(meet_y);
}

void check_requested(const struct fixture *f, SluiceTextureId id, const bool *wanted, int line)
{
    uint32_t count = fixture_layout(f, id).tileCount;
    for (uint32_t i = 0; i < count; i++)
        check_state(f, id, i, wanted[i] ? SLUICE_TILE_STATE_REQUESTED : SLUICE_TILE_STATE_FREE,
                    line);
}
