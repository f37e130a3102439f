#include "metrics/flip_color.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

/* Linear sRGB to XYZ over the XYZ of white, and back: from the primaries of IEC 61966-2-1 and D65
 * at (0.31271, 0.32902). Rows of the first sum to 1. */
static const double xyz_of_rgb[3][3] = {
    {0.43389538883150308, 0.37624237262225113, 0.18986223854624579},
    {0.21263682167732384, 0.71518298184125073, 0.072180196481425471},
    {0.017752423151729927, 0.10946562866246513, 0.8727819481858049},
};
static const double rgb_of_xyz[3][3] = {
    {3.0803419882804608, -1.5373989694887855, -0.54294301879167506},
    {-0.92117839616512365, 1.8759299836951759, 0.045248412469947583},
    {0.052881292875543252, -0.20401120612390997, 1.1511299132483668},
};

/* Exponent of distances; the share of the largest where the curve bends, and the error there. */
static const double exponent = 0.7, knee_at = 0.4, knee_error = 0.95;

static void transform(const double matrix[3][3], const double in[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = matrix[i][0] * in[0] + matrix[i][1] * in[1] + matrix[i][2] * in[2];
}

void slc_opponents_from_linear(const double rgb[3], double opponents[3])
{
    double xyz[3];
    transform(xyz_of_rgb, rgb, xyz);
    opponents[0] = xyz[1];
    opponents[1] = xyz[0] - xyz[1];
    opponents[2] = xyz[1] - xyz[2];
}

static void linear_from_opponents(const double opponents[3], double rgb[3])
{
    double xyz[3] = {opponents[1] + opponents[0], opponents[0], opponents[0] - opponents[2]};
    transform(rgb_of_xyz, xyz, rgb);
    for (int i = 0; i < 3; i++)
        rgb[i] = rgb[i] > 0 ? rgb[i] < 1 ? rgb[i] : 1 : 0;
}

/** Cube root to 13 digits for 1e-3 to 2. Takes a third of the time of cbrt. */
static double cube_root(double value)
{
    uint64_t bits;
    double root;
    memcpy(&bits, &value, sizeof bits);
    bits = bits / 3 + 0x2a9f789300000000u; /* a third of the exponent: 4 % off at most */
    memcpy(&root, &bits, sizeof root);
    for (int i = 0; i < 2; i++) { /* Halley: errors to the power of three */
        double cube = root * root * root;
        root *= (cube + 2 * value) / (2 * cube + value);
    }
    return root;
}

static double lightness_curve(double value)
{
    const double delta = 6.0 / 29;
    return value > delta * delta * delta ? cube_root(value)
                                         : value / (3 * delta * delta) + 4.0 / 29;
}

/** L*a*b*, its a* and b* scaled by L* / 100 (Hunt: dark colors look less colorful). */
static void hunt_lab_from_linear(const double rgb[3], double lab[3])
{
    double xyz[3];
    transform(xyz_of_rgb, rgb, xyz);
    for (int i = 0; i < 3; i++)
        xyz[i] = lightness_curve(xyz[i]);
    lab[0] = 116 * xyz[1] - 16;
    lab[1] = 0.01 * lab[0] * 500 * (xyz[0] - xyz[1]);
    lab[2] = 0.01 * lab[0] * 200 * (xyz[1] - xyz[2]);
}

/** HyAB: city block between lightness and the plane of colors. */
static double distance(const double rgb_a[3], const double rgb_b[3])
{
    double a[3], b[3];
    hunt_lab_from_linear(rgb_a, a);
    hunt_lab_from_linear(rgb_b, b);
    double x = a[1] - b[1], y = a[2] - b[2];
    return fabs(a[0] - b[0]) + sqrt(x * x + y * y);
}

void slc_flip_curve_init(struct slc_flip_curve *curve)
{
    const double green[3] = {0, 1, 0}, blue[3] = {0, 0, 1};
    curve->largest = exponent * log(distance(green, blue));
    curve->knee = log(knee_at);
    curve->knee_slope = log(knee_error / knee_at);
}

/** Returns the logarithm of the error for a distance above 0. */
static double compress(const struct slc_flip_curve *curve, double distance)
{
    double share = exponent * log(distance) - curve->largest;
    if (share < curve->knee)
        return share + curve->knee_slope;
    double above = (exp(share) - knee_at) / (1 - knee_at);
    return log(fmin(knee_error + above * (1 - knee_error), 1));
}

double slc_flip_error(const struct slc_flip_curve *curve, const double a[3], const double b[3],
                      double feature)
{
    double rgb_a[3], rgb_b[3], apart = 0;
    if (a[0] != b[0] || a[1] != b[1] || a[2] != b[2]) {
        linear_from_opponents(a, rgb_a);
        linear_from_opponents(b, rgb_b);
        apart = distance(rgb_a, rgb_b);
    }
    if (apart == 0)
        return pow(0, 1 - feature);
    return exp((1 - feature) * compress(curve, apart));
}
