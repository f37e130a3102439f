#include "top_tree.h"

#include <math.h>
#include <string.h>

#include "../common/ray_table.h"
#include "transform.h"

#define NODE_USAGE (VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT)

bool top_tree_create(const struct gpu *gpu, const struct clusters *clusters, struct top_tree *t)
{
    *t = (struct top_tree){.instances.element = sizeof(struct PbrtInstance)};
    return world_tree_create(clusters, PBRT_ITEM_BOX, &t->tree) &&
           gpu_create_buffer(gpu, 4 * sizeof(uint32_t), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                             &t->world) &&
           table_grow(gpu, &t->instances, 1);
}

void top_tree_finish(const struct gpu *gpu, struct top_tree *t)
{
    gpu_destroy_buffer(gpu, &t->world);
    gpu_destroy_buffer(gpu, &t->nodes);
    table_finish(gpu, &t->instances);
    world_tree_finish(&t->tree);
    *t = (struct top_tree){0};
}

/** Returns the box around the eight transformed corners, rounded outward. */
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

bool top_tree_set(const struct gpu *gpu, struct top_tree *t, uint32_t index, uint32_t part,
                  const struct top_tree_place *place)
{
    float inverse[12];
    if (!table_grow(gpu, &t->instances, index + 1))
        return false;
    if (!place || !transform_invert(place->to_world, inverse))
        return world_tree_set(&t->tree, WORLD_TREE_PLACE, index, WORLD_TREE_NO_PART, NULL);
    struct PbrtInstance entry = {.nodes = {(uint32_t)place->nodes, (uint32_t)(place->nodes >> 32)},
                                 .flags = place->opaque ? PBRT_INSTANCE_OPAQUE : 0};
    memcpy(entry.toWorld, place->to_world, sizeof entry.toWorld);
    for (int r = 0; r < 3; r++)
        memcpy(entry.toObject + 3 * r, inverse + 4 * r, 3 * sizeof *inverse);
    *(struct PbrtInstance *)table_at(&t->instances, index) = entry;
    const struct box_tree_box box = world_box(place->to_world, &place->box);
    return world_tree_set(&t->tree, WORLD_TREE_PLACE, index, part, &box);
}

bool top_tree_set_box(struct top_tree *t, uint32_t index, uint32_t part, const SluiceProxyBox *box)
{
    struct box_tree_box copy;
    if (!box)
        return world_tree_set(&t->tree, WORLD_TREE_BOX, index, WORLD_TREE_NO_PART, NULL);
    memcpy(copy.low, box->min, sizeof copy.low);
    memcpy(copy.high, box->max, sizeof copy.high);
    return world_tree_set(&t->tree, WORLD_TREE_BOX, index, part, &copy);
}

/** Copies nodes that fit into the buffer. The others are copied after it has grown. */
static void copy_nodes(void *user_data, uint32_t first, uint32_t count)
{
    const struct top_tree *t = user_data;
    struct box_tree_node *nodes = t->nodes.mapped;
    if ((first + (VkDeviceSize)count) * sizeof *nodes <= t->nodes.size)
        memcpy(nodes + first, t->tree.nodes + first, count * sizeof *nodes);
}

static bool grow_nodes(const struct gpu *gpu, struct top_tree *t)
{
    const VkDeviceSize size = (VkDeviceSize)t->tree.node_count * sizeof *t->tree.nodes;
    if (t->nodes.size >= size)
        return true;
    gpu_destroy_buffer(gpu, &t->nodes);
    if (!gpu_create_buffer(gpu, size + size / 2, NODE_USAGE, &t->nodes))
        return false;
    const uint64_t address = ray_buffer_address(gpu, t->nodes.buffer);
    memcpy(t->world.mapped, &(uint32_t[2]){(uint32_t)address, (uint32_t)(address >> 32)},
           2 * sizeof(uint32_t));
    memcpy(t->nodes.mapped, t->tree.nodes, size);
    return true;
}

bool top_tree_build(const struct gpu *gpu, struct top_tree *t)
{
    return world_tree_build(&t->tree, copy_nodes, t) && grow_nodes(gpu, t);
}
