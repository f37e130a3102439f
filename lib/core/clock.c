#include "core/clock.h"

#include "core/given_up_retry.h"
#include "residency/due.h"
#include "residency/node.h"

bool slc_time_is_backwards(const slc_manager *m, uint64_t time)
{
    return m->has_time && (int64_t)(time - m->time) < 0;
}

bool slc_retire_is_backwards(const slc_manager *m, uint64_t retire_value)
{
    return retire_value != 0 && retire_value < m->last_retire;
}

void slc_advance_time(slc_manager *m, uint64_t time)
{
    m->has_time = true;
    m->time = time;
    for (uint32_t node; (node = slc_due_first(&m->residency)) &&
                        (int64_t)(time - slc_node_at(&m->residency, node)->order) >= 0;)
        slc_node_request_again(&m->residency, node);
    slc_given_up_advance(m);
}
