#include <sluice/metrics.h>

#include "support/test.h"

#include "pictures.h"

#include <math.h>
#include <string.h>

enum { MAX_PIXELS = 64 * 64 };

/** SSIM of the window around (x, y), cut at the border: all 121 weights, two passes. */
static double window_ssim(const double *a, const double *b, int width, int height, int x, int y,
                          double peak)
{
    double weight_sum = 0, mean_a = 0, mean_b = 0, variance_a = 0, variance_b = 0, covariance = 0;
    for (int pass = 0; pass < 2; pass++)
        for (int v = y - 5; v <= y + 5; v++)
            for (int u = x - 5; u <= x + 5; u++) {
                if (u < 0 || v < 0 || u >= width || v >= height)
                    continue;
                double weight = exp(-((u - x) * (u - x) + (v - y) * (v - y)) / 4.5);
                double p = a[v * width + u], q = b[v * width + u];
                if (pass == 0) {
                    weight_sum += weight;
                    mean_a += weight * p;
                    mean_b += weight * q;
                } else {
                    variance_a += weight * (p - mean_a / weight_sum) * (p - mean_a / weight_sum);
                    variance_b += weight * (q - mean_b / weight_sum) * (q - mean_b / weight_sum);
                    covariance += weight * (p - mean_a / weight_sum) * (q - mean_b / weight_sum);
                }
            }
    double ma = mean_a / weight_sum, mb = mean_b / weight_sum;
    double c1 = 0.0001 * peak * peak, c2 = 0.0009 * peak * peak;
    return (2 * ma * mb + c1) * (2 * covariance / weight_sum + c2) /
           ((ma * ma + mb * mb + c1) * ((variance_a + variance_b) / weight_sum + c2));
}

/** Checks mean and map against every window by itself. */
static void check_with_oracle(const SluicePicturePair *pair, const double *a, const double *b,
                              double peak)
{
    static float values[MAX_PIXELS];
    SluiceMetricMap map = {.pValues = values};
    int width = (int)pair->width, height = (int)pair->height, count = 0;
    double mean, sum = 0;
    CHECK_OK(sluiceComputeSsim(pair, &map, NULL, &mean));
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            double expected = window_ssim(a, b, width, height, x, y, peak);
            assert_true(fabs((double)values[y * width + x] - expected) < 1e-6);
            bool counts_x = width < 11 || (x >= 5 && x + 5 < width);
            bool counts_y = height < 11 || (y >= 5 && y + 5 < height);
            if (counts_x && counts_y) {
                sum += expected;
                count++;
            }
        }
    assert_true(fabs(mean - sum / count) < 1e-9);
}

static const uint32_t sizes[][2] = {{1, 1},   {1, 7},   {7, 1},   {1, 30},  {10, 10}, {11, 11},
                                    {12, 11}, {11, 10}, {30, 23}, {10, 40}, {5, 3}};

static void every_size_agrees_with_single_windows(void **state)
{
    (void)state;
    static uint8_t pixels[2][MAX_PIXELS * 4];
    static double luma[2][MAX_PIXELS];
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        uint32_t width = sizes[i][0], height = sizes[i][1];
        fill_random(pixels[0], sizeof pixels[0], 1 + (uint32_t)i);
        for (size_t k = 0; k < sizeof pixels[1]; k++) /* half alike, so that values spread */
            pixels[1][k] = (uint8_t)(pixels[0][k] / 2 + 30 * i % 77 + k * 7 % 31);
        for (int p = 0; p < 2; p++)
            for (size_t k = 0; k < MAX_PIXELS; k++)
                luma[p][k] = 0.2126 * pixels[p][4 * k] + 0.7152 * pixels[p][4 * k + 1] +
                             0.0722 * pixels[p][4 * k + 2];
        SluicePicturePair pair = rgba8_pair(pixels[0], pixels[1], width, height);
        check_with_oracle(&pair, luma[0], luma[1], 255);
    }
}

