#include "world_tree.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Children of the root: the part with the rest, and the first node of the clusters. */
#define REST_NODE 1u
#define CLUSTER_NODES 2u

static const struct box_tree_node nothing = {.first = WORLD_TREE_NOTHING, .count = 1};

static bool is_nothing(const struct box_tree_node *node)
{
    return node->count == 1 && node->first == WORLD_TREE_NOTHING;
}

static bool fail(void)
{
    fprintf(stderr, "out of memory\n");
    return false;
}

bool world_tree_create(const struct clusters *clusters, uint32_t box_bit, struct world_tree *t)
{
    const uint32_t parts = 1 + clusters->tree.node_count;
    *t = (struct world_tree){.clusters = clusters,
                             .box_bit = box_bit,
                             .part_count = parts,
                             .node_count = CLUSTER_NODES + (parts > 1 ? parts - 1 : 1)};
    t->node_room = t->node_count;
    t->parts = calloc(parts, sizeof *t->parts);
    t->changed = calloc(parts, sizeof *t->changed);
    t->nodes = calloc(t->node_room, sizeof *t->nodes);
    if (!t->parts || !t->changed || !t->nodes)
        return fail();
    for (uint32_t i = 0; i < parts; i++)
        t->parts[i].root = nothing;
    return true;
}

void world_tree_finish(struct world_tree *t)
{
    for (uint32_t i = 0; i < t->part_count && t->parts; i++)
        free(t->parts[i].items);
    for (int kind = 0; kind < 2; kind++) {
        free(t->items[kind].boxes);
        free(t->items[kind].parts);
    }
    free(t->parts);
    free(t->changed);
    free(t->nodes);
    *t = (struct world_tree){0};
}

static void note_change(struct world_tree *t, uint32_t part)
{
    if (part == WORLD_TREE_NO_PART || t->parts[part].changed)
        return;
    t->parts[part].changed = true;
    t->changed[t->changed_count++] = part;
}

static bool reserve_items(struct world_tree_items *items, uint32_t count)
{
    if (count > items->room) {
        const uint32_t room = count < 64 ? 64 : count + count / 2;
        struct box_tree_box *boxes = realloc(items->boxes, room * sizeof *boxes);
        items->boxes = boxes ? boxes : items->boxes;
        uint32_t *parts = realloc(items->parts, room * sizeof *parts);
        items->parts = parts ? parts : items->parts;
        if (!boxes || !parts)
            return fail();
        items->room = room;
    }
    for (; items->count < count; items->count++)
        items->parts[items->count] = WORLD_TREE_NO_PART;
    return true;
}

static bool append(struct world_tree_part *part, uint32_t number)
{
    if (part->count == part->room) {
        const uint32_t room = part->room ? 2 * part->room : 16;
        uint32_t *grown = realloc(part->items, room * sizeof *grown);
        if (!grown)
            return fail();
        part->items = grown;
        part->room = room;
    }
    part->items[part->count++] = number;
    return true;
}

bool world_tree_set(struct world_tree *t, enum world_tree_kind kind, uint32_t index, uint32_t part,
                    const struct box_tree_box *box)
{
    struct world_tree_items *items = &t->items[kind];
    if (!reserve_items(items, index + 1))
        return false;
    const uint32_t before = items->parts[index];
    if (part != WORLD_TREE_NO_PART && part != before &&
        !append(&t->parts[part], index | (kind == WORLD_TREE_BOX ? t->box_bit : 0)))
        return false;
    note_change(t, before);
    note_change(t, part);
    items->parts[index] = part;
    if (part != WORLD_TREE_NO_PART)
        items->boxes[index] = *box;
    return true;
}

