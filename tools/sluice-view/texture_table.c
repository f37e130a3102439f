#include "texture_table.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SECONDS 0.25

static bool is_current(const struct texture_table *t, const char *filter,
                       const struct texture_order *order, double seconds)
{
    return t->rows && seconds < t->next && t->next <= seconds + SECONDS &&
           strcmp(t->filter, filter) == 0 &&
           (!order ||
            (t->order.column == order->column && t->order.descending == order->descending));
}

void texture_table_update(struct texture_table *t, const struct stage *stage,
                          const struct view_facts *facts, const char *filter,
                          const struct texture_order *order, double seconds)
{
    if (!stage_played(stage) && is_current(t, filter, order, seconds))
        return;
    if (!t->rows)
        t->rows = calloc(facts->texture_count + 1u, sizeof *t->rows);
    if (order)
        t->order = *order;
    snprintf(t->filter, sizeof t->filter, "%s", filter);
    t->next = seconds + SECONDS;
    t->count = 0;
    for (uint32_t i = 0; t->rows && i < facts->texture_count; i++) {
        t->rows[t->count] = texture_row_of(stage, facts, i);
        t->count += texture_row_matches(&t->rows[t->count], t->filter);
    }
    texture_rows_sort(t->rows, t->count, (enum texture_column)t->order.column, t->order.descending);
    t->sum = texture_rows_sum(t->rows, t->count);
}

void texture_table_finish(struct texture_table *t)
{
    free(t->rows);
    *t = (struct texture_table){0};
}
