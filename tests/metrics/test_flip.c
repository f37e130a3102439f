#include <sluice/metrics.h>

#include "support/test.h"

#include "pictures.h"

#include "flip_oracle.h"

#include <math.h>
#include <string.h>

enum { SIZE = 64, MAX_PIXELS = SIZE * SIZE };

/** Two pictures of one color each, 24x24. */
static double flip_of_colors(const uint8_t first[3], const uint8_t second[3])
{
    static uint8_t a[24 * 24 * 4], b[24 * 24 * 4];
    double mean;
    for (int i = 0; i < 24 * 24; i++) {
        memcpy(a + 4 * i, first, 3);
        memcpy(b + 4 * i, second, 3);
    }
    SluicePicturePair pair = rgba8_pair(a, b, 24, 24);
    CHECK_OK(sluiceComputeFlip(&pair, 0, NULL, NULL, &mean));
    return mean;
}

static void check_with_oracle(uint32_t width, uint32_t height, float pixels_per_degree)
{
    static uint8_t pixels[2][MAX_PIXELS * 4];
    static float values[MAX_PIXELS];
    static double expected[MAX_PIXELS];
    SluicePicturePair pair = rgba8_pair(pixels[0], pixels[1], width, height);
    SluiceMetricMap map = {.pValues = values};
    double mean, sum = 0;
    fill_random(pixels[0], sizeof pixels[0], width);
    for (size_t i = 0; i < sizeof pixels[1]; i++)
        pixels[1][i] = (uint8_t)(pixels[0][i] * (i % 3 + 2) / 5 + i % 29);
    CHECK_OK(sluiceComputeFlip(&pair, pixels_per_degree, &map, NULL, &mean));
    flip_oracle(pixels[0], pixels[1], (int)width, (int)height, (double)pixels_per_degree, expected);
    for (uint32_t i = 0; i < width * height; i++) {
        assert_true(fabs((double)values[i] - expected[i]) < 1e-6);
        assert_true(values[i] >= 0 && values[i] <= 1);
        sum += expected[i];
    }
    assert_true(fabs(mean - sum / (width * height)) < 1e-6);
}

static void small_pictures_agree_with_direct_convolution(void **state)
{
    (void)state;
    check_with_oracle(1, 1, 67);
    check_with_oracle(1, 26, 67);
    check_with_oracle(26, 1, 40);
    check_with_oracle(21, 21, 67);
    check_with_oracle(29, 37, 67);
    check_with_oracle(17, 13, 20);
    check_with_oracle(9, 8, 1);
    check_with_oracle(12, 14, 200);
}

static void one_pixel_is_seen_as_far_as_filters_reach(void **state)
{
    (void)state;
    static uint8_t a[MAX_PIXELS * 4], b[MAX_PIXELS * 4];
    static float values[MAX_PIXELS];
    static double expected[MAX_PIXELS];
    SluicePicturePair pair = rgba8_pair(a, b, SIZE, SIZE);
    SluiceMetricMap map = {.pValues = values};
    for (int row = 0; row < SIZE; row += 21) {
        double mean;
        fill_drawing(a, SIZE, SIZE);
        memcpy(b, a, sizeof b);
        b[4 * (row * SIZE + 40)] ^= 0x80;
        CHECK_OK(sluiceComputeFlip(&pair, 67, &map, NULL, &mean));
        flip_oracle(a, b, SIZE, SIZE, 67, expected);
        assert_true(values[row * SIZE + 40] > 0.01f);
        for (int i = 0; i < MAX_PIXELS; i++)
            assert_true(fabs((double)values[i] - expected[i]) < 1e-6);
    }
}

static void equal_pictures_have_exactly_none(void **state)
{
    (void)state;
    static uint8_t pixels[MAX_PIXELS * 4];
    static float values[MAX_PIXELS];
    double mean = 1;
    fill_random(pixels, sizeof pixels, 4);
    SluicePicturePair pair = rgba8_pair(pixels, pixels, SIZE, SIZE);
    SluiceMetricMap map = {.pValues = values};
    CHECK_OK(sluiceComputeFlip(&pair, 0, &map, NULL, &mean));
    assert_true(mean == 0);
    for (int i = 0; i < MAX_PIXELS; i++)
        assert_true(values[i] == 0);
}

static void grays_follow_the_difference_of_lightness(void **state)
{
    (void)state;
    const uint8_t black[3] = {0};
    double largest = flip_oracle_largest();
    for (int value = 5; value < 256; value += 50) {
        const uint8_t gray[3] = {(uint8_t)value, (uint8_t)value, (uint8_t)value};
        double light = light_of(value / 255.0);
        double lightness = light > 216.0 / 24389 ? 116 * cbrt(light) - 16 : light * 24389 / 27;
        double share = pow(lightness, 0.7) / largest;
        double expected = share < 0.4 ? share * 0.95 / 0.4 : 0.95 + (share - 0.4) * 0.05 / 0.6;
        /* features of a plain picture are rounding errors, but their square root counts */
        assert_true(fabs(flip_of_colors(black, gray) - expected) < 1e-7);
    }
}