static void floats_agree_with_single_windows(void **state)
{
    (void)state;
    static float pixels[2][MAX_PIXELS];
    static double values[2][MAX_PIXELS];
    uint32_t seed = 9;
    for (int i = 0; i < MAX_PIXELS; i++) {
        pixels[0][i] = (float)(random_next(&seed) * 1000);
        pixels[1][i] = (float)(pixels[0][i] * 0.8f + random_next(&seed) * 100);
        values[0][i] = (double)pixels[0][i];
        values[1][i] = fmin((double)pixels[1][i], 900);
        values[0][i] = fmin(values[0][i], 900);
    }
    SluicePicturePair pair = rgba8_pair(pixels[0], pixels[1], 31, 17);
    pair.format = SLUICE_PIXEL_FORMAT_R32_FLOAT;
    pair.peak = 900;
    check_with_oracle(&pair, values[0], values[1], 900);
}

static void equal_pictures_have_exactly_one(void **state)
{
    (void)state;
    static uint8_t pixels[MAX_PIXELS * 4];
    static float values[MAX_PIXELS];
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        uint32_t width = sizes[i][0], height = sizes[i][1];
        SluicePicturePair pair = rgba8_pair(pixels, pixels, width, height);
        SluiceMetricMap map = {.pValues = values};
        double mean;
        fill_random(pixels, sizeof pixels, 3);
        CHECK_OK(sluiceComputeSsim(&pair, &map, NULL, &mean));
        assert_true(mean == 1);
        for (uint32_t k = 0; k < width * height; k++)
            assert_true(values[k] == 1);
    }
}

static void constants_follow_the_term_of_luminance(void **state)
{
    (void)state;
    static uint8_t a[20 * 20 * 4], b[20 * 20 * 4];
    for (int dark = 0; dark < 256; dark += 51) {
        memset(a, dark, sizeof a);
        memset(b, 255 - dark / 2, sizeof b);
        double p = dark, q = 255 - dark / 2, c1 = 2.55 * 2.55, mean;
        SluicePicturePair pair = rgba8_pair(a, b, 20, 20);
        CHECK_OK(sluiceComputeSsim(&pair, NULL, NULL, &mean));
        assert_true(fabs(mean - (2 * p * q + c1) / (p * p + q * q + c1)) < 1e-9);
    }
}

static void the_order_of_the_two_does_not_matter(void **state)
{
    (void)state;
    static uint8_t a[MAX_PIXELS * 4], b[MAX_PIXELS * 4];
    double forth, back;
    fill_random(a, sizeof a, 1);
    fill_drawing(b, 64, 64);
    SluicePicturePair pair = rgba8_pair(a, b, 64, 64), swapped = rgba8_pair(b, a, 64, 64);
    CHECK_OK(sluiceComputeSsim(&pair, NULL, NULL, &forth));
    CHECK_OK(sluiceComputeSsim(&swapped, NULL, NULL, &back));
    assert_true(fabs(forth - back) < 1e-14 && forth < 0.5);
}

static void more_noise_is_less_alike(void **state)
{
    (void)state;
    static uint8_t a[MAX_PIXELS * 4], b[MAX_PIXELS * 4];
    double last = 1;
    fill_drawing(a, 64, 64);
    for (int amplitude = 2; amplitude <= 64; amplitude *= 2) {
        double mean;
        add_noise(a, b, MAX_PIXELS, amplitude);
        SluicePicturePair pair = rgba8_pair(a, b, 64, 64);
        CHECK_OK(sluiceComputeSsim(&pair, NULL, NULL, &mean));
        assert_true(mean < last && mean > 0);
        last = mean;
    }
    assert_true(last < 0.8);
}

static void a_picture_and_its_negative_are_unlike(void **state)
{
    (void)state;
    static uint8_t a[MAX_PIXELS * 4], b[MAX_PIXELS * 4];
    double mean;
    fill_random(a, sizeof a, 8);
    for (size_t i = 0; i < sizeof a; i++)
        b[i] = (uint8_t)(255 - a[i]);
    SluicePicturePair pair = rgba8_pair(a, b, 64, 64);
    CHECK_OK(sluiceComputeSsim(&pair, NULL, NULL, &mean));
    assert_true(mean < -0.5 && mean >= -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_size_agrees_with_single_windows),
        cmocka_unit_test(floats_agree_with_single_windows),
        cmocka_unit_test(equal_pictures_have_exactly_one),
        cmocka_unit_test(constants_follow_the_term_of_luminance),
        cmocka_unit_test(the_order_of_the_two_does_not_matter),
        cmocka_unit_test(more_noise_is_less_alike),
        cmocka_unit_test(a_picture_and_its_negative_are_unlike),
    };
    return RUN_TESTS(tests);
}
