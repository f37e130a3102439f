#include "vulkan/reload_lists.h"

#include "base/alloc.h"
#include "base/checked.h"

#include <assert.h>

#define FIRST_KEYS 16u

SluiceResult slc_reload_lists_init(struct slc_reload_lists *r, const SluiceAllocationCallbacks *cb,
                                   uint32_t texture_count, uint32_t spare)
{
    *r = (struct slc_reload_lists){.cb = cb, .spare = spare, .texture_count = texture_count};
    SluiceResult result = slc_map_init(&r->keys, cb, FIRST_KEYS);
    if (result != SLUICE_SUCCESS)
        return result;
    r->lists = slc_calloc(cb, texture_count, sizeof *r->lists);
    return r->lists ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

void slc_reload_lists_finish(struct slc_reload_lists *r)
{
    if (!r->cb)
        return;
    slc_map_finish(&r->keys, r->cb);
    slc_free(r->cb, r->nodes, r->capacity, sizeof *r->nodes);
    slc_free(r->cb, r->lists, r->texture_count, sizeof *r->lists);
    *r = (struct slc_reload_lists){0};
}

SluiceResult slc_reload_lists_reserve(struct slc_reload_lists *r, uint32_t count)
{
    uint32_t old = r->capacity, most = r->count + count + r->spare;
    SluiceResult result = slc_map_reserve(&r->keys, r->cb, most);
    if (result != SLUICE_SUCCESS || most <= old)
        return result;
    uint32_t capacity = slc_max_u32(most, 2 * old);
    struct slc_reload_node *nodes = slc_regrow(r->cb, r->nodes, old, capacity, sizeof *nodes);
    if (!nodes)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint32_t i = old; i < capacity; i++) {
        nodes[i].next = r->free_node;
        r->free_node = i + 1;
    }
    r->nodes = nodes;
    r->capacity = capacity;
    return SLUICE_SUCCESS;
}

/* Places of textures ------------------------------------------------------------------------- */

static struct slc_reload_chain *chain_of(struct slc_reload_lists *r, enum slc_reload_place place)
{
    if (place == SLC_RELOAD_READY)
        return &r->ready;
    return place == SLC_RELOAD_WAITING ? &r->waiting : NULL;
}

static void leave_place(struct slc_reload_lists *r, uint32_t texture)
{
    struct slc_reload_list *list = &r->lists[texture];
    struct slc_reload_chain *chain = chain_of(r, list->place);
    list->place = SLC_RELOAD_NOWHERE;
    if (!chain)
        return;
    *(list->before ? &r->lists[list->before - 1].after : &chain->first) = list->after;
    *(list->after ? &r->lists[list->after - 1].before : &chain->last) = list->before;
    chain->count--;
}

/* Inserts a texture after `before` (1 + index); 0: at the front. */
static void enter_place(struct slc_reload_lists *r, uint32_t texture, enum slc_reload_place place,
                        uint32_t before)
{
    struct slc_reload_list *list = &r->lists[texture];
    struct slc_reload_chain *chain = chain_of(r, place);
    list->place = place;
    list->before = before;
    list->after = before ? r->lists[before - 1].after : chain->first;
    *(list->before ? &r->lists[list->before - 1].after : &chain->first) = texture + 1;
    *(list->after ? &r->lists[list->after - 1].before : &chain->last) = texture + 1;
    chain->count++;
}

static bool is_reached(uint64_t now, uint64_t due)
{
    return now - due <= UINT64_MAX / 2;
}

/* Inserts a texture by due time. Usually at the end: all textures have the same retry delay. */
static void enter(struct slc_reload_lists *r, uint32_t texture)
{
    const struct slc_reload_list *list = &r->lists[texture];
    uint32_t before = list->waits ? r->waiting.last : r->ready.last;
    while (list->waits && before && !is_reached(list->due, r->lists[before - 1].due))
        before = r->lists[before - 1].before;
    enter_place(r, texture, list->waits ? SLC_RELOAD_WAITING : SLC_RELOAD_READY, before);
}

void slc_reload_lists_wait(struct slc_reload_lists *r, uint32_t texture, uint64_t due)
{
    struct slc_reload_list *list = &r->lists[texture];
    bool has_place = chain_of(r, list->place);
    list->waits = true;
    list->due = due;
    if (!has_place)
        return;
    leave_place(r, texture);
    enter(r, texture);
}

void slc_reload_lists_wake(struct slc_reload_lists *r, uint64_t now)
{
    while (r->waiting.first && is_reached(now, r->lists[r->waiting.first - 1].due)) {
        uint32_t texture = r->waiting.first - 1;
        leave_place(r, texture);
        r->lists[texture].waits = false;
        enter(r, texture);
    }
}

uint32_t slc_reload_lists_begin(struct slc_reload_lists *r)
{
    assert(r->ready.first);
    uint32_t texture = r->ready.first - 1;
    leave_place(r, texture);
    r->lists[texture].place = SLC_RELOAD_TURN;
    return texture;
}

void slc_reload_lists_end(struct slc_reload_lists *r, uint32_t texture)
{
    struct slc_reload_list *list = &r->lists[texture];
    if (list->place != SLC_RELOAD_TURN)
        return; /* the texture was dropped */
    list->place = SLC_RELOAD_NOWHERE;
    if (list->count)
        enter(r, texture);
}

/* Tiles -------------------------------------------------------------------------------------- */

bool slc_reload_lists_has(const struct slc_reload_lists *r, uint32_t texture, uint32_t tile)
{
    return r->lists[texture].count &&
           slc_map_get(&r->keys, slc_pair_key(texture, tile)) != SLC_MAP_NONE;
}

uint32_t slc_reload_lists_count(const struct slc_reload_lists *r, uint32_t texture)
{
    return r->lists[texture].count;
}

void slc_reload_lists_add(struct slc_reload_lists *r, uint32_t texture, uint32_t tile)
{
    struct slc_reload_list *list = &r->lists[texture];
    if (slc_reload_lists_has(r, texture, tile))
        return;
    assert(r->free_node);
    uint32_t node = r->free_node;
    r->free_node = r->nodes[node - 1].next;
    r->nodes[node - 1] = (struct slc_reload_node){.tile = tile};
    *(list->last ? &r->nodes[list->last - 1].next : &list->first) = node;
    list->last = node;
    list->count++;
    r->count++;
    slc_map_add(&r->keys, slc_pair_key(texture, tile), 0);
    if (list->place == SLC_RELOAD_NOWHERE)
        enter(r, texture);
}

static uint32_t take(struct slc_reload_lists *r, uint32_t texture)
{
    struct slc_reload_list *list = &r->lists[texture];
    uint32_t node = list->first, tile = r->nodes[node - 1].tile;
    list->first = r->nodes[node - 1].next;
    if (--list->count == 0)
        list->last = 0;
    r->nodes[node - 1].next = r->free_node;
    r->free_node = node;
    r->count--;
    slc_map_remove(&r->keys, slc_pair_key(texture, tile));
    return tile;
}

uint32_t slc_reload_lists_take(struct slc_reload_lists *r, uint32_t texture)
{
    assert(r->lists[texture].count && r->lists[texture].place == SLC_RELOAD_TURN);
    return take(r, texture);
}

void slc_reload_lists_drop(struct slc_reload_lists *r, uint32_t texture)
{
    struct slc_reload_list *list = &r->lists[texture];
    while (list->count)
        take(r, texture);
    leave_place(r, texture);
    *list = (struct slc_reload_list){0};
}
