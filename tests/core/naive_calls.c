/* The calls that are about textures, heaps and maps as a whole, and the dispatch of all calls. */
#include "core/naive_manager.h"

#include <stdlib.h>
#include <string.h>

static bool has_followers(const struct naive_manager *n, SluiceTextureId id)
{
    for (uint32_t i = 0; i < n->texture_room; i++)
        if (n->textures[i] && n->textures[i]->primary == id)
            return true;
    return false;
}

static SluiceResult set_primary(struct naive_manager *n, const struct call *call)
{
    SluiceResult result;
    const struct naive_texture *primary = NULL;
    if (call->null != NULL_NONE)
        return SLUICE_ERROR_NULL_POINTER;
    struct naive_texture *t = naive_find(n, call->texture, &result);
    if (!t)
        return result;
    if (call->primary == SLUICE_NO_TEXTURE) {
        t->primary = SLUICE_NO_TEXTURE;
        return SLUICE_SUCCESS;
    }
    if (!(primary = naive_find(n, call->primary, &result)))
        return result;
    if (primary == t || primary->primary != SLUICE_NO_TEXTURE || has_followers(n, t->id))
        return SLUICE_ERROR_INVALID_ARGUMENT;
    if (t->primary != primary->id) {
        t->primary = primary->id;
        t->follower_since = ++n->stamp;
    }
    return SLUICE_SUCCESS;
}

static bool retire_is_backwards(const struct naive_manager *n, uint64_t retire)
{
    return retire != 0 && retire < n->last_retire;
}

static void free_texture(struct naive_manager *n, struct naive_texture *t)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < n->given_up_count; i++)
        if (n->given_up[i].texture != t->id)
            n->given_up[kept++] = n->given_up[i];
    n->given_up_count = kept;
    for (uint32_t i = 0; i < n->texture_room; i++)
        if (n->textures[i] && n->textures[i]->primary == t->id)
            n->textures[i]->primary = SLUICE_NO_TEXTURE;
    n->removed = realloc(n->removed, (n->removed_count + 1) * sizeof *n->removed);
    if (!n->removed)
        abort();
    n->removed[n->removed_count++] = t->id;
    n->textures[(uint32_t)t->id] = NULL;
    naive_free_texture(t);
}

static SluiceResult remove_texture(struct naive_manager *n, const struct call *call)
{
    SluiceResult result;
    if (call->null != NULL_NONE)
        return SLUICE_ERROR_NULL_POINTER;
    struct naive_texture *t = naive_find(n, call->texture, &result);
    if (!t)
        return result;
    if (retire_is_backwards(n, call->retire))
        return SLUICE_ERROR_TIME_BACKWARDS;
    if (call->retire)
        n->last_retire = call->retire;
    for (uint32_t i = 0; i < t->layout.tileCount; i++)
        if (naive_has_slot(&t->tiles[i]))
            naive_retire_slot(n, &t->tiles[i], call->retire);
    n->bias.scene_changed |= naive_holds_anything(t);
    free_texture(n, t);
    return SLUICE_SUCCESS;
}

bool naive_is_idle(const struct naive_texture *t)
{
    for (uint32_t i = 0; i < t->layout.tileCount; i++)
        if (t->tiles[i].state != SLUICE_TILE_STATE_FREE &&
            t->tiles[i].state != SLUICE_TILE_STATE_STANDBY)
            return false;
    return !naive_holds_anything(t);
}

static SluiceResult forget_texture(struct naive_manager *n, const struct call *call)
{
    SluiceResult result;
    if (call->null != NULL_NONE)
        return SLUICE_ERROR_NULL_POINTER;
    struct naive_texture *t = naive_find(n, call->texture, &result);
    if (!t)
        return result;
    if (retire_is_backwards(n, call->retire))
        return SLUICE_ERROR_TIME_BACKWARDS;
    if (!naive_is_idle(t))
        return SLUICE_NOT_READY;
    if (call->retire)
        n->last_retire = call->retire;
    for (uint32_t i = 0; i < t->layout.tileCount; i++) {
        struct naive_tile *tile = &t->tiles[i];
        if (tile->state == SLUICE_TILE_STATE_FREE)
            continue;
        naive_retire_slot(n, tile, call->retire);
        tile->state = SLUICE_TILE_STATE_FREE;
        tile->listed = false;
        t->minmip_stale = true;
        n->events[NAIVE_TEXTURE_FORGOTTEN]++;
    }
    return SLUICE_SUCCESS;
}

