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

/** Number of rows that are summed at once, so that sums stay in registers. */
enum { BATCH = 32 };

struct taps {
    const double *rows[BATCH];
    double weights[BATCH];
    uint32_t count;
};

/** Vector of two unaligned values: the widest vector on every machine. */
typedef double pair __attribute__((vector_size(16), aligned(8), may_alias));

/** Adds the weighted values from x on to the eight at `out`. */
static void add_eight(const struct taps *taps, uint32_t x, double *out)
{
    pair *sums = (pair *)out;
    pair a = sums[0], b = sums[1], c = sums[2], d = sums[3];
    for (uint32_t i = 0; i < taps->count; i++) {
        const pair *in = (const pair *)(taps->rows[i] + x);
        double weight = taps->weights[i];
        a += weight * in[0];
        b += weight * in[1];
        c += weight * in[2];
        d += weight * in[3];
    }
    sums[0] = a;
    sums[1] = b;
    sums[2] = c;
    sums[3] = d;
}

/** Adds the weighted rows to `out`. */
static void flush_taps(struct taps *taps, double *out, uint32_t width)
{
    uint32_t x = 0;
    for (; x + 8 <= width; x += 8)
        add_eight(taps, x, out + x);
    for (; x < width; x++)
        for (uint32_t i = 0; i < taps->count; i++)
            out[x] += taps->weights[i] * taps->rows[i][x];
    taps->count = 0;
}

static void add_tap(struct taps *taps, const double *row, double weight, double *out,
                    uint32_t width)
{
    taps->rows[taps->count] = row;
    taps->weights[taps->count++] = weight;
    if (taps->count == BATCH)
        flush_taps(taps, out, width);
}

void slc_filter_row(const double *row, uint32_t padding, uint32_t width, struct slc_kernel kernel,
                    double *out)
{
    struct taps taps = {.count = 0};
    assert(kernel.radius <= padding);
    memset(out, 0, width * sizeof *out);
    for (uint32_t i = 0; i <= 2 * kernel.radius; i++)
        add_tap(&taps, row + (padding - kernel.radius) + i, kernel.weights[i], out, width);
    if (taps.count > 0)
        flush_taps(&taps, out, width);
}

void slc_filter_rows(const struct slc_window *window, uint32_t plane, uint32_t y,
                     struct slc_kernel kernel, enum slc_border border, double *out)
{
    struct taps taps = {.count = 0};
    assert(kernel.radius <= window->radius);
    memset(out, 0, window->width * sizeof *out);
    for (uint32_t i = 0; i <= 2 * kernel.radius; i++) {
        int64_t at = (int64_t)y + i - kernel.radius, last = (int64_t)window->height - 1;
        if (border == SLC_BORDER_ZERO && (at < 0 || at > last))
            continue;
        at = at < 0 ? 0 : at > last ? last : at;
        add_tap(&taps, slc_window_row(window, (uint32_t)at, plane), kernel.weights[i], out,
                window->width);
    }
    if (taps.count > 0)
        flush_taps(&taps, out, window->width);
}
