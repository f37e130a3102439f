#include "bake/pyramid.h"

#include "base/alloc.h"
#include "base/checked.h"

#include <assert.h>
#include <float.h>
#include <math.h>

static bool reaches_around(const struct slc_axis *rows)
{
    return rows->filter != SLUICE_BAKE_FILTER_BOX && rows->wrap == SLUICE_BAKE_WRAP_REPEAT &&
           rows->size > 1;
}

static size_t kept_count(const struct slc_halving *halving)
{
    return ((size_t)halving->head_count + halving->ring_count) * halving->columns.axis.below * 4;
}

/* Fills all fields of a halving except its allocations. */
static void plan_halving(struct slc_halving *halving, const struct slc_pyramid_info *info,
                         uint32_t level, uint32_t first)
{
    *halving = (struct slc_halving){
        .rows = slc_axis_make(slc_mip_size(info->height, level), info->filter, info->wrap_y),
        .first = first,
    };
    halving->columns.axis =
        slc_axis_make(slc_mip_size(info->width, level), info->filter, info->wrap_x);
    /* The distance to mirrored and clamped rows is at most the number of taps. */
    halving->ring_count = slc_min_u32(halving->rows.size, slc_axis_max_taps(&halving->rows) + 1);
    if (!reaches_around(&halving->rows))
        return;
    halving->head_count = slc_min_u32(halving->rows.size, 2 * SLC_MAX_TAPS);
    while (halving->first_below < halving->rows.below &&
           slc_axis_first(&halving->rows, halving->first_below) < (int32_t)first)
        halving->first_below++;
    halving->first_below %= halving->rows.below; /* with so few rows, all are kept */
}

static uint32_t row_below(const struct slc_halving *halving)
{
    return (halving->first_below + halving->made) % halving->rows.below;
}

/* Finds the taps of the next row. Even sizes have the same weights in every row. */
static void find_taps(struct slc_halving *halving)
{
    if (halving->made == 0 || halving->rows.size % 2)
        slc_axis_taps(&halving->rows, row_below(halving), &halving->taps);
    else
        halving->taps.first = slc_axis_first(&halving->rows, row_below(halving));
}

static SluiceResult init_halving(struct slc_halving *halving, const SluiceAllocationCallbacks *cb)
{
    struct slc_axis axis = halving->columns.axis;
    SluiceResult result = slc_columns_init(&halving->columns, cb, &axis);
    if (result != SLUICE_SUCCESS)
        return result;
    halving->kept = slc_alloc(cb, kept_count(halving), sizeof(float));
    halving->row = slc_alloc(cb, 4 * (size_t)axis.below, sizeof(float));
    if (!halving->kept || !halving->row)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    find_taps(halving);
    return SLUICE_SUCCESS;
}

static void plan(struct slc_pyramid *pyramid, const struct slc_pyramid_info *info)
{
    *pyramid = (struct slc_pyramid){.info = *info};
    pyramid->level_count = slc_mip_count(slc_max_u32(info->width, info->height));
    assert(pyramid->level_count <= SLC_MAX_LEVELS);
    uint32_t first = 0;
    for (uint32_t level = 0; level + 1 < pyramid->level_count; level++) {
        plan_halving(&pyramid->halvings[level], info, level, first);
        first = pyramid->halvings[level].first_below;
    }
}

SluiceResult slc_pyramid_init(struct slc_pyramid *pyramid, const SluiceAllocationCallbacks *cb,
                              const struct slc_pyramid_info *info)
{
    plan(pyramid, info);
    SluiceResult result = SLUICE_SUCCESS;
    for (uint32_t level = 0; level + 1 < pyramid->level_count && result == SLUICE_SUCCESS; level++)
        result = init_halving(&pyramid->halvings[level], cb);
    return result;
}

void slc_pyramid_finish(struct slc_pyramid *pyramid, const SluiceAllocationCallbacks *cb)
{
    for (uint32_t level = 0; level + 1 < pyramid->level_count; level++) {
        struct slc_halving *halving = &pyramid->halvings[level];
        slc_free(cb, halving->kept, kept_count(halving), sizeof(float));
        slc_free(cb, halving->row, 4 * (size_t)halving->columns.axis.below, sizeof(float));
        slc_columns_finish(&halving->columns, cb);
        halving->kept = halving->row = NULL;
    }
}

