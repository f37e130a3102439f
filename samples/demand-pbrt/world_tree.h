/** The compute path's tree over the world in host memory. Each cluster is a part. Only changed
 * parts are rebuilt. Needs no device. */
#ifndef DEMAND_PBRT_WORLD_TREE_H
#define DEMAND_PBRT_WORLD_TREE_H

#include "clusters.h"

/** `first` of an empty leaf. */
#define WORLD_TREE_NOTHING 0xffffffffu
/** Part of all items outside clusters. The part of a cluster is 1 + its node in the tree. */
#define WORLD_TREE_REST 0u
#define WORLD_TREE_NO_PART 0xffffffffu

/** Kinds of items. Each kind has its own numbering. */
enum world_tree_kind { WORLD_TREE_PLACE, WORLD_TREE_BOX };

struct world_tree_part {
    uint32_t *items; ///< owned; item numbers as in leaves. May hold removed and duplicate items.
    uint32_t count, room;
    uint32_t first, node_room; ///< range of its nodes, without its root
    bool changed;
    struct box_tree_node root;
};

struct world_tree_items {
    struct box_tree_box *boxes; ///< owned
    uint32_t *parts;            ///< owned; WORLD_TREE_NO_PART: absent
    uint32_t count, room;
};

/** Zeroed is empty. */
struct world_tree {
    const struct clusters *clusters;
    uint32_t box_bit; ///< set in the item numbers of boxes
    struct world_tree_items items[2];
    struct world_tree_part *parts; ///< owned
    uint32_t part_count;
    uint32_t *changed; ///< owned; indices of changed parts
    uint32_t changed_count;
    struct box_tree_node *nodes; ///< owned; the first is the root. Leaves have one item, `first`.
    uint32_t node_count, node_room;
    uint64_t built_count; ///< items in rebuilt parts, since the start
};

/** `clusters` must outlive the tree; may be empty. Reports errors on stderr. */
bool world_tree_create(const struct clusters *clusters, uint32_t box_bit, struct world_tree *tree);
void world_tree_finish(struct world_tree *tree);

/** Moves an item to a part. WORLD_TREE_NO_PART removes it. Reports errors on stderr. */
bool world_tree_set(struct world_tree *tree, enum world_tree_kind kind, uint32_t index,
                    uint32_t part, const struct box_tree_box *box);

/** Called for rewritten nodes: the ones at the beginning, and the ones of a part. */
typedef void (*world_tree_written)(void *user_data, uint32_t first, uint32_t count);

/** Builds changed parts, and refits the nodes above them. Reports errors on stderr. */
bool world_tree_build(struct world_tree *tree, world_tree_written written, void *user_data);

#endif /* DEMAND_PBRT_WORLD_TREE_H */
