#include "core/wants.h"

#include "base/alloc.h"
#include "base/bits.h"
#include "base/bytes.h"
#include "base/checked.h"
#include "core/mip_bias.h"
#include "core/history.h"
#include "core/minmip.h"
#include "core/overlap.h"
#include "core/shape.h"
#include "core/texture_tiles.h"
#include "core/visits.h"
#include "residency/node.h"
#include "residency/tile_runs.h"

#include <string.h>

/* Room -------------------------------------------------------------------------------------- */

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

/** Most tiles of one level that a region can touch along one axis. */
static uint64_t tiles_across(uint32_t region, uint32_t tile)
{
    /* keeps the products of the caller in range; no region is larger than the texture */
    region = slc_min_u32(region, SLUICE_MAX_TEXTURE_SIZE);
    return tile % region == 0 ? 1 : (uint64_t)region / tile + 2;
}

/** Adds the nodes that merging a map can take. `finer`: regions that request a finer level than
 * before. */
static void add_need(const slc_manager *m, const struct slc_managed_texture *t, uint64_t finer,
                     struct slc_wants_need *need)
{
    const SluiceStreamedTextureDesc *d = &t->shape->desc;
    if (t->history->bias > m->bias.value)
        finer = slc_region_count(t);
    uint64_t nodes = finer * d->regularMipCount *
                     tiles_across(d->feedbackRegionWidth, d->tileWidth) *
                     tiles_across(d->feedbackRegionHeight, d->tileHeight);
    need->nodes += nodes < t->shape->regular_tile_count ? nodes : t->shape->regular_tile_count;
    if (t->held_regions == 0)
        need->nodes += d->packedTileCount;
}

/** Numbers of regions, from comparing a map with the history. */
struct compared {
    uint32_t finer;         ///< regions that request a finer level than all maps did
    uint32_t hits, returns; ///< see history.c
};

/** slc_levels as blocks. A local copy, because stores of bytes between uses may alias slc_levels.
 */
struct level_blocks {
    slc_block coarsest, up, down, lowest, last;
};

static inline slc_block ask(slc_block v, struct level_blocks l)
{
    slc_block a = slc_max_block(slc_min_block(v, l.coarsest) + l.up, l.down) - l.down;
    a = slc_min_block(slc_max_block(a, l.lowest), l.last);
    return a | slc_equal_block(v, slc_block_of(SLUICE_MIP_UNTOUCHED));
}

static inline void compare(slc_block next, slc_block asked, slc_block least, slc_block known,
                           slc_block sums[3])
{
    slc_block again = slc_equal_block(slc_min_block(next, known), next) &
                      ~slc_equal_block(known, slc_block_of(SLUICE_MIP_UNTOUCHED));
    slc_block seen = slc_equal_block(asked, known);
    sums[0] -= ~slc_equal_block(slc_min_block(next, least), least); /* 255 is -1 */
    sums[1] -= again & seen;
    sums[2] -= again & ~seen;
}

/** Writes the levels that `values` request. Returns whether they differ from the last map. */
static bool ask_all(const struct slc_managed_texture *t, const uint8_t *values,
                    const struct slc_levels *levels, uint8_t *next)
{
    const uint8_t *asked = t->history->asked;
    const struct level_blocks l = {slc_block_of(levels->coarsest), slc_block_of(levels->up),
                                   slc_block_of(levels->down), slc_block_of(levels->lowest),
                                   slc_block_of(levels->last)};
    size_t regions = slc_region_count(t), i = 0;
    slc_block differ = slc_block_of(0);
    for (; i + SLC_BLOCK <= regions; i += SLC_BLOCK) {
        slc_block v = ask(slc_load_block(values + i), l);
        slc_store_block(next + i, v);
        differ |= v ^ slc_load_block(asked + i);
    }
    if (i < regions) {
        slc_block v = slc_block_of(SLUICE_MIP_UNTOUCHED);
        memcpy(&v, values + i, regions - i);
        v = ask(v, l);
        slc_store_block(next + i, v);
        differ |= v ^ slc_load_block(asked + i);
    }
    return slc_block_difference(differ, slc_block_of(0)) != 0;
}

