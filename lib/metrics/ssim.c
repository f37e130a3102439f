#include <sluice/metrics.h>

#include "base/alloc.h"
#include "metrics/pixel_rows.h"
#include "metrics/window.h"

#include <math.h>

enum { RADIUS = 5, TAP_COUNT = 2 * RADIUS + 1 };

/** Moments that are averaged over each window: both values, their squares and their product. */
enum { MEAN_A, MEAN_B, SQUARE_A, SQUARE_B, PRODUCT, MOMENT_COUNT };

struct ssim {
    struct slc_metric_picture pictures[2];
    double weights[TAP_COUNT];
    struct slc_window window;
    double *rows;    ///< [MOMENT_COUNT][padded]: one row, before and after filtering along y
    double *map_row; ///< behind `rows`, in the same allocation
    size_t padded, count;
};

static void fill_weights(double weights[TAP_COUNT])
{
    double sum = 0;
    for (int i = 0; i < TAP_COUNT; i++)
        sum += weights[i] = exp(-(i - RADIUS) * (i - RADIUS) / (2 * 1.5 * 1.5));
    for (int i = 0; i < TAP_COUNT; i++)
        weights[i] /= sum;
}

static SluiceResult init(struct ssim *ssim, const SluicePicturePair *pair,
                         const SluiceAllocationCallbacks *allocator)
{
    fill_weights(ssim->weights);
    ssim->padded = (size_t)pair->width + TAP_COUNT - 1;
    if (ssim->padded > SIZE_MAX / (MOMENT_COUNT + 1))
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    ssim->count = ssim->padded * (MOMENT_COUNT + 1);
    ssim->rows = slc_alloc(allocator, ssim->count, sizeof *ssim->rows);
    if (!ssim->rows)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    ssim->map_row = ssim->rows + MOMENT_COUNT * ssim->padded;
    if (slc_window_init(&ssim->window, allocator, pair->width, pair->height, MOMENT_COUNT, RADIUS))
        return SLUICE_SUCCESS;
    slc_free(allocator, ssim->rows, ssim->count, sizeof *ssim->rows);
    return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

/** Reads row y of both pictures and filters its moments along x. */
static void add_row(struct ssim *ssim, uint32_t y)
{
    uint32_t width = ssim->window.width;
    double *moments[MOMENT_COUNT];
    for (int i = 0; i < MOMENT_COUNT; i++)
        moments[i] = ssim->rows + i * ssim->padded + RADIUS;
    slc_picture_read_luma(&ssim->pictures[0], y, moments[MEAN_A]);
    slc_picture_read_luma(&ssim->pictures[1], y, moments[MEAN_B]);
    for (uint32_t x = 0; x < width; x++) {
        double a = moments[MEAN_A][x], b = moments[MEAN_B][x];
        moments[SQUARE_A][x] = a * a;
        moments[SQUARE_B][x] = b * b;
        moments[PRODUCT][x] = a * b;
    }
    for (uint32_t i = 0; i < MOMENT_COUNT; i++) {
        slc_pad_row(moments[i] - RADIUS, width, RADIUS, SLC_BORDER_ZERO);
        slc_filter_row(moments[i] - RADIUS, RADIUS, width,
                       (struct slc_kernel){ssim->weights, RADIUS},
                       slc_window_row(&ssim->window, y, i));
    }
}

/** Returns the weight of the window around `at` that lies within [0, size). */
static double weight_inside(const double weights[TAP_COUNT], uint32_t at, uint32_t size)
{
    if (at >= RADIUS && size - at > RADIUS)
        return 1;
    double sum = 0;
    for (int64_t i = 0; i < TAP_COUNT; i++)
        if (at + i >= RADIUS && at + i - RADIUS < size)
            sum += weights[i];
    return sum;
}

/** `moments` are means over the window; the peak is 1. Exactly 1 if a and b were the same. */
static double similarity(const double moments[MOMENT_COUNT])
{
    const double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
    double square_a = moments[MEAN_A] * moments[MEAN_A];
    double square_b = moments[MEAN_B] * moments[MEAN_B];
    double product = moments[MEAN_A] * moments[MEAN_B];
    double variance_a = moments[SQUARE_A] - square_a;
    double variance_b = moments[SQUARE_B] - square_b;
    double covariance = moments[PRODUCT] - product;
    return (2 * product + c1) * (2 * covariance + c2) /
           ((square_a + square_b + c1) * (variance_a + variance_b + c2));
}

/** Fills map_row with the similarities of row y. */
static void compare_row(struct ssim *ssim, uint32_t y)
{
    const struct slc_window *window = &ssim->window;
    for (uint32_t i = 0; i < MOMENT_COUNT; i++)
        slc_filter_rows(window, i, y, (struct slc_kernel){ssim->weights, RADIUS}, SLC_BORDER_ZERO,
                        ssim->rows + i * ssim->padded);
    double weight_y = weight_inside(ssim->weights, y, window->height);
    for (uint32_t x = 0; x < window->width; x++) {
        double weight = weight_y * weight_inside(ssim->weights, x, window->width);
        double moments[MOMENT_COUNT];
        for (int i = 0; i < MOMENT_COUNT; i++)
            moments[i] = ssim->rows[i * ssim->padded + x] / weight;
        ssim->map_row[x] = similarity(moments);
    }
}

/** Positions of an axis that the mean is over: from `border` to size - `border`. */
static uint32_t border_of(uint32_t size)
{
    return size >= TAP_COUNT ? RADIUS : 0;
}

static double compare(struct ssim *ssim, const SluiceMetricMap *map)
{
    uint32_t width = ssim->window.width, height = ssim->window.height, next = 0;
    uint32_t border_x = border_of(width), border_y = border_of(height);
    double sum = 0;
    for (uint32_t y = 0; y < height; y++) {
        while (next <= slc_window_last_row(&ssim->window, y))
            add_row(ssim, next++);
        compare_row(ssim, y);
        slc_metric_map_write(map, width, y, ssim->map_row);
        if (y < border_y || y >= height - border_y)
            continue;
        for (uint32_t x = border_x; x < width - border_x; x++)
            sum += ssim->map_row[x];
    }
    return sum / ((double)(width - 2 * border_x) * (double)(height - 2 * border_y));
}

SluiceResult sluiceComputeSsim(const SluicePicturePair *pPair, const SluiceMetricMap *pMap,
                               const SluiceAllocationCallbacks *pAllocator, double *pMean)
{
    struct ssim ssim;
    if (!pMean)
        return SLUICE_ERROR_NULL_POINTER;
    SluicePicturePair pair = {.structSize = sizeof pair};
    SluiceResult result = slc_picture_pair_init(ssim.pictures, pPair, &pair, pMap, pAllocator);
    if (result)
        return result;
    SluiceAllocationCallbacks allocator = slc_allocator(pAllocator);
    result = init(&ssim, &pair, &allocator);
    if (result)
        return result;
    *pMean = compare(&ssim, pMap);
    slc_window_finish(&ssim.window, &allocator);
    slc_free(&allocator, ssim.rows, ssim.count, sizeof *ssim.rows);
    return SLUICE_SUCCESS;
}
