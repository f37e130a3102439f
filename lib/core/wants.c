#include "core/wants.h"

#include "base/alloc.h"
#include "base/bytes.h"
#include "base/checked.h"
#include "core/history.h"
#include "core/overlap.h"

#include <string.h>

/* Room -------------------------------------------------------------------------------------- */

size_t slc_wants_work_size(const struct slc_texture *t)
{
    size_t bias = slc_padded(slc_region_count(t));
    if (t->desc.regularMipCount == 0)
        return bias;
    size_t row = slc_padded(t->levels[0].width) + SLC_BLOCK;
    size_t grid = (size_t)t->levels[0].width * t->levels[0].height + SLC_BLOCK;
    size_t rows = 2 * row + (slc_regions_are_tiles(t) ? 0 : grid);
    return bias > rows ? bias : rows;
}

SluiceResult slc_wants_reserve_scratch(slc_manager *m, uint64_t bytes, size_t work)
{
    bytes += work;
    if (bytes <= m->scratch_room)
        return SLUICE_SUCCESS;
    if (bytes > SIZE_MAX / 2)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    size_t room = (size_t)bytes + (size_t)bytes / 2;
    uint8_t *scratch = slc_alloc(&m->cb, room, 1);
    if (!scratch)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    slc_free(&m->cb, m->scratch, m->scratch_room, 1);
    m->scratch = scratch;
    m->scratch_room = room;
    return SLUICE_SUCCESS;
}

/* Preparing --------------------------------------------------------------------------------- */

uint8_t *slc_wants_take_map(slc_manager *m, struct slc_texture *t, struct slc_wants_need *need)
{
    size_t regions = slc_region_count(t), padded = slc_padded(regions);
    uint8_t *map = m->scratch + need->scratch;
    assert(need->scratch + padded <= m->scratch_room);
    need->scratch += padded;
    memset(map + padded - SLC_BLOCK, SLUICE_MIP_UNTOUCHED, SLC_BLOCK); /* the padding */
    return map;
}

/** Regions that ask for a finer level than they hold. */
static size_t count_finer(const struct slc_texture_state *s, const uint8_t *next, size_t padded)
{
    size_t count = 0;
    for (size_t i = 0; i < padded;) {
        size_t end = i + 255 * SLC_BLOCK < padded ? i + 255 * SLC_BLOCK : padded;
        slc_block sum = slc_block_of(0);
        for (; i < end; i += SLC_BLOCK) {
            slc_block held = slc_load_block(s->held + i), n = slc_load_block(next + i);
            sum -= ~slc_equal_block(slc_min_block(held, n), held); /* 255 is -1 */
        }
        count += slc_block_sum(sum);
    }
    return count;
}

/** The most tiles of one level that a region can touch along one axis. */
static uint64_t tiles_across(uint32_t region, uint32_t tile)
{
    return tile % region == 0 ? 1 : (uint64_t)region / tile + 2;
}

void slc_wants_add_need(const slc_manager *m, struct slc_texture *t, uint8_t *next,
                        struct slc_wants_need *need)
{
    struct slc_texture_state *s = t->state;
    size_t padded = slc_padded(slc_region_count(t));
    s->next = memcmp(next, s->asked, padded) == 0 ? NULL : next;
    uint64_t finer = padded;
    if (s->bias <= m->bias)
        finer = s->next ? count_finer(s, next, padded) : 0;
    const SluiceStreamedTextureDesc *d = &t->desc;
    uint64_t nodes = finer * d->regularMipCount *
                     tiles_across(d->feedbackRegionWidth, d->tileWidth) *
                     tiles_across(d->feedbackRegionHeight, d->tileHeight);
    need->nodes += nodes < t->regular_tile_count ? nodes : t->regular_tile_count;
    if (t->held_regions == 0)
        need->nodes += d->packedTileCount;
}

