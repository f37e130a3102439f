#include <sluice/metrics.h>

#include "base/alloc.h"
#include "base/checked.h"
#include "metrics/flip_color.h"
#include "metrics/flip_kernels.h"
#include "metrics/pixel_rows.h"
#include "metrics/window.h"

#include <math.h>
#include <string.h>

/** Planes of each row of a picture: one per filter along x. */
enum { PLANE_COUNT = SLC_FLIP_FILTER_COUNT };

/** Results of the filters along y, per row and picture. */
enum { RED_GREEN = 1, NARROW, WIDE, EDGE_X, EDGE_Y, POINT_X, POINT_Y, RESULT_COUNT };

struct flip {
    struct slc_metric_picture pictures[2];
    struct slc_flip_kernels kernels;
    struct slc_window windows[2];
    double *rows; ///< [2][RESULT_COUNT][padded]; in add_row: colors, then opponents, padded
    double *map_row;
    size_t padded, count;
    struct slc_flip_curve curve;
};

static void finish(struct flip *flip, const SluiceAllocationCallbacks *allocator)
{
    for (int i = 0; i < 2; i++)
        slc_window_finish(&flip->windows[i], allocator);
    slc_free(allocator, flip->rows, flip->count, sizeof *flip->rows);
    slc_flip_kernels_finish(&flip->kernels, allocator);
}

static bool alloc_rows(struct flip *flip, const SluiceAllocationCallbacks *allocator,
                       uint32_t width)
{
    size_t padded = (size_t)width + 2 * (size_t)flip->kernels.radius, count;
    if (padded < width || !slc_mul_size(padded, 2 * RESULT_COUNT + 1, &count))
        return false;
    flip->rows = slc_alloc(allocator, count, sizeof *flip->rows);
    if (!flip->rows)
        return false;
    flip->padded = padded;
    flip->count = count;
    flip->map_row = flip->rows + 2 * RESULT_COUNT * padded;
    return true;
}

