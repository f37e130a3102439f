/** Rows of the table of textures, for the panel and its CSV file. */
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
    const char *name, *format, *set, *source; ///< borrowed. `set`: name of the texture it follows
    uint32_t width, height, level_count;      ///< of a sum: 0
    uint64_t resident, wanted, all;           ///< tiles
    uint64_t size;                            ///< bytes that are resident
    uint32_t finest_level;                    ///< SLUICE_MIP_UNTOUCHED: the mip tail alone
    double seen_seconds;                      ///< since it was last seen; below 0: never
    uint64_t loads, evictions, failures;
    double thrash; ///< loads per resident tile
    double key;    ///< that texture_rows_sort sorts by; equal ones by name
};

struct texture_row texture_row_of(const struct stage *stage, const struct view_facts *facts,
                                  uint32_t texture);
/** Of rows. Its name is "". */
struct texture_row texture_rows_sum(const struct texture_row *rows, uint32_t count);
/** Whether each word of the filter is in a row's name, format, set or source, in either case. */
bool texture_row_matches(const struct texture_row *row, const char *filter);
void texture_rows_sort(struct texture_row *rows, uint32_t count, enum texture_column column,
                       bool descending);
/** One line per row, and one of titles. False if writing failed. */
bool texture_rows_write(FILE *file, const struct texture_row *rows, uint32_t count);

#endif /* SLUICE_VIEW_TEXTURE_ROWS_H */