static struct compared compare_all(const struct slc_managed_texture *t, const uint8_t *next)
{
    const struct slc_history *h = t->history;
    const uint8_t *asked = h->asked, *least = h->least, *known = h->known;
    size_t padded = slc_padded(slc_region_count(t));
    slc_block untouched = slc_block_of(SLUICE_MIP_UNTOUCHED);
    struct compared c = {0};
    for (size_t i = 0; i < padded;) {
        slc_block sums[3] = {slc_block_of(0), slc_block_of(0), slc_block_of(0)};
        for (size_t end = slc_batch_end(i, padded); i < end; i += SLC_BLOCK) {
            slc_block v = slc_load_block(next + i);
            if (slc_block_difference(v, untouched))
                compare(v, slc_load_block(asked + i), slc_load_block(least + i),
                        slc_load_block(known + i), sums);
        }
        c.finer += slc_block_sum(sums[0]);
        c.hits += slc_block_sum(sums[1]);
        c.returns += slc_block_sum(sums[2]);
    }
    return c;
}

uint8_t *slc_wants_take_scratch(slc_manager *m, size_t size, struct slc_wants_need *need)
{
    uint8_t *scratch = m->scratch + need->scratch;
    need->scratch += slc_padded(size);
    assert(need->scratch <= m->scratch_room);
    return scratch;
}

uint8_t *slc_wants_take_map(slc_manager *m, const struct slc_managed_texture *t,
                            struct slc_wants_need *need)
{
    return slc_wants_take_scratch(m, slc_region_count(t), need);
}

void slc_wants_set_map(slc_manager *m, struct slc_managed_texture *t, const uint8_t *values,
                       const struct slc_levels *levels, uint8_t *next, struct slc_wants_need *need)
{
    struct slc_history *h = t->history;
    struct compared c = {0};
    /* without changes of levels, values equal to the last map request the same levels */
    bool plain =
        !levels->up && !levels->down && !levels->lowest && levels->coarsest == levels->last;
    bool differs = !(plain && memcmp(values, h->asked, slc_region_count(t)) == 0) &&
                   ask_all(t, values, levels, next);
    if (differs)
        c = compare_all(t, next);
    h->next = differs ? next : NULL;
    h->hits = c.hits;
    h->returns = c.returns;
    add_need(m, t, c.finer, need);
}

/** Returns the levels for a map of the texture itself, not of a primary. */
static struct slc_levels own_levels(const struct slc_managed_texture *t,
                                    const SluiceFeedbackDesc *f)
{
    uint32_t lowest = 0;
    if (f->streamedMipLevels && f->streamedMipLevels < t->shape->desc.regularMipCount)
        lowest = t->shape->desc.regularMipCount - f->streamedMipLevels;
    int32_t bias = f->mipBias < -32 ? -32 : f->mipBias > 32 ? 32 : f->mipBias;
    return (struct slc_levels){.up = (uint8_t)(bias > 0 ? bias : 0),
                               .down = (uint8_t)(bias < 0 ? -bias : 0),
                               .lowest = (uint8_t)lowest,
                               .coarsest = (uint8_t)(t->shape->desc.mipLevelCount - 1),
                               .last = (uint8_t)(t->shape->desc.mipLevelCount - 1)};
}

SluiceResult slc_wants_prepare(slc_manager *m, struct slc_managed_texture *t,
                               const SluiceFeedbackDesc *feedback, uint32_t users,
                               struct slc_wants_need *need)
{
    if (!t->nodes && slc_bytes_are(feedback->pMinMip, slc_region_count(t), SLUICE_MIP_UNTOUCHED))
        return SLUICE_SUCCESS;
    SluiceResult result = slc_history_make(m, t, users);
    if (result != SLUICE_SUCCESS)
        return result;
    struct slc_levels levels = own_levels(t, feedback);
    slc_wants_set_map(m, t, feedback->pMinMip, &levels, slc_wants_take_map(m, t, need), need);
    return SLUICE_SUCCESS;
}

void slc_wants_abandon(slc_manager *m, struct slc_managed_texture *t)
{
    slc_state_release(m, t);
}

