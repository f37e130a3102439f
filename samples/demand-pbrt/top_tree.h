/** The compute path's twin of the top level: a tree over the shapes in the world and all boxes. */
#ifndef DEMAND_PBRT_TOP_TREE_H
#define DEMAND_PBRT_TOP_TREE_H

#include <sluice/proxy.h>

#include "../common/box_tree.h"
#include "pbrt_shared.h"
#include "table.h"

/** Zeroed is empty. */
struct top_tree {
    struct gpu_buffer world; ///< address of the nodes
    struct gpu_buffer nodes;
    struct table instances;     ///< struct PbrtInstance by place
    struct box_tree_box *boxes; ///< owned; of each place in the world. Empty: it is not there.
    uint32_t room;
};

/** Says on stderr why it failed. */
bool top_tree_create(const struct gpu *gpu, struct top_tree *tree);
void top_tree_finish(const struct gpu *gpu, struct top_tree *tree);

/** A mesh in the world. */
struct top_tree_place {
    float to_world[12];
    struct box_tree_box box; ///< of the mesh, in its own space
    uint64_t nodes;          ///< address of its tree
    bool opaque;
};

/** `place` NULL: there is nothing any more. What has no inverse is not hit. No launch is under way.
 *  Says on stderr why it failed. */
bool top_tree_set(const struct gpu *gpu, struct top_tree *tree, uint32_t index,
                  const struct top_tree_place *place);
/** Boxes of size 0 are left out. No launch is under way. Says on stderr why it failed. */
bool top_tree_build(const struct gpu *gpu, struct top_tree *tree, const SluiceProxyBox *boxes,
                    uint32_t box_count);

#endif /* DEMAND_PBRT_TOP_TREE_H */
