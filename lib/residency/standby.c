#include "residency/standby.h"

#include "residency/node_list.h"

void slc_evict_standby(struct slc_machine *r, uint32_t keep)
{
    while (r->standby.count > keep) {
        uint32_t node = r->standby.head;
        slc_list_remove(r, &r->standby, node);
        slc_node_at(r, node)->flags |= SLC_NODE_LISTED;
        slc_list_append(r, &r->evicted, node);
    }
}
