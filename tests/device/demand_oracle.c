#include "device/demand_oracle.h"

#include "base/checked.h"

#include <math.h>

#define STEP (1.0 / 256.0)
#define NOWHERE INT32_MIN
#define FLOAT_STEP (1.0 / 8388608.0) /* for numbers between 1 and 2 */

static bool all_finite(const float *values, int count)
{
    for (int i = 0; i < count; i++)
        if (!isfinite(values[i]))
            return false;
    return true;
}

long double demand_oracle_lod(const float dx[2], const float dy[2], double anisotropy)
{
    if (!all_finite(dx, 2) || !all_finite(dy, 2))
        return INFINITY;
    long double a = (long double)dx[0] * dx[0] + (long double)dx[1] * dx[1];
    long double c = (long double)dy[0] * dy[0] + (long double)dy[1] * dy[1];
    long double b = (long double)dx[0] * dy[0] + (long double)dx[1] * dy[1];
    long double det = (long double)dx[0] * dy[1] - (long double)dx[1] * dy[0];
    long double longer = sqrtl(fmaxl(a, c));
    /* Singular values of the matrix of derivatives: their product is its determinant. */
    long double wide = sqrtl((a + c + sqrtl((a - c) * (a - c) + 4 * b * b)) / 2);
    long double narrow = wide > 0 ? fabsl(det) / wide : 0;
    if (anisotropy <= 1)
        return log2l(longer);
    return log2l(fmaxl(narrow, longer / anisotropy));
}

static uint32_t mode_of(const struct SluiceDemandTexture *t, int axis)
{
    return t->shape >> (axis ? SLUICE_DEMAND_MODE_V_SHIFT : SLUICE_DEMAND_MODE_U_SHIFT) & 7;
}

struct split {
    const struct SluiceDemandTexture *texture;
    const struct DemandInput *in;
    void (*visit)(void *user, const struct demand_tap *tap);
    void *user;
    long double uv[2], axis[2]; ///< row of samples, in uv
    double shown, wanted;       ///< LODs
    bool sure;
};

double demand_oracle_share(const struct demand_tap *tap, double shown_lod)
{
    double magnified = fmin(fmax(shown_lod - tap->wanted_lod, 0), 1);
    return !tap->spline ? 0 : tap->smart ? magnified : 1;
}

/* Visits a row of `count` samples at one level. */
static void visit_row(const struct split *s, uint32_t level, double weight, uint32_t count,
                      bool sure)
{
    for (uint32_t i = 0; i < count; i++) {
        long double at = (i + 0.5L) / count - 0.5L;
        bool forced = s->in->kind == DEMAND_CUBIC;
        struct demand_tap tap = {.level = level,
                                 .u = s->uv[0] + at * s->axis[0],
                                 .v = s->uv[1] + at * s->axis[1],
                                 .weight = s->sure ? weight / count : 0,
                                 .spline = forced || s->texture->shape & SLUICE_DEMAND_SPLINE,
                                 .smart = forced || s->texture->shape & SLUICE_DEMAND_SMART,
                                 .wanted_lod = s->wanted,
                                 .nearest = s->texture->shape & SLUICE_DEMAND_NEAREST && !forced,
                                 .sure = sure && s->sure};
        tap.cubic = demand_oracle_share(&tap, s->shown);
        bool edge = fabs(s->wanted) < 1e-3 || (tap.cubic > 0 && tap.cubic < 1e-3);
        tap.sure = tap.sure && !(tap.spline && tap.smart && edge);
        s->visit(s->user, &tap);
    }
}

/* Visits the levels around `lod`, which is between 0 and `last`. */
static void visit_levels(const struct split *s, double lod, uint32_t last, uint32_t count)
{
    bool nearest = s->texture->shape & SLUICE_DEMAND_NEAREST_LEVEL;
    const double blur = STEP / 2 + 2e-4;
    for (uint32_t level = 0; level <= last; level++) {
        double distance = fabs(lod - level);
        double weight = nearest ? distance < 0.5 : fmax(1 - distance, 0);
        double edge = nearest ? 0.5 - distance : 1 - distance; /* distance to the filter's end */
        if (nearest && level > 0 && lod == level - 0.5)
            weight = 0; /* ceil(lod - 1/2) */
        if (nearest && lod == level + 0.5)
            weight = 1;
        if (edge > -blur)
            visit_row(s, level, weight, count, edge > blur);
    }
}

