#include "core/history.h"

#include "base/alloc.h"
#include "base/bytes.h"
#include "base/checked.h"
#include "core/minmip.h"
#include "core/spares.h"

/*
 * A region has the finest level of all maps within the timeout. The maps themselves are not kept:
 * maps that are close in time share a span, which keeps their finest level per region. A span ends
 * a quarter of the timeout after it began, so few spans are alive. All work is on whole arrays of
 * bytes, so its cost does not depend on how often regions flicker between maps.
 */

/* Memory ------------------------------------------------------------------------------------ */

static size_t under_size(const struct slc_managed_texture *t)
{
    return (size_t)t->shape->regular_tile_count + SLC_BLOCK; /* blocks are read over the end */
}

static size_t texel_count(const struct slc_managed_texture *t)
{
    return (size_t)t->shape->min_mip_width * t->shape->min_mip_height;
}

/** Bytes of nodes, counts by level and MinMip map. */
static size_t state_size(const struct slc_shape *s)
{
    return (s->regular_tile_count + 2 * (size_t)s->desc.regularMipCount) * sizeof(uint32_t) +
           (size_t)s->min_mip_width * s->min_mip_height;
}

static size_t history_size(const struct slc_shape *s)
{
    return sizeof(struct slc_history) + 3 * slc_padded(s->region_count) + s->regular_tile_count +
           SLC_BLOCK;
}

SluiceResult slc_state_make(slc_manager *m, struct slc_managed_texture *t)
{
    if (t->nodes)
        return SLUICE_SUCCESS;
    /* 2^30 tiles of 6 bytes and regions of 3: more than 32 bits can address */
    if (9 * (uint64_t)SLUICE_MAX_TILES_PER_TEXTURE > SIZE_MAX / 2 &&
        t->shape->regular_tile_count + (uint64_t)slc_padded(slc_region_count(t)) > SIZE_MAX / 32)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    size_t counts = 2 * (size_t)t->shape->desc.regularMipCount;
    size_t nodes = (t->shape->regular_tile_count + counts) * sizeof *t->nodes;
    t->nodes = slc_spares_take(m, state_size(t->shape));
    if (!t->nodes)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    t->min_mip = (uint8_t *)(t->nodes + t->shape->regular_tile_count + counts);
    memset(t->nodes, 0, nodes);
    memset(t->min_mip, slc_min_mip_floor(t), texel_count(t));
    return SLUICE_SUCCESS;
}

static struct slc_history *create_history(slc_manager *m, const struct slc_managed_texture *t)
{
    size_t padded = slc_padded(slc_region_count(t)), under = under_size(t);
    struct slc_history *h = slc_spares_take(m, history_size(t->shape));
    if (!h)
        return NULL;
    *h = (struct slc_history){
        .users = 1, .bias = m->bias.value, .asked_least = SLUICE_MIP_UNTOUCHED};
    h->asked = (uint8_t *)(h + 1);
    h->known = h->asked + padded;
    h->least = h->known + padded;
    h->under = h->least + padded;
    memset(h->asked, SLUICE_MIP_UNTOUCHED, 3 * padded + under);
    return h;
}

static bool add_span_map(slc_manager *m, const struct slc_managed_texture *t, struct slc_history *h)
{
    if (h->span_count == SLC_MAX_SPANS || h->spans[h->span_count].map)
        return true;
    h->spans[h->span_count].map = slc_spares_take(m, slc_padded(slc_region_count(t)));
    return h->spans[h->span_count].map != NULL;
}

static void destroy_history(slc_manager *m, const struct slc_managed_texture *t,
                            struct slc_history *h)
{
    for (uint32_t i = 0; i < SLC_MAX_SPANS; i++)
        slc_spares_give(m, h->spans[i].map, slc_padded(slc_region_count(t)));
    slc_spares_give(m, h, history_size(t->shape));
}

