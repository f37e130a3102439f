/* From feedback maps to wanted tiles: the sections "What a region asks for" to "Followers". */
#include "core/naive_manager.h"

#include <stdlib.h>
#include <string.h>

#define NOTHING SLUICE_MIP_UNTOUCHED

/* Tiles [x0, x1] x [y0, y1] of one level. */
struct tile_rect {
    uint32_t level, x0, y0, x1, y1;
};

static uint32_t min_u32(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static uint32_t tile_of_texel(uint64_t p, uint32_t level, uint32_t tile_size, uint32_t grid)
{
    uint64_t tile = (p >> level) / tile_size;
    return tile < grid ? (uint32_t)tile : grid - 1;
}

static uint64_t region_end(uint32_t r, uint32_t region_size, uint32_t size)
{
    uint64_t end = ((uint64_t)r + 1) * region_size;
    return end < size ? end : size;
}

static struct tile_rect region_tiles(const SluiceStreamedTextureLayout *l, uint32_t rx, uint32_t ry,
                                     uint32_t level)
{
    const SluiceStreamedTextureDesc *d = &l->desc;
    const uint32_t w = l->levelWidthInTiles[level], h = l->levelHeightInTiles[level];
    return (struct tile_rect){
        .level = level,
        .x0 = tile_of_texel((uint64_t)rx * d->feedbackRegionWidth, level, d->tileWidth, w),
        .y0 = tile_of_texel((uint64_t)ry * d->feedbackRegionHeight, level, d->tileHeight, h),
        .x1 = tile_of_texel(region_end(rx, d->feedbackRegionWidth, d->width) - 1, level,
                            d->tileWidth, w),
        .y1 = tile_of_texel(region_end(ry, d->feedbackRegionHeight, d->height) - 1, level,
                            d->tileHeight, h),
    };
}

static uint32_t tile_index(const SluiceStreamedTextureLayout *l, uint32_t level, uint32_t x,
                           uint32_t y)
{
    return l->levelFirstTile[level] + y * l->levelWidthInTiles[level] + x;
}

static struct tile_rect parent_tiles(const SluiceStreamedTextureLayout *l, struct tile_rect r)
{
    const uint32_t last_x = l->levelWidthInTiles[r.level + 1] - 1;
    const uint32_t last_y = l->levelHeightInTiles[r.level + 1] - 1;
    return (struct tile_rect){r.level + 1, min_u32(r.x0 / 2, last_x), min_u32(r.y0 / 2, last_y),
                              min_u32(r.x1 / 2, last_x), min_u32(r.y1 / 2, last_y)};
}

/* Step 1. Also notes in `now` what all regions together want. */
static void want_new_tiles(struct naive_manager *n, struct naive_texture *t, uint8_t *now)
{
    const SluiceStreamedTextureLayout *l = &t->layout;
    const uint32_t regions = l->feedbackWidth * l->feedbackHeight;
    bool any = n->always_packed;
    for (uint32_t r = 0; r < regions; r++)
        any = any || t->held[r] != NOTHING;
    for (uint32_t i = l->regularTileCount; i < l->tileCount; i++) {
        now[i] = any;
        if (any && !t->tiles[i].wanted)
            naive_become_wanted(n, &t->tiles[i], 0);
    }
    for (uint32_t r = 0; r < regions; r++) {
        if (t->held[r] >= l->desc.regularMipCount)
            continue;
        struct tile_rect rect =
            region_tiles(l, r % l->feedbackWidth, r / l->feedbackWidth, t->held[r]);
        for (;;) {
            for (uint32_t y = rect.y0; y <= rect.y1; y++)
                for (uint32_t x = rect.x0; x <= rect.x1; x++) {
                    uint32_t i = tile_index(l, rect.level, x, y);
                    now[i] = 1;
                    if (!t->tiles[i].wanted)
                        naive_become_wanted(n, &t->tiles[i], rect.level - t->held[r]);
                }
            if (rect.level + 1 == l->desc.regularMipCount)
                break;
            rect = parent_tiles(l, rect);
        }
    }
}

/* Numbers the drops; closing[i] is the last one of a tile at or under tile i, 0: none. */
static void number_drops(const struct naive_texture *t, const uint8_t *held_before,
                         uint64_t *closing)
{
    const SluiceStreamedTextureLayout *l = &t->layout;
    uint64_t number = 0;
    for (uint32_t r = 0; r < l->feedbackWidth * l->feedbackHeight; r++) {
        if (held_before[r] == t->held[r] || held_before[r] >= l->desc.regularMipCount)
            continue;
        struct tile_rect rect =
            region_tiles(l, r % l->feedbackWidth, r / l->feedbackWidth, held_before[r]);
        for (uint32_t y = rect.y0; y <= rect.y1; y++)
            for (uint32_t x = rect.x0; x <= rect.x1; x++) {
                struct tile_rect at = {rect.level, x, y, x, y};
                number++;
                for (;;) {
                    closing[tile_index(l, at.level, at.x0, at.y0)] = number;
                    if (at.level + 1 == l->desc.regularMipCount)
                        break;
                    at = parent_tiles(l, at);
                }
            }
    }
}

/* Step 2. */
static void drop_old_tiles(struct naive_manager *n, struct naive_texture *t,
                           const uint8_t *held_before, const uint8_t *now)
{
    const SluiceStreamedTextureLayout *l = &t->layout;
    uint64_t *closing = naive_alloc(l->tileCount, sizeof *closing);
    struct naive_ref *refs = naive_alloc(l->tileCount, sizeof *refs);
    uint32_t count = 0;
    number_drops(t, held_before, closing);
    for (uint32_t i = 0; i < l->tileCount; i++) {
        struct naive_tile *tile = &t->tiles[i];
        if (!tile->wanted || now[i])
            continue;
        if (tile->packed)
            refs[count++] = (struct naive_ref){t, tile, {1, i, 0, 0}};
        else if (closing[i])
            refs[count++] = (struct naive_ref){t, tile, {0, closing[i], tile->level, 0}};
        else
            abort(); /* nothing that wanted it went away */
    }
    naive_sort(refs, count);
    for (uint32_t i = 0; i < count; i++)
        naive_become_unwanted(n, refs[i].tile);
    free(refs);
    free(closing);
}

static void forget_maps(struct naive_texture *t, uint64_t now, uint64_t timeout)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < t->map_count; i++) {
        bool newest = i + 1 == t->map_count;
        if (newest || now - t->maps[i].time < timeout)
            t->maps[kept++] = t->maps[i];
        else
            free(t->maps[i].wanted);
    }
    t->map_count = kept;
}

