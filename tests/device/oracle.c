#include "device/oracle.h"

#include "support/test.h"

#include <math.h>
#include <string.h>

/* Limits that docs/feedback.md promises. */
#define LOD_MARGIN 0.125
#define LOD_MARGIN_ANISOTROPIC 0.1875
#define LOD_MARGIN_COARSER 0.125
#define TEXEL_MARGIN 0.0625
#define FLOAT_ERROR 2e-3
#define STEPS 33 /* samples along an anisotropic footprint */

static uint32_t level_size(uint32_t size, uint32_t level)
{
    return size >> level ? size >> level : 1;
}

void oracle_tiles_init(struct oracle_tiles *t, const struct SluiceTextureEntry *entry)
{
    t->entry = *entry;
    t->count = 0;
    for (uint32_t l = 0; l < entry->mipLevelCount; l++) {
        t->first[l] = t->count;
        t->width[l] = (level_size(entry->width, l) + entry->regionWidth - 1) / entry->regionWidth;
        t->height[l] =
            (level_size(entry->height, l) + entry->regionHeight - 1) / entry->regionHeight;
        t->count += t->width[l] * t->height[l];
    }
    assert_true(entry->mipLevelCount <= ORACLE_LEVELS && t->count <= ORACLE_TILES);
    memset(t->has, 0, t->count * sizeof t->has[0]);
}

bool *oracle_tile(struct oracle_tiles *t, uint32_t level, uint32_t x, uint32_t y)
{
    assert_true(level < t->entry.mipLevelCount && x < t->width[level] && y < t->height[level]);
    return &t->has[t->first[level] + y * t->width[level] + x];
}

/* Larger coordinates and derivatives count as infinite, as they may be infinite in texels. */
static bool is_finite(float x)
{
    return fabsf(x) <= 1e33f;
}

static bool is_finite_input(const struct ConformInput *in)
{
    if (!is_finite(in->uv[0]) || !is_finite(in->uv[1]))
        return false;
    if (in->mode == CONFORM_LOD)
        return !isnan(in->lod);
    return is_finite(in->dx[0]) && is_finite(in->dx[1]) && is_finite(in->dy[0]) &&
           is_finite(in->dy[1]) && !isnan(in->lodBias);
}

static double anisotropy_of(const struct ConformInput *in)
{
    return in->mode != CONFORM_LOD && in->maxAnisotropy > 1 ? fmin(in->maxAnisotropy, 16) : 1;
}

static double lod_of(double major, double minor, double anisotropy, double bias)
{
    if (major == 0)
        return -INFINITY;
    return log2(fmax(minor, major / anisotropy)) + bias;
}

/* Derivatives in texels per pixel. */
struct derivatives {
    double ax, ay, bx, by;
};

static struct derivatives derivatives_of(const struct SluiceTextureEntry *e,
                                         const struct ConformInput *in)
{
    return (struct derivatives){(double)in->dx[0] * e->width, (double)in->dx[1] * e->height,
                                (double)in->dy[0] * e->width, (double)in->dy[1] * e->height};
}

/* Singular values: their squares sum up to a2 + b2; their product is the determinant. */
static double major_axis(struct derivatives d)
{
    double sum = d.ax * d.ax + d.ay * d.ay + d.bx * d.bx + d.by * d.by;
    double area = d.ax * d.by - d.ay * d.bx;
    return sqrt(0.5 * (sum + sqrt(fmax(sum * sum - 4 * area * area, 0))));
}

static double minor_axis(struct derivatives d)
{
    double major = major_axis(d);
    return major > 0 ? fabs(d.ax * d.by - d.ay * d.bx) / major : 0;
}