/** Replaces a shared history by a copy of the texture's own. */
static SluiceResult copy_history(slc_manager *m, struct slc_managed_texture *t)
{
    struct slc_history *from = t->history, *h = create_history(m, t);
    size_t padded = slc_padded(slc_region_count(t));
    for (uint32_t i = 0; h && i < from->span_count; i++) {
        h->spans[i] = from->spans[i];
        h->spans[i].map = slc_spares_take(m, padded);
        if (!h->spans[i].map) {
            destroy_history(m, t, h);
            return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        }
        memcpy(h->spans[i].map, from->spans[i].map, padded);
    }
    if (!h)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    h->span_count = from->span_count;
    h->bias = from->bias;
    h->absence = from->absence;
    h->asked_least = from->asked_least;
    h->has_same_hits = from->has_same_hits;
    h->same_hits = from->same_hits;
    memcpy(h->asked, from->asked, 3 * padded + under_size(t));
    from->users--;
    t->history = h;
    return SLUICE_SUCCESS;
}

SluiceResult slc_history_make(slc_manager *m, struct slc_managed_texture *t, uint32_t users)
{
    SluiceResult result = slc_state_make(m, t);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!t->history)
        t->history = create_history(m, t);
    else if (t->history->users != users)
        result = copy_history(m, t);
    if (!t->history || result != SLUICE_SUCCESS || !add_span_map(m, t, t->history))
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    return SLUICE_SUCCESS;
}

void slc_history_share(struct slc_managed_texture *t, struct slc_history *history)
{
    assert(t->nodes && !t->history);
    t->history = history;
    history->users++;
}

void slc_history_drop(slc_manager *m, struct slc_managed_texture *t)
{
    struct slc_history *h = t->history;
    t->history = NULL;
    if (h && --h->users == 0)
        destroy_history(m, t, h);
}

void slc_state_destroy(slc_manager *m, struct slc_managed_texture *t)
{
    if (!t->nodes)
        return;
    slc_history_drop(m, t);
    slc_spares_give(m, t->nodes, state_size(t->shape));
    t->nodes = NULL;
    t->min_mip = NULL;
}

void slc_state_release(slc_manager *m, struct slc_managed_texture *t)
{
    /* No requests and no nodes: equal to a texture without a state, whose last map was empty. */
    if (t->nodes && t->held_regions == 0 && t->regular_nodes == 0)
        slc_state_destroy(m, t);
}

/* Spans ------------------------------------------------------------------------------------- */

/*
 * A map shows a sampled region with a chance q. A map that shows the region is a hit if the map
 * before it did, too, and a return if the map before it missed the region. So returns / hits
 * estimates x = (1 - q) / q. A camera that moves on makes no returns. n misses in a row have the
 * chance (1 - q)^n, and 14 (x + 1/2) >= ln(10^-6) / ln(1 - q).
 */
static uint32_t maps_to_believe(const slc_manager *m, const struct slc_managed_texture *t)
{
    if (m->config.missesToExpire)
        return m->config.missesToExpire;
    if (t->returns == 0)
        return 1;
    uint64_t maps = (uint64_t)14 * t->returns / (t->hits + 1) + 7;
    return maps < 4096 ? (uint32_t)maps : 4096;
}

static void count_returns(struct slc_managed_texture *t, uint32_t hits, uint32_t returns)
{
    size_t regions = slc_region_count(t);
    t->hits += hits;
    t->returns += returns;
    if (t->hits + t->returns >= (regions < 2048 ? 4096 : 2 * (uint64_t)regions)) {
        t->hits /= 2;
        t->returns /= 2;
        memcpy(t->history->known, t->history->least, slc_padded(regions));
        t->history->has_same_hits = false;
    }
}

/** Counts the hits of a map equal to the last one. */
static uint32_t same_hits(const struct slc_managed_texture *t)
{
    struct slc_history *h = t->history;
    size_t padded = slc_padded(slc_region_count(t));
    slc_block untouched = slc_block_of(SLUICE_MIP_UNTOUCHED);
    if (h->has_same_hits)
        return h->same_hits;
    h->has_same_hits = true;
    h->same_hits = 0;
    for (size_t i = 0; i < padded; i += SLC_BLOCK) {
        slc_block asked = slc_load_block(h->asked + i);
        uint32_t other = slc_block_difference(asked, slc_load_block(h->known + i));
        h->same_hits += slc_count_bits(slc_block_difference(asked, untouched) & ~other);
    }
    return h->same_hits;
}

