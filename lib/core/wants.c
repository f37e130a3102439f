#include "core/wants.h"

#include "base/alloc.h"
#include "base/bytes.h"
#include "base/checked.h"
#include "core/history.h"

#include <string.h>

/* Room -------------------------------------------------------------------------------------- */

SluiceResult slc_wants_reserve_scratch(slc_manager *m, uint64_t bytes, size_t largest)
{
    bytes += largest; /* for the bias */
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

static bool reserve_changes(slc_manager *m, size_t count)
{
    if (count <= m->change_room)
        return true;
    size_t room = count < 1024 ? 1024 : count;
    struct slc_change *changes = slc_alloc(&m->cb, room, sizeof *changes);
    if (!changes)
        return false;
    slc_free(&m->cb, m->changes, m->change_room, sizeof *changes);
    m->changes = changes;
    m->change_room = (uint32_t)room; /* a map has at most 2^30 regions */
    return true;
}

SluiceResult slc_wants_reserve(slc_manager *m, const struct slc_wants_need *need)
{
    return slc_reserve_nodes(m, need->nodes) && reserve_changes(m, need->regions)
               ? SLUICE_SUCCESS
               : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
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
    if (padded > need->regions)
        need->regions = padded;
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

static void add_want(slc_manager *m, struct slc_texture *t, struct slc_place p, uint32_t held)
{
    for (;;) {
        uint32_t tile = slc_tile_index(t, p);
        struct slc_cell *cell = &t->state->cells[tile];
        if (cell->wants++ != 0)
            return;
        slc_tile_wanted(m, t, &cell->node, tile, p.level, p.level - held);
        if (p.level + 1 >= t->desc.regularMipCount)
            return;
        p = slc_parent_place(t, p);
    }
}

static void drop_want(slc_manager *m, struct slc_texture *t, struct slc_place p)
{
    for (;;) {
        struct slc_cell *cell = &t->state->cells[slc_tile_index(t, p)];
        assert(cell->wants > 0);
        if (--cell->wants != 0)
            return;
        slc_tile_unwanted(m, cell->node);
        if (p.level + 1 >= t->desc.regularMipCount)
            return;
        p = slc_parent_place(t, p);
    }
}

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

/** Region numbers in ascending order to columns and rows without division. */
struct row_walk {
    uint32_t y, begin;
};

static struct slc_tile_range tiles_of(const struct slc_texture *t, struct row_walk *row,
                                      uint32_t region, uint32_t level)
{
    if (t->region_shift_x == SLC_UNALIGNED || t->region_shift_y == SLC_UNALIGNED)
        return slc_region_tiles(t, region, level);
    while (region - row->begin >= t->feedback_width) {
        row->begin += t->feedback_width;
        row->y++;
    }
    const struct slc_level *grid = &t->levels[level];
    uint32_t x = (region - row->begin) >> (level + t->region_shift_x);
    uint32_t y = row->y >> (level + t->region_shift_y);
    x = slc_min_u32(x, grid->width - 1);
    y = slc_min_u32(y, grid->height - 1);
    return (struct slc_tile_range){x, y, x, y};
}

static void apply_wants(slc_manager *m, struct slc_texture *t, uint32_t count)
{
    struct row_walk row = {0};
    for (uint32_t i = 0; i < count; i++) {
        uint32_t region = m->changes[i].region, level = t->state->held[region];
        if (level >= t->desc.regularMipCount)
            continue;
        struct slc_tile_range r = tiles_of(t, &row, region, level);
        for (uint32_t y = r.y0; y <= r.y1; y++)
            for (uint32_t x = r.x0; x <= r.x1; x++)
                add_want(m, t, (struct slc_place){level, x, y}, level);
    }
}

static void apply_drops(slc_manager *m, struct slc_texture *t, uint32_t count)
{
    struct row_walk row = {0};
    for (uint32_t i = 0; i < count; i++) {
        uint32_t region = m->changes[i].region, level = m->changes[i].old_held;
        if (level >= t->desc.regularMipCount)
            continue;
        struct slc_tile_range r = tiles_of(t, &row, region, level);
        for (uint32_t y = r.y0; y <= r.y1; y++)
            for (uint32_t x = r.x0; x <= r.x1; x++)
                drop_want(m, t, (struct slc_place){level, x, y});
    }
}

static void count_held_regions(slc_manager *m, struct slc_texture *t, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        bool before = m->changes[i].old_held != SLUICE_MIP_UNTOUCHED;
        bool after = t->state->held[m->changes[i].region] != SLUICE_MIP_UNTOUCHED;
        t->held_regions += (uint32_t)after - (uint32_t)before;
    }
}

/** The regions in m->changes hold something else now. */
static void apply_changes(slc_manager *m, struct slc_texture *t, uint32_t count)
{
    uint32_t held_before = t->held_regions;
    count_held_regions(m, t, count);
    bool packed_move = !m->info.alwaysMapPackedTiles;
    if (packed_move && held_before == 0 && t->held_regions > 0)
        packed_wanted(m, t);
    apply_wants(m, t, count);
    apply_drops(m, t, count);
    if (packed_move && held_before > 0 && t->held_regions == 0)
        packed_unwanted(m, t);
}

void slc_wants_commit(slc_manager *m, struct slc_texture *t, uint64_t time, uint64_t timeout)
{
    if (t->state) {
        m->bias_maps++;
        uint32_t count = slc_history_merge(m, t, time, timeout);
        if (count)
            apply_changes(m, t, count);
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
