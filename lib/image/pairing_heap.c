/* Fredman, Sedgewick, Sleator, Tarjan: "The pairing heap", Algorithmica 1 (1986). */
#include "image/pairing_heap.h"

#include <assert.h>

/* Melds two trees, of which either may be NULL. Roots have no siblings. */
static struct slc_heap_node *meld(const struct slc_pairing_heap *heap, struct slc_heap_node *a,
                                  struct slc_heap_node *b)
{
    if (!a || !b)
        return a ? a : b;
    struct slc_heap_node *first = heap->is_before(b, a) ? b : a;
    struct slc_heap_node *second = first == a ? b : a;
    second->next = first->child;
    if (second->next)
        second->next->link = &second->next;
    first->child = second;
    second->link = &first->child;
    return first;
}

/* Melds siblings into one tree: in pairs from the left, then all from the right. */
static struct slc_heap_node *meld_siblings(const struct slc_pairing_heap *heap,
                                           struct slc_heap_node *first)
{
    struct slc_heap_node *pairs = NULL, *tree = NULL;
    while (first) {
        struct slc_heap_node *a = first, *b = first->next;
        first = b ? b->next : NULL;
        a->next = NULL;
        if (b)
            b->next = NULL;
        a = meld(heap, a, b);
        a->next = pairs;
        pairs = a;
    }
    while (pairs) {
        struct slc_heap_node *rest = pairs->next;
        pairs->next = NULL;
        tree = meld(heap, tree, pairs);
        pairs = rest;
    }
    return tree;
}

static void add_tree(struct slc_pairing_heap *heap, struct slc_heap_node *tree)
{
    heap->root = meld(heap, heap->root, tree);
    if (heap->root)
        heap->root->link = &heap->root;
}

void slc_pairing_heap_add(struct slc_pairing_heap *heap, struct slc_heap_node *node)
{
    assert(!slc_heap_node_is_in(node));
    node->child = node->next = NULL;
    add_tree(heap, node);
}

void slc_pairing_heap_remove(struct slc_pairing_heap *heap, struct slc_heap_node *node)
{
    assert(slc_heap_node_is_in(node));
    *node->link = node->next;
    if (node->next)
        node->next->link = node->link;
    add_tree(heap, meld_siblings(heap, node->child));
    *node = (struct slc_heap_node){0};
}
