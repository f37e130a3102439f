/** The compute path's twin of the top level on the device: the tree over the shapes in the world
 * and all boxes. */
#ifndef DEMAND_PBRT_TOP_TREE_H
#define DEMAND_PBRT_TOP_TREE_H

#include <sluice/proxy.h>

#include "pbrt_shared.h"
#include "table.h"
#include "world_tree.h"

/** Zeroed is empty. */
struct top_tree {
    struct gpu_buffer world; ///< address of the nodes
    struct gpu_buffer nodes;
    struct table instances; ///< struct PbrtInstance by place
    struct world_tree tree;
};

/** `clusters` outlives the tree. Says on stderr why it failed. */
bool top_tree_create(const struct gpu *gpu, const struct clusters *clusters, struct top_tree *tree);
void top_tree_finish(const struct gpu *gpu, struct top_tree *tree);

/** A mesh in the world. */
struct top_tree_place {
    float to_world[12];
    struct box_tree_box box; ///< of the mesh, in its own space
    uint64_t nodes;          ///< address of its tree
    bool opaque;
};

/** In a part of the world_tree. `place` NULL: there is nothing any more. What has no inverse is not
 *  hit. No launch is under way. Says on stderr why it failed. */
bool top_tree_set(const struct gpu *gpu, struct top_tree *tree, uint32_t index, uint32_t part,
                  const struct top_tree_place *place);
/** The same for the box of a proxy. */
bool top_tree_set_box(struct top_tree *tree, uint32_t index, uint32_t part,
                      const SluiceProxyBox *box);
/** Builds what has changed. No launch is under way. Says on stderr why it failed. */
bool top_tree_build(const struct gpu *gpu, struct top_tree *tree);

#endif /* DEMAND_PBRT_TOP_TREE_H */
