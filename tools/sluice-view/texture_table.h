/** The table of textures as it is shown: rows that are gathered and sorted some times per second.
 */
#ifndef SLUICE_VIEW_TEXTURE_TABLE_H
#define SLUICE_VIEW_TEXTURE_TABLE_H

#include "texture_rows.h"

#define TEXTURE_TABLE_FILTER 64

struct texture_order {
    uint32_t column; ///< enum texture_column
    bool descending;
};

struct texture_table {
    struct texture_row *rows; ///< owned; their texts are the stage's
    uint32_t count;           ///< that the filter leaves
    struct texture_row sum;   ///< of these
    struct texture_order order;
    char filter[TEXTURE_TABLE_FILTER];
    double next; ///< seconds when rows are gathered again
};

/** Gathers and sorts the rows, at once if filter or order have changed, else 4 times per second.
 *  `seconds`: of the viewer's life. `order` NULL: the last one. Without memory it has no rows. */
void texture_table_update(struct texture_table *table, const struct stage *stage,
                          const struct view_facts *facts, const char *filter,
                          const struct texture_order *order, double seconds);
/** A zeroed struct is fine. Call it before the stage is destroyed. */
void texture_table_finish(struct texture_table *table);

#endif /* SLUICE_VIEW_TEXTURE_TABLE_H */
