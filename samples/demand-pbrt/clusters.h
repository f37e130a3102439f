/** Clusters of neighboring instances and shapes. A box around a cluster is resolved in steps. Needs
 * no device. */
#ifndef DEMAND_PBRT_CLUSTERS_H
#define DEMAND_PBRT_CLUSTERS_H

#include "../common/box_tree.h"

/** Factor: one step adds at most this many times the cluster size in nodes. Most trees take two
 * steps. */
#define CLUSTERS_FAN 4u

/** Clusters. A zeroed struct is empty: everything is added in one step. */
struct clusters {
    struct box_tree tree; ///< leaves are clusters; `order` holds the keys of their members
    uint32_t size;        ///< maximum of members per cluster
    uint32_t depth;       ///< maximum depth of the tree
};

/** Builds clusters. `keys` names each box and is copied. `canceled` may be NULL. Returns false when
 * out of memory, and when `*canceled` became true. */
bool clusters_create(const struct box_tree_box *boxes, const uint32_t *keys, uint32_t count,
                     uint32_t size, const atomic_bool *canceled, struct clusters *clusters);
void clusters_finish(struct clusters *clusters);

/** Returns an array by key: 1 + the node of the key's cluster, or 0 outside all clusters.
 * `key_count` must exceed all keys. The caller frees the array. Returns NULL when out of memory. */
uint32_t *clusters_list_nodes(const struct clusters *clusters, uint32_t key_count);

/** Contents of a resolved node: the keys of a cluster, or child nodes. */
struct cluster_step {
    const uint32_t *keys; ///< NULL: nodes
    uint32_t *nodes;      ///< owned by the caller, with room for CLUSTERS_FAN * size + 1
    uint32_t count;
};

/** Resolves a node. Set `step->nodes` before. */
void clusters_open(const struct clusters *clusters, uint32_t node, struct cluster_step *step);

#endif /* DEMAND_PBRT_CLUSTERS_H */
