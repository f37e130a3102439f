/* The lists that are handed out. */
#include "core/naive_manager.h"

#include <stdlib.h>

static uint32_t min_u32(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

/* Checks what all list calls have in common; *only is NULL for all textures. */
static SluiceResult check_list(struct naive_manager *n, const struct call *call,
                               struct naive_texture **only)
{
    SluiceResult result;
    *only = NULL;
    if (call->null == NULL_MANAGER || call->null == NULL_FIRST)
        return SLUICE_ERROR_NULL_POINTER;
    if (call->texture != SLUICE_ALL_TEXTURES && !(*only = naive_find(n, call->texture, &result)))
        return result;
    return SLUICE_SUCCESS;
}

/* A heap that the rules allow a slot to be taken from; NULL: there is none. */
static const struct naive_heap *fullest_heap(const struct naive_manager *n)
{
    const struct naive_heap *best = NULL;
    uint32_t best_free = 0;
    for (uint32_t i = 0; i < n->heap_count; i++) {
        uint32_t free_slots = naive_count_slots(n, &n->heaps[i], NAIVE_SLOT_FREE);
        if (free_slots > 0 && (!best || free_slots < best_free)) {
            best = &n->heaps[i];
            best_free = free_slots;
        }
    }
    return best;
}

/* Takes the next answer that the other manager got. Returns whether there is a new heap. */
static bool ask_for_heap(struct naive_manager *n, const struct outcome *seen, struct outcome *out)
{
    if (out->answer_count == seen->answer_count) {
        naive_complain(n, "the heap allocator should have been asked once more");
        return false;
    }
    struct heap_answer answer = seen->answers[out->answer_count++];
    if (answer.result != SLUICE_SUCCESS || naive_find_heap(n, answer.id))
        return false;
    n->heaps = realloc(n->heaps, (n->heap_count + 1) * sizeof *n->heaps);
    if (!n->heaps)
        abort();
    n->heaps[n->heap_count++] =
        (struct naive_heap){answer.id, naive_alloc(n->capacity, sizeof(struct naive_slot))};
    return true;
}

/* Takes the slot that the other manager took for its tile number `i`, if that is allowed. */
static void take_slot(struct naive_manager *n, const struct outcome *seen, uint32_t i,
                      const struct naive_heap *fullest, struct naive_tile *tile)
{
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
    if (naive_count_slots(n, heap, NAIVE_SLOT_FREE) !=
        naive_count_slots(n, fullest, NAIVE_SLOT_FREE))
        naive_complain(n, "tile %u: heap %u has more free slots than heap %u", i, heap->id,
                       fullest->id);
    tile->heap = other->heapId;
    tile->slot = other->slot;
    heap->slots[other->slot].use = NAIVE_SLOT_USED;
}

/* Room is left for `unserved` requests, but no slot. */
static void make_room(struct naive_manager *n, uint32_t unserved)
{
    uint32_t standby, listed = 0, retiring = 0;
    struct naive_ref *refs = naive_collect(n, NULL, SLUICE_TILE_STATE_STANDBY, &standby);
    for (uint32_t i = 0; i < standby; i++)
        listed += refs[i].tile->listed;
    free(refs);
    for (uint32_t i = 0; i < n->heap_count; i++)
        retiring += naive_count_slots(n, &n->heaps[i], NAIVE_SLOT_RETIRING);
    int64_t needed = (int64_t)unserved - listed - retiring;
    int64_t unlisted = (int64_t)standby - listed;
    if (needed > 0)
        naive_list_standby(n, needed < unlisted ? (uint64_t)(unlisted - needed) : 0);
}

SluiceResult naive_tiles_to_map(struct naive_manager *n, const struct call *call,
                                const struct outcome *seen, struct outcome *out)
{
    struct naive_texture *only;
    SluiceResult result = check_list(n, call, &only);
    if (result != SLUICE_SUCCESS)
        return result;
    uint32_t count;
    struct naive_ref *refs = naive_collect(n, only, SLUICE_TILE_STATE_REQUESTED, &count);
    for (uint32_t i = 0; i < count; i++) {
        const struct naive_tile *tile = refs[i].tile;
        uint64_t *key = refs[i].key;
        key[0] = tile->packed ? 0 : 1;
        key[1] = tile->packed ? 0 : SLUICE_MAX_MIP_LEVELS - tile->level;
        key[2] = tile->packed ? 0 : SLUICE_MAX_MIP_LEVELS - tile->deficit;
        key[3] = tile->requested_at;
    }
    naive_sort(refs, count);
    if (call->null == NULL_SECOND) {
        out->count = count;
        free(refs);
        return SLUICE_SUCCESS;
    }
    bool refused = false;
    while (out->count < count && out->count < call->room) {
        const struct naive_heap *heap = fullest_heap(n);
        const uint32_t most = n->config.maxHeapCount;
        if (!heap && !refused && (most == 0 || n->heap_count < most)) {
            refused = !ask_for_heap(n, seen, out);
            heap = fullest_heap(n);
        }
        if (!heap)
            break;
        struct naive_tile *tile = refs[out->count].tile;
        tile->state = SLUICE_TILE_STATE_ALLOCATED;
        take_slot(n, seen, out->count, heap, tile);
        if (n->complaint[0])
            break;
        struct naive_texture *t = refs[out->count].texture;
        out->tiles[out->count++] = naive_tile_info(t, (uint32_t)(tile - t->tiles));
        n->totals.handedOutTotal++;
    }
    result = out->count < count ? SLUICE_INCOMPLETE : SLUICE_SUCCESS;
    uint32_t unserved = min_u32(count, call->room) - out->count;
    if (unserved > 0) {
        make_room(n, unserved);
        result = SLUICE_BUDGET_REACHED;
    }
    free(refs);
    return result;
}

SluiceResult naive_given_up_tiles(struct naive_manager *n, const struct call *call,
                                  struct outcome *out)
{
    if (call->null == NULL_MANAGER || call->null == NULL_FIRST)
        return SLUICE_ERROR_NULL_POINTER;
    out->count = n->given_up_count;
    if (call->null == NULL_SECOND)
        return SLUICE_SUCCESS;
    out->count = min_u32(call->room, n->given_up_count);
    for (uint32_t i = 0; i < out->count; i++) {
        SluiceResult result;
        out->tiles[i] =
            naive_tile_info(naive_find(n, n->given_up[i].texture, &result), n->given_up[i].tile);
    }
    n->given_up_count -= out->count;
    for (uint32_t i = 0; i < n->given_up_count; i++)
        n->given_up[i] = n->given_up[i + out->count];
    return n->given_up_count ? SLUICE_INCOMPLETE : SLUICE_SUCCESS;
}

SluiceResult naive_tiles_to_cancel(struct naive_manager *n, const struct call *call,
                                   struct outcome *out)
{
    struct naive_texture *only;
    SluiceResult result = check_list(n, call, &only);
    if (result != SLUICE_SUCCESS)
        return result;
    uint32_t cancelled, count = 0;
    struct naive_ref *refs = naive_collect(n, only, SLUICE_TILE_STATE_CANCELLED, &cancelled);
    for (uint32_t i = 0; i < cancelled; i++)
        if (!refs[i].tile->cancel_handed_out) {
            refs[count] = refs[i];
            refs[count++].key[0] = refs[i].tile->cancelled_at;
        }
    naive_sort(refs, count);
    out->count = call->null == NULL_SECOND ? count : min_u32(call->room, count);
    for (uint32_t i = 0; i < out->count && call->null != NULL_SECOND; i++) {
        struct naive_texture *t = refs[i].texture;
        refs[i].tile->cancel_handed_out = true;
        out->tiles[i] = naive_tile_info(t, (uint32_t)(refs[i].tile - t->tiles));
    }
    free(refs);
    return out->count < count ? SLUICE_INCOMPLETE : SLUICE_SUCCESS;
}

static void unmap_tile(struct naive_manager *n, struct naive_texture *t, struct naive_tile *tile,
                       uint64_t retire)
{
    naive_retire_slot(n, tile, retire);
    tile->state = SLUICE_TILE_STATE_FREE;
    tile->listed = false;
    n->totals.unmappedTotal++;
    t->minmip_stale = true;
    naive_update_minmip(n, t);
}

SluiceResult naive_tiles_to_unmap(struct naive_manager *n, const struct call *call,
                                  struct outcome *out)
{
    struct naive_texture *only;
    SluiceResult result = check_list(n, call, &only);
    if (result != SLUICE_SUCCESS)
        return result;
    if (call->retire != 0 && call->retire < n->last_retire)
        return SLUICE_ERROR_TIME_BACKWARDS;
    if (call->retire != 0 && call->null != NULL_SECOND)
        n->last_retire = call->retire;
    uint32_t standby, count = 0;
    struct naive_ref *refs = naive_collect(n, only, SLUICE_TILE_STATE_STANDBY, &standby);
    for (uint32_t i = 0; i < standby; i++)
        if (refs[i].tile->listed) {
            refs[count] = refs[i];
            refs[count++].key[0] = refs[i].tile->listed_at;
        }
    naive_sort(refs, count);
    out->count = call->null == NULL_SECOND ? count : min_u32(call->room, count);
    for (uint32_t i = 0; i < out->count && call->null != NULL_SECOND; i++) {
        struct naive_texture *t = refs[i].texture;
        out->tiles[i] = naive_tile_info(t, (uint32_t)(refs[i].tile - t->tiles));
        unmap_tile(n, t, refs[i].tile, call->retire);
    }
    free(refs);
    return out->count < count ? SLUICE_INCOMPLETE : SLUICE_SUCCESS;
}
