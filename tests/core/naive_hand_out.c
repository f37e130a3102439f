/* sluiceGetTilesToMap: the sections "The request queue", "Handing out" and "Prefetching". */
#include "core/naive_manager.h"

#include <stdlib.h>
#include <string.h>

#define MAX_PREFETCH_TEXTURES 256u

static uint32_t min_u32(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static uint64_t max_u64(uint64_t a, uint64_t b)
{
    return a > b ? a : b;
}

/* A heap for packed tiles stays one until it is empty. */
static void note_empty_heaps(struct naive_manager *n)
{
    for (uint32_t i = 0; i < n->heap_count; i++)
        if (naive_count_slots(n, &n->heaps[i], NAIVE_SLOT_FREE) == n->capacity)
            n->heaps[i].packed = false;
}

/* Returns the heap for regular tiles with the fewest free slots, or with the most. NULL: all are
 * full. */
static struct naive_heap *regular_heap(const struct naive_manager *n, bool fullest)
{
    struct naive_heap *best = NULL;
    uint32_t best_free = 0;
    for (uint32_t i = 0; i < n->heap_count; i++) {
        uint32_t free_slots = naive_count_slots(n, &n->heaps[i], NAIVE_SLOT_FREE);
        if (!n->heaps[i].packed && free_slots > 0 &&
            (!best || (fullest ? free_slots < best_free : free_slots > best_free))) {
            best = &n->heaps[i];
            best_free = free_slots;
        }
    }
    return best;
}

static struct naive_heap *empty_heap(const struct naive_manager *n)
{
    struct naive_heap *heap = regular_heap(n, false);
    return heap && naive_count_slots(n, heap, NAIVE_SLOT_FREE) == n->capacity ? heap : NULL;
}

/* Returns the first heap for packed tiles with a free slot, or NULL. */
static struct naive_heap *packed_heap(const struct naive_manager *n)
{
    struct naive_heap *best = NULL;
    for (uint32_t i = 0; i < n->heap_count; i++)
        if (n->heaps[i].packed && naive_count_slots(n, &n->heaps[i], NAIVE_SLOT_FREE) > 0 &&
            (!best || n->heaps[i].number < best->number))
            best = &n->heaps[i];
    return best;
}

static bool is_separate(const struct naive_manager *n, const struct naive_tile *tile)
{
    return tile->packed && n->config.separatePackedTiles;
}

/* Returns a heap from which the rules allow to take a slot. There is a free slot. */
static const struct naive_heap *choose_heap(struct naive_manager *n, const struct naive_tile *tile)
{
    struct naive_heap *heap = packed_heap(n), *regular = regular_heap(n, true);
    const bool separate = is_separate(n, tile);
    n->events[NAIVE_SEPARATED] += separate && !heap && empty_heap(n);
    n->events[NAIVE_MIXED] += separate ? !heap && !empty_heap(n) : !regular;
    if (!separate)
        return regular && !(heap && naive_surplus(n)) ? regular : heap;
    if (heap)
        return heap;
    return empty_heap(n) ? empty_heap(n) : regular;
}

static uint32_t lowest_free_number(const struct naive_manager *n)
{
    uint32_t number = 0;
    for (uint32_t i = 0; i < n->heap_count; i++)
        if (n->heaps[i].number == number) {
            number++;
            i = UINT32_MAX; /* from the start again */
        }
    return number;
}

/* Takes the next heap answer of the other manager. */
static void ask_for_heap(struct naive_manager *n, const struct outcome *seen, struct outcome *out)
{
    n->heap_refused = true;
    if (out->answer_count == seen->answer_count) {
        naive_complain(n, "the heap allocator should have been asked once more");
        return;
    }
    struct heap_answer answer = seen->answers[out->answer_count++];
    if (answer.result != SLUICE_SUCCESS || naive_find_heap(n, answer.id))
        return;
    n->heap_refused = false;
    n->heaps = realloc(n->heaps, (n->heap_count + 1) * sizeof *n->heaps);
    if (!n->heaps)
        abort();
    const uint32_t number = lowest_free_number(n);
    n->heaps[n->heap_count++] = (struct naive_heap){
        answer.id, number, naive_alloc(n->capacity, sizeof(struct naive_slot)), false};
}

/* Takes the slot that the other manager took for its tile number `i`, if the rules allow it. */
static void take_slot(struct naive_manager *n, const struct outcome *seen, uint32_t i,
                      struct naive_tile *tile)
{
    const struct naive_heap *best = choose_heap(n, tile);
    const uint32_t free_slots = naive_count_slots(n, best, NAIVE_SLOT_FREE);
    if (i >= seen->count) {
        naive_complain(n, "tile %u of the list is missing", i);
        return;
    }
    const SluiceTile *other = &seen->tiles[i];
    struct naive_heap *heap = naive_find_heap(n, other->heapId);
    if (!heap || other->slot >= n->capacity) {
        naive_complain(n, "tile %u: no slot %u in heap %u", i, other->slot, other->heapId);
        return;
    }
    if (heap->slots[other->slot].use != NAIVE_SLOT_FREE)
        naive_complain(n, "tile %u: slot %u of heap %u is not free", i, other->slot, heap->id);
    if (heap->packed != best->packed || (best->packed && heap != best) ||
        naive_count_slots(n, heap, NAIVE_SLOT_FREE) != free_slots)
        naive_complain(n, "tile %u: a slot of heap %u was due, or of an equal one, not of %u", i,
                       best->id, heap->id);
    if (is_separate(n, tile) && free_slots == n->capacity)
        heap->packed = true;
    tile->heap = other->heapId;
    tile->slot = other->slot;
    heap->slots[other->slot].use = NAIVE_SLOT_USED;
}

/* Hands out one tile. Complains and returns false if the other manager could not have done so. */
static bool hand_out(struct naive_manager *n, struct naive_texture *t, struct naive_tile *tile,
                     const struct outcome *seen, struct outcome *out)
{
    if (tile->outside && out->count >= seen->count)
        naive_complain(n, "tile %u of the list is missing", out->count);
    else if (!tile->outside)
        take_slot(n, seen, out->count, tile);
    if (n->complaint[0])
        return false;
    n->totals.handedOutTotal++;
    out->tiles[out->count++] = naive_tile_info(t, (uint32_t)(tile - t->tiles));
    return true;
}

static bool slot_for(struct naive_manager *n, bool packed)
{
    return naive_count_all(n, NAIVE_SLOT_FREE) > (packed ? 0 : naive_kept(n));
}

static bool may_have_more_heaps(const struct naive_manager *n)
{
    const uint32_t most = n->config.maxHeapCount, target = n->config.targetHeapCount;
    return (most == 0 || n->heap_count < most) && (target == 0 || n->heap_count < target);
}

/* Returns the slots that a call for one texture must leave to coarser requests, if no more heaps
 * are available. */
static uint32_t owed_slots(const struct naive_manager *n, const struct call *call,
                           const struct naive_tile *tile)
{
    const bool more = may_have_more_heaps(n);
    if (call->texture == SLUICE_ALL_TEXTURES || tile->packed || (more && !n->heap_refused))
        return 0;
    uint32_t count, owed = 0;
    struct naive_ref *refs = naive_collect(n, NULL, SLUICE_TILE_STATE_REQUESTED, &count);
    for (uint32_t i = 0; i < count; i++)
        owed += !refs[i].tile->packed && refs[i].tile->level > tile->level;
    free(refs);
    return owed;
}

static bool find_slot(struct naive_manager *n, const struct call *call,
                      const struct naive_tile *tile, bool *refused, const struct outcome *seen,
                      struct outcome *out)
{
    if (tile->outside)
        return true;
    const uint32_t owed = owed_slots(n, call, tile);
    const bool may_take = tile->packed ? naive_count_all(n, NAIVE_SLOT_FREE) > 0
                                       : naive_count_all(n, NAIVE_SLOT_FREE) > naive_kept(n) + owed;
    const bool own_kind = is_separate(n, tile)
                              ? packed_heap(n) || empty_heap(n)
                              : regular_heap(n, true) || (packed_heap(n) && naive_surplus(n));
    if (may_take && own_kind)
        return true;
    n->events[NAIVE_SLOT_OWED] += !may_take && slot_for(n, tile->packed);
    if (!*refused && may_have_more_heaps(n)) {
        ask_for_heap(n, seen, out);
        *refused = n->heap_refused;
        if (!*refused)
            return true;
    }
    if (may_take)
        return true;
    n->events[NAIVE_RESERVE_KEPT] += slot_for(n, true);
    return false;
}

bool naive_is_passed_over(const struct naive_manager *n, const struct naive_ref *ref)
{
    const struct naive_tile *tile = ref->tile;
    return n->starved && !tile->packed &&
           ref->texture->last_wishes[tile - ref->texture->tiles] > tile->level;
}

/* Returns the texture with the oldest last map, among textures that hold anything. */
static struct naive_texture *oldest_texture(struct naive_manager *n)
{
    struct naive_texture *oldest = NULL;
    for (uint32_t i = 0; i < n->texture_room; i++) {
        struct naive_texture *t = n->textures[i];
        if (t && naive_holds_anything(t) && (!oldest || t->map_stamp < oldest->map_stamp))
            oldest = t;
    }
    return oldest;
}

static bool is_idle(const struct naive_manager *n, const struct naive_texture *t)
{
    const uint64_t age = n->time - t->map_time;
    const uint64_t k = t->interval == 0 ? 16 : 4;
    return age > 0 && age / k >= max_u64(t->map_timeout, max_u64(t->interval, n->usual));
}

void naive_drop_wants(struct naive_manager *n, struct naive_texture *t)
{
    naive_forget_history(t);
    const size_t regions = (size_t)t->layout.feedbackWidth * t->layout.feedbackHeight;
    memset(t->last_asked, SLUICE_MIP_UNTOUCHED, regions);
    memset(t->held, SLUICE_MIP_UNTOUCHED, regions);
    naive_apply_held(n, t);
    n->bias.scene_changed = true;
}

void naive_count_standby(const struct naive_manager *n, uint32_t *listed, uint32_t *unlisted)
{
    uint32_t standby;
    struct naive_ref *refs = naive_collect(n, NULL, SLUICE_TILE_STATE_STANDBY, &standby);
    *listed = *unlisted = 0;
    for (uint32_t i = 0; i < standby; i++) {
        *listed += !refs[i].tile->outside && refs[i].tile->listed;
        *unlisted += !refs[i].tile->outside && !refs[i].tile->listed;
    }
    free(refs);
}

/* Call when the list has room for `unserved` requests, but no slot is free. Returns whether a
 * texture was forgotten. */
static bool make_room(struct naive_manager *n, uint64_t unserved)
{
    const uint32_t reserved = naive_kept(n), free_slots = naive_count_all(n, NAIVE_SLOT_FREE);
    const uint64_t needed = unserved + (reserved > free_slots ? reserved - free_slots : 0);
    const uint64_t retiring = naive_count_all(n, NAIVE_SLOT_RETIRING);
    uint32_t listed, unlisted;
    bool forgot = false;
    naive_count_standby(n, &listed, &unlisted);
    while (listed + retiring + unlisted < needed) {
        struct naive_texture *t = oldest_texture(n);
        if (!t || !is_idle(n, t))
            break;
        naive_drop_wants(n, t);
        n->events[NAIVE_FORGOTTEN]++;
        forgot = true;
        naive_count_standby(n, &listed, &unlisted);
    }
    if (needed > listed + retiring) {
        const uint64_t more = needed - listed - retiring;
        naive_list_standby(n, more < unlisted ? unlisted - more : 0);
    }
    return forgot;
}

static void end_round(struct naive_manager *n)
{
    if (n->round.maps == 0 || n->round.maps < naive_count_holding(n))
        return;
    struct naive_round *r = &n->round;
    r->maps = 0;
    r->waited = r->began;
    r->began = n->stamp;
    if (++r->count % 4 == 0) {
        r->waited_long = r->began_long;
        r->began_long = n->stamp;
    }
}

static struct naive_ref *request_queue(const struct naive_manager *n,
                                       const struct naive_texture *only, uint32_t *count)
{
    struct naive_ref *refs = naive_collect(n, only, SLUICE_TILE_STATE_REQUESTED, count);
    for (uint32_t i = 0; i < *count; i++) {
        const struct naive_tile *tile = refs[i].tile;
        uint64_t *key = refs[i].key;
        key[0] = tile->outside ? 0 : tile->packed ? 1 : 2;
        key[1] = tile->packed ? 0 : SLUICE_MAX_MIP_LEVELS - tile->level;
        key[2] = tile->packed ? 0 : 64 - tile->need;
        key[3] = tile->requested_at;
    }
    naive_sort(refs, *count);
    return refs;
}

/* Returns whether handing out stopped for lack of slots. `*stopped_at`: number of that request. */
static bool hand_out_requests(struct naive_manager *n, const struct call *call,
                              const struct naive_ref *refs, uint32_t count,
                              const struct outcome *seen, struct outcome *out, uint32_t *stopped_at)
{
    uint32_t passed_over = 0;
    bool refused = false;
    for (uint32_t i = 0; i < count && out->count < call->room; i++) {
        struct naive_tile *tile = refs[i].tile;
        if (naive_is_passed_over(n, &refs[i])) {
            n->events[NAIVE_PASSED_OVER]++;
            if (++passed_over == NAIVE_MAX_PASSED_OVER)
                return false;
            continue;
        }
        *stopped_at = i;
        if (!find_slot(n, call, tile, &refused, seen, out))
            return true;
        tile->state = SLUICE_TILE_STATE_ALLOCATED;
        if (!hand_out(n, refs[i].texture, tile, seen, out))
            return false;
    }
    return false;
}

static uint32_t count_canceled(const struct naive_manager *n)
{
    uint32_t all, count = 0;
    struct naive_ref *refs = naive_collect(n, NULL, SLUICE_TILE_STATE_CANCELED, &all);
    for (uint32_t i = 0; i < all; i++)
        count += !refs[i].tile->outside;
    free(refs);
    return count;
}

/* Returns whether one more tile may be handed out. If not, tells whether room or host memory is
 * lacking. */
static bool may_prefetch(struct naive_manager *n, const struct call *call,
                         const struct outcome *seen, const struct outcome *out, bool *cut_short)
{
    uint32_t listed, unlisted, canceled = count_canceled(n);
    naive_count_standby(n, &listed, &unlisted);
    *cut_short = out->count == call->room;
    if (*cut_short || unlisted + canceled >= n->config.numExtraStandbyTiles || !slot_for(n, false))
        return false;
    *cut_short = seen->memory_refused && out->count == seen->count;
    return !*cut_short;
}

/* Returns whether prefetching continues. */
static bool prefetch_level(struct naive_manager *n, struct naive_texture *t,
                           const struct call *call, const struct outcome *seen, struct outcome *out,
                           bool *cut_short)
{
    for (uint32_t i = 0; i < t->layout.regularTileCount; i++) {
        struct naive_tile *tile = &t->tiles[i];
        if (tile->level + 1 + n->prefetch_level != t->layout.desc.regularMipCount ||
            tile->state != SLUICE_TILE_STATE_FREE)
            continue;
        if (!may_prefetch(n, call, seen, out, cut_short))
            return false;
        tile->state = SLUICE_TILE_STATE_CANCELED;
        tile->cancel_handed_out = true;
        if (!hand_out(n, t, tile, seen, out))
            return false;
        n->events[NAIVE_PREFETCHED]++;
    }
    return true;
}

/* Returns whether prefetching was cut short. */
static bool prefetch(struct naive_manager *n, const struct call *call, const struct outcome *seen,
                     struct outcome *out)
{
    bool cut_short = false;
    for (uint32_t i = min_u32(MAX_PREFETCH_TEXTURES, n->texture_room); i > 0; i--) {
        if (n->prefetch_index >= n->texture_room) {
            n->prefetch_index = 0;
            n->prefetch_level++;
        }
        if (n->prefetch_level >= n->config.prefetchLevels)
            n->prefetch_level = 0;
        struct naive_texture *t = n->textures[n->prefetch_index];
        if (t && !prefetch_level(n, t, call, seen, out, &cut_short))
            return cut_short;
        n->prefetch_index++;
    }
    return false;
}

SluiceResult naive_tiles_to_map(struct naive_manager *n, const struct call *call,
                                const struct outcome *seen, struct outcome *out)
{
    struct naive_texture *only;
    SluiceResult result = naive_check_list(n, call, &only);
    if (result != SLUICE_SUCCESS)
        return result;
    uint32_t count;
    note_empty_heaps(n);
    struct naive_ref *refs = request_queue(n, only, &count);
    if (call->null == NULL_SECOND) {
        out->count = count;
        free(refs);
        return SLUICE_SUCCESS;
    }
    naive_look_at_bias(n);
    n->events[NAIVE_BIAS_ABOVE_0] += n->bias.value > 0;
    uint32_t stopped_at = 0;
    const bool stopped = hand_out_requests(n, call, refs, count, seen, out, &stopped_at);
    n->events[NAIVE_STARVED] += stopped && !n->starved;
    if (call->room)
        n->starved = stopped;
    const uint32_t unserved = count - out->count;
    result = out->count < count ? SLUICE_INCOMPLETE : SLUICE_SUCCESS;
    if (!only && n->config.prefetchLevels && out->count == count && prefetch(n, call, seen, out))
        result = SLUICE_INCOMPLETE;
    end_round(n);
    const bool evicts = stopped && !n->config.noEviction;
    if (evicts || naive_surplus(n)) {
        if (!make_room(n, evicts ? unserved : 0))
            naive_evict_for(n, refs ? refs + stopped_at : NULL, count - stopped_at,
                            evicts ? unserved : 0);
    }
    if (stopped)
        result = SLUICE_BUDGET_REACHED;
    free(refs);
    return result;
}
