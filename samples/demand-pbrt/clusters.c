#include "clusters.h"

#include <stdlib.h>

/* Levels by which a tree may be deeper than one that is split in halves. */
#define SPARE_DEPTH 2u

bool clusters_create(const struct box_tree_box *boxes, const uint32_t *keys, uint32_t count,
                     uint32_t size, const atomic_bool *canceled, struct clusters *c)
{
    *c = (struct clusters){.size = size, .depth = SPARE_DEPTH};
    while ((uint64_t)size << (c->depth - SPARE_DEPTH) < count)
        c->depth++;
    if (!box_tree_build_until(boxes, count, size, c->depth, canceled, &c->tree))
        return false;
    if (count == 0)
        return true;
    for (uint32_t i = 0; i < count; i++)
        c->tree.order[i] = keys[c->tree.order[i]];
    /* Shrink the nodes, which had room for leaves of one box each. */
    void *fitting = realloc(c->tree.nodes, c->tree.node_count * sizeof *c->tree.nodes);
    if (fitting)
        c->tree.nodes = fitting;
    return true;
}

void clusters_finish(struct clusters *c)
{
    box_tree_finish(&c->tree);
    *c = (struct clusters){0};
}

uint32_t *clusters_list_nodes(const struct clusters *c, uint32_t key_count)
{
    uint32_t *nodes = calloc(key_count + 1u, sizeof *nodes);
    for (uint32_t i = 0; nodes && i < c->tree.node_count; i++)
        for (uint32_t k = 0; k < c->tree.nodes[i].count; k++)
            nodes[c->tree.order[c->tree.nodes[i].first + k]] = 1 + i;
    return nodes;
}

void clusters_open(const struct clusters *c, uint32_t node, struct cluster_step *step)
{
    const struct box_tree_node *nodes = c->tree.nodes;
    const uint32_t most = CLUSTERS_FAN * c->size;
    step->keys = NULL;
    if (nodes[node].count > 0) {
        step->keys = c->tree.order + nodes[node].first;
        step->count = nodes[node].count;
        return;
    }
    step->nodes[0] = node;
    step->count = 1;
    /* Breadth first: replace each node by its two children, the first of them in its place. */
    for (uint32_t at = 0, end = 1; at < step->count && step->count < most;) {
        const struct box_tree_node *parent = &nodes[step->nodes[at]];
        if (parent->count == 0) {
            step->nodes[at] = parent->first;
            step->nodes[step->count++] = parent->first + 1;
        }
        at++;
        if (at == end) { /* end of a level: continue with the next one from the start */
            const bool grew = step->count > end;
            end = step->count;
            at = grew ? 0 : step->count;
        }
    }
}