static uint32_t add_weights(uint32_t a, uint32_t b)
{
    return a < UINT32_MAX - b ? a + b : UINT32_MAX;
}

/**
 * Misses that the last maps count as if all are empty: one per map and region with a request. A map
 * that is not empty resets the count to 0.
 */
static uint32_t absence(const struct slc_managed_texture *t, const uint8_t *map)
{
    if (!slc_bytes_are(map, slc_region_count(t), SLUICE_MIP_UNTOUCHED))
        return 0;
    return add_weights(t->history->absence, slc_max_u32(t->held_regions, 1));
}

/** log2 of the regions along the side of a tile of level 0; 0 if tiles are not whole regions. */
static uint32_t region_shift(const struct slc_managed_texture *t)
{
    uint8_t x = t->shape->region_shift_x, y = t->shape->region_shift_y;
    return x == SLC_UNALIGNED || y == SLC_UNALIGNED ? 0 : slc_min_u32(slc_min_u32(x, y), 8);
}

/** Finest level that a span no longer keeps. A tile of level w is seen by 4^(w + s) regions. */
static uint8_t first_unbelieved(uint32_t newer, uint32_t needed, uint32_t region_shift)
{
    uint8_t level = 0;
    for (needed >>= 2 * region_shift; needed > newer; needed >>= 2)
        level++;
    return level;
}

/** Finest levels of a block over all spans. */
static slc_block least_of_spans(const struct slc_history *h, size_t i)
{
    slc_block least = slc_load_block(h->spans[0].map + i);
    for (uint32_t k = 1; k < h->span_count; k++)
        least = slc_min_block(least, slc_load_block(h->spans[k].map + i));
    return least;
}

/** Sets a block of `least`, and counts the regions with a request. */
static void set_least(struct slc_managed_texture *t, size_t i, slc_block before, slc_block least,
                      struct slc_range *changed)
{
    slc_block untouched = slc_block_of(SLUICE_MIP_UNTOUCHED);
    if (!slc_block_difference(before, least))
        return;
    slc_store_block(t->history->least + i, least);
    slc_range_add(changed, (uint32_t)i, (uint32_t)i + SLC_BLOCK);
    t->held_regions += slc_count_bits(slc_block_difference(least, untouched));
    t->held_regions -= slc_count_bits(slc_block_difference(before, untouched));
}

/** Removes levels from `below` on from a span, and updates `least`. */
static void thin_span(struct slc_managed_texture *t, struct slc_span *span, uint8_t below,
                      struct slc_range *changed)
{
    const struct slc_history *h = t->history;
    size_t padded = slc_padded(slc_region_count(t));
    slc_block limit = slc_block_of(below), untouched = slc_block_of(SLUICE_MIP_UNTOUCHED);
    slc_block rest = untouched;
    for (size_t i = 0; i < padded; i += SLC_BLOCK) {
        slc_block v = slc_load_block(span->map + i);
        if (!slc_block_difference(v, untouched))
            continue;
        slc_block gone = slc_equal_block(slc_max_block(v, limit), v), left = v | gone;
        slc_store_block(span->map + i, left);
        rest &= left;
        /* other spans are searched only for levels that `least` had from this span */
        slc_block before = slc_load_block(h->least + i);
        slc_block lost = gone & slc_equal_block(v, before) & ~slc_equal_block(v, untouched);
        if (slc_block_difference(lost, slc_block_of(0)))
            set_least(t, i, before, least_of_spans(h, i), changed);
    }
    span->below = below;
    span->empty = slc_block_difference(rest, untouched) == 0;
}

static void drop_spans(struct slc_history *h, uint32_t count)
{
    struct slc_span old[SLC_MAX_SPANS];
    memcpy(old, h->spans, sizeof old);
    for (uint32_t i = 0; i < SLC_MAX_SPANS; i++)
        h->spans[i] = old[(i + count) % SLC_MAX_SPANS];
    h->span_count -= count;
}

/** Parameters of one merge, for the expiry of older maps. */
struct now {
    uint64_t time, timeout;
    uint32_t absence; ///< misses that the last maps count as, if they are empty
    uint32_t needed;  ///< misses after which a region is no longer wanted
};

