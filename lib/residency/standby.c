#include "residency/standby.h"

#include "residency/node_list.h"

void slc_list_for_unmapping(struct slc_machine *r, uint32_t node)
{
    struct slc_node *n = slc_node_at(r, node);
    slc_list_remove(r, slc_standby_list(r, n), node);
    n->flags |= SLC_NODE_LISTED;
    slc_list_append(r, &r->evicted, node);
}

static void evict_oldest(struct slc_machine *r, const struct slc_list *standby, uint32_t keep)
{
    while (standby->count > keep)
        slc_list_for_unmapping(r, standby->head);
}

void slc_evict_standby(struct slc_machine *r, uint32_t keep)
{
    evict_oldest(r, &r->standby, keep);
}

void slc_limit_standby(struct slc_machine *r)
{
    evict_oldest(r, &r->standby, r->limits.standby);
    evict_oldest(r, &r->standby_outside, r->limits.standby);
}
