#include "core/wants.h"

#include "base/alloc.h"
#include "base/checked.h"

#include <stdlib.h>
#include <string.h>

/*
 * A region holds the least level of all maps within the timeout. Only the last map is kept whole.
 * Where a map asks for less than the one before, the finer level goes into a chain of decaying
 * levels of the region, newest and coarsest first; a map that asks for as much again ends those it
 * covers. All chains of a texture are threaded on one list by time, so that lapsing looks at
 * nothing that has not lapsed.
 */

static uint32_t region_count(const struct slc_texture *t)
{
    return t->feedback_width * t->feedback_height;
}

/* Memory ------------------------------------------------------------------------------------ */

static void free_state(slc_manager *m, const struct slc_texture *t, struct slc_texture_state *s)
{
    size_t regions = region_count(t), tiles = t->regular_tile_count;
    slc_free(&m->cb, s->want_counts, tiles, sizeof *s->want_counts);
    slc_free(&m->cb, s->nodes, tiles, sizeof *s->nodes);
    slc_free(&m->cb, s->decays, regions, sizeof *s->decays);
    slc_free(&m->cb, s->asked, regions, 1);
    slc_free(&m->cb, s->next_asked, regions, 1);
    slc_free(&m->cb, s->held, regions, 1);
    slc_free(&m->cb, s->min_mip, (size_t)t->min_mip_width * t->min_mip_height, 1);
    slc_free(&m->cb, s, 1, sizeof *s);
}

