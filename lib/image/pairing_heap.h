/**
 * Intrusive heap: its nodes are members of the ordered structs. So adding and removing need no
 * memory, and any node can be removed. Adding takes constant time, removing log n on average.
 */
#ifndef SLC_IMAGE_PAIRING_HEAP_H
#define SLC_IMAGE_PAIRING_HEAP_H

#include <stdbool.h>
#include <stddef.h>

struct slc_heap_node {
    struct slc_heap_node *child; ///< first child; children come later in order
    struct slc_heap_node *next;  ///< sibling
    struct slc_heap_node **link; ///< the pointer to this node; NULL: in no heap
};

struct slc_pairing_heap {
    struct slc_heap_node *root; ///< the first; NULL: empty
    bool (*is_before)(const struct slc_heap_node *a, const struct slc_heap_node *b);
};

/** Adds a node that is in no heap. */
void slc_pairing_heap_add(struct slc_pairing_heap *heap, struct slc_heap_node *node);

/** Removes a node of this heap. Its own sort key may have changed, keys of other nodes may not. */
void slc_pairing_heap_remove(struct slc_pairing_heap *heap, struct slc_heap_node *node);

static inline bool slc_heap_node_is_in(const struct slc_heap_node *node)
{
    return node->link != NULL;
}

/** Returns the struct that has a node as member. */
#define SLC_CONTAINER_OF(node, type, member)                                                       \
    ((type *)(void *)((char *)(node)-offsetof(type, member)))

#endif /* SLC_IMAGE_PAIRING_HEAP_H */
