/* Picture comparisons and feedback predictions with the largest and smallest numbers. */
#include "extremes/extremes.h"

#include "support/test.h"

#include <sluice/feedback_rate.h>
#include <sluice/metrics.h>

#include <float.h>
#include <math.h>
#include <stdlib.h>

enum { SIZE = 16, PIXELS = SIZE * SIZE };

static SluicePicturePair pair_of(const float *a, const float *b, float peak)
{
    return (SluicePicturePair){.structSize = sizeof(SluicePicturePair),
                               .pA = a,
                               .pB = b,
                               .width = SIZE,
                               .height = SIZE,
                               .format = SLUICE_PIXEL_FORMAT_R32_FLOAT,
                               .peak = peak};
}

/* SSIM of constant windows with K1 = 0.01: the variances are 0. */
static double constant_ssim(double a, double b)
{
    const double c1 = 0.01 * 0.01;
    return (2 * a * b + c1) / (a * a + b * b + c1);
}

static double counts_as(float value, float peak)
{
    return !(value > 0) ? 0 : value >= peak ? 1 : (double)value / (double)peak;
}

static void fill(float *picture, float value)
{
    for (int i = 0; i < PIXELS; i++)
        picture[i] = value;
}

static const float peaks[] = {0x1p-149f, FLT_MIN, 1e-20f, 1, 65504, 1e30f, FLT_MAX};
#define PEAKS (sizeof peaks / sizeof peaks[0])

/* Tries all pairs of special values, and each with the peaks. */
static void ssim_of_constants_is_that_of_the_formula(void **state)
{
    (void)state;
    static float a[PIXELS], b[PIXELS];
    struct extremes_row row = {.name = "c.ssim.constants", .unit = "absolute", .bound = 1e-11};
    for (size_t p = 0; p < PEAKS; p++)
        for (uint32_t i = 0; i < EXTREMES_SPECIALS; i++)
            for (uint32_t j = 0; j <= EXTREMES_SPECIALS; j++) {
                double mean;
                float x = extremes_specials[i];
                float y = j < EXTREMES_SPECIALS ? extremes_specials[j] : peaks[p];
                fill(a, x);
                fill(b, y);
                SluicePicturePair pair = pair_of(a, b, peaks[p]);
                CHECK_OK(sluiceComputeSsim(&pair, NULL, NULL, &mean));
                double wanted = constant_ssim(counts_as(x, peaks[p]), counts_as(y, peaks[p]));
                extremes_add(&row, fabs(mean - wanted), "%g and %g of %g", (double)x, (double)y,
                             (double)peaks[p]);
            }
    extremes_end(&row);
}

/* FLIP of constants depends only on the values that they count as. It is bounded, symmetric, and 0
 * for equal values. */
static void flip_of_constants_depends_on_what_they_count_as(void **state)
{
    (void)state;
    static float a[PIXELS], b[PIXELS];
    struct extremes_row row = {.name = "c.flip.constants", .unit = "absolute"};
    for (size_t p = 0; p < PEAKS; p += 2)
        for (uint32_t i = 0; i < EXTREMES_SPECIALS; i++)
            for (uint32_t j = 0; j < EXTREMES_SPECIALS; j += extremes_are_long() ? 1 : 5) {
                double flip, other;
                float x = extremes_specials[i], y = extremes_specials[j];
                bool same = counts_as(x, peaks[p]) == counts_as(y, peaks[p]);
                fill(a, x);
                fill(b, y);
                SluicePicturePair pair = pair_of(a, b, peaks[p]), turned = pair_of(b, a, peaks[p]);
                CHECK_OK(sluiceComputeFlip(&pair, 0, NULL, NULL, &flip));
                CHECK_OK(sluiceComputeFlip(&turned, 0, NULL, NULL, &other));
                bool right = flip >= 0 && flip <= 1 && flip == other && (!same || flip == 0);
                extremes_add(&row, right ? 0 : INFINITY, "%g and %g of %g", (double)x, (double)y,
                             (double)peaks[p]);
            }
    extremes_end(&row);
}