static int compare(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

static const struct world_tree_items *items_of(const struct world_tree *t, uint32_t number)
{
    return &t->items[number & t->box_bit ? WORLD_TREE_BOX : WORLD_TREE_PLACE];
}

/** Sorts the list, so that equal parts give equal trees. Removes items that have left the part. */
static void tidy(const struct world_tree *t, uint32_t index)
{
    struct world_tree_part *part = &t->parts[index];
    uint32_t kept = 0;
    if (part->count > 0)
        qsort(part->items, part->count, sizeof *part->items, compare);
    for (uint32_t i = 0; i < part->count; i++) {
        const uint32_t number = part->items[i];
        if (items_of(t, number)->parts[number & ~t->box_bit] == index &&
            (kept == 0 || part->items[kept - 1] != number))
            part->items[kept++] = number;
    }
    part->count = kept;
}

/** Reserves room behind all nodes, with some to grow. The part's old nodes are lost. */
static bool reserve_nodes(struct world_tree *t, struct world_tree_part *part, uint32_t count)
{
    if (count <= part->node_room)
        return true;
    const uint32_t room = count + count / 2, end = t->node_count + room;
    if (end > t->node_room) {
        const uint32_t grown_room = end + end / 2;
        struct box_tree_node *grown = realloc(t->nodes, grown_room * sizeof *grown);
        if (!grown)
            return fail();
        memset(grown + t->node_room, 0, (grown_room - t->node_room) * sizeof *grown);
        t->nodes = grown;
        t->node_room = grown_room;
    }
    part->first = t->node_count;
    part->node_room = room;
    t->node_count = end;
    return true;
}

static struct box_tree_node place_node(const struct world_tree_part *part,
                                       const struct box_tree *tree, uint32_t index)
{
    struct box_tree_node node = tree->nodes[index];
    node.first =
        node.count > 0 ? part->items[tree->order[node.first]] : part->first + node.first - 1;
    return node;
}

static bool build_tree(struct world_tree *t, uint32_t index, struct box_tree *tree)
{
    struct world_tree_part *part = &t->parts[index];
    const uint32_t above = index == WORLD_TREE_REST ? 1 : 1 + t->clusters->depth;
    const uint32_t depth = above < BOX_TREE_MOST_DEPTH ? BOX_TREE_MOST_DEPTH - above : 0;
    struct box_tree_box *boxes = malloc((part->count + 1u) * sizeof *boxes);
    if (part->count > 1u << depth) {
        fprintf(stderr,
                "%u shapes and boxes are in one cluster, and at most %u have room: render with the "
                "pipelines, or fewer instances\n",
                part->count, 1u << depth);
        free(boxes);
        return false;
    }
    for (uint32_t i = 0; boxes && i < part->count; i++)
        boxes[i] = items_of(t, part->items[i])->boxes[part->items[i] & ~t->box_bit];
    const bool done =
        (boxes && box_tree_build_within(boxes, part->count, 1, depth, tree)) || fail();
    free(boxes);
    return done;
}

static bool build_part(struct world_tree *t, uint32_t index, world_tree_written written,
                       void *user_data)
{
    struct world_tree_part *part = &t->parts[index];
    struct box_tree tree = {0};
    tidy(t, index);
    t->built_count += part->count;
    part->root = nothing;
    if (part->count == 0)
        return true;
    const bool done = build_tree(t, index, &tree) && reserve_nodes(t, part, tree.node_count - 1);
    if (done) {
        part->root = place_node(part, &tree, 0);
        for (uint32_t i = 1; i < tree.node_count; i++)
            t->nodes[part->first + i - 1] = place_node(part, &tree, i);
        if (tree.node_count > 1)
            written(user_data, part->first, tree.node_count - 1);
    }
    box_tree_finish(&tree);
    return done;
}

/** Returns a node over the two at `first`. */
static struct box_tree_node node_over(const struct world_tree *t, uint32_t first)
{
    const struct box_tree_node *children = &t->nodes[first];
    struct box_tree_box box = box_tree_empty_box();
    struct box_tree_node node = {.first = first};
    if (is_nothing(&children[0]) && is_nothing(&children[1]))
        return nothing;
    for (int i = 0; i < 2; i++) {
        if (is_nothing(&children[i]))
            continue;
        box_tree_add_point(&box, children[i].low);
        box_tree_add_point(&box, children[i].high);
    }
    memcpy(node.low, box.low, sizeof node.low);
    memcpy(node.high, box.high, sizeof node.high);
    return node;
}

/* Computes the upper nodes, from the end to the root, because children lie behind their parents. */
static void fit(struct world_tree *t)
{
    const struct box_tree *clusters = &t->clusters->tree;
    t->nodes[REST_NODE] = t->parts[WORLD_TREE_REST].root;
    t->nodes[CLUSTER_NODES] = nothing;
    for (uint32_t i = clusters->node_count; i-- > 0;)
        t->nodes[CLUSTER_NODES + i] = clusters->nodes[i].count > 0
                                          ? t->parts[1 + i].root
                                          : node_over(t, CLUSTER_NODES + clusters->nodes[i].first);
    t->nodes[0] = node_over(t, REST_NODE);
}

bool world_tree_build(struct world_tree *t, world_tree_written written, void *user_data)
{
    for (; t->changed_count > 0; t->changed_count--) {
        const uint32_t part = t->changed[t->changed_count - 1];
        if (!build_part(t, part, written, user_data))
            return false;
        t->parts[part].changed = false;
    }
    fit(t);
    written(user_data, 0, CLUSTER_NODES + (t->part_count > 1 ? t->part_count - 1 : 1));
    return true;
}