/* Committing -------------------------------------------------------------------------------- */

/* A tile of level l is wanted if a region under it requests l or a finer level. So the finest level
 * under each tile suffices. Each level is computed from the next finer one. If a level does not
 * change, no coarser one does. The cost does not depend on how many regions changed.
 */

static slc_block at_most(slc_block values, slc_block limit)
{
    return slc_equal_block(slc_min_block(values, limit), values);
}

/**
 * Tiles that become wanted or unwanted. They are settled in batches, so that the memory of each
 * tile is prefetched while further tiles are searched.
 */
struct moves {
    uint32_t count;
    struct slc_move tiles[64];
    struct slc_move_log *log; ///< log of the moves; NULL: none
    bool counted_only;        ///< only counts wanted tiles; a snapshot restores their nodes
};

/** Returns a block with 255 in the first `count` bytes, at most a block, and 0 in the rest. */
static slc_block first_bytes(uint32_t count)
{
    static const uint8_t ramp[2 * SLC_BLOCK] = {255, 255, 255, 255, 255, 255, 255, 255,
                                                255, 255, 255, 255, 255, 255, 255, 255};
    return slc_load_block(ramp + SLC_BLOCK - count);
}

/** log2 of the tiles of level 0 that request a tile. At least one does. */
static uint32_t need_of(const struct slc_managed_texture *t, uint32_t tile, uint32_t level)
{
    if (level == 0)
        return 0;
    struct slc_tile_range r = slc_area(t, slc_place_at(t, tile, level));
    const uint8_t *under = t->history->under + r.x0;
    uint32_t pitch = t->shape->levels[0].width, width = r.x1 - r.x0 + 1;
    slc_block limit = slc_block_of((uint8_t)level), sums = slc_block_of(0);
    uint32_t count = 0, added = 0;
    for (uint32_t y = r.y0; y <= r.y1; y++)
        for (uint32_t x = 0; x < width; x += SLC_BLOCK) {
            slc_block inside = first_bytes(slc_min_u32(width - x, SLC_BLOCK));
            sums -= at_most(slc_load_block(under + (size_t)y * pitch + x), limit) & inside;
            if (++added % 255 == 0) { /* bytes of the sum are full */
                count += slc_block_sum(sums);
                sums = slc_block_of(0);
            }
        }
    return slc_highest_bit(count + slc_block_sum(sums));
}

static void settle_move(slc_manager *m, struct slc_managed_texture *t, struct slc_run *run,
                        const struct slc_move *move)
{
    uint32_t *cell = &t->nodes[move->tile], node = *cell & ~SLC_RESIDENT;
    if (node && slc_run_add(&m->residency, run, node, move->level, move->wanted))
        return;
    if (!move->wanted)
        slc_node_unwanted(&m->residency, node);
    else if (node)
        slc_tile_wanted(m, t, cell, move->tile, move->level);
    else
        slc_tile_requested(m, t, cell, move->tile, move->level,
                           need_of(t, move->tile, move->level));
}

static void settle_moves(slc_manager *m, struct slc_managed_texture *t, struct moves *moves)
{
    struct slc_run run = {.count = 0};
    for (uint32_t i = 0; i < moves->count; i++)
        SLC_PREFETCH(slc_node_at(&m->residency, t->nodes[moves->tiles[i].tile] & ~SLC_RESIDENT));
    for (uint32_t i = 0; i < moves->count; i++)
        settle_move(m, t, &run, &moves->tiles[i]);
    slc_run_end(&m->residency, &run);
    if (moves->log) {
        memcpy(moves->log->moves + moves->log->count, moves->tiles,
               moves->count * sizeof *moves->tiles);
        moves->log->count += moves->count;
    }
    moves->count = 0;
}

static void add_move(slc_manager *m, struct slc_managed_texture *t, struct moves *moves,
                     struct slc_move move)
{
    if (moves->count == sizeof moves->tiles / sizeof *moves->tiles)
        settle_moves(m, t, moves);
    SLC_PREFETCH(&t->nodes[move.tile]);
    t->wanted_tiles += move.wanted ? 1 : UINT32_MAX;
    *slc_wanted_in_level(t, move.level) += move.wanted ? 1 : UINT32_MAX;
    if (!moves->counted_only)
        moves->tiles[moves->count++] = move;
}