/** What the texels of a map ask for: clamp(min(v, last) + bias, lowest, last). */
static void ask(const struct slc_texture *t, const SluiceFeedbackDesc *f, uint8_t *next)
{
    size_t regions = slc_region_count(t);
    uint32_t lowest = 0;
    if (f->streamedMipLevels && f->streamedMipLevels < t->desc.regularMipCount)
        lowest = t->desc.regularMipCount - f->streamedMipLevels;
    int32_t bias = f->mipBias < -32 ? -32 : f->mipBias > 32 ? 32 : f->mipBias;
    slc_block low = slc_block_of((uint8_t)lowest);
    slc_block last = slc_block_of((uint8_t)(t->desc.mipLevelCount - 1));
    slc_block up = slc_block_of((uint8_t)(bias > 0 ? bias : 0));
    slc_block down = slc_block_of((uint8_t)(bias < 0 ? -bias : 0));
    slc_block untouched = slc_block_of(SLUICE_MIP_UNTOUCHED);
    for (size_t i = 0; i < regions; i += SLC_BLOCK) {
        slc_block v = untouched;
        if (i + SLC_BLOCK <= regions)
            v = slc_load_block(f->pMinMip + i);
        else
            memcpy(&v, f->pMinMip + i, regions - i);
        slc_block a = slc_max_block(slc_min_block(v, last) + up, down) - down;
        a = slc_min_block(slc_max_block(a, low), last);
        slc_store_block(next + i, a | slc_equal_block(v, untouched));
    }
}

SluiceResult slc_wants_prepare(slc_manager *m, struct slc_texture *t,
                               const SluiceFeedbackDesc *feedback, struct slc_wants_need *need)
{
    if (!t->state && slc_bytes_are(feedback->pMinMip, slc_region_count(t), SLUICE_MIP_UNTOUCHED))
        return SLUICE_SUCCESS;
    SluiceResult result = slc_state_make(m, t);
    if (result != SLUICE_SUCCESS)
        return result;
    uint8_t *next = slc_wants_take_map(m, t, need);
    ask(t, feedback, next);
    slc_wants_add_need(m, t, next, need);
    return SLUICE_SUCCESS;
}

void slc_wants_abandon(slc_manager *m, struct slc_texture *t)
{
    if (t->state && t->state->span_count == 0)
        slc_state_destroy(m, t);
}

/* Committing -------------------------------------------------------------------------------- */

static void packed_wanted(slc_manager *m, struct slc_texture *t)
{
    for (uint32_t i = 0; i < t->desc.packedTileCount; i++)
        slc_tile_wanted(m, t, &t->packed_nodes[i], t->regular_tile_count + i,
                        t->desc.regularMipCount, 0);
}

static void packed_unwanted(slc_manager *m, struct slc_texture *t)
{
    for (uint32_t i = 0; i < t->desc.packedTileCount; i++)
        slc_tile_unwanted(m, t->packed_nodes[i]);
}

/* A tile of level l is wanted if a region under it holds l or a finer level. So the least level
 * held under each tile says it all, level by level from the one below: where nothing changes in a
 * level, nothing does above it, and how many regions changed matters to no one.
 */

static slc_block at_most(slc_block values, slc_block limit)
{
    return slc_equal_block(slc_min_block(values, limit), values);
}

static void settle_tile(slc_manager *m, struct slc_texture *t, uint32_t tile, uint32_t level,
                        uint8_t least)
{
    uint32_t *cell = &t->state->nodes[tile];
    if (least <= level)
        slc_tile_wanted(m, t, cell, tile, level, level - least);
    else
        slc_tile_unwanted(m, *cell & ~SLC_RESIDENT);
}

/**
 * Takes over the least levels of `count` tiles of one row, beginning with `tile`. `least` is
 * readable to the end of its last block. Returns whether any is new.
 */
static bool settle_row(slc_manager *m, struct slc_texture *t, uint32_t level, uint32_t tile,
                       const uint8_t *least, uint32_t count)
{
    static const uint8_t ramp[2 * SLC_BLOCK] = {255, 255, 255, 255, 255, 255, 255, 255,
                                                255, 255, 255, 255, 255, 255, 255, 255};
    slc_block limit = slc_block_of((uint8_t)level);
    bool changed = false;
    for (uint32_t i = 0; i < count; i += SLC_BLOCK) {
        uint8_t *under = t->state->under + tile + i;
        slc_block before = slc_load_block(under), now = slc_load_block(least + i);
        if (count - i < SLC_BLOCK) {
            slc_block inside = slc_load_block(ramp + SLC_BLOCK - (count - i));
            now = (now & inside) | (before & ~inside);
        }
        if (!slc_block_difference(before, now))
            continue;
        changed = true;
        slc_store_block(under, now);
        uint32_t moves = slc_block_difference(at_most(before, limit), at_most(now, limit));
        for (; moves; moves &= moves - 1) {
            uint32_t k = i + (uint32_t)__builtin_ctz(moves);
            settle_tile(m, t, tile + k, level, least[k]);
        }
    }
    return changed;
}

struct rows {
    uint32_t first, end;
};

static void add_row(struct rows *rows, uint32_t row)
{
    if (rows->first == rows->end)
        rows->first = row;
    rows->end = row + 1;
}