/** Expires requests that timed out and that enough newer maps missed. */
static void lapse(struct slc_managed_texture *t, const struct now *now, struct slc_range *changed)
{
    struct slc_history *h = t->history;
    uint32_t shift = region_shift(t), newer = 1, dropped = 0;
    for (uint32_t i = h->span_count; i-- > 0;) {
        struct slc_span *span = &h->spans[i];
        uint32_t misses = slc_max_u32(newer, now->absence);
        bool over = now->time - span->end >= now->timeout;
        uint8_t below = first_unbelieved(misses, now->needed, shift);
        if (over && below < span->below)
            thin_span(t, span, below, changed);
        dropped = over && span->empty ? dropped + 1 : 0;
        newer = add_weights(newer, span->weight);
    }
    drop_spans(h, dropped); /* the oldest ones */
}

/** Adds the map to the newest span or to a new one. Returns whether the span is new. */
static bool join_span(struct slc_history *h, const struct now *now)
{
    struct slc_span *newest = h->span_count ? &h->spans[h->span_count - 1] : NULL;
    if (newest && (h->span_count == SLC_MAX_SPANS || now->time - newest->begin < now->timeout / 4 ||
                   slc_max_u32(newest->weight, now->absence) < now->needed / 4)) {
        newest->end = now->time;
        newest->weight = add_weights(newest->weight, 1);
        newest->below = SLUICE_MIP_UNTOUCHED;
        newest->empty = false;
        return false;
    }
    newest = &h->spans[h->span_count++];
    newest->begin = newest->end = now->time;
    newest->weight = 1;
    newest->below = SLUICE_MIP_UNTOUCHED;
    newest->empty = false;
    return true;
}

/* Merging ----------------------------------------------------------------------------------- */

static void merge(struct slc_managed_texture *t, const uint8_t *map, bool fresh,
                  struct slc_range *changed)
{
    struct slc_history *h = t->history;
    size_t padded = slc_padded(slc_region_count(t));
    uint8_t *asked = h->asked, *kept = h->least, *span = h->spans[h->span_count - 1].map;
    h->has_same_hits = false;
    slc_block untouched = slc_block_of(SLUICE_MIP_UNTOUCHED), finest = untouched;
    for (size_t i = 0; i < padded; i += SLC_BLOCK) {
        slc_block next = slc_load_block(map + i);
        finest = slc_min_block(finest, next);
        slc_store_block(asked + i, next);
        if (!slc_block_difference(next, untouched)) {
            if (fresh)
                slc_store_block(span + i, next);
            continue;
        }
        slc_store_block(span + i, fresh ? next : slc_min_block(slc_load_block(span + i), next));
        slc_store_block(h->known + i, slc_min_block(slc_load_block(h->known + i), next));
        slc_block before = slc_load_block(kept + i);
        set_least(t, i, before, slc_min_block(before, next), changed);
    }
    h->asked_least = SLUICE_MIP_UNTOUCHED;
    for (uint32_t i = 0; i < SLC_BLOCK; i++)
        h->asked_least = finest[i] < h->asked_least ? finest[i] : h->asked_least;
}

struct slc_range slc_history_merge(const slc_manager *m, struct slc_managed_texture *t,
                                   uint64_t time, uint64_t timeout)
{
    struct slc_history *h = t->history;
    const uint8_t *map = h->next ? h->next : h->asked;
    if (h->next)
        count_returns(t, h->hits, h->returns);
    else
        count_returns(t, same_hits(t), 0);
    h->absence = absence(t, map);
    struct now now = {
        .time = time, .timeout = timeout, .absence = h->absence, .needed = maps_to_believe(m, t)};
    struct slc_range changed = {0, 0};
    lapse(t, &now, &changed);
    /* the newest span contains a map equal to the last one, unless its levels were just removed */
    bool has_map =
        !h->next && h->span_count > 0 && h->spans[h->span_count - 1].below == SLUICE_MIP_UNTOUCHED;
    bool fresh = join_span(h, &now);
    if (!has_map)
        merge(t, map, fresh, &changed);
    else if (fresh)
        memcpy(h->spans[h->span_count - 1].map, map, slc_padded(slc_region_count(t)));
    return changed;
}

/* Asking ------------------------------------------------------------------------------------ */

