/** Transforms of three rows and four columns, as in sluice/pbrt.h. */
#ifndef DEMAND_PBRT_TRANSFORM_H
#define DEMAND_PBRT_TRANSFORM_H

#include <sluice/pbrt.h>

#include <math.h>
#include <stdbool.h>
#include <string.h>

static inline void transform_point(const float m[12], const float p[3], float out[3])
{
    float result[3];
    for (int r = 0; r < 3; r++)
        result[r] = m[4 * r] * p[0] + m[4 * r + 1] * p[1] + m[4 * r + 2] * p[2] + m[4 * r + 3];
    memcpy(out, result, sizeof result);
}

static inline void transform_vector(const float m[12], const float v[3], float out[3])
{
    float result[3];
    for (int r = 0; r < 3; r++)
        result[r] = m[4 * r] * v[0] + m[4 * r + 1] * v[1] + m[4 * r + 2] * v[2];
    memcpy(out, result, sizeof result);
}

/** out = a * b. `out` may be `a` or `b`. */
static inline void transform_multiply(const float a[12], const float b[12], float out[12])
{
    float result[12];
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 4; c++) {
            float sum = c == 3 ? a[4 * r + 3] : 0.0f;
            for (int i = 0; i < 3; i++)
                sum += a[4 * r + i] * b[4 * i + c];
            result[4 * r + c] = sum;
        }
    memcpy(out, result, sizeof result);
}

static inline double transform_determinant(const float m[12])
{
    return (double)m[0] * ((double)m[5] * m[10] - (double)m[6] * m[9]) -
           (double)m[1] * ((double)m[4] * m[10] - (double)m[6] * m[8]) +
           (double)m[2] * ((double)m[4] * m[9] - (double)m[5] * m[8]);
}

/** Returns false, and leaves `out` unchanged, if there is no inverse. */
static inline bool transform_invert(const float m[12], float out[12])
{
    const double d = transform_determinant(m);
    float inverse[12];
    if (!(fabs(d) > 0.0) || !isfinite(1.0 / d))
        return false;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            const int r1 = (c + 1) % 3, r2 = (c + 2) % 3, c1 = (r + 1) % 3, c2 = (r + 2) % 3;
            double minor =
                (double)m[4 * r1 + c1] * m[4 * r2 + c2] - (double)m[4 * r1 + c2] * m[4 * r2 + c1];
            inverse[4 * r + c] = (float)(minor / d);
        }
    for (int r = 0; r < 3; r++)
        inverse[4 * r + 3] =
            -(inverse[4 * r] * m[3] + inverse[4 * r + 1] * m[7] + inverse[4 * r + 2] * m[11]);
    memcpy(out, inverse, sizeof inverse);
    return true;
}

static inline SluicePbrtBounds bounds_none(void)
{
    return (SluicePbrtBounds){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
}

static inline void bounds_add_point(SluicePbrtBounds *box, const float p[3])
{
    for (int i = 0; i < 3; i++) {
        box->least[i] = fminf(box->least[i], p[i]);
        box->most[i] = fmaxf(box->most[i], p[i]);
    }
}

static inline void bounds_add(SluicePbrtBounds *box, const SluicePbrtBounds *other)
{
    bounds_add_point(box, other->least);
    bounds_add_point(box, other->most);
}

/** Returns the box around the eight transformed corners. */
static inline SluicePbrtBounds transform_bounds(const float m[12], const SluicePbrtBounds *box)
{
    SluicePbrtBounds result = bounds_none();
    for (int corner = 0; corner < 8; corner++) {
        float p[3];
        for (int i = 0; i < 3; i++)
            p[i] = corner >> i & 1 ? box->most[i] : box->least[i];
        transform_point(m, p, p);
        bounds_add_point(&result, p);
    }
    return result;
}

#endif /* DEMAND_PBRT_TRANSFORM_H */