static void evict(struct naive_manager *n, struct naive_texture *t, uint32_t keep)
{
    if (naive_holds_anything(t)) {
        naive_drop_wants(n, t);
        n->events[NAIVE_TEXTURE_EVICTED]++;
    }
    uint32_t left = 0;
    for (uint32_t i = 0; i < t->layout.tileCount; i++)
        left += t->tiles[i].state == SLUICE_TILE_STATE_STANDBY && !t->tiles[i].listed;
    for (uint32_t i = 0; i < t->layout.tileCount; i++) {
        struct naive_tile *tile = &t->tiles[i];
        if (left <= keep || tile->state != SLUICE_TILE_STATE_STANDBY || tile->listed)
            continue;
        tile->listed = true;
        tile->listed_at = ++n->stamp;
        left--;
        n->events[NAIVE_TEXTURE_LISTED]++;
    }
}

/* The follower of `t` that came after `f`; the first one after `t` itself. */
static struct naive_texture *next_follower(const struct naive_manager *n,
                                           const struct naive_texture *t,
                                           const struct naive_texture *f)
{
    struct naive_texture *next = NULL;
    for (uint32_t i = 0; i < n->texture_room; i++) {
        struct naive_texture *other = n->textures[i];
        if (other && other->primary == t->id &&
            (f == t || other->follower_since > f->follower_since) &&
            (!next || other->follower_since < next->follower_since))
            next = other;
    }
    return next;
}

static SluiceResult evict_texture(struct naive_manager *n, const struct call *call)
{
    SluiceResult result;
    if (call->null != NULL_NONE)
        return SLUICE_ERROR_NULL_POINTER;
    struct naive_texture *t = naive_find(n, call->texture, &result);
    if (!t)
        return result;
    evict(n, t, call->keep);
    for (struct naive_texture *f = t; (f = next_follower(n, t, f));) {
        evict(n, f, call->keep);
        n->events[NAIVE_FOLLOWER_EVICTED]++;
    }
    return SLUICE_SUCCESS;
}

static SluiceResult complete(struct naive_manager *n, const struct call *call)
{
    if (call->null != NULL_NONE)
        return SLUICE_ERROR_NULL_POINTER;
    if (call->retire == 0) /* always complete: says nothing new */
        return SLUICE_SUCCESS;
    if (call->retire < n->completed)
        return SLUICE_ERROR_TIME_BACKWARDS;
    n->completed = call->retire;
    for (uint32_t i = 0; i < n->heap_count; i++)
        for (uint32_t k = 0; k < n->capacity; k++) {
            struct naive_slot *slot = &n->heaps[i].slots[k];
            if (slot->use == NAIVE_SLOT_RETIRING && slot->retire <= call->retire)
                *slot = (struct naive_slot){NAIVE_SLOT_FREE, 0};
        }
    return SLUICE_SUCCESS;
}

static bool is_empty(const struct naive_manager *n, const struct naive_heap *heap)
{
    return naive_count_slots(n, heap, NAIVE_SLOT_FREE) == n->capacity;
}

static int compare_heap_numbers(const void *a, const void *b)
{
    const struct naive_heap *const *x = a, *const *y = b;
    return (*x)->number < (*y)->number ? -1 : 1;
}

/* Writes pointers to the heaps that are to be listed, in order, and returns how many. */
static uint32_t list_empty_heaps(const struct naive_manager *n, const struct naive_heap **heaps)
{
    const uint64_t free_slots = naive_count_all(n, NAIVE_SLOT_FREE);
    const bool none_taken = free_slots == (uint64_t)n->heap_count * n->capacity;
    const uint64_t keep = none_taken ? 0 : n->capacity / 2 + naive_reserved(n);
    uint32_t empty = 0, count = 0;
    for (uint32_t i = 0; i < n->heap_count; i++)
        if (is_empty(n, &n->heaps[i]))
            heaps[empty++] = &n->heaps[i];
    qsort(heaps, empty, sizeof *heaps, compare_heap_numbers);
    const uint64_t too_many = naive_surplus(n) / n->capacity;
    while (count < empty &&
           (count < too_many || free_slots - (uint64_t)(count + 1) * n->capacity >= keep))
        count++;
    return count;
}

static SluiceResult empty_heaps(struct naive_manager *n, const struct call *call,
                                struct outcome *out)
{
    if (call->null == NULL_MANAGER || call->null == NULL_FIRST)
        return SLUICE_ERROR_NULL_POINTER;
    const struct naive_heap **heaps = naive_alloc(n->heap_count, sizeof(void *));
    const uint32_t count = list_empty_heaps(n, heaps);
    out->count = count;
    if (call->null != NULL_SECOND) {
        out->count = call->room < count ? call->room : count;
        for (uint32_t i = 0; i < out->count; i++)
            out->heaps[i] = heaps[i]->id;
    }
    free(heaps);
    return out->count < count ? SLUICE_INCOMPLETE : SLUICE_SUCCESS;
}