static SluiceResult init(struct flip *flip, const SluicePicturePair *pair,
                         const SluiceAllocationCallbacks *allocator, double pixels_per_degree)
{
    flip->rows = NULL;
    flip->count = 0;
    flip->windows[0] = flip->windows[1] = (struct slc_window){0};
    slc_flip_curve_init(&flip->curve);
    if (!slc_flip_kernels_init(&flip->kernels, allocator, pixels_per_degree))
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    bool ok = alloc_rows(flip, allocator, pair->width);
    for (int i = 0; i < 2 && ok; i++)
        ok = slc_window_init(&flip->windows[i], allocator, pair->width, pair->height, PLANE_COUNT,
                             flip->kernels.radius);
    if (!ok)
        finish(flip, allocator);
    return ok ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

/** Reads row y of a picture and filters it along x. */
static void add_row(struct flip *flip, int picture, uint32_t y)
{
    /* the opponent that each filter is for */
    static const int opponent_of[PLANE_COUNT] = {0, 1, 2, 2, 0, 0, 0};
    const struct slc_window *window = &flip->windows[picture];
    uint32_t radius = flip->kernels.radius;
    double *rgb = flip->rows, *padded[3];
    slc_picture_read_rgb(&flip->pictures[picture], y, rgb);
    for (int i = 0; i < 3; i++)
        padded[i] = flip->rows + (3 + i) * flip->padded;
    for (uint32_t x = 0; x < window->width; x++) {
        double opponents[3];
        slc_opponents_from_linear(rgb + 3 * (size_t)x, opponents);
        for (int i = 0; i < 3; i++)
            padded[i][radius + x] = opponents[i];
    }
    for (int i = 0; i < 3; i++)
        slc_pad_row(padded[i], window->width, radius, SLC_BORDER_REPEAT);
    for (uint32_t i = 0; i < PLANE_COUNT; i++)
        slc_filter_row(padded[opponent_of[i]], radius, window->width, flip->kernels.filters[i],
                       slc_window_row(window, y, i));
}

/** Filters the planes of a picture along y. */
static void filter_row(struct flip *flip, int picture, uint32_t y)
{
    static const struct {
        uint32_t plane, filter;
    } passes[RESULT_COUNT] = {
        {SLC_FLIP_LUMINANCE, SLC_FLIP_LUMINANCE},
        {SLC_FLIP_RED_GREEN, SLC_FLIP_RED_GREEN},
        {SLC_FLIP_BLUE_YELLOW_NARROW, SLC_FLIP_BLUE_YELLOW_NARROW},
        {SLC_FLIP_BLUE_YELLOW_WIDE, SLC_FLIP_BLUE_YELLOW_WIDE},
        {SLC_FLIP_EDGE, SLC_FLIP_SMOOTH},
        {SLC_FLIP_SMOOTH, SLC_FLIP_EDGE},
        {SLC_FLIP_POINT, SLC_FLIP_SMOOTH},
        {SLC_FLIP_SMOOTH, SLC_FLIP_POINT},
    };
    for (int i = 0; i < RESULT_COUNT; i++)
        slc_filter_rows(&flip->windows[picture], passes[i].plane, y,
                        flip->kernels.filters[passes[i].filter], SLC_BORDER_REPEAT,
                        flip->rows + (picture * RESULT_COUNT + i) * flip->padded);
}

static double result_at(const struct flip *flip, int picture, int result, uint32_t x)
{
    return flip->rows[(picture * RESULT_COUNT + result) * flip->padded + x];
}

/** Returns the difference of the gradient lengths of both pictures. */
static double feature_difference(const struct flip *flip, int along_x, int along_y, uint32_t x)
{
    double lengths[2];
    for (int i = 0; i < 2; i++) {
        double gx = result_at(flip, i, along_x, x), gy = result_at(flip, i, along_y, x);
        lengths[i] = sqrt(gx * gx + gy * gy);
    }
    return fabs(lengths[0] - lengths[1]);
}

static double feature_error(const struct flip *flip, uint32_t x)
{
    double edge = feature_difference(flip, EDGE_X, EDGE_Y, x);
    double point = feature_difference(flip, POINT_X, POINT_Y, x);
    return fmin(sqrt(fmax(edge, point) / sqrt(2)), 1); /* rounding may pass 1 */
}

static double error_at(const struct flip *flip, uint32_t x)
{
    double colors[2][3], narrow = flip->kernels.share_narrow;
    for (int i = 0; i < 2; i++) {
        colors[i][0] = result_at(flip, i, 0, x);
        colors[i][1] = result_at(flip, i, RED_GREEN, x);
        colors[i][2] =
            narrow * result_at(flip, i, NARROW, x) + (1 - narrow) * result_at(flip, i, WIDE, x);
    }
    return slc_flip_error(&flip->curve, colors[0], colors[1], feature_error(flip, x));
}

/** Fills map_row with the errors of row y and returns their sum. */
static double compare_row(struct flip *flip, uint32_t y)
{
    double sum = 0;
    filter_row(flip, 0, y);
    filter_row(flip, 1, y);
    for (uint32_t x = 0; x < flip->windows[0].width; x++)
        sum += flip->map_row[x] = error_at(flip, x);
    return sum;
}

static double compare(struct flip *flip, const SluiceMetricMap *map)
{
    const struct slc_window *window = &flip->windows[0];
    int64_t last_different = INT64_MIN; /* last read row that differs */
    double sum = 0;
    for (uint32_t y = 0, next = 0; y < window->height; y++) {
        for (; next <= slc_window_last_row(window, y); next++) {
            add_row(flip, 0, next);
            add_row(flip, 1, next);
            if (!slc_picture_row_is_equal(flip->pictures, next))
                last_different = next;
        }
        if (last_different >= (int64_t)y - window->radius)
            sum += compare_row(flip, y);
        else
            memset(flip->map_row, 0, window->width * sizeof *flip->map_row);
        slc_metric_map_write(map, window->width, y, flip->map_row);
    }
    return sum / ((double)window->width * (double)window->height);
}

SluiceResult sluiceComputeFlip(const SluicePicturePair *pPair, float pixelsPerDegree,
                               const SluiceMetricMap *pMap,
                               const SluiceAllocationCallbacks *pAllocator, double *pMean)
{
    struct flip flip;
    double pixels_per_degree =
        pixelsPerDegree == 0 ? 3840 * acos(-1) / 180 : (double)pixelsPerDegree;
    if (!pMean)
        return SLUICE_ERROR_NULL_POINTER;
    SluicePicturePair pair = {.structSize = sizeof pair};
    SluiceResult result = slc_picture_pair_init(flip.pictures, pPair, &pair, pMap, pAllocator);
    if (result)
        return result;
    if (!(pixels_per_degree >= 1 && pixels_per_degree <= 4096))
        return SLUICE_ERROR_INVALID_ARGUMENT;
    SluiceAllocationCallbacks allocator = slc_allocator(pAllocator);
    result = init(&flip, &pair, &allocator, pixels_per_degree);
    if (result)
        return result;
    *pMean = compare(&flip, pMap);
    finish(&flip, &allocator);
    return SLUICE_SUCCESS;
}
