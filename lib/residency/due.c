/*
 * FAILED tiles sorted by due time, then by order of failure: a treap, so that a failure costs
 * logarithmic time. A node's `prev` and `next` are its children, and `slot` is its parent: a FAILED
 * tile has no slot.
 */
#include "residency/due.h"

/** Priority in the treap: a fixed shuffle of node numbers. Higher nodes are nearer to the root. */
static uint32_t rank(uint32_t node)
{
    node = (node ^ node >> 16) * 0x7FEB352Du;
    node = (node ^ node >> 15) * 0x846CA68Bu;
    return node ^ node >> 16;
}

static uint32_t *link_to(struct slc_machine *r, uint32_t parent, uint32_t child)
{
    if (!parent)
        return &r->failed.root;
    struct slc_node *p = slc_node_at(r, parent);
    return p->prev == child ? &p->prev : &p->next;
}

/** Rotates a node up: its parent becomes its child. */
static void rotate_up(struct slc_machine *r, uint32_t node)
{
    struct slc_node *n = slc_node_at(r, node);
    uint32_t parent = n->slot;
    struct slc_node *p = slc_node_at(r, parent);
    uint32_t *link = link_to(r, p->slot, parent);
    bool left = p->prev == node;
    uint32_t moved = left ? n->next : n->prev;
    *(left ? &p->prev : &p->next) = moved;
    if (moved)
        slc_node_at(r, moved)->slot = parent;
    *(left ? &n->next : &n->prev) = parent;
    n->slot = p->slot;
    p->slot = node;
    *link = node;
    r->steps++;
}

void slc_due_insert(struct slc_machine *r, uint32_t node)
{
    struct slc_node *n = slc_node_at(r, node);
    uint32_t parent = 0, *link = &r->failed.root;
    while (*link) {
        struct slc_node *p = slc_node_at(r, *link);
        parent = *link;
        link = (int64_t)(n->order - p->order) < 0 ? &p->prev : &p->next;
        r->steps++;
    }
    *link = node;
    n->slot = parent;
    n->prev = n->next = 0;
    while (n->slot && rank(n->slot) < rank(node))
        rotate_up(r, node);
    r->failed.count++;
}

void slc_due_remove(struct slc_machine *r, uint32_t node)
{
    struct slc_node *n = slc_node_at(r, node);
    while (n->prev && n->next)
        rotate_up(r, rank(n->prev) > rank(n->next) ? n->prev : n->next);
    uint32_t child = n->prev ? n->prev : n->next;
    *link_to(r, n->slot, node) = child;
    if (child)
        slc_node_at(r, child)->slot = n->slot;
    n->slot = n->prev = n->next = 0;
    r->failed.count--;
}

static uint32_t first_under(const struct slc_machine *r, uint32_t node)
{
    while (node && slc_node_at(r, node)->prev)
        node = slc_node_at(r, node)->prev;
    return node;
}

uint32_t slc_due_first(const struct slc_machine *r)
{
    return first_under(r, r->failed.root);
}

uint32_t slc_due_next(const struct slc_machine *r, uint32_t node)
{
    const struct slc_node *n = slc_node_at(r, node);
    if (n->next)
        return first_under(r, n->next);
    uint32_t parent = n->slot;
    while (parent && slc_node_at(r, parent)->next == node) {
        node = parent;
        parent = slc_node_at(r, node)->slot;
    }
    return parent;
}

const char *slc_due_check(const struct slc_machine *r)
{
    uint32_t count = 0, before = 0;
    for (uint32_t node = slc_due_first(r); node; node = slc_due_next(r, node)) {
        const struct slc_node *n = slc_node_at(r, node);
        if (n->state != SLUICE_TILE_STATE_FAILED || ++count > r->failed.count)
            return "a tile that is due is not FAILED, or there is no end of them";
        if (before && (int64_t)(n->order - slc_node_at(r, before)->order) < 0)
            return "FAILED tiles are not in order of due time";
        if (n->slot ? rank(n->slot) < rank(node) : r->failed.root != node)
            return "a FAILED tile is above one that should be nearer to the root";
        before = node;
    }
    return count == r->failed.count ? NULL : "FAILED tiles are lost";
}
