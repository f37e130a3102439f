/** The shown texture table: rows that are gathered and sorted several times per second. */
#ifndef SLUICE_VIEW_TEXTURE_TABLE_H
#define SLUICE_VIEW_TEXTURE_TABLE_H

#include "texture_rows.h"

#define TEXTURE_TABLE_FILTER 64

struct texture_order {
    uint32_t column; ///< enum texture_column
    bool descending;
};

struct texture_table {
    struct texture_row *rows; ///< owned; the stage owns their texts
    uint32_t count;           ///< rows that match the filter
    struct texture_row sum;   ///< sum of these rows
    struct texture_order order;
    char filter[TEXTURE_TABLE_FILTER];
    double next; ///< seconds when rows are gathered again
};

/** Gathers and sorts the rows 4 times per second, and at once if filter or order changed.
 * `seconds`: time since the viewer began. `order` NULL: the last order. Without memory the table
 * has no rows.
 */
void texture_table_update(struct texture_table *table, const struct stage *stage,
                          const struct view_facts *facts, const char *filter,
                          const struct texture_order *order, double seconds);
/** Frees the rows. Call before the stage is destroyed. A zeroed struct is allowed. */
void texture_table_finish(struct texture_table *table);

#endif /* SLUICE_VIEW_TEXTURE_TABLE_H */