static SluiceResult release_heap(struct naive_manager *n, const struct call *call)
{
    if (call->null != NULL_NONE)
        return SLUICE_ERROR_NULL_POINTER;
    struct naive_heap *heap = naive_find_heap(n, call->heap);
    if (!heap)
        return SLUICE_ERROR_UNKNOWN_HEAP;
    if (!is_empty(n, heap))
        return SLUICE_ERROR_HEAP_IN_USE;
    free(heap->slots);
    *heap = n->heaps[--n->heap_count];
    return SLUICE_SUCCESS;
}

static bool fits(size_t pitch, size_t size, uint32_t width, uint32_t height)
{
    if (pitch < width)
        return false;
    if (height > 1 && pitch > (SIZE_MAX - width) / (height - 1))
        return false;
    return size >= (size_t)(height - 1) * pitch + width;
}

/* Bytes between the rows are compared as well: nobody may write there. */
static void write_rows(const struct naive_texture *t, const SluiceMinMipRect *r, size_t pitch,
                       uint8_t *bytes)
{
    for (uint32_t y = 0; y < r->height; y++)
        memcpy(bytes + y * pitch, &t->minmip[(size_t)(r->y + y) * t->layout.minMipWidth + r->x],
               r->width);
}

static SluiceResult write_minmip(struct naive_manager *n, const struct call *call,
                                 struct outcome *out)
{
    SluiceResult result;
    const bool whole = call->kind == CALL_WRITE_MINMIP;
    if (call->null != NULL_NONE)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceMinMipRect r = call->rect;
    const struct naive_texture *t = naive_find(n, whole ? call->texture : r.textureId, &result);
    if (!t)
        return result;
    const uint32_t w = t->layout.minMipWidth, h = t->layout.minMipHeight;
    if (whole)
        r = (SluiceMinMipRect){call->texture, 0, 0, w, h};
    if (r.x > w || r.width > w - r.x || r.y > h || r.height > h - r.y || !r.width || !r.height)
        return SLUICE_ERROR_INVALID_ARGUMENT;
    if (!fits(call->pitch, call->size, r.width, r.height))
        return SLUICE_ERROR_SIZE_MISMATCH;
    write_rows(t, &r, call->pitch, out->bytes);
    return SLUICE_SUCCESS;
}

/* Rectangles are the other manager's, after a check that they cover what changed. */
static void take_rect(struct naive_manager *n, struct naive_texture *t, const SluiceMinMipRect *r,
                      SluiceMinMipRect *out)
{
    const uint32_t w = t->layout.minMipWidth, h = t->layout.minMipHeight;
    if (r->x > w || r->width > w - r->x || r->y > h || r->height > h - r->y)
        naive_complain(n, "the rectangle of %#llx is not inside its map",
                       (unsigned long long)t->id);
    for (uint32_t y = 0; y < h; y++)
        for (uint32_t x = 0; x < w; x++)
            if (t->changed[y * w + x] &&
                (x < r->x || x - r->x >= r->width || y < r->y || y - r->y >= r->height))
                naive_complain(n, "the rectangle of %#llx misses texel (%u, %u)",
                               (unsigned long long)t->id, x, y);
    memset(t->changed, 0, (size_t)w * h);
    t->dirty_since = 0;
    *out = *r;
    out->textureId = t->id;
}

static SluiceResult minmip_updates(struct naive_manager *n, const struct call *call,
                                   const struct outcome *seen, struct outcome *out)
{
    if (call->null == NULL_MANAGER || call->null == NULL_FIRST)
        return SLUICE_ERROR_NULL_POINTER;
    struct naive_ref *refs = naive_alloc(n->texture_room, sizeof *refs);
    uint32_t count = 0;
    for (uint32_t i = 0; i < n->texture_room; i++)
        if (n->textures[i] && n->textures[i]->dirty_since)
            refs[count++] =
                (struct naive_ref){n->textures[i], NULL, {n->textures[i]->dirty_since, 0, 0, 0}};
    naive_sort(refs, count);
    out->count = call->null == NULL_SECOND || count < call->room ? count : call->room;
    for (uint32_t i = 0; i < out->count && i < seen->count && call->null != NULL_SECOND; i++)
        take_rect(n, refs[i].texture, &seen->rects[i], &out->rects[i]);
    free(refs);
    return out->count < count ? SLUICE_INCOMPLETE : SLUICE_SUCCESS;
}

