/*
 * Lists of the GIVEN_UP tiles of a texture, oldest first. The links are stored in the nodes' field
 * `order`, which GIVEN_UP tiles do not use otherwise.
 */
#include "core/given_up.h"

static uint32_t previous_of(const struct slc_node *n)
{
    return (uint32_t)(n->order >> 32);
}

static uint32_t next_of(const struct slc_node *n)
{
    return (uint32_t)n->order;
}

static void link(slc_manager *m, struct slc_managed_texture *t, uint32_t node, uint32_t next)
{
    if (node)
        slc_node_at(&m->residency, node)->order =
            (slc_node_at(&m->residency, node)->order & ~(uint64_t)UINT32_MAX) | next;
    else
        t->given_up_first = next;
    if (next)
        slc_node_at(&m->residency, next)->order =
            (uint64_t)node << 32 | (uint32_t)slc_node_at(&m->residency, next)->order;
    else
        t->given_up_last = node;
}

void slc_given_up_enter(slc_manager *m, uint32_t node)
{
    struct slc_managed_texture *t = slc_texture_at(m, slc_node_at(&m->residency, node)->owner);
    uint32_t last = t->given_up_last;
    link(m, t, last, node);
    link(m, t, node, 0);
}

void slc_given_up_leave(slc_manager *m, uint32_t node)
{
    const struct slc_node *n = slc_node_at(&m->residency, node);
    link(m, slc_texture_at(m, n->owner), previous_of(n), next_of(n));
}
