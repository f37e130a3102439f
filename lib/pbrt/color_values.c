#include "pbrt/color_values.h"

#include <math.h>
#include <string.h>

#define FIRST_NM 360
#define LAST_NM 830

void slc_pbrt_xyz_to_rgb(const float xyz[3], float rgb[3])
{
    static const float M[3][3] = {{3.240479f, -1.537150f, -0.498535f},
                                  {-0.969256f, 1.875991f, 0.041556f},
                                  {0.055648f, -0.204043f, 1.057311f}};
    for (int i = 0; i < 3; i++) {
        float value = M[i][0] * xyz[0] + M[i][1] * xyz[1] + M[i][2] * xyz[2];
        rgb[i] = value > 0 ? value : 0;
    }
}

static double lobe(double x, double height, double center, double below, double above)
{
    double t = (x - center) / (x < center ? below : above);
    return height * exp(-0.5 * t * t);
}

/* Wyman, Sloan and Shirley, "Simple Analytic Approximations to the CIE XYZ Color Matching
 * Functions", JCGT 2013, multi-lobe fit. */
static void matching(double nm, double xyz[3])
{
    xyz[0] = lobe(nm, 1.056, 599.8, 37.9, 31.0) + lobe(nm, 0.362, 442.0, 16.0, 26.7) +
             lobe(nm, -0.065, 501.1, 20.4, 26.2);
    xyz[1] = lobe(nm, 0.821, 568.8, 46.9, 40.5) + lobe(nm, 0.286, 530.9, 16.3, 31.1);
    xyz[2] = lobe(nm, 1.217, 437.0, 11.8, 36.0) + lobe(nm, 0.681, 459.0, 26.0, 13.8);
}

static double planck(double nm, double kelvin)
{
    double x = 1.438776877e7 / (nm * kelvin); /* hc / (lambda k T) */
    return x > 700 ? 0 : 1 / (pow(nm, 5) * expm1(x));
}

void slc_pbrt_blackbody_rgb(double kelvin, float rgb[3])
{
    double sums[3] = {0, 0, 0}, luminance = 0;
    rgb[0] = rgb[1] = rgb[2] = 0;
    if (!(kelvin > 0))
        return;
    double peak = planck(2.897771955e6 / kelvin, kelvin);
    if (!(peak > 0))
        return;
    for (int nm = FIRST_NM; nm <= LAST_NM; nm += 5) {
        double xyz[3], radiance = planck(nm, kelvin) / peak;
        matching(nm, xyz);
        for (int i = 0; i < 3; i++)
            sums[i] += xyz[i] * radiance;
        luminance += xyz[1];
    }
    float xyz[3] = {(float)(sums[0] / luminance), (float)(sums[1] / luminance),
                    (float)(sums[2] / luminance)};
    slc_pbrt_xyz_to_rgb(xyz, rgb);
}

static double sample(const float *pairs, size_t count, double nm, size_t *at)
{
    if (nm <= pairs[0])
        return pairs[1];
    while (*at + 1 < count && pairs[2 * (*at + 1)] < nm)
        ++*at;
    if (*at + 1 >= count)
        return pairs[2 * count - 1];
    double x0 = pairs[2 * *at], x1 = pairs[2 * *at + 2];
    double t = x1 > x0 ? (nm - x0) / (x1 - x0) : 0;
    return pairs[2 * *at + 1] * (1 - t) + pairs[2 * *at + 3] * t;
}

void slc_pbrt_sampled_rgb(const float *pairs, size_t count, float rgb[3])
{
    double sums[3] = {0, 0, 0}, white[3] = {0, 0, 0};
    size_t at = 0;
    for (int nm = FIRST_NM; nm <= LAST_NM; nm += 5) {
        double xyz[3], value = sample(pairs, count, nm, &at);
        matching(nm, xyz);
        for (int i = 0; i < 3; i++) {
            sums[i] += xyz[i] * value;
            white[i] += xyz[i];
        }
    }
    /* Relative to a constant, in the color of the white point. */
    static const double D65[3] = {0.950456, 1, 1.089058};
    float xyz[3];
    for (int i = 0; i < 3; i++)
        xyz[i] = (float)(sums[i] / white[i] * D65[i]);
    slc_pbrt_xyz_to_rgb(xyz, rgb);
}

void slc_pbrt_metal_rgb(const char *name, float rgb[3])
{
    static const struct {
        const char *metal;
        float rgb[3];
    } METALS[] = {
        {"CuZn", {0.91f, 0.78f, 0.42f}},  {"Cu", {0.955f, 0.638f, 0.538f}},
        {"Au", {1.0f, 0.782f, 0.344f}},   {"Ag", {0.972f, 0.960f, 0.915f}},
        {"Al", {0.913f, 0.922f, 0.924f}}, {"MgO", {0.07f, 0.07f, 0.07f}},
        {"TiO2", {0.2f, 0.2f, 0.22f}},
    };
    static const float OTHER[3] = {0.6f, 0.6f, 0.6f};
    memcpy(rgb, OTHER, sizeof OTHER);
    for (size_t i = 0; i < sizeof METALS / sizeof *METALS; i++)
        if (strstr(name, METALS[i].metal)) {
            memcpy(rgb, METALS[i].rgb, sizeof METALS[i].rgb);
            return;
        }
}