/**
 * Sets the finest levels of `count` tiles of a level, beginning with `tile`. `least` is readable to
 * the end of its last block. Returns a range with all tiles that changed.
 */
static struct slc_range settle_tiles(slc_manager *m, struct slc_managed_texture *t,
                                     struct moves *moves, uint32_t level, uint32_t tile,
                                     const uint8_t *least, uint32_t count)
{
    slc_block limit = slc_block_of((uint8_t)level);
    struct slc_range changed = {0, 0};
    uint8_t *under = t->history->under + tile;
    for (uint32_t i = 0; i < count; i += SLC_BLOCK) {
        slc_block before = slc_load_block(under + i), now = slc_load_block(least + i);
        if (count - i < SLC_BLOCK) {
            slc_block inside = first_bytes(count - i);
            now = (now & inside) | (before & ~inside);
        }
        if (!slc_block_difference(before, now))
            continue;
        slc_range_add(&changed, i, slc_min_u32(i + SLC_BLOCK, count));
        slc_store_block(under + i, now);
        uint32_t bits = slc_block_difference(at_most(before, limit), at_most(now, limit));
        for (; bits; bits &= bits - 1) {
            uint32_t k = i + slc_lowest_bit(bits);
            add_move(m, t, moves, (struct slc_move){tile + k, (uint8_t)level, least[k] <= level});
        }
    }
    return changed;
}

/** Returns the requested levels of the regions: finest level of their maps plus bias. */
static const uint8_t *held_levels(slc_manager *m, const struct slc_managed_texture *t,
                                  uint8_t *work)
{
    const struct slc_history *h = t->history;
    if (m->bias.value == 0)
        return h->least;
    slc_bias_map(m, t, work);
    slc_block last = slc_block_of((uint8_t)(t->shape->desc.mipLevelCount - 1));
    for (size_t i = 0; i < slc_padded(slc_region_count(t)); i += SLC_BLOCK) {
        slc_block least = slc_load_block(h->least + i);
        slc_block held = slc_min_block(least + slc_load_block(work + i), last);
        held |= slc_equal_block(least, slc_block_of(SLUICE_MIP_UNTOUCHED));
        slc_store_block(work + i, held);
    }
    return work;
}

static const uint8_t *search_tiles(const struct slc_managed_texture *t, const uint8_t *held,
                                   uint8_t *work)
{
    const SluiceStreamedTextureDesc *d = &t->shape->desc;
    const struct slc_level *grid = &t->shape->levels[0];
    struct slc_grid regions = {.width = d->width,
                               .height = d->height,
                               .cell_width = d->feedbackRegionWidth,
                               .cell_height = d->feedbackRegionHeight,
                               .columns = t->shape->feedback_width,
                               .rows = t->shape->feedback_height};
    struct slc_grid tiles = {.width = d->width,
                             .height = d->height,
                             .cell_width = d->tileWidth,
                             .cell_height = d->tileHeight,
                             .columns = grid->width,
                             .rows = grid->height};
    slc_least_overlapped(&regions, held, &tiles, work);
    return work;
}

/** Settles level 0: tiles are regions, or the regions over each tile are searched. Returns rows. */
static struct slc_range settle_level_0(slc_manager *m, struct slc_managed_texture *t,
                                       struct moves *moves, struct slc_range regions)
{
    const struct slc_level *grid = &t->shape->levels[0];
    uint8_t *work = slc_wants_work(m, t) + slc_shape_rows_size(t->shape);
    const uint8_t *least = held_levels(m, t, work);
    if (!slc_regions_are_tiles(t->shape))
        least = search_tiles(t, least, work + slc_padded(slc_region_count(t)));
    struct slc_range all = {0, grid->width * grid->height};
    if (slc_regions_are_tiles(t->shape)) {
        all.first = regions.first;
        all.end = slc_min_u32(all.end, regions.end);
    }
    struct slc_range tiles =
        settle_tiles(m, t, moves, 0, all.first, least + all.first, all.end - all.first);
    tiles.first += all.first;
    tiles.end += tiles.end ? all.first : 0;
    if (tiles.end == 0)
        return tiles;
    return (struct slc_range){tiles.first / grid->width, (tiles.end - 1) / grid->width + 1};
}

