/** Tree over a mesh's triangles: the compute path's counterpart of an acceleration structure. */
#ifndef DEMAND_PBRT_MESH_TREE_H
#define DEMAND_PBRT_MESH_TREE_H

#include <sluice/pbrt.h>

#include "../common/box_tree.h"

/** Device address and bounds of a mesh's tree. */
struct mesh_tree {
    uint64_t address;        ///< device address of the nodes
    struct box_tree_box box; ///< bounds of all triangles
};

/** Returns false when out of memory, and says so on stderr. */
bool mesh_tree_build(const SluicePbrtMesh *mesh, struct box_tree *tree);

/** Upper bound of the words that mesh_tree_write writes. */
uint64_t mesh_tree_words(const SluicePbrtMesh *mesh, const struct box_tree *tree);
/**
 * Writes the triangle indices in the order of the tree's leaves, then the triangles' file numbers,
 * then the nodes. The nodes begin at a multiple of four words from `base`. Returns their begin.
 */
uint32_t *mesh_tree_write(const SluicePbrtMesh *mesh, const struct box_tree *tree,
                          const uint32_t *base, uint32_t *at);

#endif /* DEMAND_PBRT_MESH_TREE_H */
