#include <sluice/metrics.h>

#include "support/test.h"

#include <math.h>
#include <stdlib.h>

static void equal_pictures_are_infinitely_alike(void **state)
{
    (void)state;
    const uint8_t a[12] = {1, 2, 3, 255, 0, 9};
    double psnr = 0;
    CHECK_OK(sluiceComputePsnr8(a, a, 2, 2, 3, &psnr));
    assert_true(isinf(psnr) && psnr > 0);
}

static void random_pictures_agree_with_long_double(void **state)
{
    (void)state;
    enum { WIDTH = 61, HEIGHT = 47 };
    static uint8_t a[WIDTH * HEIGHT * 4], b[WIDTH * HEIGHT * 4];
    uint32_t random = 3;
    for (uint32_t channels = 1; channels <= 4; channels++) {
        long double sum = 0;
        size_t count = (size_t)WIDTH * HEIGHT * channels;
        for (size_t i = 0; i < count; i++) {
            random = random * 1664525u + 1013904223u;
            a[i] = (uint8_t)(random >> 24);
            b[i] = (uint8_t)(random >> 16);
            sum += ((long double)a[i] - b[i]) * ((long double)a[i] - b[i]);
        }
        double psnr;
        CHECK_OK(sluiceComputePsnr8(a, b, WIDTH, HEIGHT, channels, &psnr));
        assert_true(fabsl(psnr - 10 * log10l(255.0L * 255.0L * count / sum)) < 1e-12L);
    }
}

static void black_against_white_is_zero(void **state)
{
    (void)state;
    const uint8_t black[4] = {0}, white[4] = {255, 255, 255, 255};
    double psnr = 1;
    CHECK_OK(sluiceComputePsnr8(black, white, 2, 2, 1, &psnr));
    assert_true(psnr == 0);
}

static void one_step_in_one_value_is_found(void **state)
{
    (void)state;
    enum { COUNT = 1 << 22 };
    uint8_t *a = calloc(COUNT, 1), *b = calloc(COUNT, 1);
    double psnr;
    b[COUNT - 1] = 1;
    CHECK_OK(sluiceComputePsnr8(a, b, 1 << 11, 1 << 11, 1, &psnr));
    assert_true(fabs(psnr - 10 * log10(255.0 * 255.0 * COUNT)) < 1e-9);
    free(a);
    free(b);
}

static void wrong_arguments_are_refused(void **state)
{
    (void)state;
    const uint8_t a[1] = {0};
    double psnr;
    CHECK_RESULT(sluiceComputePsnr8(NULL, a, 1, 1, 1, &psnr), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceComputePsnr8(a, NULL, 1, 1, 1, &psnr), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceComputePsnr8(a, a, 1, 1, 1, NULL), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceComputePsnr8(a, a, 0, 1, 1, &psnr), SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceComputePsnr8(a, a, 1, 0, 1, &psnr), SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceComputePsnr8(a, a, 1, 1, 0, &psnr), SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceComputePsnr8(a, a, 1, 1, 5, &psnr), SLUICE_ERROR_INVALID_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_pictures_are_infinitely_alike),
        cmocka_unit_test(random_pictures_agree_with_long_double),
        cmocka_unit_test(black_against_white_is_zero),
        cmocka_unit_test(one_step_in_one_value_is_found),
        cmocka_unit_test(wrong_arguments_are_refused),
    };
    return RUN_TESTS(tests);
}