static SluiceResult tile_state(struct naive_manager *n, const struct call *call,
                               struct outcome *out)
{
    SluiceResult result;
    if (call->null == NULL_MANAGER)
        return SLUICE_ERROR_NULL_POINTER;
    const struct naive_texture *t = naive_find(n, call->texture, &result);
    if (!t)
        return result;
    if (call->tile >= t->layout.tileCount)
        return SLUICE_ERROR_UNKNOWN_TILE;
    out->state = t->tiles[call->tile].state;
    out->tiles[0] = naive_tile_info(t, call->tile);
    return SLUICE_SUCCESS;
}

static SluiceResult texture_layout(struct naive_manager *n, const struct call *call,
                                   struct outcome *out)
{
    SluiceResult result;
    if (call->null != NULL_NONE)
        return SLUICE_ERROR_NULL_POINTER;
    const struct naive_texture *t = naive_find(n, call->texture, &result);
    if (!t)
        return result;
    out->layout = t->layout;
    return SLUICE_SUCCESS;
}

static SluiceResult set_config(struct naive_manager *n, const struct call *call)
{
    if (call->null != NULL_NONE)
        return SLUICE_ERROR_NULL_POINTER;
    n->config = call->config;
    naive_limit_standby(n);
    return SLUICE_SUCCESS;
}

static SluiceResult dispatch(struct naive_manager *n, const struct call *call,
                             const struct outcome *seen, struct outcome *out)
{
    switch (call->kind) {
    case CALL_SET_CONFIG: return set_config(n, call);
    case CALL_ADD_TEXTURE: return naive_add_texture(n, call, seen, out);
    case CALL_REMOVE_TEXTURE: return remove_texture(n, call);
    case CALL_FORGET: return forget_texture(n, call);
    case CALL_EVICT: return evict_texture(n, call);
    case CALL_FEEDBACK: return naive_feedback(n, call);
    case CALL_MATCH_PRIMARY: return naive_match(n, call);
    case CALL_SET_PRIMARY: return set_primary(n, call);
    case CALL_TILES_TO_MAP: return naive_tiles_to_map(n, call, seen, out);
    case CALL_MAPPED:
    case CALL_FAILED:
    case CALL_CANCELED: return naive_answer(n, call);
    case CALL_RETRY: return naive_retry(n, call);
    case CALL_GIVEN_UP: return naive_given_up_tiles(n, call, out);
    case CALL_TILES_TO_CANCEL: return naive_tiles_to_cancel(n, call, out);
    case CALL_TILES_TO_UNMAP: return naive_tiles_to_unmap(n, call, out);
    case CALL_COMPLETE: return complete(n, call);
    case CALL_TRIM:
        if (call->null != NULL_NONE)
            return SLUICE_ERROR_NULL_POINTER;
        naive_list_standby(n, call->keep);
        return SLUICE_SUCCESS;
    case CALL_DEFRAGMENT: return naive_defragment(n, call, seen, out);
    case CALL_EVACUATE: return naive_evacuate(n, call);
    case CALL_EMPTY_HEAPS: return empty_heaps(n, call, out);
    case CALL_RELEASE_HEAP: return release_heap(n, call);
    case CALL_MINMIP_UPDATES: return minmip_updates(n, call, seen, out);
    case CALL_WRITE_MINMIP:
    case CALL_WRITE_RECT: return write_minmip(n, call, out);
    case CALL_TILE_STATE: return tile_state(n, call, out);
    case CALL_LAYOUT:
        return call->null == NULL_NONE ? naive_layout(&call->desc, &out->layout)
                                       : SLUICE_ERROR_NULL_POINTER;
    case CALL_TEXTURE_LAYOUT: return texture_layout(n, call, out);
    case CALL_STATISTICS:
        if (call->null != NULL_NONE)
            return SLUICE_ERROR_NULL_POINTER;
        naive_statistics(n, &out->statistics);
        return SLUICE_SUCCESS;
    case CALL_KIND_COUNT: break;
    }
    abort();
}

void naive_call(struct naive_manager *n, const struct call *call, const struct outcome *seen,
                struct outcome *expected)
{
    expected->count = 0;
    expected->answer_count = 0;
    expected->texture = 0;
    n->complaint[0] = 0;
    expected->result = dispatch(n, call, seen, expected);
    for (uint32_t i = 0; i < n->texture_room; i++) {
        if (!n->textures[i])
            continue;
        naive_update_minmip(n, n->textures[i]);
        if (!naive_has_state(n->textures[i]))
            naive_forget_history(n->textures[i]);
    }
}
