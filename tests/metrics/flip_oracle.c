#include "flip_oracle.h"

#include "pictures.h"

#include <math.h>

enum { MAX_PIXELS = 64 * 64, MAX_RADIUS = 40, MAX_TAPS = 2 * MAX_RADIUS + 1 };

static const double pi = 3.14159265358979323846;
static const double white[3] = {0.31271 / 0.32902, 1, (1 - 0.31271 - 0.32902) / 0.32902};

static double determinant(double m[3][3])
{
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/** m * x = right, by Cramer's rule. */
static void solve(double m[3][3], const double right[3], double x[3])
{
    for (int column = 0; column < 3; column++) {
        double replaced[3][3];
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                replaced[i][j] = j == column ? right[i] : m[i][j];
        x[column] = determinant(replaced) / determinant(m);
    }
}

/** Linear sRGB to XYZ, from the chromaticities. */
static void find_matrix(double m[3][3])
{
    const double primaries[3][2] = {{0.64, 0.33}, {0.3, 0.6}, {0.15, 0.06}};
    double scales[3];
    for (int j = 0; j < 3; j++) {
        double x = primaries[j][0], y = primaries[j][1];
        m[0][j] = x / y;
        m[1][j] = 1;
        m[2][j] = (1 - x - y) / y;
    }
    solve(m, white, scales);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            m[i][j] *= scales[j];
}

/** YCxCz of XYZ. */
static void opponents(const double xyz[3], double out[3])
{
    out[0] = 116 * xyz[1] / white[1] - 16;
    out[1] = 500 * (xyz[0] / white[0] - xyz[1] / white[1]);
    out[2] = 200 * (xyz[1] / white[1] - xyz[2] / white[2]);
}

static double curve(double t)
{
    return t > 216.0 / 24389 ? cbrt(t) : (24389.0 / 27 * t + 16) / 116;
}

static void hunt_lab(double m[3][3], const double rgb[3], double lab[3])
{
    double f[3];
    for (int i = 0; i < 3; i++)
        f[i] = curve((m[i][0] * rgb[0] + m[i][1] * rgb[1] + m[i][2] * rgb[2]) / white[i]);
    lab[0] = 116 * f[1] - 16;
    lab[1] = 500 * (f[0] - f[1]) * lab[0] / 100;
    lab[2] = 200 * (f[1] - f[2]) * lab[0] / 100;
}

static double hyab(const double a[3], const double b[3])
{
    return fabs(a[0] - b[0]) + sqrt((a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

double flip_oracle_largest(void)
{
    const double green[3] = {0, 1, 0}, blue[3] = {0, 0, 1};
    double m[3][3], a[3], b[3];
    find_matrix(m);
    hunt_lab(m, green, a);
    hunt_lab(m, blue, b);
    return pow(hyab(a, b), 0.7);
}

/** Hunt's L*a*b* of a filtered color. */
static void filtered_lab(double m[3][3], const double ycxcz[3], double lab[3])
{
    double y = (ycxcz[0] + 16) / 116, rgb[3];
    double xyz[3] = {(y + ycxcz[1] / 500) * white[0], y, (y - ycxcz[2] / 200) * white[2]};
    solve(m, xyz, rgb);
    for (int i = 0; i < 3; i++)
        rgb[i] = rgb[i] < 0 ? 0 : rgb[i] > 1 ? 1 : rgb[i];
    hunt_lab(m, rgb, lab);
}

/** Contrast sensitivity in space, of one channel, `z` degrees squared from the center. */
static double sensitivity(int channel, double z)
{
    static const double table[3][4] = {
        {1, 0.0047, 0, 1e-5}, {1, 0.0053, 0, 1e-5}, {34.1, 0.04, 13.5, 0.025}};
    const double *t = table[channel];
    return t[0] * sqrt(pi / t[1]) * exp(-pi * pi * z / t[1]) +
           t[2] * sqrt(pi / t[3]) * exp(-pi * pi * z / t[3]);
}

/** Kernels in two dimensions: three of color, then edge along x and y, point along x and y. */
static double kernel_value(int kernel, int x, int y, double pixels_per_degree)
{
    double s = 0.5 * 0.082 * pixels_per_degree, r2 = x * x + y * y;
    int along = kernel % 2 ? x : y;
    if (kernel < 3)
        return sensitivity(kernel, r2 / (pixels_per_degree * pixels_per_degree));
    if (kernel < 5)
        return -along * exp(-r2 / (2 * s * s));
    return (along * along / (s * s) - 1) * exp(-r2 / (2 * s * s));
}

static int clamped(int value, int size)
{
    return value < 0 ? 0 : value >= size ? size - 1 : value;
}

/** Positive weights get the sum 1 and negative ones -1. */
static int fill_kernel(double taps[MAX_TAPS][MAX_TAPS], int kernel, double pixels_per_degree)
{
    double deviation = kernel < 3 ? sqrt(0.04 / (2 * pi * pi)) * pixels_per_degree
                                  : 0.5 * 0.082 * pixels_per_degree;
    int radius = (int)ceil(3 * deviation);
    double positive = 0, negative = 0;
    for (int pass = 0; pass < 2; pass++)
        for (int y = -radius; y <= radius; y++)
            for (int x = -radius; x <= radius; x++) {
                double value = kernel_value(kernel, x, y, pixels_per_degree);
                positive += pass == 0 && value > 0 ? value : 0;
                negative += pass == 0 && value < 0 ? -value : 0;
                if (value != 0)
                    taps[y + radius][x + radius] = value / (value > 0 ? positive : negative);
                else
                    taps[y + radius][x + radius] = 0;
            }
    return radius;
}

static void convolve(const double *in, double *out, int width, int height, int kernel,
                     double pixels_per_degree)
{
    static double taps[MAX_TAPS][MAX_TAPS];
    int radius = fill_kernel(taps, kernel, pixels_per_degree);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            double sum = 0;
            for (int v = -radius; v <= radius; v++)
                for (int u = -radius; u <= radius; u++)
                    sum += taps[v + radius][u + radius] *
                           in[clamped(y + v, height) * width + clamped(x + u, width)];
            out[y * width + x] = sum;
        }
}

/** The seven filtered planes of a picture. */
static void filter_picture(double m[3][3], const uint8_t *pixels, int width, int height,
                           double pixels_per_degree, double planes[7][MAX_PIXELS])
{
    static double channels[4][MAX_PIXELS];
    for (int i = 0; i < width * height; i++) {
        double xyz[3] = {0}, color[3];
        for (int k = 0; k < 9; k++)
            xyz[k / 3] += m[k / 3][k % 3] * light_of(pixels[4 * i + k % 3] / 255.0);
        opponents(xyz, color);
        for (int k = 0; k < 3; k++)
            channels[k][i] = color[k];
        channels[3][i] = (color[0] + 16) / 116;
    }
    for (int k = 0; k < 7; k++)
        convolve(channels[k < 3 ? k : 3], planes[k], width, height, k, pixels_per_degree);
}

static double length_difference(double a[7][MAX_PIXELS], double b[7][MAX_PIXELS], int plane, int i)
{
    return fabs(sqrt(a[plane][i] * a[plane][i] + a[plane + 1][i] * a[plane + 1][i]) -
                sqrt(b[plane][i] * b[plane][i] + b[plane + 1][i] * b[plane + 1][i]));
}

void flip_oracle(const uint8_t *a, const uint8_t *b, int width, int height,
                 double pixels_per_degree, double *errors)
{
    static double planes[2][7][MAX_PIXELS];
    double m[3][3], largest = flip_oracle_largest();
    find_matrix(m);
    filter_picture(m, a, width, height, pixels_per_degree, planes[0]);
    filter_picture(m, b, width, height, pixels_per_degree, planes[1]);
    for (int i = 0; i < width * height; i++) {
        double lab[2][3];
        for (int k = 0; k < 2; k++) {
            double color[3] = {planes[k][0][i], planes[k][1][i], planes[k][2][i]};
            filtered_lab(m, color, lab[k]);
        }
        double distance = pow(hyab(lab[0], lab[1]), 0.7), knee = 0.4 * largest;
        double color_error = distance < knee
                                 ? distance * 0.95 / knee
                                 : 0.95 + (distance - knee) / (largest - knee) * (1 - 0.95);
        double feature = fmax(length_difference(planes[0], planes[1], 3, i),
                              length_difference(planes[0], planes[1], 5, i));
        errors[i] = pow(color_error, 1 - sqrt(feature / sqrt(2)));
    }
}