/** Computes the finest levels of row `y` from the next finer level: first over rows, then columns.
 */
static void reduce_row(const struct slc_managed_texture *t, uint32_t level, uint32_t y,
                       uint8_t *columns, uint8_t *least)
{
    const struct slc_level *fine = &t->shape->levels[level - 1], *here = &t->shape->levels[level];
    uint32_t y0 = 2 * y, y1 = y + 1 == here->height ? fine->height : 2 * y + 2;
    const uint8_t *row = t->history->under + fine->first_tile + (size_t)y0 * fine->width;
    for (uint32_t x = 0; x < fine->width; x += SLC_BLOCK) {
        slc_block v = slc_load_block(row + x);
        for (uint32_t k = 1; k < y1 - y0; k++)
            v = slc_min_block(v, slc_load_block(row + (size_t)k * fine->width + x));
        slc_store_block(columns + x, v);
    }
    slc_halve_bytes(columns, here->width - 1, least);
    uint8_t last = SLUICE_MIP_UNTOUCHED; /* the last tile covers all remaining columns */
    for (uint32_t x = 2 * here->width - 2; x < fine->width; x++)
        last = columns[x] < last ? columns[x] : last;
    least[here->width - 1] = last;
}

static struct slc_range settle_level(slc_manager *m, struct slc_managed_texture *t,
                                     struct moves *moves, uint32_t level, struct slc_range below)
{
    const struct slc_level *grid = &t->shape->levels[level];
    uint8_t *columns = slc_wants_work(m, t), *least = columns + slc_shape_rows_size(t->shape) / 2;
    uint32_t first = slc_min_u32(below.first / 2, grid->height - 1);
    uint32_t last = slc_min_u32((below.end - 1) / 2, grid->height - 1);
    struct slc_range rows = {0, 0};
    for (uint32_t y = first; y <= last; y++) {
        reduce_row(t, level, y, columns, least);
        uint32_t tile = grid->first_tile + y * grid->width;
        if (settle_tiles(m, t, moves, level, tile, least, grid->width).end == 0)
            continue;
        slc_range_add(&rows, y, y + 1);
    }
    return rows;
}

static void packed_before(slc_manager *m, struct slc_managed_texture *t, bool held_before)
{
    if (!m->info.alwaysMapPackedTiles && !held_before && t->held_regions > 0)
        slc_packed_tiles_wanted(m, t);
}

static void packed_after(slc_manager *m, struct slc_managed_texture *t, bool held_before)
{
    if (!m->info.alwaysMapPackedTiles && held_before && t->held_regions == 0)
        slc_packed_tiles_unwanted(m, t);
}

/** Returns whether the level of some tile of level 0 changed. The texture has regular levels. */
static bool settle_levels(slc_manager *m, struct slc_managed_texture *t, struct moves *moves,
                          struct slc_range regions)
{
    struct slc_range rows = settle_level_0(m, t, moves, regions);
    bool changed = rows.end > 0;
    for (uint32_t l = 1; l < t->shape->desc.regularMipCount && rows.end > 0; l++)
        rows = settle_level(m, t, moves, l, rows);
    return changed;
}

void slc_wants_restore(slc_manager *m, struct slc_managed_texture *t)
{
    struct moves moves = {.counted_only = true};
    struct slc_range all = {0, (uint32_t)slc_padded(slc_region_count(t))};
    uint32_t bias = m->bias.value;
    m->bias.value = t->history->bias;
    if (t->shape->desc.regularMipCount > 0)
        settle_levels(m, t, &moves, all);
    m->bias.value = bias;
}

/** Settles changed regions. Returns whether the level of some tile of level 0 changed. */
static bool settle(slc_manager *m, struct slc_managed_texture *t, struct slc_range regions,
                   bool held_before, struct slc_move_log *log)
{
    bool changed = false;
    packed_before(m, t, held_before);
    if (t->shape->desc.regularMipCount > 0) {
        struct moves moves = {.count = 0, .log = log};
        changed = settle_levels(m, t, &moves, regions);
        settle_moves(m, t, &moves);
    }
    packed_after(m, t, held_before);
    return changed;
}

