#include "top_tree.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../common/ray_table.h"
#include "transform.h"

#define NODE_USAGE (VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT)

/* What the tree is built of. */
struct items {
    struct box_tree_box *boxes; ///< owned
    uint32_t *numbers;          ///< owned; what shaders are told
    uint32_t count;
};

bool top_tree_create(const struct gpu *gpu, struct top_tree *t)
{
    *t = (struct top_tree){.instances.element = sizeof(struct PbrtInstance)};
    return gpu_create_buffer(gpu, 4 * sizeof(uint32_t), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                             &t->world) &&
           table_grow(gpu, &t->instances, 1);
}

void top_tree_finish(const struct gpu *gpu, struct top_tree *t)
{
    gpu_destroy_buffer(gpu, &t->world);
    gpu_destroy_buffer(gpu, &t->nodes);
    table_finish(gpu, &t->instances);
    free(t->boxes);
    *t = (struct top_tree){0};
}

/** Around the eight corners of a box, rounded outward. */
static struct box_tree_box world_box(const float m[12], const struct box_tree_box *box)
{
    struct box_tree_box world = box_tree_empty_box();
    for (int corner = 0; corner < 8; corner++) {
        float low[3], high[3];
        for (int r = 0; r < 3; r++) {
            double at = m[4 * r + 3];
            for (int c = 0; c < 3; c++)
                at += (double)m[4 * r + c] * (corner >> c & 1 ? box->high[c] : box->low[c]);
            low[r] = nextafterf((float)at, -INFINITY);
            high[r] = nextafterf((float)at, INFINITY);
        }
        box_tree_add_point(&world, low);
        box_tree_add_point(&world, high);
    }
    return world;
}

static bool reserve(struct top_tree *t, uint32_t count)
{
    if (count <= t->room)
        return true;
    const uint32_t room = count < 64 ? 64 : count + count / 2;
    struct box_tree_box *grown = realloc(t->boxes, room * sizeof *grown);
    if (!grown) {
        fprintf(stderr, "out of memory\n");
        return false;
    }
    t->boxes = grown;
    for (uint32_t i = t->room; i < room; i++)
        t->boxes[i] = box_tree_empty_box();
    t->room = room;
    return true;
}

bool top_tree_set(const struct gpu *gpu, struct top_tree *t, uint32_t index,
                  const struct top_tree_place *place)
{
    float inverse[12];
    if (!reserve(t, index + 1) || !table_grow(gpu, &t->instances, index + 1))
        return false;
    t->boxes[index] = box_tree_empty_box();
    if (!place || !transform_invert(place->to_world, inverse))
        return true;
    struct PbrtInstance entry = {.nodes = {(uint32_t)place->nodes, (uint32_t)(place->nodes >> 32)},
                                 .flags = place->opaque ? PBRT_INSTANCE_OPAQUE : 0};
    memcpy(entry.toWorld, place->to_world, sizeof entry.toWorld);
    for (int r = 0; r < 3; r++)
        memcpy(entry.toObject + 3 * r, inverse + 4 * r, 3 * sizeof *inverse);
    *(struct PbrtInstance *)table_at(&t->instances, index) = entry;
    t->boxes[index] = world_box(place->to_world, &place->box);
    return true;
}

static void add_item(struct items *items, const struct box_tree_box *box, uint32_t number)
{
    items->boxes[items->count] = *box;
    items->numbers[items->count++] = number;
}

static bool gather(const struct top_tree *t, const SluiceProxyBox *boxes, uint32_t box_count,
                   struct items *items)
{
    const size_t most = (size_t)t->instances.count + box_count;
    items->boxes = malloc(most * sizeof *items->boxes);
    items->numbers = malloc(most * sizeof *items->numbers);
    if (!items->boxes || !items->numbers)
        return false;
    for (uint32_t i = 0; i < t->instances.count && i < t->room; i++)
        if (t->boxes[i].low[0] <= t->boxes[i].high[0])
            add_item(items, &t->boxes[i], i);
    for (uint32_t i = 0; i < box_count; i++) {
        struct box_tree_box box;
        memcpy(box.low, boxes[i].min, sizeof box.low);
        memcpy(box.high, boxes[i].max, sizeof box.high);
        if (box.low[0] < box.high[0])
            add_item(items, &box, i | PBRT_ITEM_BOX);
    }
    return true;
}

static bool write_nodes(const struct gpu *gpu, struct top_tree *t, const struct items *items,
                        const struct box_tree *tree)
{
    const struct box_tree_node nothing = {.first = PBRT_NONE, .count = 1};
    const uint32_t count = tree->node_count ? tree->node_count : 1;
    const VkDeviceSize size = (VkDeviceSize)count * sizeof *tree->nodes;
    if (t->nodes.size < size) {
        gpu_destroy_buffer(gpu, &t->nodes);
        if (!gpu_create_buffer(gpu, size + size / 2, NODE_USAGE, &t->nodes))
            return false;
        const uint64_t address = ray_buffer_address(gpu, t->nodes.buffer);
        memcpy(t->world.mapped, &(uint32_t[2]){(uint32_t)address, (uint32_t)(address >> 32)},
               2 * sizeof(uint32_t));
    }
    struct box_tree_node *nodes = t->nodes.mapped;
    nodes[0] = nothing;
    for (uint32_t i = 0; i < tree->node_count; i++) {
        struct box_tree_node node = tree->nodes[i];
        if (node.count > 0)
            node.first = items->numbers[tree->order[node.first]];
        nodes[i] = node;
    }
    return true;
}

bool top_tree_build(const struct gpu *gpu, struct top_tree *t, const SluiceProxyBox *boxes,
                    uint32_t box_count)
{
    struct items items = {0};
    struct box_tree tree = {0};
    bool done =
        gather(t, boxes, box_count, &items) && box_tree_build(items.boxes, items.count, 1, &tree);
    if (!done)
        fprintf(stderr, "out of memory\n");
    done = done && write_nodes(gpu, t, &items, &tree);
    box_tree_finish(&tree);
    free(items.boxes);
    free(items.numbers);
    return done;
}
