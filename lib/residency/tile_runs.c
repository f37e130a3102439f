/*
 * Runs: neighbors in one list that go to the end of another list are moved together. An owner that
 * enters or leaves the view makes long runs.
 */
#include "residency/tile_runs.h"

#include "residency/standby.h"

static void splice(struct slc_machine *r, struct slc_list *from, struct slc_list *to,
                   const struct slc_run *run)
{
    struct slc_node *first = slc_node_at(r, run->first), *last = slc_node_at(r, run->last);
    if (first->prev)
        slc_node_at(r, first->prev)->next = last->next;
    else
        from->head = last->next;
    if (last->next)
        slc_node_at(r, last->next)->prev = first->prev;
    else
        from->tail = first->prev;
    from->count -= run->count;
    first->prev = to->tail;
    last->next = 0;
    if (to->tail)
        slc_node_at(r, to->tail)->next = run->first;
    else
        to->head = run->first;
    to->tail = run->last;
    to->count += run->count;
}

void slc_run_end(struct slc_machine *r, struct slc_run *run)
{
    struct slc_list *mapped = &r->mapped[run->level];
    uint32_t count = run->count;
    if (count == 0)
        return;
    if (run->wanted) {
        splice(r, &r->standby, mapped, run);
        r->restored_total += count;
    } else {
        splice(r, mapped, &r->standby, run);
    }
    uint32_t *counts = r->state_counts;
    counts[SLUICE_TILE_STATE_MAPPED] += run->wanted ? count : 0 - count;
    counts[SLUICE_TILE_STATE_STANDBY] += run->wanted ? 0 - count : count;
    run->count = 0;
    if (r->standby.count > r->limits.standby)
        slc_evict_standby(r, r->limits.standby);
}

/** True if a node is in the list from which runs are taken. */
static bool fits_run(const struct slc_node *n, bool wanted)
{
    if (wanted)
        return n->state == SLUICE_TILE_STATE_STANDBY && n->flags == 0;
    return n->state == SLUICE_TILE_STATE_MAPPED;
}

bool slc_run_add(struct slc_machine *r, struct slc_run *run, uint32_t node, uint32_t level,
                 bool wanted)
{
    struct slc_node *n = slc_node_at(r, node);
    if (run->count &&
        !(run->next == node && run->wanted == wanted && run->level == level && fits_run(n, wanted)))
        slc_run_end(r, run); /* may list this tile for unmapping */
    if (!fits_run(n, wanted))
        return false;
    if (run->count == 0)
        *run = (struct slc_run){.first = node, .level = level, .wanted = wanted};
    run->last = node;
    run->next = n->next;
    run->count++;
    uint8_t before = n->state;
    n->state = wanted ? SLUICE_TILE_STATE_MAPPED : SLUICE_TILE_STATE_STANDBY;
    if (r->user.changed)
        r->user.changed(r->user.user, n, before, n->state);
    return true;
}