/* Visits a row along the longer derivative. If float cannot decide, visits both directions and
 * neighboring counts. */
static void visit_rows(struct split *s, double lod, uint32_t last, double bias, float d[2][2])
{
    const struct DemandInput *in = s->in;
    double x = hypot(d[0][0], d[0][1]), y = hypot(d[1][0], d[1][1]);
    double ratio = fmax(x, y) * exp2(bias - lod) - 0.01;
    double count = fmin(fmax(ceil(ratio), 1), s->texture->maxAnisotropy);
    bool tied = fabs(x - y) < 1e-5 * x;
    s->sure = ratio < 0.9 || (!tied && fabs(ratio - round(ratio)) > 2e-4 * ratio);
    for (int derivative = 0; derivative < 2; derivative++) {
        if (!tied && (derivative == 0) != (x >= y))
            continue;
        for (int i = 0; i < 2; i++)
            s->axis[i] = (derivative ? in->dy : in->dx)[i] * exp2l(bias);
        for (int more = s->sure ? 0 : -1; more <= (s->sure ? 0 : 1); more++)
            if (count + more >= 1)
                visit_levels(s, lod, last, (uint32_t)count + (uint32_t)more);
        if (s->sure)
            return;
    }
}

bool demand_oracle_taps(const struct SluiceDemandTexture *t, const struct DemandInput *in,
                        double loader_bias, void (*visit)(void *user, const struct demand_tap *tap),
                        void *user)
{
    struct split s = {.texture = t, .in = in, .visit = visit, .user = user, .sure = true};
    uint32_t last = slc_mip_count(slc_max_u32(t->width, t->height)) - 1;
    double bias = t->lodBias + loader_bias;
    bool finite = fabsf(in->uv[0]) <= 1e33f && fabsf(in->uv[1]) <= 1e33f;
    float d[2][2];
    for (int i = 0; i < 2; i++) {
        uint32_t mode = mode_of(t, i);
        bool periodic =
            mode == SLUICE_ADDRESS_MODE_REPEAT || mode == SLUICE_ADDRESS_MODE_MIRRORED_REPEAT;
        /* exact, so that half a texel counts even beside 1e30 */
        s.uv[i] = !finite ? 0 : periodic ? fmodl(in->uv[i], 2) : in->uv[i];
        d[0][i] = in->dx[i] * (float)(i ? t->height : t->width);
        d[1][i] = in->dy[i] * (float)(i ? t->height : t->width);
    }
    long double lod = in->kind == DEMAND_LOD ? isnan(in->lod) ? INFINITY : in->lod
                                             : demand_oracle_lod(d[0], d[1], t->maxAnisotropy);
    double clamped = (double)fminl(fmaxl(lod + bias, 0), last);
    s.shown = clamped;
    s.wanted = (double)(lod + t->lodBias);
    bool row = in->kind != DEMAND_LOD && t->maxAnisotropy > 1;
    if (row && lod + bias < last)
        visit_rows(&s, clamped, last, bias, d);
    else
        visit_levels(&s, clamped, last, 1);
    return s.sure && !(row && fabsl(lod + bias - last) < 1e-4L);
}

/* Vulkan's wrapping: from any number to a texel; -1: border. */
static int32_t wrap(uint32_t mode, long double i, uint32_t size)
{
    long double n = size;
    if (mode == SLUICE_ADDRESS_MODE_REPEAT) {
        i = fmodl(i, n);
        return (int32_t)(i < 0 ? i + n : i);
    }
    if (mode == SLUICE_ADDRESS_MODE_MIRRORED_REPEAT) {
        i = fmodl(i, 2 * n);
        i += (i < 0 ? 2 * n : 0) - n;
        return (int32_t)(n - 1 - (i >= 0 ? i : -(1 + i)));
    }
    if (mode == SLUICE_ADDRESS_MODE_CLAMP_TO_BORDER)
        return i < 0 || i >= n ? -1 : (int32_t)i;
    if (mode == SLUICE_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE)
        i = i >= 0 ? i : -(1 + i);
    return (int32_t)(i < 0 ? 0 : i >= n ? n - 1 : i);
}

static double spline(double x)
{
    x = fabs(x);
    if (x >= 2)
        return 0;
    return x >= 1 ? (2 - x) * (2 - x) * (2 - x) / 6 : (3 * x * x * x - 6 * x * x + 4) / 6;
}

