#include "metrics/window.h"

#include "base/alloc.h"
#include "base/checked.h"

#include <assert.h>
#include <string.h>

bool slc_window_init(struct slc_window *window, const SluiceAllocationCallbacks *allocator,
                     uint32_t width, uint32_t height, uint32_t plane_count, uint32_t radius)
{
    size_t count;
    *window = (struct slc_window){0};
    if (!slc_mul_size(width, plane_count, &count) ||
        !slc_mul_size(count, 2 * (size_t)radius + 1, &count))
        return false;
    double *rows = slc_alloc(allocator, count, sizeof *rows);
    if (!rows)
        return false;
    *window = (struct slc_window){rows, count, width, height, plane_count, radius};
    return true;
}

void slc_window_finish(struct slc_window *window, const SluiceAllocationCallbacks *allocator)
{
    slc_free(allocator, window->rows, window->count, sizeof *window->rows);
}

double *slc_window_row(const struct slc_window *window, uint32_t y, uint32_t plane)
{
    size_t slot = y % (2 * window->radius + 1);
    return window->rows + (slot * window->plane_count + plane) * window->width;
}

uint32_t slc_window_last_row(const struct slc_window *window, uint32_t y)
{
    uint32_t below = window->height - 1 - y;
    return y + slc_min_u32(below, window->radius);
}

void slc_pad_row(double *row, uint32_t width, uint32_t radius, enum slc_border border)
{
    double *end = row + radius + width;
    double before = border == SLC_BORDER_REPEAT ? row[radius] : 0;
    double after = border == SLC_BORDER_REPEAT ? end[-1] : 0;
    for (uint32_t i = 0; i < radius; i++) {
        row[i] = before;
        end[i] = after;
    }
}

void slc_filter_row(const double *row, uint32_t padding, uint32_t width, struct slc_kernel kernel,
                    double *out)
{
    assert(kernel.radius <= padding);
    memset(out, 0, width * sizeof *out);
    for (uint32_t i = 0; i <= 2 * kernel.radius; i++) {
        const double *in = row + (padding - kernel.radius) + i;
        double weight = kernel.weights[i];
        for (uint32_t x = 0; x < width; x++)
            out[x] += weight * in[x];
    }
}

void slc_filter_rows(const struct slc_window *window, uint32_t plane, uint32_t y,
                     struct slc_kernel kernel, enum slc_border border, double *out)
{
    assert(kernel.radius <= window->radius);
    memset(out, 0, window->width * sizeof *out);
    for (uint32_t i = 0; i <= 2 * kernel.radius; i++) {
        int64_t at = (int64_t)y + i - kernel.radius, last = (int64_t)window->height - 1;
        if (border == SLC_BORDER_ZERO && (at < 0 || at > last))
            continue;
        at = at < 0 ? 0 : at > last ? last : at;
        const double *in = slc_window_row(window, (uint32_t)at, plane);
        double weight = kernel.weights[i];
        for (uint32_t x = 0; x < window->width; x++)
            out[x] += weight * in[x];
    }
}
