/** Instances and shapes in clusters that lie near each other: what a box around many of them
 * becomes step by step. No device. */
#ifndef DEMAND_PBRT_CLUSTERS_H
#define DEMAND_PBRT_CLUSTERS_H

#include "../common/box_tree.h"

/** Nodes of a tree that one step adds, by the size of a cluster: most trees take two steps. */
#define CLUSTERS_FAN 4u

/** Zeroed is empty: everything is added in one step. */
struct clusters {
    struct box_tree tree; ///< leaves are clusters; `order` has the keys of what is in them
    uint32_t size;        ///< most that is in a cluster
    uint32_t depth;       ///< of the tree, at most
};

/** Where `keys` has a name for each box. `keys` is copied. False when out of memory, and when
 *  `*canceled`, which may be NULL, became true. */
bool clusters_create(const struct box_tree_box *boxes, const uint32_t *keys, uint32_t count,
                     uint32_t size, const atomic_bool *canceled, struct clusters *clusters);
void clusters_finish(struct clusters *clusters);

/** For each key 1 + the node of its cluster, and 0 for those in none. `key_count` is beyond all
 * keys. The caller frees it. NULL when out of memory. */
uint32_t *clusters_list_nodes(const struct clusters *clusters, uint32_t key_count);

/** What a node becomes: keys, if it is a cluster, or else nodes below it. */
struct cluster_step {
    const uint32_t *keys; ///< NULL: nodes
    uint32_t *nodes;      ///< owned by the caller, with room for CLUSTERS_FAN times the size + 1
    uint32_t count;
};

/** `step->nodes` is given. */
void clusters_open(const struct clusters *clusters, uint32_t node, struct cluster_step *step);

#endif /* DEMAND_PBRT_CLUSTERS_H */
