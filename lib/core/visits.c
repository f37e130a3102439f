#include "core/visits.h"

static void visit_append(slc_manager *m, struct slc_managed_texture *t)
{
    t->visited = true;
    t->bias_epoch = m->bias.epoch; /* the bias that the map was merged with */
    t->visit_prev = m->visit_last;
    t->visit_next = SLC_NONE;
    if (m->visit_last != SLC_NONE)
        slc_texture_at(m, m->visit_last)->visit_next = t->index;
    else
        m->visit_first = t->index;
    m->visit_last = t->index;
    m->visited_count++;
}

static void visit_remove(slc_manager *m, struct slc_managed_texture *t)
{
    t->visited = false;
    m->bias.behind -= t->bias_epoch != m->bias.epoch;
    if (t->visit_prev != SLC_NONE)
        slc_texture_at(m, t->visit_prev)->visit_next = t->visit_next;
    else
        m->visit_first = t->visit_next;
    if (t->visit_next != SLC_NONE)
        slc_texture_at(m, t->visit_next)->visit_prev = t->visit_prev;
    else
        m->visit_last = t->visit_prev;
    m->visited_count--;
}

void slc_visit(slc_manager *m, struct slc_managed_texture *t, bool holds)
{
    if (t->visited != holds)
        m->bias.changed = true;
    if (t->visited)
        visit_remove(m, t);
    if (holds)
        visit_append(m, t);
}
