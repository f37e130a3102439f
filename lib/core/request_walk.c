#include "core/request_walk.h"

#include "base/alloc.h"
#include "residency/request_queues.h"

#include <stdlib.h>

static int by_request_order(const void *a, const void *b)
{
    const struct slc_request_key *x = a, *y = b;
    if (x->rank != y->rank)
        return x->rank > y->rank ? -1 : 1;
    return x->order < y->order ? -1 : x->order > y->order;
}

static struct slc_request_key key_of(const slc_manager *m, uint32_t node)
{
    const struct slc_node *n = slc_node_at(&m->residency, node);
    return (struct slc_request_key){(uint32_t)n->level << 8 | n->need, node, n->order};
}

/** Collects a texture's requests from the queues of all textures, where they are in order. */
static uint32_t pick_requests(const slc_manager *m, const struct slc_managed_texture *t,
                              struct slc_request_key *keys)
{
    uint32_t count = 0;
    for (uint32_t node = slc_first_request(&m->residency); node && count < t->requested_count;
         node = slc_next_request(&m->residency, node))
        if (slc_node_at(&m->residency, node)->owner == t->index)
            keys[count++] = key_of(m, node);
    return count;
}

static uint32_t search_requests(const slc_manager *m, const struct slc_managed_texture *t,
                                struct slc_request_key *keys)
{
    uint32_t count = 0;
    for (uint32_t tile = 0; tile < t->shape->tile_count && count < t->requested_count; tile++) {
        uint32_t node = slc_find_node(t, tile);
        if (node && slc_node_at(&m->residency, node)->state == SLUICE_TILE_STATE_REQUESTED)
            keys[count++] = key_of(m, node);
    }
    qsort(keys, count, sizeof *keys, by_request_order);
    return count;
}

struct slc_request_key *slc_sort_requests(const slc_manager *m, const struct slc_managed_texture *t)
{
    struct slc_request_key *keys = slc_alloc(&m->cb, t->requested_count, sizeof *keys);
    if (!keys)
        return NULL;
    bool few = m->residency.requests.count < t->shape->tile_count;
    uint32_t count = few ? pick_requests(m, t, keys) : search_requests(m, t, keys);
    (void)count;
    assert(count == t->requested_count);
    return keys;
}

struct slc_request_walk slc_walk_requests(const slc_manager *m,
                                          const struct slc_managed_texture *scope,
                                          const struct slc_request_key *keys)
{
    if (!scope)
        return (struct slc_request_walk){.node = slc_first_request(&m->residency)};
    uint32_t count = scope->requested_count;
    return (struct slc_request_walk){keys, 0, count, count ? keys[0].node : 0};
}

void slc_walk_on(const slc_manager *m, struct slc_request_walk *w)
{
    if (w->count)
        w->node = ++w->at < w->count ? w->keys[w->at].node : 0;
    else
        w->node = slc_next_request(&m->residency, w->node);
}
