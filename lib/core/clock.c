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

static void request_due(slc_manager *m)
{
    m->events.reason = SLUICE_TILE_EVENT_RETRIED;
    for (uint32_t node; (node = slc_due_first(&m->residency)) &&
                        (int64_t)(m->time - slc_node_at(&m->residency, node)->order) >= 0;)
        slc_node_request_again(&m->residency, node);
}

void slc_advance_time(slc_manager *m, uint64_t time)
{
    m->has_time = true;
    m->time = time;
    if (m->residency.failed.count > 0)
        request_due(m);
    if (m->trouble_count > 0)
        slc_given_up_advance(m);
}