SluiceResult slc_make_state(slc_manager *m, struct slc_texture *t)
{
    if (t->state)
        return SLUICE_SUCCESS;
    struct slc_texture_state *s = slc_calloc(&m->cb, 1, sizeof *s);
    if (!s)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    size_t regions = region_count(t), tiles = t->regular_tile_count;
    size_t texels = (size_t)t->min_mip_width * t->min_mip_height;
    s->decays = slc_calloc(&m->cb, regions, sizeof *s->decays);
    s->asked = slc_alloc(&m->cb, regions, 1);
    s->next_asked = slc_alloc(&m->cb, regions, 1);
    s->held = slc_alloc(&m->cb, regions, 1);
    s->min_mip = slc_alloc(&m->cb, texels, 1);
    bool fits = s->decays && s->asked && s->next_asked && s->held && s->min_mip;
    if (tiles) {
        s->want_counts = slc_calloc(&m->cb, tiles, sizeof *s->want_counts);
        s->nodes = slc_calloc(&m->cb, tiles, sizeof *s->nodes);
        fits = fits && s->want_counts && s->nodes;
    }
    if (!fits) {
        free_state(m, t, s);
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    memset(s->asked, SLUICE_MIP_UNTOUCHED, regions);
    memset(s->held, SLUICE_MIP_UNTOUCHED, regions);
    memset(s->min_mip, slc_min_mip_floor(t), texels);
    t->state = s;
    return SLUICE_SUCCESS;
}

bool slc_reserve_decays(slc_manager *m, uint64_t count)
{
    uint64_t have = (uint64_t)m->free_decay_count + (m->decay_room - m->decay_end);
    if (count <= have)
        return true;
    uint64_t room = (uint64_t)m->decay_room * 2;
    if (room < m->decay_room + (count - have))
        room = m->decay_room + (count - have);
    if (room < 256)
        room = 256;
    if (room >= UINT32_MAX)
        return false;
    struct slc_decay *decays =
        slc_regrow(&m->cb, m->decays, m->decay_room, (size_t)room, sizeof *decays);
    if (!decays)
        return false;
    m->decays = decays;
    m->decay_room = (uint32_t)room;
    return true;
}

static bool reserve_changes(slc_manager *m, uint64_t count)
{
    if (count <= m->change_room)
        return true;
    size_t room = (size_t)(count < 1024 ? 1024 : count + count / 2);
    struct slc_change *changes = slc_alloc(&m->cb, room, sizeof *changes);
    if (!changes)
        return false;
    slc_free(&m->cb, m->changes, m->change_room, sizeof *changes);
    m->changes = changes;
    m->change_room = (uint32_t)room;
    return true;
}

SluiceResult slc_wants_reserve(slc_manager *m, const struct slc_wants_need *need)
{
    if (need->changes >= UINT32_MAX || !slc_reserve_nodes(m, need->nodes) ||
        !slc_reserve_decays(m, need->decays) || !reserve_changes(m, need->changes))
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    return SLUICE_SUCCESS;
}

/* Decaying levels --------------------------------------------------------------------------- */

static void decay_push(slc_manager *m, struct slc_texture_state *s, uint32_t region, uint8_t level,
                       uint64_t time)
{
    uint32_t d = m->free_decay;
    if (d) {
        m->free_decay = m->decays[d].next;
        m->free_decay_count--;
    } else {
        assert(m->decay_end < m->decay_room);
        d = m->decay_end++;
    }
    m->decays[d] = (struct slc_decay){.time = time,
                                      .region = region,
                                      .older = s->decays[region],
                                      .prev = s->decay_list.tail,
                                      .level = level};
    if (s->decay_list.tail)
        m->decays[s->decay_list.tail].next = d;
    else
        s->decay_list.head = d;
    s->decay_list.tail = d;
    s->decay_list.count++;
    s->decays[region] = d;
}

/** Off the time list and back to the pool; the caller has mended the region's chain. */
static void decay_free(slc_manager *m, struct slc_texture_state *s, uint32_t d)
{
    struct slc_decay *e = &m->decays[d];
    if (e->prev)
        m->decays[e->prev].next = e->next;
    else
        s->decay_list.head = e->next;
    if (e->next)
        m->decays[e->next].prev = e->prev;
    else
        s->decay_list.tail = e->prev;
    s->decay_list.count--;
    e->next = m->free_decay;
    m->free_decay = d;
    m->free_decay_count++;
}

/** A map asks for `level`: what decays at that level or a coarser one is covered by it. */
static void decay_cover(slc_manager *m, struct slc_texture_state *s, uint32_t region, uint8_t level)
{
    uint32_t d = s->decays[region];
    while (d && m->decays[d].level >= level) {
        uint32_t older = m->decays[d].older;
        decay_free(m, s, d);
        d = older;
    }
    s->decays[region] = d;
}

/** The oldest entry of its region lapses; it is at the end of the chain. */
static void decay_lapse(slc_manager *m, struct slc_texture_state *s, uint32_t d)
{
    uint32_t *link = &s->decays[m->decays[d].region];
    while (*link != d)
        link = &m->decays[*link].older;
    assert(m->decays[d].older == 0);
    *link = 0;
    decay_free(m, s, d);
}

void slc_state_destroy(slc_manager *m, struct slc_texture *t)
{
    if (!t->state)
        return;
    while (t->state->decay_list.head)
        decay_free(m, t->state, t->state->decay_list.head);
    free_state(m, t, t->state);
    t->state = NULL;
}

/* Preparing --------------------------------------------------------------------------------- */

static uint8_t wanted_level(const struct slc_texture *t, uint8_t asked)
{
    if (asked == SLUICE_MIP_UNTOUCHED)
        return asked;
    return asked < t->desc.regularMipCount ? asked : (uint8_t)t->desc.regularMipCount;
}

/** Skips equal bytes, eight at a time. Returns the first difference at or after `i`, or `end`. */
static size_t first_difference(const uint8_t *a, const uint8_t *b, size_t i, size_t end)
{
    while (i + 8 <= end) {
        uint64_t x, y;
        memcpy(&x, a + i, 8);
        memcpy(&y, b + i, 8);
        if (x != y)
            break;
        i += 8;
    }
    while (i < end && a[i] == b[i])
        i++;
    return i;
}

static uint64_t range_count(struct slc_tile_range r)
{
    return (uint64_t)(r.x1 - r.x0 + 1) * (r.y1 - r.y0 + 1);
}

void slc_wants_add_need(const struct slc_texture *t, struct slc_wants_need *need)
{
    const struct slc_texture_state *s = t->state;
    size_t regions = region_count(t);
    uint64_t nodes = 0;
    for (size_t i = first_difference(s->asked, s->next_asked, 0, regions); i < regions;
         i = first_difference(s->asked, s->next_asked, i + 1, regions)) {
        need->changes++;
        need->decays++;
        uint32_t held = slc_min_u32(s->held[i], t->desc.regularMipCount);
        for (uint32_t l = wanted_level(t, s->next_asked[i]); l < held; l++)
            nodes += range_count(slc_region_tiles(t, (uint32_t)i, l));
    }
    need->nodes += nodes < t->regular_tile_count ? nodes : t->regular_tile_count;
    if (t->held_regions == 0)
        need->nodes += t->desc.packedTileCount;
    need->changes += s->decay_list.count;
}

/** One table for all 256 texels: clamping and bias are the same everywhere. */
static void make_asked_table(const struct slc_texture *t, const SluiceFeedbackDesc *f,
                             uint8_t table[256])
{
    int64_t last = (int64_t)t->desc.mipLevelCount - 1, lowest = 0;
    if (f->streamedMipLevels && f->streamedMipLevels < t->desc.regularMipCount)
        lowest = (int64_t)(t->desc.regularMipCount - f->streamedMipLevels);
    for (int v = 0; v < 255; v++) {
        int64_t asked = (v < last ? v : last) + (int64_t)f->mipBias;
        asked = asked < lowest ? lowest : asked;
        table[v] = (uint8_t)(asked > last ? last : asked);
    }
    table[SLUICE_MIP_UNTOUCHED] = SLUICE_MIP_UNTOUCHED;
}

static bool is_empty_map(const uint8_t *map, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (map[i] != SLUICE_MIP_UNTOUCHED)
            return false;
    return true;
}

SluiceResult slc_wants_prepare(slc_manager *m, struct slc_texture *t,
                               const SluiceFeedbackDesc *feedback, struct slc_wants_need *need)
{
    size_t regions = region_count(t);
    if (!t->state && is_empty_map(feedback->pMinMip, regions))
        return SLUICE_SUCCESS;
    SluiceResult result = slc_make_state(m, t);
    if (result != SLUICE_SUCCESS)
        return result;
    uint8_t table[256];
    make_asked_table(t, feedback, table);
    for (size_t i = 0; i < regions; i++)
        t->state->next_asked[i] = table[feedback->pMinMip[i]];
    slc_wants_add_need(t, need);
    return SLUICE_SUCCESS;
}

/* Committing -------------------------------------------------------------------------------- */

static void add_want(slc_manager *m, struct slc_texture *t, struct slc_place p, uint32_t held)
{
    for (;;) {
        uint32_t tile = slc_tile_index(t, p);
        if (t->state->want_counts[tile]++ != 0)
            return;
        slc_tile_wanted(m, t, tile, p.level, p.level - held);
        if (p.level + 1 >= t->desc.regularMipCount)
            return;
        p = slc_parent_place(t, p);
    }
}

static void drop_want(slc_manager *m, struct slc_texture *t, struct slc_place p)
{
    for (;;) {
        uint32_t tile = slc_tile_index(t, p);
        assert(t->state->want_counts[tile] > 0);
        if (--t->state->want_counts[tile] != 0)
            return;
        slc_tile_unwanted(m, t, tile);
        if (p.level + 1 >= t->desc.regularMipCount)
            return;
        p = slc_parent_place(t, p);
    }
}

static void packed_wanted(slc_manager *m, struct slc_texture *t)
{
    for (uint32_t i = 0; i < t->desc.packedTileCount; i++)
        slc_tile_wanted(m, t, t->regular_tile_count + i, t->desc.regularMipCount, 0);
}

static void packed_unwanted(slc_manager *m, struct slc_texture *t)
{
    for (uint32_t i = 0; i < t->desc.packedTileCount; i++)
        slc_tile_unwanted(m, t, t->regular_tile_count + i);
}

/** Notes the region once, with what it held before the call. */
static void note_change(slc_manager *m, uint32_t *count, uint32_t region, uint8_t old_held)
{
    m->changes[(*count)++] = (struct slc_change){region, old_held};
}

/** The least of what the last map asks for and what decays. */
static uint8_t least_level(const slc_manager *m, const struct slc_texture *t, uint32_t region)
{
    uint8_t least = wanted_level(t, t->state->asked[region]);
    for (uint32_t d = t->state->decays[region]; d; d = m->decays[d].older)
        if (m->decays[d].level < least)
            least = m->decays[d].level;
    return least;
}

/** Takes the new map for the last one. Notes regions whose held level may change. */
static uint32_t merge_map(slc_manager *m, struct slc_texture *t)
{
    struct slc_texture_state *s = t->state;
    size_t regions = region_count(t);
    uint32_t count = 0;
    for (size_t i = first_difference(s->asked, s->next_asked, 0, regions); i < regions;
         i = first_difference(s->asked, s->next_asked, i + 1, regions)) {
        uint8_t before = wanted_level(t, s->asked[i]), after = wanted_level(t, s->next_asked[i]);
        s->asked[i] = s->next_asked[i];
        if (before == after)
            continue;
        if (after < before)
            decay_cover(m, s, (uint32_t)i, after);
        else
            decay_push(m, s, (uint32_t)i, before, t->map_time);
        if (after < s->held[i]) {
            note_change(m, &count, (uint32_t)i, s->held[i]);
            s->held[i] = after;
        }
    }
    return count;
}

static int by_region(const void *a, const void *b)
{
    uint32_t x = ((const struct slc_change *)a)->region, y = ((const struct slc_change *)b)->region;
    return x < y ? -1 : x > y;
}

/** Lets levels lapse. Notes regions whose held level changes; sorts all notes by region. */
static uint32_t lapse(slc_manager *m, struct slc_texture *t, uint64_t time, uint64_t timeout,
                      uint32_t count)
{
    struct slc_texture_state *s = t->state;
    uint32_t merged = count;
    while (s->decay_list.head && time - m->decays[s->decay_list.head].time >= timeout) {
        uint32_t region = m->decays[s->decay_list.head].region;
        decay_lapse(m, s, s->decay_list.head);
        uint8_t least = least_level(m, t, region);
        if (least == s->held[region])
            continue;
        note_change(m, &count, region, s->held[region]);
        s->held[region] = least;
    }
    if (count > merged)
        qsort(m->changes, count, sizeof *m->changes, by_region);
    return count;
}

/** One note per region, with the oldest level; those that end as they began go. */
static uint32_t unite_changes(slc_manager *m, const struct slc_texture *t, uint32_t count)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count;) {
        struct slc_change c = m->changes[i];
        /* Of several lapses in one call the finest level was held first. */
        for (i++; i < count && m->changes[i].region == c.region; i++)
            if (m->changes[i].old_held < c.old_held)
                c.old_held = m->changes[i].old_held;
        if (c.old_held != t->state->held[c.region])
            m->changes[kept++] = c;
    }
    return kept;
}

