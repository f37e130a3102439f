#include "core/uv_transform.h"

#include <math.h>
#include <string.h>

/*
 * Positions along an axis are integers: a UV of the follower in parts of W * 2^24, where W is the
 * primary's size. W is at most 2^20, scale and offset below 2^37: all sums stay below 2^58, and
 * products with a size within a period below 2^64.
 */

#define MOST 4096.0

static bool read_axis(struct slc_uv_axis *axis, float scale, float offset, SluiceUvWrap wrap)
{
    double size = fabs((double)scale);
    if (!(size >= 1 / MOST && size <= MOST) || !(fabs((double)offset) <= MOST) ||
        (unsigned)wrap > SLUICE_UV_WRAP_MIRROR_CLAMP)
        return false;
    axis->scale = (int64_t)floor((double)scale * (1 << SLC_UV_BITS) + 0.5);
    axis->offset = (int64_t)floor((double)offset * (1 << SLC_UV_BITS) + 0.5);
    axis->wrap = wrap;
    return true;
}

const char *slc_uv_transform_read(struct slc_uv_transform *t, const SluiceUvTransform *from)
{
    if (!read_axis(&t->u, from->scaleU, from->offsetU, from->wrapU) ||
        !read_axis(&t->v, from->scaleV, from->offsetV, from->wrapV))
        return "a scale must have a size of 1/4096 to 4096, an offset one of at most 4096, and a "
               "wrap must be a SluiceUvWrap";
    return NULL;
}

bool slc_uv_axis_is_valid(const struct slc_uv_axis *axis)
{
    const int64_t most = (int64_t)MOST << SLC_UV_BITS, least = (INT64_C(1) << SLC_UV_BITS) / 4096;
    return axis->scale >= -most && axis->scale <= most &&
           (axis->scale >= least || axis->scale <= -least) && axis->offset >= -most &&
           axis->offset <= most && (unsigned)axis->wrap <= SLUICE_UV_WRAP_MIRROR_CLAMP;
}

static bool is_none(const struct slc_uv_axis *axis)
{
    return axis->scale == 1 << SLC_UV_BITS &&
           (axis->offset == 0 ||
            (axis->wrap == SLUICE_UV_WRAP_REPEAT && axis->offset % (1 << SLC_UV_BITS) == 0));
}

bool slc_uv_transform_is_none(const struct slc_uv_transform *t)
{
    return is_none(&t->u) && is_none(&t->v);
}

/** a >= b * 2^shift */
static bool is_at_least(uint64_t a, uint64_t b, int shift)
{
    if (shift >= 0)
        return shift < 64 && b <= a >> shift;
    return a >= ((b + ((uint64_t)1 << -shift) - 1) >> -shift);
}

static uint64_t size_of(int64_t value)
{
    return (uint64_t)(value < 0 ? -value : value);
}

int slc_uv_level_offset(const struct slc_uv_transform *t, const SluiceStreamedTextureDesc *primary,
                        const SluiceStreamedTextureDesc *follower)
{
    int d = -33; /* below every ratio of sizes times scale */
    while (
        is_at_least(follower->width * size_of(t->u.scale), primary->width, d + 1 + SLC_UV_BITS) &&
        is_at_least(follower->height * size_of(t->v.scale), primary->height, d + 1 + SLC_UV_BITS))
        d++;
    return d;
}

struct interval {
    uint64_t begin, end; ///< within a period
};

/** Maps an interval of the axis into [0, period). */
struct intervals {
    struct interval list[4];
    uint32_t count;
};

static void add(struct intervals *out, int64_t begin, int64_t end)
{
    if (begin < end)
        out->list[out->count++] = (struct interval){(uint64_t)begin, (uint64_t)end};
}

static int64_t greater(int64_t a, int64_t b)
{
    return a > b ? a : b;
}

