#include "bvh.h"

#include <stdlib.h>
#include <string.h>

#include "../common/box_tree.h"

#define LEAF_TRIANGLES 4

static bool reserve(struct bvh *bvh, size_t count)
{
    if (bvh->count + count <= bvh->capacity)
        return true;
    const size_t capacity = 2 * bvh->capacity + count;
    struct TracerNode *grown = realloc(bvh->nodes, capacity * sizeof *grown);
    if (!grown)
        return false;
    bvh->nodes = grown;
    bvh->capacity = capacity;
    return true;
}

/** Appends the nodes of a tree. */
static bool add_tree(struct bvh *bvh, const struct box_tree *tree, uint32_t *root)
{
    if (!reserve(bvh, tree->node_count))
        return false;
    *root = (uint32_t)bvh->count;
    for (uint32_t i = 0; i < tree->node_count; i++) {
        const struct box_tree_node *node = &tree->nodes[i];
        struct TracerNode *added = &bvh->nodes[bvh->count++];
        added->first = node->first + (node->count == 0 ? *root : 0);
        added->count = node->count;
        memcpy(added->low, node->low, sizeof added->low);
        memcpy(added->high, node->high, sizeof added->high);
    }
    return true;
}

static struct box_tree_box triangle_box(const struct mesh *mesh, const uint32_t corners[3])
{
    struct box_tree_box box = box_tree_empty_box();
    for (int i = 0; i < 3; i++)
        box_tree_add_point(&box, mesh->vertices[corners[i]].position);
    return box;
}

bool bvh_add_triangles(struct bvh *bvh, struct mesh *mesh, uint32_t first_index,
                       uint32_t index_count, uint32_t *root)
{
    const uint32_t count = index_count / 3;
    uint32_t *indices = mesh->indices + first_index;
    uint32_t *sorted = malloc(index_count * sizeof *sorted);
    struct box_tree_box *boxes = malloc(count * sizeof *boxes);
    struct box_tree tree = {0};
    bool done = sorted && boxes;
    for (uint32_t i = 0; done && i < count; i++)
        boxes[i] = triangle_box(mesh, indices + 3 * i);
    done =
        done && box_tree_build(boxes, count, LEAF_TRIANGLES, &tree) && add_tree(bvh, &tree, root);
    for (uint32_t i = 0; done && i < count; i++)
        memcpy(sorted + 3 * i, indices + 3 * tree.order[i], 3 * sizeof *sorted);
    if (done)
        memcpy(indices, sorted, index_count * sizeof *sorted);
    box_tree_finish(&tree);
    free(boxes);
    free(sorted);
    return done;
}

/** Returns the box around the transformed corners of the shape's box. */
static struct box_tree_box instance_box(const struct bvh *bvh,
                                        const struct TracerInstance *instance)
{
    const struct TracerNode *root = &bvh->nodes[instance->rootNode];
    struct box_tree_box box = box_tree_empty_box();
    for (int corner = 0; corner < 8; corner++) {
        float point[3];
        for (int row = 0; row < 3; row++) {
            const float *m = instance->toWorld + 4 * row;
            point[row] = m[3];
            for (int axis = 0; axis < 3; axis++)
                point[row] += m[axis] * (corner >> axis & 1 ? root->high[axis] : root->low[axis]);
        }
        box_tree_add_point(&box, point);
    }
    return box;
}

bool bvh_add_instances(struct bvh *bvh, const struct TracerInstance *instances, uint32_t count)
{
    struct box_tree_box *boxes = malloc(count * sizeof *boxes);
    struct box_tree tree = {0};
    bool done = boxes;
    for (uint32_t i = 0; done && i < count; i++)
        boxes[i] = instance_box(bvh, &instances[i]);
    done = done && box_tree_build(boxes, count, 1, &tree);
    for (uint32_t i = 0; done && i < tree.node_count; i++)
        if (tree.nodes[i].count > 0)
            tree.nodes[i].first = tree.order[tree.nodes[i].first];
    done = done && add_tree(bvh, &tree, &bvh->scene_root);
    box_tree_finish(&tree);
    free(boxes);
    return done;
}

void bvh_finish(struct bvh *bvh)
{
    free(bvh->nodes);
    memset(bvh, 0, sizeof *bvh);
}