static void apply_wants(slc_manager *m, struct slc_texture *t, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t region = m->changes[i].region, level = t->state->held[region];
        if (level >= t->desc.regularMipCount)
            continue;
        struct slc_tile_range r = slc_region_tiles(t, region, level);
        for (uint32_t y = r.y0; y <= r.y1; y++)
            for (uint32_t x = r.x0; x <= r.x1; x++)
                add_want(m, t, (struct slc_place){level, x, y}, level);
    }
}

static void apply_drops(slc_manager *m, struct slc_texture *t, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t region = m->changes[i].region, level = m->changes[i].old_held;
        if (level >= t->desc.regularMipCount)
            continue;
        struct slc_tile_range r = slc_region_tiles(t, region, level);
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

void slc_wants_commit(slc_manager *m, struct slc_texture *t, uint64_t time, uint64_t timeout)
{
    if (t->state) {
        uint32_t held_before = t->held_regions;
        uint32_t count = merge_map(m, t);
        count = lapse(m, t, time, timeout, count);
        count = unite_changes(m, t, count);
        count_held_regions(m, t, count);
        bool packed_move = !m->info.alwaysMapPackedTiles;
        if (packed_move && held_before == 0 && t->held_regions > 0)
            packed_wanted(m, t);
        apply_wants(m, t, count);
        apply_drops(m, t, count);
        if (packed_move && held_before > 0 && t->held_regions == 0)
            packed_unwanted(m, t);
        /* Nothing held and nothing left: the last map was empty, which is what no state means. */
        if (t->held_regions == 0 && t->regular_nodes == 0)
            slc_state_destroy(m, t);
    }
    t->has_map = true;
    t->map_time = time;
}