/* Notes the time of a merged map that requested something. */
static void take_sight(struct slc_managed_texture *t, uint64_t time)
{
    if (t->history->asked_least == SLUICE_MIP_UNTOUCHED)
        return;
    t->seen = true;
    t->seen_time = time;
}

static void take_time(slc_manager *m, struct slc_managed_texture *t, uint64_t time,
                      uint64_t timeout)
{
    if (t->has_map && time != t->map_time) {
        t->interval = time - t->map_time;
        m->map_interval = t->interval;
    }
    t->timeout = timeout;
    t->has_map = true;
    t->map_time = time;
}

void slc_wants_commit(slc_manager *m, struct slc_managed_texture *t, uint64_t time,
                      uint64_t timeout, struct slc_move_log *log)
{
    m->events.reason = SLUICE_TILE_EVENT_FEEDBACK;
    if (t->nodes) {
        struct slc_history *h = t->history;
        bool held_before = t->held_regions > 0;
        m->bias.maps++;
        m->round.maps++;
        struct slc_range changed = slc_history_merge(m, t, time, timeout);
        bool same_bias = h->bias == m->bias.value;
        if (!same_bias)
            changed = (struct slc_range){0, (uint32_t)slc_padded(slc_region_count(t))};
        h->bias = m->bias.value;
        if (changed.end > 0 && settle(m, t, changed, held_before, log) && same_bias)
            m->bias.changed = true;
        slc_visit(m, t, t->held_regions > 0);
        take_sight(t, time);
        slc_state_release(m, t);
    }
    take_time(m, t, time, timeout);
}

void slc_wants_repeat(slc_manager *m, const struct slc_managed_texture *leader,
                      struct slc_managed_texture *t, uint64_t time, uint64_t timeout,
                      const struct slc_move_log *log)
{
    bool held_before = t->held_regions > 0;
    struct moves moves = {.count = 0};
    m->events.reason = SLUICE_TILE_EVENT_FEEDBACK;
    m->bias.maps++;
    m->round.maps++;
    t->held_regions = leader->held_regions;
    t->hits = leader->hits;
    t->returns = leader->returns;
    packed_before(m, t, held_before);
    for (uint32_t i = 0; i < log->count; i++)
        add_move(m, t, &moves, log->moves[i]);
    settle_moves(m, t, &moves);
    packed_after(m, t, held_before);
    slc_visit(m, t, t->held_regions > 0);
    take_sight(t, time);
    slc_state_release(m, t);
    take_time(m, t, time, timeout);
}

/** Makes all tiles of a texture unwanted. The caller drops the history afterwards. */
static void unwant_all(slc_manager *m, struct slc_managed_texture *t)
{
    struct moves moves = {.count = 0};
    const uint8_t *under = t->history->under;
    for (uint32_t l = 0; l < t->shape->desc.regularMipCount; l++) {
        const struct slc_level *grid = &t->shape->levels[l];
        uint32_t first = grid->first_tile, count = grid->width * grid->height;
        slc_block limit = slc_block_of((uint8_t)l);
        for (uint32_t i = 0; i < count; i += SLC_BLOCK) {
            uint32_t bits = ~slc_block_difference(at_most(slc_load_block(under + first + i), limit),
                                                  slc_block_of(255));
            bits &= count - i < SLC_BLOCK ? (1u << (count - i)) - 1 : 0xFFFF;
            for (; bits; bits &= bits - 1)
                add_move(m, t, &moves,
                         (struct slc_move){first + i + slc_lowest_bit(bits), (uint8_t)l, false});
        }
    }
    settle_moves(m, t, &moves);
}

void slc_wants_drop(slc_manager *m, struct slc_managed_texture *t)
{
    t->held_regions = 0;
    slc_visit(m, t, false);
    unwant_all(m, t);
    packed_after(m, t, true);
    slc_history_drop(m, t);
    slc_state_release(m, t);
}
