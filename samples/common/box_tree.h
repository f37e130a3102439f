/**
 * Trees of boxes for devices without ray tracing. Equal boxes give equal trees. box_tree.glsl tests
 * which boxes a ray enters.
 */
#ifndef SAMPLES_COMMON_BOX_TREE_H
#define SAMPLES_COMMON_BOX_TREE_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

/** Limit of a leaf's depth; the root has depth 0. A walk that visits the nearer child first keeps
 * at most one node more than this. */
#define BOX_TREE_MOST_DEPTH 30u

struct box_tree_box {
    float low[3], high[3];
};

/** A box around two nodes, `first` and `first` + 1, or around `count` boxes. */
struct box_tree_node {
    float low[3];
    uint32_t first;
    float high[3];
    uint32_t count; ///< 0: the box is around nodes
};

/** Zeroed is empty. */
struct box_tree {
    struct box_tree_node *nodes; ///< owned; the first is the root
    uint32_t node_count;         ///< 0: no boxes
    uint32_t *order;             ///< owned; box indices; each leaf has a range
};

/**
 * Builds a tree whose leaves have at most `leaf_size` boxes, by binned surface areas (Wald, "On
 * fast Construction of SAH-based Bounding Volume Hierarchies", 2007). `count`: at most 2^30. Boxes
 * with values that are not finite may lie in any leaf. Returns false when out of memory, with
 * nothing built.
 */
bool box_tree_build(const struct box_tree_box *boxes, uint32_t count, uint32_t leaf_size,
                    struct box_tree *tree);
/** Builds a tree like box_tree_build, with leaves at a depth of at most `depth`: 1 to
 * BOX_TREE_MOST_DEPTH. `count`: at most `leaf_size` << `depth`. */
bool box_tree_build_within(const struct box_tree_box *boxes, uint32_t count, uint32_t leaf_size,
                           uint32_t depth, struct box_tree *tree);
/** box_tree_build_within until `*canceled` is true; NULL: to the end. False when it was canceled,
 *  too: nothing is built. */
bool box_tree_build_until(const struct box_tree_box *boxes, uint32_t count, uint32_t leaf_size,
                          uint32_t depth, const atomic_bool *canceled, struct box_tree *tree);
void box_tree_finish(struct box_tree *tree);

struct box_tree_box box_tree_empty_box(void);
void box_tree_add_point(struct box_tree_box *box, const float point[3]);

#endif /* SAMPLES_COMMON_BOX_TREE_H */