/* Derivative of the spline. */
static double spline_slope(double x)
{
    double a = fabs(x), slope = a >= 2 ? 0 : a >= 1 ? -(2 - a) * (2 - a) / 2 : (3 * a - 4) * a / 2;
    return x < 0 ? -slope : slope;
}

struct axis_texels {
    int32_t at[8];
    double weight[8], slope[8]; ///< slopes per unit of the coordinate
    bool sure[8];
};

static double axis_blur(const struct SluiceDemandTexture *t, int axis, const struct demand_tap *tap,
                        long double coordinate)
{
    uint32_t size = slc_mip_size(axis ? t->height : t->width, tap->level), mode = mode_of(t, axis);
    bool periodic =
        mode == SLUICE_ADDRESS_MODE_REPEAT || mode == SLUICE_ADDRESS_MODE_MIRRORED_REPEAT;
    /* Error of float: whole periods are exact, the rest is rounded. */
    double reach = periodic ? 4 : fmin(fabs((double)coordinate) + 2, 64);
    return (tap->nearest ? 1e-6 : STEP / 2) + reach * FLOAT_STEP * size;
}

/* Finds the texels that the filter reaches along one axis, with their weights. */
static struct axis_texels filter_axis(const struct SluiceDemandTexture *t, int axis,
                                      const struct demand_tap *tap, bool cubic)
{
    uint32_t size = slc_mip_size(axis ? t->height : t->width, tap->level), mode = mode_of(t, axis);
    long double coordinate = axis ? tap->v : tap->u;
    double blur = axis_blur(t, axis, tap, coordinate);
    /* beyond, everything is edge or border; neighbors must differ */
    coordinate = fminl(fmaxl(coordinate, -1e9L), 1e9L);
    long double place = coordinate * size - 0.5L, low = floorl(place);
    struct axis_texels a;
    for (int k = 0; k < 8; k++) {
        long double i = low + k - 3;
        double distance = (double)fabsl(i - place);
        double width = cubic ? 2 : tap->nearest ? 0.5 : 1;
        a.at[k] = NOWHERE;
        if (width - distance < -blur)
            continue;
        a.at[k] = wrap(mode, i, size);
        a.weight[k] = cubic          ? spline(distance)
                      : tap->nearest ? distance < 0.5 || i == place + 0.5L
                                     : fmax(1 - distance, 0);
        a.slope[k] = cubic          ? size * spline_slope((double)(place - i))
                     : tap->nearest ? 0
                                    : (i == low ? -1.0 : i == low + 1) * size;
        a.sure[k] = cubic ? a.weight[k] > 2 * blur : width - distance > blur;
        if (tap->nearest && i == place + 0.5L && blur < 0.01)
            a.sure[k] = false;
    }
    return a;
}

bool demand_oracle_jumps(const struct SluiceDemandTexture *t, const struct demand_tap *tap)
{
    if (tap->nearest || tap->cubic >= 1)
        return false;
    for (int axis = 0; axis < 2; axis++) {
        long double coordinate = axis ? tap->v : tap->u;
        long double place = coordinate * slc_mip_size(axis ? t->height : t->width, tap->level);
        double blur = axis_blur(t, axis, tap, coordinate);
        if (fabsl(place - 0.5L - roundl(place - 0.5L)) < 2 * blur)
            return true;
    }
    return false;
}

void demand_oracle_touches(const struct SluiceDemandTexture *t, const struct demand_tap *tap,
                           void (*visit)(void *user, const struct demand_touch *touch), void *user)
{
    for (int cubic = 0; cubic < 2; cubic++) {
        double share = cubic ? tap->cubic : 1 - tap->cubic;
        if (!(share > 0))
            continue;
        struct axis_texels x = filter_axis(t, 0, tap, cubic), y = filter_axis(t, 1, tap, cubic);
        for (int j = 0; j < 8; j++)
            for (int i = 0; i < 8; i++) {
                if (x.at[i] == NOWHERE || y.at[j] == NOWHERE)
                    continue;
                bool border = x.at[i] < 0 || y.at[j] < 0;
                struct demand_touch touch = {.x = border ? -1 : x.at[i],
                                             .y = border ? -1 : y.at[j],
                                             .weight = share * x.weight[i] * y.weight[j],
                                             .du = share * x.slope[i] * y.weight[j],
                                             .dv = share * x.weight[i] * y.slope[j],
                                             .sure = x.sure[i] && y.sure[j]};
                visit(user, &touch);
            }
    }
}