static int64_t smaller(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

/** Adds the part of [begin, end) within period `turn`; `back`: mirrored. */
static void add_turn(struct intervals *out, int64_t begin, int64_t end, int64_t turn,
                     int64_t period, bool back)
{
    int64_t first = greater(begin - turn * period, 0);
    int64_t last = smaller(end - turn * period, period);
    if (back)
        add(out, period - last, period - first);
    else
        add(out, first, last);
}

/** Folds [begin, end) into one period. `begin` is in the period from 0 on. */
static void fold_periodic(struct intervals *out, int64_t begin, int64_t end, int64_t period,
                          bool mirror)
{
    int64_t cycle = mirror ? 2 * period : period;
    if (end - begin >= cycle) {
        add(out, 0, period);
        return;
    }
    int64_t start = begin % cycle;
    start += start < 0 ? cycle : 0;
    for (int64_t turn = 0; turn < (mirror ? 4 : 2); turn++)
        add_turn(out, start, start + (end - begin), turn, period, mirror && turn % 2);
}

static void fold_clamped(struct intervals *out, int64_t begin, int64_t end, int64_t period,
                         bool mirror)
{
    add_turn(out, begin, end, 0, period, false);
    if (mirror)
        add_turn(out, begin, end, -1, period, true);
    else if (begin < 0)
        add(out, 0, 1);
    if (end > period || (mirror && begin < -period))
        add(out, period - 1, period);
}

static void fold(struct intervals *out, int64_t begin, int64_t end, int64_t period,
                 SluiceUvWrap wrap)
{
    out->count = 0;
    if (wrap <= SLUICE_UV_WRAP_MIRROR)
        fold_periodic(out, begin, end, period, wrap == SLUICE_UV_WRAP_MIRROR);
    else
        fold_clamped(out, begin, end, period, wrap == SLUICE_UV_WRAP_MIRROR_CLAMP);
}

/** One axis of both grids. */
struct pair {
    const struct slc_uv_axis *axis;
    uint32_t from_size, from_cell, from_count, to_size, to_cell, to_count;
};

/** Finds the intervals of the follower in which cell `i` of the primary is sampled. */
static void place_cell(const struct pair *p, uint32_t i, struct intervals *out)
{
    uint64_t begin = (uint64_t)i * p->from_cell, end = begin + p->from_cell;
    end = end < p->from_size ? end : p->from_size; /* the last cell is cut off */
    int64_t shift = p->axis->offset * p->from_size;
    int64_t a = (int64_t)begin * p->axis->scale + shift;
    int64_t b = (int64_t)end * p->axis->scale + shift;
    fold(out, smaller(a, b), greater(a, b), (int64_t)p->from_size << SLC_UV_BITS, p->axis->wrap);
}

/** First and last cell of the follower that the interval overlaps. */
static void cells_of(const struct pair *p, const struct interval *in, uint32_t *first,
                     uint32_t *last)
{
    uint64_t unit = (uint64_t)p->from_size << SLC_UV_BITS;
    /* 2^44 times 2^20, the largest texture, would be 2^64 */
    uint64_t end = in->end == unit
                       ? p->to_size
                       : in->end * p->to_size / unit + (in->end * p->to_size % unit > 0);
    *first = (uint32_t)(in->begin * p->to_size / unit / p->to_cell);
    *last = (uint32_t)((end - 1) / p->to_cell);
}

static void lower(uint8_t *bytes, uint32_t first, uint32_t last, uint8_t value)
{
    for (uint32_t i = first; i <= last; i++)
        bytes[i] = bytes[i] < value ? bytes[i] : value;
}

static void lower_row(uint8_t *row, const uint8_t *by, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        row[i] = row[i] < by[i] ? row[i] : by[i];
}

/* Writes one row per row of the primary, with the follower's columns. */
static void spread_columns(const struct pair *p, uint32_t rows, const uint8_t *values, uint8_t *out)
{
    memset(out, SLUICE_MIP_UNTOUCHED, (size_t)rows * p->to_count);
    for (uint32_t column = 0; column < p->from_count; column++) {
        struct intervals where;
        place_cell(p, column, &where);
        for (uint32_t k = 0; k < where.count; k++) {
            uint32_t first, last;
            cells_of(p, &where.list[k], &first, &last);
            for (uint32_t y = 0; y < rows; y++) {
                uint8_t value = values[(size_t)y * p->from_count + column];
                if (value != SLUICE_MIP_UNTOUCHED)
                    lower(out + (size_t)y * p->to_count, first, last, value);
            }
        }
    }
}

void slc_least_transformed(const struct slc_uv_transform *t, const struct slc_grid *from,
                           const uint8_t *values, const struct slc_grid *to, uint8_t *work,
                           uint8_t *least)
{
    const struct pair x = {&t->u,     from->width,    from->cell_width, from->columns,
                           to->width, to->cell_width, to->columns};
    const struct pair y = {&t->v,      from->height,    from->cell_height, from->rows,
                           to->height, to->cell_height, to->rows};
    spread_columns(&x, from->rows, values, work);
    memset(least, SLUICE_MIP_UNTOUCHED, (size_t)to->rows * to->columns);
    for (uint32_t row = 0; row < from->rows; row++) {
        struct intervals where;
        place_cell(&y, row, &where);
        for (uint32_t k = 0; k < where.count; k++) {
            uint32_t first, last;
            cells_of(&y, &where.list[k], &first, &last);
            for (uint32_t r = first; r <= last; r++)
                lower_row(least + (size_t)r * to->columns, work + (size_t)row * to->columns,
                          to->columns);
        }
    }
}