uint64_t slc_pyramid_memory(const struct slc_pyramid_info *info)
{
    struct slc_pyramid pyramid;
    uint64_t size = 0;
    plan(&pyramid, info);
    for (uint32_t level = 0; level + 1 < pyramid.level_count; level++) {
        const struct slc_halving *halving = &pyramid.halvings[level];
        size += kept_count(halving) * sizeof(float) + slc_columns_memory(&halving->columns.axis) +
                4 * (uint64_t)halving->columns.axis.below * sizeof(float);
    }
    return size;
}

/* Returns the place in `kept` of the `n`th row received. */
static float *kept_row(const struct slc_halving *halving, uint32_t n)
{
    uint32_t slot = n < halving->head_count ? n : halving->head_count + n % halving->ring_count;
    return halving->kept + (size_t)slot * halving->columns.axis.below * 4;
}

/* Returns the position, in order of arrival, of a tap's row. */
static uint32_t arrival(const struct slc_halving *halving, uint32_t tap)
{
    const struct slc_axis *rows = &halving->rows;
    uint32_t y = slc_wrap_index(rows->wrap, halving->taps.first + (int32_t)tap, rows->size);
    return y >= halving->first ? y - halving->first : y + rows->size - halving->first;
}

static bool is_ready(const struct slc_halving *halving)
{
    if (halving->made == halving->rows.below)
        return false;
    for (uint32_t t = 0; t < halving->taps.count; t++)
        if (arrival(halving, t) >= halving->received)
            return false;
    return true;
}

/* Sums rows in double. Results saturate at +-FLT_MAX. */
static void sum_rows_wide(struct slc_halving *halving)
{
    const struct slc_taps *taps = &halving->taps;
    for (size_t i = 0; i < 4 * (size_t)halving->columns.axis.below; i++) {
        double sum = 0.0;
        for (uint32_t t = 0; t < taps->count; t++)
            sum += (double)kept_row(halving, arrival(halving, t))[i] * (double)taps->weights[t];
        halving->row[i] = (float)fmin(fmax(sum, -(double)FLT_MAX), (double)FLT_MAX);
    }
}

static void make_row(struct slc_halving *halving, bool may_overflow)
{
    uint32_t width = halving->columns.axis.below;
    const struct slc_taps *taps = &halving->taps;
    slc_row_set(kept_row(halving, arrival(halving, 0)), taps->weights[0], halving->row, width);
    for (uint32_t t = 1; t < taps->count; t++)
        slc_row_add(kept_row(halving, arrival(halving, t)), taps->weights[t], halving->row, width);
    if (may_overflow && !slc_row_is_finite(halving->row, width))
        sum_rows_wide(halving);
    halving->made++;
    if (halving->made < halving->rows.below)
        find_taps(halving);
}

/* Pushes a row into a level and its results into the next. Recursion depth: number of levels. */
static SluiceResult push(struct slc_pyramid *pyramid, uint32_t level, const float *rgba)
{
    if (level + 1 >= pyramid->level_count)
        return SLUICE_SUCCESS;
    struct slc_halving *halving = &pyramid->halvings[level];
    float *kept = kept_row(halving, halving->received);
    slc_columns_apply(&halving->columns, rgba, kept);
    if (pyramid->info.may_overflow && !slc_row_is_finite(kept, halving->columns.axis.below))
        slc_columns_apply_wide(&halving->columns, rgba, kept);
    halving->received++;
    SluiceResult result = SLUICE_SUCCESS;
    while (result == SLUICE_SUCCESS && is_ready(halving)) {
        uint32_t y = row_below(halving);
        make_row(halving, pyramid->info.may_overflow);
        result = pyramid->info.row(pyramid->info.user, level + 1, y, halving->row);
        if (result == SLUICE_SUCCESS)
            result = push(pyramid, level + 1, halving->row);
    }
    return result;
}

SluiceResult slc_pyramid_push(struct slc_pyramid *pyramid, const float *rgba)
{
    assert(pyramid->level_count == 1 ||
           pyramid->halvings[0].received < pyramid->halvings[0].rows.size);
    return push(pyramid, 0, rgba);
}

void slc_pyramid_rewind(struct slc_pyramid *pyramid)
{
    for (uint32_t level = 0; level + 1 < pyramid->level_count; level++) {
        pyramid->halvings[level].received = pyramid->halvings[level].made = 0;
        find_taps(&pyramid->halvings[level]);
    }
}
