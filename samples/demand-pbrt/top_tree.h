/** Tree over all placed shapes and boxes: the compute path's counterpart of the top-level
 * acceleration structure. */
#ifndef DEMAND_PBRT_TOP_TREE_H
#define DEMAND_PBRT_TOP_TREE_H

#include <sluice/proxy.h>

#include "pbrt_shared.h"
#include "table.h"
#include "world_tree.h"

/** Zeroed is empty. */
struct top_tree {
    struct gpu_buffer world; ///< holds the device address of the nodes
    struct gpu_buffer nodes;
    struct table instances; ///< struct PbrtInstance by place
    struct world_tree tree;
};

/** `clusters` must outlive the tree. Reports errors on stderr. */
bool top_tree_create(const struct gpu *gpu, const struct clusters *clusters, struct top_tree *tree);
void top_tree_finish(const struct gpu *gpu, struct top_tree *tree);

/** A placed mesh. */
struct top_tree_place {
    float to_world[12];
    struct box_tree_box box; ///< bounds of the mesh in its own space
    uint64_t nodes;          ///< device address of the mesh's tree
    bool opaque;
};

/** Sets the place `index` in a part of the world_tree. `place` NULL: removes it. Rays miss places
 * whose transform has no inverse. Call only while no launch is running. Reports errors on
 * stderr. */
bool top_tree_set(const struct gpu *gpu, struct top_tree *tree, uint32_t index, uint32_t part,
                  const struct top_tree_place *place);
/** Sets the box of a proxy. `box` NULL: removes it. */
bool top_tree_set_box(struct top_tree *tree, uint32_t index, uint32_t part,
                      const SluiceProxyBox *box);
/** Builds changed parts. Call only while no launch is running. Reports errors on stderr. */
bool top_tree_build(const struct gpu *gpu, struct top_tree *tree);

#endif /* DEMAND_PBRT_TOP_TREE_H */
