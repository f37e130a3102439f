#include "exr/primaries.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Tolerance below which a matrix counts as identity: most halves would not change. */
#define IDENTITY_TOLERANCE 0x1p-12
/* Determinants of real primaries are 0.05 and more. */
#define LEAST_DETERMINANT 1e-6

const struct slc_chromaticities slc_rec709 = {
    {0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}};

/* From XYZ to the responses of Bradford's sharpened cones. */
static const double bradford[3][3] = {
    {0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}};

static void multiply(double a[3][3], double b[3][3], double product[3][3])
{
    double result[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            result[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
    memcpy(product, result, sizeof result);
}

static void transform(double matrix[3][3], const double in[3], double out[3])
{
    double result[3];
    for (int i = 0; i < 3; i++)
        result[i] = matrix[i][0] * in[0] + matrix[i][1] * in[1] + matrix[i][2] * in[2];
    memcpy(out, result, sizeof result);
}

static double cofactor(double m[3][3], int i, int j)
{
    int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
    return m[i1][j1] * m[i2][j2] - m[i1][j2] * m[i2][j1];
}

/* Inverts a matrix. False if singular or NaN: comparisons with NaN are false. */
static bool invert(double matrix[3][3], double inverse[3][3])
{
    double determinant = 0.0;
    for (int j = 0; j < 3; j++)
        determinant += matrix[0][j] * cofactor(matrix, 0, j);
    if (!(fabs(determinant) > LEAST_DETERMINANT) || !isfinite(determinant))
        return false;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            inverse[i][j] = cofactor(matrix, j, i) / determinant;
    return true;
}

/* Finds the tristimulus values for luminance 1. */
static bool find_xyz(const double xy[2], double xyz[3])
{
    if (!(xy[1] > 1e-3 && xy[1] <= 1.0 && xy[0] >= 0.0 && xy[0] <= 1.0))
        return false;
    xyz[0] = xy[0] / xy[1];
    xyz[1] = 1.0;
    xyz[2] = (1.0 - xy[0] - xy[1]) / xy[1];
    return true;
}

/* Finds the matrix of primaries, scaled so that their sum is the white point. */
static bool find_rgb_to_xyz(const struct slc_chromaticities *from, double matrix[3][3])
{
    const double *const primaries[3] = {from->red, from->green, from->blue};
    double inverse[3][3], white[3], scale[3];
    for (int j = 0; j < 3; j++) {
        matrix[0][j] = primaries[j][0];
        matrix[1][j] = primaries[j][1];
        matrix[2][j] = 1.0 - primaries[j][0] - primaries[j][1];
    }
    if (!find_xyz(from->white, white) || !invert(matrix, inverse))
        return false;
    transform(inverse, white, scale);
    for (int j = 0; j < 3; j++) {
        if (!(fabs(scale[j]) > 1e-6)) /* the white point contains nothing of this primary */
            return false;
        for (int i = 0; i < 3; i++)
            matrix[i][j] *= scale[j];
    }
    return true;
}

static bool find_adaptation(const double neutral[2], double matrix[3][3])
{
    double cones[3][3], back[3][3], from[3], to[3];
    memcpy(cones, bradford, sizeof cones);
    if (!find_xyz(neutral, from) || !find_xyz(slc_rec709.white, to) || !invert(cones, back))
        return false;
    transform(cones, from, from);
    transform(cones, to, to);
    for (int i = 0; i < 3; i++) {
        if (!(from[i] > 1e-3))
            return false;
        for (int j = 0; j < 3; j++)
            cones[i][j] *= to[i] / from[i];
    }
    multiply(back, cones, matrix);
    return true;
}

static bool is_near(const double a[2], double x, double y)
{
    return fabs(a[0] - x) < 1e-4 && fabs(a[1] - y) < 1e-4;
}

static bool is_xyz(const struct slc_chromaticities *c)
{
    return is_near(c->red, 1, 0) && is_near(c->green, 0, 1) && is_near(c->blue, 0, 0);
}

bool slc_primaries_to_rec709(const struct slc_chromaticities *from, const double neutral[2],
                             double matrix[3][3])
{
    double to_xyz[3][3], adaptation[3][3], rec709_to_xyz[3][3], from_xyz[3][3];
    if (!neutral)
        neutral = is_xyz(from) ? slc_rec709.white : from->white;
    if (!find_rgb_to_xyz(from, to_xyz) || !find_adaptation(neutral, adaptation) ||
        !find_rgb_to_xyz(&slc_rec709, rec709_to_xyz) || !invert(rec709_to_xyz, from_xyz))
        return false;
    multiply(adaptation, to_xyz, matrix);
    multiply(from_xyz, matrix, matrix);
    for (int i = 0; i < 9; i++)
        if (!(fabs(matrix[i / 3][i % 3]) < 1e3)) /* far beyond real colors */
            return false;
    return true;
}

bool slc_matrix_is_identity(double matrix[3][3])
{
    for (int i = 0; i < 9; i++)
        if (fabs(matrix[i / 3][i % 3] - (i % 4 == 0)) > IDENTITY_TOLERANCE)
            return false;
    return true;
}

void slc_convert_colors(double matrix[3][3], float *colors, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++, colors += 3) {
        double color[3] = {(double)colors[0], (double)colors[1], (double)colors[2]};
        if (!isfinite(color[0] + color[1] + color[2]))
            continue;
        transform(matrix, color, color);
        for (int c = 0; c < 3; c++)
            colors[c] = (float)fmin(fmax(color[c], -(double)FLT_MAX), (double)FLT_MAX);
    }
}
