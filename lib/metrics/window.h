/**
 * Separable filters over a picture that is read row by row. Each row is filtered along x when it
 * arrives. Rows within `radius` of the current row are kept for the filter along y.
 */
#ifndef SLC_METRICS_WINDOW_H
#define SLC_METRICS_WINDOW_H

#include <sluice/base.h>

struct slc_window {
    double *rows; ///< [2 * radius + 1][plane_count][width]
    size_t count; ///< number of values in `rows`
    uint32_t width, height, plane_count, radius;
};

/** Weights of 2 * radius + 1 taps, the first at -radius. */
struct slc_kernel {
    const double *weights;
    uint32_t radius;
};

/** Values beyond the border of the picture. */
enum slc_border {
    SLC_BORDER_ZERO,
    SLC_BORDER_REPEAT, ///< the pixel at the border is repeated
};

/** Allocates the rows. False: out of memory; do not finish the window then. */
bool slc_window_init(struct slc_window *window, const SluiceAllocationCallbacks *allocator,
                     uint32_t width, uint32_t height, uint32_t plane_count, uint32_t radius);
void slc_window_finish(struct slc_window *window, const SluiceAllocationCallbacks *allocator);

/** Returns the memory of row y of a plane, which replaces row y - 2 * radius - 1. */
double *slc_window_row(const struct slc_window *window, uint32_t y, uint32_t plane);

/** Returns the last row that must be present before row y is filtered. */
uint32_t slc_window_last_row(const struct slc_window *window, uint32_t y);

/** Fills `radius` values before and after the `width` ones at row + radius. */
void slc_pad_row(double *row, uint32_t width, uint32_t radius, enum slc_border border);

/** Filters along x. `row` has `padding` >= kernel.radius values before and after its `width`. */
void slc_filter_row(const double *row, uint32_t padding, uint32_t width, struct slc_kernel kernel,
                    double *out);

/** Filters along y, around row y of a plane; kernel.radius <= window.radius. */
void slc_filter_rows(const struct slc_window *window, uint32_t plane, uint32_t y,
                     struct slc_kernel kernel, enum slc_border border, double *out);

#endif /* SLC_METRICS_WINDOW_H */
