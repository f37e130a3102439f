#include "pbrt/affine.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define RADIANS 0.017453292519943295

float slc_pbrt_clamped_float(double value)
{
    return (float)(value > FLT_MAX ? FLT_MAX : value < -FLT_MAX ? -FLT_MAX : value);
}

struct slc_pbrt_affine slc_pbrt_identity(void)
{
    return (struct slc_pbrt_affine){{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
}

struct slc_pbrt_affine slc_pbrt_product(const struct slc_pbrt_affine *a,
                                        const struct slc_pbrt_affine *b)
{
    struct slc_pbrt_affine c;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++)
            c.m[i][j] = a->m[i][0] * b->m[0][j] + a->m[i][1] * b->m[1][j] +
                        a->m[i][2] * b->m[2][j] + (j == 3 ? a->m[i][3] : 0);
    return c;
}

static double cofactor(const struct slc_pbrt_affine *a, int row, int column)
{
    int r0 = (row + 1) % 3, r1 = (row + 2) % 3, c0 = (column + 1) % 3, c1 = (column + 2) % 3;
    return a->m[r0][c0] * a->m[r1][c1] - a->m[r0][c1] * a->m[r1][c0];
}

double slc_pbrt_determinant(const struct slc_pbrt_affine *a)
{
    return a->m[0][0] * cofactor(a, 0, 0) + a->m[0][1] * cofactor(a, 0, 1) +
           a->m[0][2] * cofactor(a, 0, 2);
}

bool slc_pbrt_is_finite(const struct slc_pbrt_affine *a)
{
    for (int i = 0; i < 12; i++)
        if (!(fabs(a->m[i / 4][i % 4]) <= FLT_MAX))
            return false;
    return true;
}

bool slc_pbrt_inverse(const struct slc_pbrt_affine *a, struct slc_pbrt_affine *inverse)
{
    double determinant = slc_pbrt_determinant(a);
    if (determinant == 0 || !isfinite(determinant))
        return false;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            inverse->m[i][j] = cofactor(a, j, i) / determinant;
    for (int i = 0; i < 3; i++)
        inverse->m[i][3] = -(inverse->m[i][0] * a->m[0][3] + inverse->m[i][1] * a->m[1][3] +
                             inverse->m[i][2] * a->m[2][3]);
    return slc_pbrt_is_finite(inverse);
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static bool normalize(double v[3])
{
    double length = sqrt(dot(v, v));
    if (!(length > 0) || !isfinite(length))
        return false;
    for (int i = 0; i < 3; i++)
        v[i] /= length;
    return true;
}

bool slc_pbrt_rotation(double degrees, const double axis[3], struct slc_pbrt_affine *rotation)
{
    double a[3] = {axis[0], axis[1], axis[2]};
    double sine = sin(degrees * RADIANS), cosine = cos(degrees * RADIANS);
    if (!normalize(a))
        return false;
    *rotation = slc_pbrt_identity();
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        rotation->m[i][i] = a[i] * a[i] + (1 - a[i] * a[i]) * cosine;
        rotation->m[i][j] = a[i] * a[j] * (1 - cosine) - a[k] * sine;
        rotation->m[i][k] = a[i] * a[k] * (1 - cosine) + a[j] * sine;
    }
    return true;
}

bool slc_pbrt_look_at(const double eye[3], const double look[3], const double up[3],
                      struct slc_pbrt_affine *transform)
{
    double direction[3] = {look[0] - eye[0], look[1] - eye[1], look[2] - eye[2]};
    double above[3] = {up[0], up[1], up[2]}, right[3], straight_up[3];
    if (!normalize(direction) || !normalize(above))
        return false;
    cross(above, direction, right);
    if (!(dot(right, right) > 1e-20) || !normalize(right))
        return false;
    cross(direction, right, straight_up);
    struct slc_pbrt_affine camera;
    for (int i = 0; i < 3; i++) {
        camera.m[i][0] = right[i];
        camera.m[i][1] = straight_up[i];
        camera.m[i][2] = direction[i];
        camera.m[i][3] = eye[i];
    }
    return slc_pbrt_inverse(&camera, transform);
}

void slc_pbrt_apply_vector(const struct slc_pbrt_affine *a, const double vector[3], double out[3])
{
    double result[3];
    for (int i = 0; i < 3; i++)
        result[i] = dot(a->m[i], vector);
    memcpy(out, result, sizeof result);
}

void slc_pbrt_apply_point(const struct slc_pbrt_affine *a, const double point[3], double out[3])
{
    slc_pbrt_apply_vector(a, point, out);
    for (int i = 0; i < 3; i++)
        out[i] += a->m[i][3];
}

void slc_pbrt_to_floats(const struct slc_pbrt_affine *a, float out[12])
{
    for (int i = 0; i < 12; i++)
        out[i] = slc_pbrt_clamped_float(a->m[i / 4][i % 4]);
}

struct slc_pbrt_affine slc_pbrt_from_floats(const float in[12])
{
    struct slc_pbrt_affine a;
    for (int i = 0; i < 12; i++)
        a.m[i / 4][i % 4] = in[i];
    return a;
}

SluicePbrtBounds slc_pbrt_no_bounds(void)
{
    return (SluicePbrtBounds){{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}};
}

void slc_pbrt_add_point(SluicePbrtBounds *bounds, const float point[3])
{
    for (int i = 0; i < 3; i++) {
        bounds->least[i] = point[i] < bounds->least[i] ? point[i] : bounds->least[i];
        bounds->most[i] = point[i] > bounds->most[i] ? point[i] : bounds->most[i];
    }
}

SluicePbrtBounds slc_pbrt_apply_bounds(const struct slc_pbrt_affine *a,
                                       const SluicePbrtBounds *bounds)
{
    SluicePbrtBounds out;
    for (int i = 0; i < 3; i++) {
        double least = a->m[i][3], most = a->m[i][3];
        for (int j = 0; j < 3; j++) {
            double at_least = a->m[i][j] * bounds->least[j], at_most = a->m[i][j] * bounds->most[j];
            least += fmin(at_least, at_most);
            most += fmax(at_least, at_most);
        }
        out.least[i] = slc_pbrt_clamped_float(least);
        out.most[i] = slc_pbrt_clamped_float(most);
    }
    return out;
}