struct oracle_lod oracle_lod(const struct SluiceTextureEntry *entry, const struct ConformInput *in)
{
    if (!is_finite_input(in))
        return (struct oracle_lod){NAN, NAN, NAN, NAN, NAN};
    if (in->mode == CONFORM_LOD)
        return (struct oracle_lod){in->lod, in->lod, in->lod, in->lod, in->lod};
    struct derivatives d = derivatives_of(entry, in);
    double a = hypot(d.ax, d.ay), b = hypot(d.bx, d.by), n = anisotropy_of(in), bias = in->lodBias;
    double longer = fmax(a, b), shorter = fmin(a, b), major = major_axis(d), minor = minor_axis(d);
    return (struct oracle_lod){.lengths = lod_of(longer, shorter, n, bias),
                               .ellipse = lod_of(major, minor, n, bias),
                               .finest = lod_of(longer, minor, n, bias),
                               .coarsest = lod_of(major, shorter, n, bias),
                               .isotropic = lod_of(major, 0, 1, bias)};
}

static double clamp(double x, double low, double high)
{
    return x < low ? low : x > high ? high : x;
}

/* Returns -1 for the border, which is no texel. */
static int64_t address(double texel, uint32_t size, uint32_t mode)
{
    double n = size;
    switch (mode) {
    case SLUICE_ADDRESS_MODE_REPEAT: return (int64_t)(texel - n * floor(texel / n));
    case SLUICE_ADDRESS_MODE_MIRRORED_REPEAT:
        texel -= 2 * n * floor(texel / (2 * n));
        return (int64_t)(texel < n ? texel : 2 * n - 1 - texel);
    case SLUICE_ADDRESS_MODE_CLAMP_TO_BORDER: return texel < 0 || texel >= n ? -1 : (int64_t)texel;
    case SLUICE_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE:
        texel = texel < 0 ? -1 - texel : texel;
        return (int64_t)clamp(texel, 0, n - 1);
    default: return (int64_t)clamp(texel, 0, n - 1);
    }
}

static bool repeats(uint32_t mode)
{
    return mode == SLUICE_ADDRESS_MODE_REPEAT || mode == SLUICE_ADDRESS_MODE_MIRRORED_REPEAT;
}

/* Moves a coordinate near 0 exactly, so that half a texel still counts beside it. */
static double brought_near(double coordinate, uint32_t mode)
{
    return repeats(mode) ? fmod(coordinate, 2) : coordinate;
}

/* Lists the tiles along one axis under one tap, at most four. */
static uint32_t tap_tiles(double coordinate, uint32_t size, uint32_t tile, uint32_t mode,
                          struct oracle_filter filter, uint32_t out[4])
{
    double at = coordinate * size, half = filter.nearest ? 0 : 0.5;
    double low = floor(at - half - filter.subtexel);
    double high =
        filter.nearest ? floor(at + filter.subtexel) : ceil(at + half + filter.subtexel) - 1;
    uint32_t count = 0;
    for (double texel = low; texel <= high && count < 4; texel++) {
        int64_t t = address(texel, size, mode);
        if (t >= 0)
            out[count++] = (uint32_t)t / tile;
        if (texel + 1 == texel) /* beyond 2^53 there are no neighbors */
            break;
    }
    return count;
}

static void require_tap(struct oracle_tiles *t, uint32_t level, double u, double v,
                        struct oracle_filter filter)
{
    const struct SluiceTextureEntry *e = &t->entry;
    uint32_t xs[4], ys[4];
    uint32_t nx =
        tap_tiles(u, level_size(e->width, level), e->regionWidth, e->addressModeU, filter, xs);
    uint32_t ny =
        tap_tiles(v, level_size(e->height, level), e->regionHeight, e->addressModeV, filter, ys);
    for (uint32_t y = 0; y < ny; y++)
        for (uint32_t x = 0; x < nx; x++)
            *oracle_tile(t, level, xs[x], ys[y]) = true;
}

/* Axis of an anisotropic footprint, in uv. */
static void footprint_axis(const struct SluiceTextureEntry *e, const struct ConformInput *in,
                           bool by_ellipse, double axis[2])
{
    struct derivatives d = derivatives_of(e, in);
    const float *longer = hypot(d.ax, d.ay) >= hypot(d.bx, d.by) ? in->dx : in->dy;
    axis[0] = (double)longer[0];
    axis[1] = (double)longer[1];
    if (!by_ellipse)
        return;
    double angle = 0.5 * atan2(2 * (d.ax * d.ay + d.bx * d.by),
                               d.ax * d.ax + d.bx * d.bx - d.ay * d.ay - d.by * d.by);
    axis[0] = major_axis(d) * cos(angle) / e->width;
    axis[1] = major_axis(d) * sin(angle) / e->height;
}

