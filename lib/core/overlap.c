#include "core/overlap.h"

#include <string.h>

/*
 * Cell i of one grid is [i * c, (i + 1) * c) of `size`, cell j of the other [j * r, (j + 1) * r) of
 * `other_size`. The quotients for the first and the last j grow by a constant step from cell to
 * cell, so one division per axis suffices for all cells.
 */
struct axis {
    uint64_t unit; ///< size * r
    uint64_t step, remainder_step;
    uint64_t quotient, remainder; ///< begin * other_size / unit, and the remainder
    uint32_t other_count;
};

static struct axis make_axis(uint32_t cell, uint32_t size, uint32_t other_cell, uint32_t other_size,
                             uint32_t other_count)
{
    struct axis a = {.unit = (uint64_t)size * other_cell, .other_count = other_count};
    uint64_t advance = (uint64_t)cell * other_size;
    a.step = advance / a.unit;
    a.remainder_step = advance % a.unit;
    return a;
}

/** Cells of the other grid that overlap the next cell, inclusive. */
static void next_overlap(struct axis *a, uint32_t *first, uint32_t *last)
{
    *first = (uint32_t)a->quotient;
    a->quotient += a->step;
    a->remainder += a->remainder_step;
    if (a->remainder >= a->unit) {
        a->remainder -= a->unit;
        a->quotient++;
    }
    /* (end * other_size - 1) / unit, where the next begin is this end */
    uint64_t end = a->remainder > 0 ? a->quotient : a->quotient - 1;
    /* the last cell may reach beyond the grid */
    *last = end < a->other_count ? (uint32_t)end : a->other_count - 1;
}

static uint8_t least_in(const uint8_t *values, uint32_t columns, uint32_t x0, uint32_t x1,
                        uint32_t y0, uint32_t y1)
{
    uint8_t least = 255;
    for (uint32_t y = y0; y <= y1; y++)
        for (uint32_t x = x0; x <= x1; x++) {
            uint8_t v = values[(size_t)y * columns + x];
            least = v < least ? v : least;
        }
    return least;
}

/*
 * Neighbors that overlap the same cells share one result. Otherwise thin cells of one grid under
 * thick cells of the other would cost the product of their counts.
 */
void slc_least_overlapped(const struct slc_grid *from, const uint8_t *values,
                          const struct slc_grid *to, uint8_t *least)
{
    struct axis down =
        make_axis(to->cell_height, to->height, from->cell_height, from->height, from->rows);
    const struct axis along =
        make_axis(to->cell_width, to->width, from->cell_width, from->width, from->columns);
    uint32_t last_y0 = 1, last_y1 = 0; /* no range */
    for (uint32_t row = 0; row < to->rows; row++) {
        uint8_t *out = least + (size_t)row * to->columns;
        uint32_t y0, y1;
        next_overlap(&down, &y0, &y1);
        if (y0 == last_y0 && y1 == last_y1) {
            memcpy(out, out - to->columns, to->columns);
            continue;
        }
        last_y0 = y0, last_y1 = y1;
        struct axis across = along;
        uint32_t last_x0 = 1, last_x1 = 0;
        for (uint32_t column = 0; column < to->columns; column++) {
            uint32_t x0, x1;
            next_overlap(&across, &x0, &x1);
            if (x0 == last_x0 && x1 == last_x1) {
                out[column] = out[column - 1];
                continue;
            }
            last_x0 = x0, last_x1 = x1;
            out[column] = least_in(values, from->columns, x0, x1, y0, y1);
        }
    }
}