/* `asked` is `a` per region, 255: nothing. The texture keeps it. */
static void merge_map(struct naive_manager *n, struct naive_texture *t, uint8_t *asked,
                      uint64_t time, uint64_t timeout)
{
    const uint32_t regions = t->layout.feedbackWidth * t->layout.feedbackHeight;
    const uint32_t regular = t->layout.desc.regularMipCount;
    free(t->last_asked);
    t->last_asked = asked;

    struct naive_map *maps = realloc(t->maps, (t->map_count + 1) * sizeof *maps);
    if (!maps)
        abort();
    t->maps = maps;
    struct naive_map *map = &maps[t->map_count++];
    *map = (struct naive_map){time, naive_alloc(regions, 1)};
    for (uint32_t r = 0; r < regions; r++)
        map->wanted[r] = asked[r] == NOTHING ? NOTHING : (uint8_t)min_u32(asked[r], regular);
    forget_maps(t, time, timeout);

    uint8_t *held_before = t->held;
    t->held = naive_alloc(regions, 1);
    for (uint32_t r = 0; r < regions; r++) {
        t->held[r] = NOTHING;
        for (uint32_t i = 0; i < t->map_count; i++)
            t->held[r] = (uint8_t)min_u32(t->held[r], t->maps[i].wanted[r]);
    }
    uint8_t *now = naive_alloc(t->layout.tileCount, 1);
    want_new_tiles(n, t, now);
    drop_old_tiles(n, t, held_before, now);
    naive_list_standby(n, n->config.numExtraStandbyTiles);
    free(now);
    free(held_before);
}

static int64_t clamp_i64(int64_t value, int64_t low, int64_t high)
{
    return value < low ? low : value > high ? high : value;
}

/* Whether region r of one texture and region q of the other overlap by more than a border. */
static bool overlap(uint32_t r, uint32_t r_size, uint32_t w, uint32_t q, uint32_t q_size,
                    uint32_t other_w)
{
    uint64_t x0 = (uint64_t)r * r_size, x1 = region_end(r, r_size, w);
    uint64_t q0 = (uint64_t)q * q_size, q1 = region_end(q, q_size, other_w);
    return x0 * other_w < q1 * w && q0 * w < x1 * other_w;
}

/* Whether size >= other * 2^d. */
static bool at_least(uint64_t size, uint64_t other, int d)
{
    return d >= 0 ? size >= other << d : size << -d >= other;
}

static int level_offset(const SluiceStreamedTextureDesc *follower,
                        const SluiceStreamedTextureDesc *primary)
{
    int d = 20;
    while (!at_least(follower->width, primary->width, d) ||
           !at_least(follower->height, primary->height, d))
        d--;
    return d;
}

