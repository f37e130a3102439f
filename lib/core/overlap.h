/** Two grids of cells over the same unit square. */
#ifndef SLC_CORE_OVERLAP_H
#define SLC_CORE_OVERLAP_H

#include <stdint.h>

struct slc_grid {
    uint32_t width, height;           ///< size of the whole grid, in any unit
    uint32_t cell_width, cell_height; ///< cell size; the last column and row may be cut off
    uint32_t columns, rows;
};

/** Each cell of `to` gets the least value of the cells of `from` that it overlaps. */
void slc_least_overlapped(const struct slc_grid *from, const uint8_t *values,
                          const struct slc_grid *to, uint8_t *least);

#endif /* SLC_CORE_OVERLAP_H */
