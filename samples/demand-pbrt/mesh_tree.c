#include "mesh_tree.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LEAF_TRIANGLES 4
#define NODE_WORDS (sizeof(struct box_tree_node) / sizeof(uint32_t))

bool mesh_tree_build(const SluicePbrtMesh *mesh, struct box_tree *tree)
{
    const uint32_t count = mesh->triangleCount;
    struct box_tree_box *boxes = malloc(count * sizeof *boxes);
    *tree = (struct box_tree){0};
    for (uint32_t i = 0; boxes && i < count; i++) {
        boxes[i] = box_tree_empty_box();
        for (int corner = 0; corner < 3; corner++)
            box_tree_add_point(&boxes[i], mesh->pPositions +
                                              3 * (size_t)mesh->pIndices[3 * (size_t)i + corner]);
    }
    const bool done = boxes && box_tree_build(boxes, count, LEAF_TRIANGLES, tree);
    if (!done)
        fprintf(stderr, "out of memory\n");
    free(boxes);
    return done;
}

uint64_t mesh_tree_words(const SluicePbrtMesh *mesh, const struct box_tree *tree)
{
    return 4ull * mesh->triangleCount + 3 + (uint64_t)NODE_WORDS * tree->node_count;
}

uint32_t *mesh_tree_write(const SluicePbrtMesh *mesh, const struct box_tree *tree,
                          const uint32_t *base, uint32_t *at)
{
    const size_t count = mesh->triangleCount;
    for (size_t i = 0; i < count; i++)
        memcpy(at + 3 * i, mesh->pIndices + 3 * (size_t)tree->order[i], 3 * sizeof *at);
    memcpy(at + 3 * count, tree->order, count * sizeof *at);
    const size_t end = (size_t)(at - base) + 4 * count;
    uint32_t *nodes = at + 4 * count + (4 - end % 4) % 4;
    memcpy(nodes, tree->nodes, tree->node_count * sizeof *tree->nodes);
    return nodes;
}
