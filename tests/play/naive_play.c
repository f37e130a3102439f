#include "play/naive_play.h"

#include <string.h>

#define NEVER UINT32_MAX

/** Number of tiles of a level in a row or column of tiles. */
static uint32_t tiles_across(uint32_t size, uint32_t level, uint32_t tile)
{
    uint32_t texels = size >> level ? size >> level : 1;
    return (texels + tile - 1) / tile;
}

/** Returns the parent position, computed step by step on each level's grid. */
static uint32_t ancestor(uint32_t at, uint32_t level, uint32_t size, uint32_t tile)
{
    for (uint32_t l = 1; l <= level; l++) {
        at /= 2;
        if (at >= tiles_across(size, l, tile))
            at = tiles_across(size, l, tile) - 1;
    }
    return at;
}

static bool overlap(uint32_t a, uint32_t a_size, uint32_t b, uint32_t b_size)
{
    return a * a_size < (b + 1) * b_size && b * b_size < (a + 1) * a_size;
}

static uint32_t regions_across(uint32_t size, uint32_t region)
{
    return (size + region - 1) / region;
}

/** Returns the level that a map's region requests: the regular count for packed levels, NEVER for
 * none. */
static uint32_t wanted(const struct naive_trace *t, uint32_t frame, uint32_t texture, uint32_t x,
                       uint32_t y)
{
    const SluiceStreamedTextureDesc *d = &t->textures[texture];
    const uint32_t columns = regions_across(d->width, d->feedbackRegionWidth);
    const uint8_t value = t->maps[frame][texture][y * columns + x];
    if (value == 255)
        return NEVER;
    return value < d->regularMipCount ? value : d->regularMipCount;
}

/** Returns whether a frame's map of the texture requires tile (x, y) of a level. */
static bool needs(const struct naive_trace *t, uint32_t frame, uint32_t texture, uint32_t level,
                  uint32_t x, uint32_t y)
{
    const SluiceStreamedTextureDesc *d = &t->textures[texture];
    for (uint32_t ry = 0; ry < regions_across(d->height, d->feedbackRegionHeight); ry++)
        for (uint32_t rx = 0; rx < regions_across(d->width, d->feedbackRegionWidth); rx++) {
            const uint32_t want = wanted(t, frame, texture, rx, ry);
            if (want == NEVER || want > level)
                continue;
            for (uint32_t ty = 0; ty < tiles_across(d->height, 0, d->tileHeight); ty++)
                for (uint32_t tx = 0; tx < tiles_across(d->width, 0, d->tileWidth); tx++)
                    if (overlap(rx, d->feedbackRegionWidth, tx, d->tileWidth) &&
                        overlap(ry, d->feedbackRegionHeight, ty, d->tileHeight) &&
                        ancestor(tx, level, d->width, d->tileWidth) == x &&
                        ancestor(ty, level, d->height, d->tileHeight) == y)
                        return true;
        }
    return false;
}

static uint32_t first_need(const struct naive_trace *t, uint32_t texture, uint32_t level,
                           uint32_t x, uint32_t y)
{
    for (uint32_t f = 0; f < t->frame_count; f++)
        if (t->has_map[f][texture] && needs(t, f, texture, level, x, y))
            return f;
    return NEVER;
}

/** Returns whether the latest map at `frame` does not require the tile. */
static bool is_stale(const struct naive_trace *t, uint32_t frame, uint32_t texture, uint32_t level,
                     uint32_t x, uint32_t y)
{
    for (uint32_t f = frame + 1; f-- > 0;)
        if (t->has_map[f][texture])
            return !needs(t, f, texture, level, x, y);
    return false;
}

static uint32_t member_count(const struct naive_trace *t, uint32_t primary)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < t->texture_count; i++)
        count += t->primaries[i] == primary;
    return count;
}

/** Frames in which tiles arrive, by level and position. */
struct arrivals {
    uint32_t at[SLUICE_MAX_MIP_LEVELS][16][16];
};