static void require_level(struct oracle_tiles *t, uint32_t level, const struct ConformInput *in,
                          struct oracle_filter filter)
{
    const struct SluiceTextureEntry *e = &t->entry;
    double u = brought_near(in->uv[0], e->addressModeU);
    double v = brought_near(in->uv[1], e->addressModeV);
    if (anisotropy_of(in) == 1) {
        require_tap(t, level, u, v, filter);
        return;
    }
    double axis[2], scale = filter.bias_scales ? exp2(in->lodBias) : 1;
    footprint_axis(e, in, filter.by_ellipse, axis);
    for (int i = 0; i < STEPS; i++) {
        double at = scale * ((double)i / (STEPS - 1) - 0.5);
        require_tap(t, level, u + at * axis[0], v + at * axis[1], filter);
    }
}

void oracle_require(struct oracle_tiles *t, const struct ConformInput *in,
                    struct oracle_filter filter)
{
    double last = t->entry.mipLevelCount - 1;
    struct oracle_lod lods = oracle_lod(&t->entry, in);
    double lod = filter.by_ellipse ? lods.ellipse : lods.lengths;
    if (isnan(lod))
        return; /* nothing is known, so nothing is required */
    lod = clamp(lod + filter.lod_offset, 0, last);
    uint32_t level = (uint32_t)lod;
    require_level(t, level, in, filter);
    if (lod - level >= filter.lod_quantum && lod > level)
        require_level(t, level + 1, in, filter);
}

/* Returns the parent of a tile, starting at the level 0 tile of a region. */
static uint32_t parent(uint32_t tile, uint32_t coarser_count)
{
    return tile / 2 < coarser_count ? tile / 2 : coarser_count - 1;
}

void oracle_decode(struct oracle_tiles *t, const uint32_t *map)
{
    const struct SluiceTextureEntry *e = &t->entry;
    for (uint32_t y = 0; y < e->regionCountY; y++)
        for (uint32_t x = 0; x < e->regionCountX; x++) {
            uint32_t mark = map[y * e->regionCountX + x], tx = x, ty = y;
            if (mark == SLUICE_MIP_UNTOUCHED)
                continue;
            for (uint32_t l = 0; l < e->mipLevelCount; l++) {
                if (l) {
                    tx = parent(tx, t->width[l]);
                    ty = parent(ty, t->height[l]);
                }
                if (l >= mark)
                    *oracle_tile(t, l, tx, ty) = true;
            }
        }
}

void oracle_close(struct oracle_tiles *t)
{
    for (uint32_t l = 1; l < t->entry.mipLevelCount; l++)
        for (uint32_t y = 0; y < t->height[l - 1]; y++)
            for (uint32_t x = 0; x < t->width[l - 1]; x++)
                if (*oracle_tile(t, l - 1, x, y))
                    *oracle_tile(t, l, parent(x, t->width[l]), parent(y, t->height[l])) = true;
}

static uint32_t region_of(double at, uint32_t mode, double regions_per_unit, uint32_t count)
{
    if (mode == SLUICE_ADDRESS_MODE_REPEAT)
        at -= floor(at);
    else if (mode == SLUICE_ADDRESS_MODE_MIRRORED_REPEAT)
        at = fabs(at - 2 * floor(at / 2 + 0.5));
    else if (mode == SLUICE_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE)
        at = fabs(at);
    return (uint32_t)clamp(floor(clamp(at, 0, 1) * regions_per_unit), 0, count - 1);
}