/* Scaling a picture of light by a power of two must not change the result. */
static void light_of_any_scale_is_compared_alike(void **state)
{
    (void)state;
    static float a[PIXELS], b[PIXELS], scaled[2][PIXELS];
    struct extremes_row row = {.name = "c.metrics.scale", .unit = "absolute"};
    double one[2], many[2];
    for (int i = 0; i < PIXELS; i++) {
        a[i] = (float)(extremes_random((uint64_t)i) >> 8) / 16777216.0f;
        b[i] = (float)(extremes_random((uint64_t)i + PIXELS) >> 8) / 16777216.0f;
    }
    SluicePicturePair pair = pair_of(a, b, 1), far = pair_of(scaled[0], scaled[1], 1);
    CHECK_OK(sluiceComputeSsim(&pair, NULL, NULL, &one[0]));
    CHECK_OK(sluiceComputeFlip(&pair, 0, NULL, NULL, &one[1]));
    for (int exponent = -100; exponent <= 127; exponent += extremes_are_long() ? 1 : 13) {
        for (int i = 0; i < PIXELS; i++) {
            scaled[0][i] = ldexpf(a[i], exponent);
            scaled[1][i] = ldexpf(b[i], exponent);
        }
        far.peak = ldexpf(1, exponent);
        CHECK_OK(sluiceComputeSsim(&far, NULL, NULL, &many[0]));
        CHECK_OK(sluiceComputeFlip(&far, 0, NULL, NULL, &many[1]));
        extremes_add(&row, fabs(one[0] - many[0]) + fabs(one[1] - many[1]), "2^%d", exponent);
    }
    extremes_end(&row);
}

/* Images with one step in one of n values, and with the maximum difference in all values. */
static void psnr_of_any_size_is_that_of_the_formula(void **state)
{
    (void)state;
    struct extremes_row row = {.name = "c.psnr.decibels", .unit = "dB", .bound = 1e-11};
    uint32_t most = extremes_are_long() ? 8192 : 1024;
    uint8_t *a = calloc((size_t)most * most, 4), *b = calloc((size_t)most * most, 4);
    for (uint32_t width = 1; width <= most; width *= 2)
        for (uint32_t channels = 1; channels <= 4; channels++) {
            double psnr;
            long double count = (long double)width * width * channels;
            b[(size_t)count - 1] = 1;
            CHECK_OK(sluiceComputePsnr8(a, b, width, width, channels, &psnr));
            long double wanted = 10 * log10l(255 * 255.0L * count);
            extremes_add(&row, (double)fabsl(psnr - wanted), "%u x %u x %u", width, width,
                         channels);
            b[(size_t)count - 1] = 0;
            CHECK_OK(sluiceComputePsnr8(a, b, width, width, channels, &psnr));
            assert_true(isinf(psnr) && psnr > 0);
        }
    for (size_t i = 0; i < (size_t)most * most * 4; i++)
        b[i] = 255;
    double psnr;
    CHECK_OK(sluiceComputePsnr8(a, b, most, most, 4, &psnr));
    extremes_add(&row, fabs(psnr), "black and white");
    free(a);
    free(b);
    extremes_end(&row);
}

/* Independent draws: (1 - p)^n, in units of the error that feedback_rate.h states. */
static void predicted_misses_are_those_of_long_double(void **state)
{
    (void)state;
    struct extremes_row row = {
        .name = "c.predict_feedback_miss.value", .unit = "of the stated error", .bound = 1};
    uint64_t count = extremes_count(100000, 5000000);
    for (uint64_t i = 0; i < count; i++) {
        SluiceFeedbackRate rate = {.structSize = sizeof rate,
                                   .selection = SLUICE_FEEDBACK_SELECTION_RANDOM_PIXELS,
                                   .regionWidth = 1 + extremes_random(i) % (1u << i % 13),
                                   .regionHeight = 1 + extremes_random(i + 1) % (1u << i % 11),
                                   .textureCount = 1,
                                   .frameRate = 1 + extremes_random(i + 2) % 1000,
                                   .timeoutSeconds = extremes_random(i + 3) % (1u << i % 20)};
        double p = i % 2 ? extremes_random(i + 4) / 4294967296.0
                         : fabs((double)extremes_float(i / 2)),
               miss;
        if (!(p <= 1))
            continue;
        CHECK_OK(sluicePredictFeedbackMiss(&rate, p, &miss));
        long double frames = fmaxl(floorl((long double)rate.frameRate * rate.timeoutSeconds), 1);
        long double draws = frames * rate.regionWidth * rate.regionHeight;
        long double wanted = p == 0 ? 1 : expl(draws * log1pl(-(long double)p));
        if (wanted < (long double)DBL_MIN)
            extremes_add(&row, miss < 4.5e-308 ? 0 : INFINITY, "%g, %Lg draws", p, draws);
        else
            extremes_add(&row, (double)(fabsl(miss / wanted - 1) / (5e-16L * (1 - logl(wanted)))),
                         "%g, %Lg draws", p, draws);
    }
    extremes_end(&row);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ssim_of_constants_is_that_of_the_formula),
        cmocka_unit_test(flip_of_constants_depends_on_what_they_count_as),
        cmocka_unit_test(light_of_any_scale_is_compared_alike),
        cmocka_unit_test(psnr_of_any_size_is_that_of_the_formula),
        cmocka_unit_test(predicted_misses_are_those_of_long_double),
    };
    return extremes_begin(argc, argv) ? RUN_TESTS(tests) : 2;
}
