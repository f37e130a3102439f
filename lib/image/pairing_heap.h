/**
 * A heap of nodes that live in what they order: adding and removing need no memory, and any node
 * can be removed. In a heap of n, adding takes constant time, removing log n on average.
 */
#ifndef SLC_IMAGE_PAIRING_HEAP_H
#define SLC_IMAGE_PAIRING_HEAP_H

#include <stdbool.h>
#include <stddef.h>

struct slc_heap_node {
    struct slc_heap_node *child; ///< the first of those that come after it
    struct slc_heap_node *next;  ///< sibling
    struct slc_heap_node **link; ///< what points here; NULL: in no heap
};

struct slc_pairing_heap {
    struct slc_heap_node *root; ///< the first; NULL: empty
    bool (*is_before)(const struct slc_heap_node *a, const struct slc_heap_node *b);
};

/** The node must be in no heap. */
void slc_pairing_heap_add(struct slc_pairing_heap *heap, struct slc_heap_node *node);

/** The node must be in this heap; what orders it may have changed, what orders others not. */
void slc_pairing_heap_remove(struct slc_pairing_heap *heap, struct slc_heap_node *node);

static inline bool slc_heap_node_is_in(const struct slc_heap_node *node)
{
    return node->link != NULL;
}

/** The struct that a node is a member of. */
#define SLC_CONTAINER_OF(node, type, member)                                                       \
    ((type *)(void *)((char *)(node)-offsetof(type, member)))

#endif /* SLC_IMAGE_PAIRING_HEAP_H */
