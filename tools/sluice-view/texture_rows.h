/** Rows of the texture table, for the panel and its CSV file. */
#ifndef SLUICE_VIEW_TEXTURE_ROWS_H
#define SLUICE_VIEW_TEXTURE_ROWS_H

#include "facts.h"
#include "stage.h"

#include <stdio.h>

enum texture_column {
    COLUMN_NAME,
    COLUMN_THRASH,
    COLUMN_LOADS,
    COLUMN_RESIDENT,
    COLUMN_WANTED,
    COLUMN_ALL,
    COLUMN_MEMORY,
    COLUMN_FINEST,
    COLUMN_SEEN,
    COLUMN_EVICTED,
    COLUMN_FAILED,
    COLUMN_SIZE,
    COLUMN_FORMAT,
    COLUMN_LEVELS,
    COLUMN_SET,
    COLUMN_SOURCE,
    COLUMN_COUNT
};

struct texture_row {
    uint32_t texture;                         ///< index; STAGE_NO_TEXTURE: a sum
    const char *name, *format, *set, *source; ///< borrowed. `set`: name of its primary
    uint32_t width, height, level_count;      ///< 0 in a sum
    uint64_t resident, wanted, all;           ///< tiles
    uint64_t size;                            ///< bytes that are resident
    uint32_t finest_level;                    ///< SLUICE_MIP_UNTOUCHED: the mip tail alone
    double seen_seconds; ///< time since the texture was last seen; below 0: never
    uint64_t loads, evictions, failures;
    double thrash; ///< loads per resident tile
    double key;    ///< sort key of texture_rows_sort; rows with equal keys are sorted by name
};

struct texture_row texture_row_of(const struct stage *stage, const struct view_facts *facts,
                                  uint32_t texture);
/** Returns the sum of rows. Its name is "". */
struct texture_row texture_rows_sum(const struct texture_row *rows, uint32_t count);
/** Returns true if each word of the filter occurs in the row's name, format, set or source. Ignores
 *  case. */
bool texture_row_matches(const struct texture_row *row, const char *filter);
void texture_rows_sort(struct texture_row *rows, uint32_t count, enum texture_column column,
                       bool descending);
/** Writes a line of titles and one line per row. False if writing failed. */
bool texture_rows_write(FILE *file, const struct texture_row *rows, uint32_t count);

#endif /* SLUICE_VIEW_TEXTURE_ROWS_H */
