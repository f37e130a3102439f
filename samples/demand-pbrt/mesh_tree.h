/** The compute path's twin of a mesh's structure: a tree over its triangles. */
#ifndef DEMAND_PBRT_MESH_TREE_H
#define DEMAND_PBRT_MESH_TREE_H

#include <sluice/pbrt.h>

#include "../common/box_tree.h"

/** Where it is on the device. */
struct mesh_tree {
    uint64_t address;        ///< of its nodes
    struct box_tree_box box; ///< around all triangles
};

/** False when out of memory, having said so on stderr. */
bool mesh_tree_build(const SluicePbrtMesh *mesh, struct box_tree *tree);

/** Words of what mesh_tree_write writes, at most. */
uint64_t mesh_tree_words(const SluicePbrtMesh *mesh, const struct box_tree *tree);
/**
 * Writes indices of the triangles in the order of the tree's leaves, the numbers of the triangles,
 * and, at the next multiple of four words from `base` on, the nodes. Returns where these begin.
 */
uint32_t *mesh_tree_write(const SluicePbrtMesh *mesh, const struct box_tree *tree,
                          const uint32_t *base, uint32_t *at);

#endif /* DEMAND_PBRT_MESH_TREE_H */