static void blue_against_green_is_the_largest(void **state)
{
    (void)state;
    const uint8_t green[3] = {0, 255, 0}, blue[3] = {0, 0, 255};
    double largest = flip_of_colors(green, blue);
    assert_true(fabs(largest - 1) < 1e-9 && largest <= 1);
    for (int i = 0; i < 8; i++)
        for (int j = 0; j < i; j++) {
            const uint8_t a[3] = {(uint8_t)(i & 1 ? 255 : 0), (uint8_t)(i & 2 ? 255 : 0),
                                  (uint8_t)(i & 4 ? 255 : 0)};
            const uint8_t b[3] = {(uint8_t)(j & 1 ? 255 : 0), (uint8_t)(j & 2 ? 255 : 0),
                                  (uint8_t)(j & 4 ? 255 : 0)};
            double error = flip_of_colors(a, b);
            assert_true(error > 0.5 && error <= largest);
        }
}

static void black_against_white_is_near_one(void **state)
{
    (void)state;
    const uint8_t black[3] = {0}, white[3] = {255, 255, 255};
    assert_true(fabs(flip_of_colors(black, white) - 0.967) < 5e-4);
}

static void the_order_of_the_two_does_not_matter(void **state)
{
    (void)state;
    static uint8_t a[MAX_PIXELS * 4], b[MAX_PIXELS * 4];
    double forth, back;
    fill_random(a, sizeof a, 1);
    fill_drawing(b, SIZE, SIZE);
    SluicePicturePair pair = rgba8_pair(a, b, SIZE, SIZE), swapped = rgba8_pair(b, a, SIZE, SIZE);
    CHECK_OK(sluiceComputeFlip(&pair, 0, NULL, NULL, &forth));
    CHECK_OK(sluiceComputeFlip(&swapped, 0, NULL, NULL, &back));
    assert_true(forth == back && forth > 0);
}

static void more_noise_is_more_error(void **state)
{
    (void)state;
    static uint8_t a[MAX_PIXELS * 4], b[MAX_PIXELS * 4];
    double last = 0;
    fill_drawing(a, SIZE, SIZE);
    for (int amplitude = 2; amplitude <= 64; amplitude *= 2) {
        double mean;
        add_noise(a, b, MAX_PIXELS, amplitude);
        SluicePicturePair pair = rgba8_pair(a, b, SIZE, SIZE);
        CHECK_OK(sluiceComputeFlip(&pair, 0, NULL, NULL, &mean));
        assert_true(mean > last && mean < 1);
        last = mean;
    }
}

static void from_afar_fine_stripes_are_less_seen(void **state)
{
    (void)state;
    static uint8_t a[MAX_PIXELS * 4], b[MAX_PIXELS * 4];
    double near_by, far_off;
    for (size_t i = 0; i < sizeof a; i++) {
        a[i] = i / 4 % 2 ? 180 : 100;
        b[i] = i / 4 % 2 ? 100 : 180;
    }
    SluicePicturePair pair = rgba8_pair(a, b, SIZE, SIZE);
    CHECK_OK(sluiceComputeFlip(&pair, 10, NULL, NULL, &near_by));
    CHECK_OK(sluiceComputeFlip(&pair, 100, NULL, NULL, &far_off));
    assert_true(far_off < near_by / 2);
}

static void zero_asks_for_the_display_of_the_paper(void **state)
{
    (void)state;
    static uint8_t a[MAX_PIXELS * 4], b[MAX_PIXELS * 4];
    double by_default, said;
    fill_drawing(a, SIZE, SIZE);
    add_noise(a, b, MAX_PIXELS, 20);
    SluicePicturePair pair = rgba8_pair(a, b, SIZE, SIZE);
    CHECK_OK(sluiceComputeFlip(&pair, 0, NULL, NULL, &by_default));
    CHECK_OK(sluiceComputeFlip(&pair, 67.0206433f, NULL, NULL, &said));
    assert_true(fabs(by_default - said) < 1e-7);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(small_pictures_agree_with_direct_convolution),
        cmocka_unit_test(one_pixel_is_seen_as_far_as_filters_reach),
        cmocka_unit_test(equal_pictures_have_exactly_none),
        cmocka_unit_test(grays_follow_the_difference_of_lightness),
        cmocka_unit_test(blue_against_green_is_the_largest),
        cmocka_unit_test(black_against_white_is_near_one),
        cmocka_unit_test(the_order_of_the_two_does_not_matter),
        cmocka_unit_test(more_noise_is_more_error),
        cmocka_unit_test(from_afar_fine_stripes_are_less_seen),
        cmocka_unit_test(zero_asks_for_the_display_of_the_paper),
    };
    return RUN_TESTS(tests);
}