static void load_texture(const struct naive_trace *t, uint32_t texture, uint32_t latency,
                         struct arrivals *arrivals, struct naive_answer *answer)
{
    const SluiceStreamedTextureDesc *d = &t->textures[texture];
    const uint32_t members = member_count(t, texture);
    memset(arrivals, 0xff, sizeof *arrivals);
    for (uint32_t level = 0; level < d->regularMipCount; level++)
        for (uint32_t y = 0; y < tiles_across(d->height, level, d->tileHeight); y++)
            for (uint32_t x = 0; x < tiles_across(d->width, level, d->tileWidth); x++) {
                const uint32_t need = first_need(t, texture, level, x, y);
                if (need == NEVER)
                    continue;
                answer->needed_tiles += members;
                arrivals->at[level][y][x] = need + latency;
                if (need + latency >= t->frame_count)
                    continue;
                answer->loaded_tiles += members;
                if (is_stale(t, need + latency, texture, level, x, y))
                    answer->stale_tiles += members;
            }
}

/** Returns the finest resident level over tile (x, y) of level 0 with all coarser ones resident. */
static uint32_t level_there(const struct naive_trace *t, uint32_t texture,
                            const struct arrivals *arrivals, uint32_t frame, uint32_t latency,
                            uint32_t x, uint32_t y)
{
    const SluiceStreamedTextureDesc *d = &t->textures[texture];
    uint32_t level = d->regularMipCount;
    if (frame <= latency)
        return level + 1;
    while (level > 0) {
        const uint32_t ax = ancestor(x, level - 1, d->width, d->tileWidth);
        const uint32_t ay = ancestor(y, level - 1, d->height, d->tileHeight);
        if (arrivals->at[level - 1][ay][ax] >= frame)
            break;
        level--;
    }
    return level;
}

static void look(const struct naive_trace *t, uint32_t texture, const struct arrivals *arrivals,
                 uint32_t frame, uint32_t latency, struct naive_answer *answer)
{
    const SluiceStreamedTextureDesc *d = &t->textures[texture];
    for (uint32_t ry = 0; ry < regions_across(d->height, d->feedbackRegionHeight); ry++)
        for (uint32_t rx = 0; rx < regions_across(d->width, d->feedbackRegionWidth); rx++) {
            const uint32_t want = wanted(t, frame, texture, rx, ry);
            uint32_t have = 0;
            if (want == NEVER)
                continue;
            for (uint32_t ty = 0; ty < tiles_across(d->height, 0, d->tileHeight); ty++)
                for (uint32_t tx = 0; tx < tiles_across(d->width, 0, d->tileWidth); tx++) {
                    if (!overlap(rx, d->feedbackRegionWidth, tx, d->tileWidth) ||
                        !overlap(ry, d->feedbackRegionHeight, ty, d->tileHeight))
                        continue;
                    const uint32_t level =
                        level_there(t, texture, arrivals, frame, latency, tx, ty);
                    have = level > have ? level : have;
                }
            answer->touched_regions++;
            answer->missing_regions += have > want;
            answer->missing_levels += have > want ? have - want : 0;
        }
}

static bool is_touched(const struct naive_trace *t, uint32_t texture)
{
    for (uint32_t f = 0; f < t->frame_count; f++)
        for (uint32_t r = 0; t->has_map[f][texture] && r < NAIVE_REGIONS; r++)
            if (t->maps[f][texture][r] != 255)
                return true;
    return false;
}

struct naive_answer naive_play(const struct naive_trace *t, uint32_t latency)
{
    struct naive_answer answer = {0};
    for (uint32_t i = 0; i < t->texture_count; i++) {
        const uint64_t packed = t->textures[i].packedTileCount;
        answer.loaded_tiles += latency < t->frame_count ? packed : 0;
        answer.needed_tiles += is_touched(t, t->primaries[i]) ? packed : 0;
        if (t->primaries[i] != i)
            continue;
        struct arrivals arrivals;
        load_texture(t, i, latency, &arrivals, &answer);
        for (uint32_t f = 0; f < t->frame_count; f++)
            if (t->has_map[f][i])
                look(t, i, &arrivals, f, latency, &answer);
    }
    return answer;
}
