#include "residency/standby.h"

#include "residency/node_list.h"

static void evict_oldest(struct slc_machine *r, struct slc_list *standby, uint32_t keep)
{
    while (standby->count > keep) {
        uint32_t node = standby->head;
        slc_list_remove(r, standby, node);
        slc_node_at(r, node)->flags |= SLC_NODE_LISTED;
        slc_list_append(r, &r->evicted, node);
    }
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