static void follow(struct naive_manager *n, const struct naive_texture *primary,
                   struct naive_texture *t, uint64_t time, uint64_t timeout)
{
    const SluiceStreamedTextureLayout *l = &t->layout, *p = &primary->layout;
    const int offset = level_offset(&l->desc, &p->desc);
    uint8_t *asked = naive_alloc((size_t)l->feedbackWidth * l->feedbackHeight, 1);
    for (uint32_t ry = 0; ry < l->feedbackHeight; ry++)
        for (uint32_t rx = 0; rx < l->feedbackWidth; rx++) {
            uint32_t least = NOTHING;
            for (uint32_t q = 0; q < p->feedbackWidth * p->feedbackHeight; q++)
                if (overlap(rx, l->desc.feedbackRegionWidth, l->desc.width, q % p->feedbackWidth,
                            p->desc.feedbackRegionWidth, p->desc.width) &&
                    overlap(ry, l->desc.feedbackRegionHeight, l->desc.height, q / p->feedbackWidth,
                            p->desc.feedbackRegionHeight, p->desc.height))
                    least = min_u32(least, primary->last_asked[q]);
            asked[ry * l->feedbackWidth + rx] =
                least == NOTHING ? NOTHING
                                 : (uint8_t)clamp_i64((int64_t)least + offset, 0,
                                                      (int64_t)l->desc.mipLevelCount - 1);
        }
    merge_map(n, t, asked, time, timeout);
}

static bool time_is_backwards(const struct naive_manager *n, uint64_t time)
{
    return n->has_time && (int64_t)(time - n->time) < 0;
}

static void feed_followers(struct naive_manager *n, const struct naive_texture *primary,
                           uint64_t time, uint64_t timeout)
{
    struct naive_ref *refs = naive_alloc(n->texture_room, sizeof *refs);
    uint32_t count = 0;
    for (uint32_t i = 0; i < n->texture_room; i++) {
        struct naive_texture *t = n->textures[i];
        if (t && t->primary == primary->id)
            refs[count++] = (struct naive_ref){t, NULL, {t->follower_since, 0, 0, 0}};
    }
    naive_sort(refs, count);
    for (uint32_t i = 0; i < count; i++)
        follow(n, primary, refs[i].texture, time, timeout);
    free(refs);
}

SluiceResult naive_feedback(struct naive_manager *n, const struct call *call)
{
    SluiceResult result;
    if (call->null != NULL_NONE || call->null_map)
        return SLUICE_ERROR_NULL_POINTER;
    struct naive_texture *t = naive_find(n, call->texture, &result);
    if (!t)
        return result;
    const SluiceStreamedTextureLayout *l = &t->layout;
    if (call->map_width != l->feedbackWidth || call->map_height != l->feedbackHeight)
        return SLUICE_ERROR_SIZE_MISMATCH;
    if (time_is_backwards(n, call->time))
        return SLUICE_ERROR_TIME_BACKWARDS;
    n->has_time = true;
    n->time = call->time;
    naive_retry_due(n, call->time);

    const int64_t last = (int64_t)l->desc.mipLevelCount - 1;
    const int64_t regular = l->desc.regularMipCount;
    int64_t low = call->streamed_levels ? regular - (int64_t)call->streamed_levels : 0;
    low = low < 0 ? 0 : low;
    uint8_t *asked = naive_alloc((size_t)l->feedbackWidth * l->feedbackHeight, 1);
    for (uint32_t r = 0; r < l->feedbackWidth * l->feedbackHeight; r++) {
        int64_t v = call->map[r];
        asked[r] = v == NOTHING ? NOTHING
                                : (uint8_t)clamp_i64((v < last ? v : last) + call->bias, low, last);
    }
    merge_map(n, t, asked, call->time, call->timeout);
    feed_followers(n, t, call->time, call->timeout);
    return SLUICE_SUCCESS;
}

SluiceResult naive_match(struct naive_manager *n, const struct call *call)
{
    SluiceResult result;
    if (call->null != NULL_NONE)
        return SLUICE_ERROR_NULL_POINTER;
    struct naive_texture *primary = naive_find(n, call->primary, &result);
    if (!primary)
        return result;
    struct naive_texture *t = naive_find(n, call->texture, &result);
    if (!t)
        return result;
    if (t == primary)
        return SLUICE_ERROR_INVALID_ARGUMENT;
    if (time_is_backwards(n, call->time))
        return SLUICE_ERROR_TIME_BACKWARDS;
    n->has_time = true;
    n->time = call->time;
    naive_retry_due(n, call->time);
    if (primary->last_asked)
        follow(n, primary, t, call->time, call->timeout);
    return SLUICE_SUCCESS;
}