/* Marks regions from `below` before to `above` behind a coordinate, walked in small steps. */
static void allow_axis(bool *regions, double coordinate, double below, double above, uint32_t mode,
                       double regions_per_unit, uint32_t count)
{
    assert_true(count <= ORACLE_REGIONS);
    memset(regions, 0, count * sizeof regions[0]);
    if (mode != SLUICE_ADDRESS_MODE_REPEAT) /* a mirrored image has its tiles on the other side */
        below = above = fmax(below, above);
    coordinate = brought_near(coordinate, mode);
    double low = coordinate - below, high = coordinate + above;
    low = repeats(mode) ? fmax(low, coordinate - 2) : clamp(low, -2, 2);
    high = repeats(mode) ? fmin(high, coordinate + 2) : clamp(high, -2, 2);
    uint32_t steps = (uint32_t)((high - low) * regions_per_unit * 4) + 1;
    for (uint32_t i = 0; i <= steps; i++)
        regions[region_of(low + (high - low) * i / steps, mode, regions_per_unit, count)] = true;
    /* the last region may be narrow: it is before each edge of the image */
    for (double edge = ceil(low); edge <= high && edge + 1 > edge; edge++) {
        regions[region_of(edge - 1e-9, mode, regions_per_unit, count)] = true;
        regions[region_of(edge, mode, regions_per_unit, count)] = true;
    }
}

static void allow_all(struct oracle_allowed *a, const struct SluiceTextureEntry *e)
{
    memset(a->x, true, e->regionCountX * sizeof a->x[0]);
    memset(a->y, true, e->regionCountY * sizeof a->y[0]);
}

bool oracle_allows(const struct oracle_allowed *a, uint32_t level, uint32_t x, uint32_t y)
{
    return (a->x[x] && a->y[y]) || (level >= a->wide_level && a->wide_x[x] && a->wide_y[y]);
}

/* Allows regions around `uv` for levels up to `coarsest`. A tile may begin a texel before its
 * regions. */
static void allow_box(bool *xs, bool *ys, const struct SluiceTextureEntry *e,
                      const struct ConformInput *in, const double box[2], uint32_t coarsest)
{
    double above = 0.5 + TEXEL_MARGIN + FLOAT_ERROR;
    double below = above + (e->flags & SLUICE_TEXTURE_FLAG_UNEVEN ? 1 : 0);
    double wide = 1.0 / level_size(e->width, coarsest),
           high = 1.0 / level_size(e->height, coarsest);
    allow_axis(xs, in->uv[0], below * wide + box[0], above * wide + box[0], e->addressModeU,
               (double)e->width / e->regionWidth, e->regionCountX);
    allow_axis(ys, in->uv[1], below * high + box[1], above * high + box[1], e->addressModeV,
               (double)e->height / e->regionHeight, e->regionCountY);
}

/* Returns the coarser of the two levels read at this LOD. */
static uint32_t coarser_level(double lod, double last)
{
    return (uint32_t)clamp(floor(clamp(lod, 0, last)) + 1, 0, last);
}

void oracle_allow(struct oracle_allowed *a, const struct SluiceTextureEntry *e,
                  const struct ConformInput *in)
{
    double last = e->mipLevelCount - 1;
    struct oracle_lod lod = oracle_lod(e, in);
    a->level = e->mipLevelCount - 1;
    a->wide_level = UINT32_MAX;
    if (isnan(lod.lengths)) {
        allow_all(a, e);
        return;
    }
    double margin = in->mode == CONFORM_LOD ? 0
                    : anisotropy_of(in) > 1 ? LOD_MARGIN_ANISOTROPIC
                                            : LOD_MARGIN;
    a->level = (uint32_t)clamp(lod.finest - margin - FLOAT_ERROR, 0, last);
    double box[2] = {0, 0};
    if (anisotropy_of(in) > 1)
        for (int i = 0; i < 2; i++)
            box[i] = hypot(in->dx[i], in->dy[i]) * exp2(fmax(in->lodBias, 0));
    double coarser = in->mode == CONFORM_LOD ? 0 : LOD_MARGIN_COARSER;
    lod.coarsest += coarser;
    lod.isotropic += coarser;
    allow_box(a->x, a->y, e, in, box, coarser_level(lod.coarsest + FLOAT_ERROR, last));
    allow_box(a->wide_x, a->wide_y, e, in, box, coarser_level(lod.isotropic + FLOAT_ERROR, last));
    a->wide_level = coarser_level(lod.coarsest - FLOAT_ERROR, last) + 1;
}
