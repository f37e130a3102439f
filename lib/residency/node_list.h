/** Lists of nodes, linked by `prev` and `next`. */
#ifndef SLC_RESIDENCY_NODE_LIST_H
#define SLC_RESIDENCY_NODE_LIST_H

#include "residency/machine.h"

static inline void slc_list_append(const struct slc_machine *r, struct slc_list *list,
                                   uint32_t node)
{
    slc_node_at(r, node)->prev = list->tail;
    slc_node_at(r, node)->next = 0;
    if (list->tail)
        slc_node_at(r, list->tail)->next = node;
    else
        list->head = node;
    list->tail = node;
    list->count++;
}

static inline void slc_list_remove(const struct slc_machine *r, struct slc_list *list,
                                   uint32_t node)
{
    const struct slc_node *n = slc_node_at(r, node);
    if (n->prev)
        slc_node_at(r, n->prev)->next = n->next;
    else
        list->head = n->next;
    if (n->next)
        slc_node_at(r, n->next)->prev = n->prev;
    else
        list->tail = n->prev;
    list->count--;
}

#endif /* SLC_RESIDENCY_NODE_LIST_H */