/** Regions along one axis that touch the tiles [tile << level, (tile + 1) << level) of level 0. */
static void regions_under(uint32_t tile, uint32_t level, bool last, uint32_t tile_size,
                          uint32_t region_size, uint32_t region_count, uint32_t *first,
                          uint32_t *end)
{
    uint64_t begin = ((uint64_t)tile << level) * tile_size;
    uint64_t beyond = ((uint64_t)(tile + 1) << level) * tile_size;
    *first = (uint32_t)(begin / region_size);
    uint64_t regions = (beyond + region_size - 1) / region_size;
    *end = last || regions > region_count ? region_count : (uint32_t)regions;
}

/** True if one of `count` bytes is at most `limit`; a block may be read over the end. */
static bool any_at_most(const uint8_t *bytes, uint32_t count, uint32_t limit)
{
    slc_block limits = slc_block_of((uint8_t)limit), none = slc_block_of(0);
    for (uint32_t i = 0; i < count; i += SLC_BLOCK) {
        slc_block v = slc_load_block(bytes + i);
        uint32_t found = slc_block_difference(slc_equal_block(slc_min_block(v, limits), v), none);
        uint32_t inside = count - i < SLC_BLOCK ? (1u << (count - i)) - 1 : 0xFFFF;
        if (found & inside)
            return true;
    }
    return false;
}

/** True if the last map requests `level` or a finer one under the tiles `r` of that level. */
static bool is_asked_in(const struct slc_managed_texture *t, uint32_t level,
                        struct slc_tile_range r)
{
    const struct slc_shape *s = t->shape;
    const struct slc_level *grid = &s->levels[level];
    const SluiceStreamedTextureDesc *d = &s->desc;
    uint32_t x0, x1, y0, y1, inside;
    if (!t->history || t->history->asked_least > level)
        return false; /* saves the search where the camera has left: areas can be large */
    regions_under(r.x0, level, r.x0 + 1 == grid->width, d->tileWidth, d->feedbackRegionWidth,
                  s->feedback_width, &x0, &x1);
    regions_under(r.y0, level, r.y0 + 1 == grid->height, d->tileHeight, d->feedbackRegionHeight,
                  s->feedback_height, &y0, &y1);
    if (r.x1 > r.x0)
        regions_under(r.x1, level, r.x1 + 1 == grid->width, d->tileWidth, d->feedbackRegionWidth,
                      s->feedback_width, &inside, &x1);
    if (r.y1 > r.y0)
        regions_under(r.y1, level, r.y1 + 1 == grid->height, d->tileHeight, d->feedbackRegionHeight,
                      s->feedback_height, &inside, &y1);
    for (uint32_t y = y0; y < y1; y++)
        if (any_at_most(t->history->asked + (size_t)y * s->feedback_width + x0, x1 - x0, level))
            return true;
    return false;
}

bool slc_is_asked_for(const slc_manager *m, uint32_t node)
{
    const struct slc_node *n = slc_node_at(&m->residency, node);
    const struct slc_managed_texture *t = slc_texture_at(m, n->owner);
    if (n->tile >= t->shape->regular_tile_count)
        return true;
    struct slc_place p = slc_node_place(t, n);
    return is_asked_in(t, p.level, (struct slc_tile_range){p.x, p.y, p.x, p.y});
}

bool slc_is_seen(const slc_manager *m, uint32_t node)
{
    const struct slc_node *n = slc_node_at(&m->residency, node);
    const struct slc_managed_texture *t = slc_texture_at(m, n->owner);
    struct slc_place p = slc_node_place(t, n);
    /* one map misses nine tiles by chance as rarely as nine maps miss one tile; half of the misses
     * that end a request suffice here */
    if (first_unbelieved(18, maps_to_believe(m, t), region_shift(t)) > p.level)
        return true;
    const struct slc_level *grid = &t->shape->levels[p.level];
    return is_asked_in(t, p.level,
                       (struct slc_tile_range){p.x > 0 ? p.x - 1 : 0, p.y > 0 ? p.y - 1 : 0,
                                               slc_min_u32(p.x + 1, grid->width - 1),
                                               slc_min_u32(p.y + 1, grid->height - 1)});
}
