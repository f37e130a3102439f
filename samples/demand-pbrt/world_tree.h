/** The compute path's tree over the world in host memory: a part for each cluster, of which only
 *  those that changed are built anew. No device. */
#ifndef DEMAND_PBRT_WORLD_TREE_H
#define DEMAND_PBRT_WORLD_TREE_H

#include "clusters.h"

/** `first` of a leaf with nothing in it. */
#define WORLD_TREE_NOTHING 0xffffffffu
/** The part of all that is in no cluster. That of a cluster is 1 + its node in the tree. */
#define WORLD_TREE_REST 0u
#define WORLD_TREE_NO_PART 0xffffffffu

/** Items of two kinds have numbers of their own. */
enum world_tree_kind { WORLD_TREE_PLACE, WORLD_TREE_BOX };

struct world_tree_part {
    uint32_t *items; ///< owned; numbers as leaves have them; some have left, some are in it twice
    uint32_t count, room;
    uint32_t first, node_room; ///< of its nodes but the first
    bool changed;
    struct box_tree_node root;
};

struct world_tree_items {
    struct box_tree_box *boxes; ///< owned
    uint32_t *parts;            ///< owned; WORLD_TREE_NO_PART: it is not there
    uint32_t count, room;
};

/** Zeroed is empty. */
struct world_tree {
    const struct clusters *clusters;
    uint32_t box_bit; ///< of the numbers of boxes in leaves
    struct world_tree_items items[2];
    struct world_tree_part *parts; ///< owned
    uint32_t part_count;
    uint32_t *changed; ///< owned; parts
    uint32_t changed_count;
    struct box_tree_node *nodes; ///< owned; the first is the root. Leaves have one item, `first`.
    uint32_t node_count, node_room;
    uint64_t built_count; ///< items in parts that were built, since the beginning
};

/** `clusters` outlives the tree; it may be empty. Says on stderr why it failed. */
bool world_tree_create(const struct clusters *clusters, uint32_t box_bit, struct world_tree *tree);
void world_tree_finish(struct world_tree *tree);

/** Puts an item in a part, or with WORLD_TREE_NO_PART takes it away. Says on stderr why it failed.
 */
bool world_tree_set(struct world_tree *tree, enum world_tree_kind kind, uint32_t index,
                    uint32_t part, const struct box_tree_box *box);

/** Tells of nodes that are new: those at the beginning, and those of a part. */
typedef void (*world_tree_written)(void *user_data, uint32_t first, uint32_t count);

/** Builds parts that have changed, and fits the nodes above them. Says on stderr why it failed. */
bool world_tree_build(struct world_tree *tree, world_tree_written written, void *user_data);

#endif /* DEMAND_PBRT_WORLD_TREE_H */
