#include "metrics/flip_kernels.h"

#include "base/alloc.h"

#include <math.h>

#define PI 3.14159265358979323846

/* Contrast sensitivity at f cycles per degree is a * exp(-b * f^2). Blue-yellow is a sum of two
 * such terms: table 1 of the paper. The height in space is a * sqrt(pi / b); the width scales with
 * sqrt(b). */
static const double luminance_b = 0.0047, red_green_b = 0.0053;
static const double narrow_a = 13.5, narrow_b = 0.025, wide_a = 34.1, wide_b = 0.04;

/** Returns the standard deviation in degrees of the Gaussian with transform exp(-b * f^2). */
static double deviation_of(double b)
{
    return sqrt(b / 2) / PI;
}

/** Fills `kernel` with a Gaussian of sum 1; returns its sum before that, the peak being 1. */
static double fill_gaussian(double *weights, uint32_t radius, double deviation)
{
    double sum = 0;
    for (uint32_t i = 0; i <= 2 * radius; i++) {
        double distance = ((double)i - radius) / deviation;
        sum += weights[i] = exp(-0.5 * distance * distance);
    }
    for (uint32_t i = 0; i <= 2 * radius; i++)
        weights[i] /= sum;
    return sum;
}

/** Makes the positive weights sum to 1 and the negative ones to -1. */
static void balance(double *weights, uint32_t radius)
{
    double positive = 0, negative = 0;
    for (uint32_t i = 0; i <= 2 * radius; i++) {
        positive += fmax(weights[i], 0);
        negative -= fmin(weights[i], 0);
    }
    for (uint32_t i = 0; i <= 2 * radius; i++)
        weights[i] /= weights[i] > 0 ? positive : negative;
}

static void fill_features(double *smooth, double *edge, double *point, uint32_t radius,
                          double deviation)
{
    fill_gaussian(smooth, radius, deviation);
    for (uint32_t i = 0; i <= 2 * radius; i++) {
        double distance = ((double)i - radius) / deviation;
        edge[i] = -distance * smooth[i];
        point[i] = (distance * distance - 1) * smooth[i];
    }
    balance(edge, radius);
    balance(point, radius);
}

static void fill_kernels(struct slc_flip_kernels *kernels, double *weights[], uint32_t color,
                         uint32_t feature, double pixels_per_degree, double feature_deviation)
{
    double scale = pixels_per_degree;
    fill_gaussian(weights[SLC_FLIP_LUMINANCE], color, scale * deviation_of(luminance_b));
    fill_gaussian(weights[SLC_FLIP_RED_GREEN], color, scale * deviation_of(red_green_b));
    double narrow =
        fill_gaussian(weights[SLC_FLIP_BLUE_YELLOW_NARROW], color, scale * deviation_of(narrow_b));
    double wide =
        fill_gaussian(weights[SLC_FLIP_BLUE_YELLOW_WIDE], color, scale * deviation_of(wide_b));
    /* normalize the sum of both terms to 1 */
    narrow *= narrow * narrow_a * sqrt(PI / narrow_b);
    wide *= wide * wide_a * sqrt(PI / wide_b);
    kernels->share_narrow = narrow / (narrow + wide);
    fill_features(weights[SLC_FLIP_SMOOTH], weights[SLC_FLIP_EDGE], weights[SLC_FLIP_POINT],
                  feature, feature_deviation);
}

bool slc_flip_kernels_init(struct slc_flip_kernels *kernels,
                           const SluiceAllocationCallbacks *allocator, double pixels_per_degree)
{
    /* edges are 0.082 degrees wide; filters end at three deviations of the widest */
    double deviation = 0.5 * 0.082 * pixels_per_degree;
    uint32_t color = (uint32_t)ceil(3 * deviation_of(wide_b) * pixels_per_degree);
    uint32_t feature = (uint32_t)ceil(3 * deviation);
    uint32_t radius = color > feature ? color : feature;
    double *filters[SLC_FLIP_FILTER_COUNT];
    kernels->radius = radius;
    kernels->count = SLC_FLIP_FILTER_COUNT * (2 * (size_t)radius + 1);
    kernels->weights = slc_alloc(allocator, kernels->count, sizeof *kernels->weights);
    if (!kernels->weights)
        return false;
    for (int i = 0; i < SLC_FLIP_FILTER_COUNT; i++) {
        filters[i] = kernels->weights + i * (2 * (size_t)radius + 1);
        kernels->filters[i] =
            (struct slc_kernel){filters[i], i < SLC_FLIP_SMOOTH ? color : feature};
    }
    fill_kernels(kernels, filters, color, feature, pixels_per_degree, deviation);
    return true;
}

void slc_flip_kernels_finish(struct slc_flip_kernels *kernels,
                             const SluiceAllocationCallbacks *allocator)
{
    slc_free(allocator, kernels->weights, kernels->count, sizeof *kernels->weights);
}