/** Level 0: tiles are regions, or the regions over each tile are searched. */
static struct rows settle_level_0(slc_manager *m, struct slc_texture *t)
{
    const struct slc_level *grid = &t->levels[0];
    const uint8_t *least = t->state->held;
    if (!slc_regions_are_tiles(t)) {
        uint8_t *found = slc_wants_work(m, t) + 2 * (slc_padded(grid->width) + SLC_BLOCK);
        const SluiceStreamedTextureDesc *d = &t->desc;
        struct slc_grid regions = {
            d->width,          d->height,         d->feedbackRegionWidth, d->feedbackRegionHeight,
            t->feedback_width, t->feedback_height};
        struct slc_grid tiles = {d->width,      d->height,   d->tileWidth,
                                 d->tileHeight, grid->width, grid->height};
        slc_least_overlapped(&regions, t->state->held, &tiles, found);
        least = found;
    }
    struct rows rows = {0};
    for (uint32_t y = 0; y < grid->height; y++)
        if (settle_row(m, t, 0, y * grid->width, least + (size_t)y * grid->width, grid->width))
            add_row(&rows, y);
    return rows;
}

/** The least of the rows of the finer level under row `y`, and then of the columns. */
static void reduce_row(const struct slc_texture *t, uint32_t level, uint32_t y, uint8_t *columns,
                       uint8_t *least)
{
    const struct slc_level *fine = &t->levels[level - 1], *here = &t->levels[level];
    uint32_t y0 = 2 * y, y1 = y + 1 == here->height ? fine->height : 2 * y + 2;
    const uint8_t *row = t->state->under + fine->first_tile + (size_t)y0 * fine->width;
    for (uint32_t x = 0; x < fine->width; x += SLC_BLOCK) {
        slc_block v = slc_load_block(row + x);
        for (uint32_t k = 1; k < y1 - y0; k++)
            v = slc_min_block(v, slc_load_block(row + (size_t)k * fine->width + x));
        slc_store_block(columns + x, v);
    }
    slc_halve_bytes(columns, here->width - 1, least);
    uint8_t last = SLUICE_MIP_UNTOUCHED; /* the last tile takes what is over */
    for (uint32_t x = 2 * here->width - 2; x < fine->width; x++)
        last = columns[x] < last ? columns[x] : last;
    least[here->width - 1] = last;
}

static struct rows settle_level(slc_manager *m, struct slc_texture *t, uint32_t level,
                                struct rows below)
{
    const struct slc_level *grid = &t->levels[level];
    uint8_t *columns = slc_wants_work(m, t);
    uint8_t *least = columns + slc_padded(t->levels[0].width) + SLC_BLOCK;
    uint32_t first = slc_min_u32(below.first / 2, grid->height - 1);
    uint32_t end = slc_min_u32((below.end - 1) / 2, grid->height - 1) + 1;
    struct rows rows = {0};
    for (uint32_t y = first; y < end; y++) {
        reduce_row(t, level, y, columns, least);
        if (settle_row(m, t, level, grid->first_tile + y * grid->width, least, grid->width))
            add_row(&rows, y);
    }
    return rows;
}

/** Some region holds another level. */
static void settle(slc_manager *m, struct slc_texture *t, bool held_before)
{
    bool packed_move = !m->info.alwaysMapPackedTiles;
    if (packed_move && !held_before && t->held_regions > 0)
        packed_wanted(m, t);
    if (t->desc.regularMipCount > 0) {
        struct rows rows = settle_level_0(m, t);
        for (uint32_t l = 1; l < t->desc.regularMipCount && rows.first < rows.end; l++)
            rows = settle_level(m, t, l, rows);
    }
    if (packed_move && held_before && t->held_regions == 0)
        packed_unwanted(m, t);
}

void slc_wants_commit(slc_manager *m, struct slc_texture *t, uint64_t time, uint64_t timeout)
{
    if (t->state) {
        bool held_before = t->held_regions > 0;
        m->bias_maps++;
        if (slc_history_merge(m, t, time, timeout))
            settle(m, t, held_before);
        /* Nothing held and nothing left: the last map was empty, which is what no state means. */
        if (t->held_regions == 0 && t->regular_nodes == 0)
            slc_state_destroy(m, t);
        else
            slc_visit_renew(m, t);
    }
    t->interval = t->has_map ? time - t->map_time : 0;
    t->timeout = timeout;
    t->has_map = true;
    t->map_time = time;
}
