#include <sluice/metrics.h>

#include "support/failing_allocator.h"
#include "support/test.h"

#include "pictures.h"

#include <math.h>
#include <string.h>

enum { SIZE = 24, PIXELS = SIZE * SIZE };

static SluiceResult compute(bool flip, const SluicePicturePair *pair, const SluiceMetricMap *map,
                            const SluiceAllocationCallbacks *allocator, double *mean)
{
    return flip ? sluiceComputeFlip(pair, 0, map, allocator, mean)
                : sluiceComputeSsim(pair, map, allocator, mean);
}

static SluicePicturePair float_pair(const float *a, const float *b, SluicePixelFormat format,
                                    float peak)
{
    SluicePicturePair pair = rgba8_pair(a, b, SIZE, SIZE);
    pair.format = format;
    pair.peak = peak;
    return pair;
}

/** Values far outside [0, 4] in `wild`, and what they count as, for a peak of 4, in `tame`. */
static void fill_wild(float *wild, float *tame)
{
    static const float pairs[7][2] = {{NAN, 0},   {INFINITY, 4}, {-INFINITY, 0},  {-3, 0},
                                      {1e30f, 4}, {2.5f, 2.5f},  {1e-40f, 1e-40f}};
    for (int i = 0; i < PIXELS * 4; i++) {
        wild[i] = pairs[i * 5 / 3 % 7][0];
        tame[i] = pairs[i * 5 / 3 % 7][1];
    }
}

static void floats_are_clamped_and_nan_is_zero(void **state)
{
    (void)state;
    static float wild[PIXELS * 4], tame[PIXELS * 4], gray[PIXELS * 4];
    fill_wild(wild, tame);
    for (int i = 0; i < PIXELS * 4; i++)
        gray[i] = 1;
    for (int flip = 0; flip < 2; flip++)
        for (int format = 1; format <= 2; format++) {
            double same, of_wild, of_tame;
            SluicePicturePair pair = float_pair(wild, tame, (SluicePixelFormat)format, 4);
            CHECK_OK(compute(flip, &pair, NULL, NULL, &same));
            assert_true(same == (flip ? 0 : 1));
            pair.pB = gray;
            CHECK_OK(compute(flip, &pair, NULL, NULL, &of_wild));
            pair.pA = tame;
            CHECK_OK(compute(flip, &pair, NULL, NULL, &of_tame));
            assert_true(of_wild == of_tame && isfinite(of_wild) && fabs(of_wild - same) > 0.1);
        }
}

static void all_black_is_equal_to_itself(void **state)
{
    (void)state;
    static float black[PIXELS * 4], negative[PIXELS * 4];
    for (int i = 0; i < PIXELS * 4; i++)
        negative[i] = -0.0f;
    for (int flip = 0; flip < 2; flip++) {
        double mean;
        SluicePicturePair pair =
            float_pair(black, negative, SLUICE_PIXEL_FORMAT_RGBA32_FLOAT, 1e-30f);
        CHECK_OK(compute(flip, &pair, NULL, NULL, &mean));
        assert_true(mean == (flip ? 0 : 1));
    }
}

static void scaled_with_its_peak_nothing_changes(void **state)
{
    (void)state;
    static float a[2][PIXELS * 4], b[2][PIXELS * 4];
    uint32_t seed = 2;
    for (int i = 0; i < PIXELS * 4; i++) {
        a[0][i] = (float)random_next(&seed);
        b[0][i] = (float)random_next(&seed);
        a[1][i] = a[0][i] * 1024;
        b[1][i] = b[0][i] * 1024;
    }
    for (int flip = 0; flip < 2; flip++) {
        double one, many;
        SluicePicturePair pair = float_pair(a[0], b[0], SLUICE_PIXEL_FORMAT_RGBA32_FLOAT, 1);
        CHECK_OK(compute(flip, &pair, NULL, NULL, &one));
        pair = float_pair(a[1], b[1], SLUICE_PIXEL_FORMAT_RGBA32_FLOAT, 1024);
        CHECK_OK(compute(flip, &pair, NULL, NULL, &many));
        assert_true(one == many && (flip ? one > 0.1 : one < 0.9));
    }
}

static void flip_of_light_is_that_of_its_encoding(void **state)
{
    (void)state;
    static uint8_t encoded[2][PIXELS * 4];
    static float light[2][PIXELS * 4];
    double of_encoded, of_light;
    for (int p = 0; p < 2; p++) {
        fill_random(encoded[p], PIXELS * 4, 7 + (uint32_t)p);
        for (int i = 0; i < PIXELS * 4; i++)
            light[p][i] = (float)light_of(encoded[p][i] / 255.0);
    }
    SluicePicturePair pair = rgba8_pair(encoded[0], encoded[1], SIZE, SIZE);
    CHECK_OK(sluiceComputeFlip(&pair, 0, NULL, NULL, &of_encoded));
    pair = float_pair(light[0], light[1], SLUICE_PIXEL_FORMAT_RGBA32_FLOAT, 1);
    CHECK_OK(sluiceComputeFlip(&pair, 0, NULL, NULL, &of_light));
    assert_true(fabs(of_encoded - of_light) < 1e-6 && of_encoded > 0.1);
}

static void pitches_and_alpha_do_not_matter(void **state)
{
    (void)state;
    static uint8_t tight[2][PIXELS * 4], wide_a[SIZE][113], wide_b[SIZE][SIZE * 4 + 1];
    static float packed[PIXELS], spread[SIZE][SIZE + 3];
    for (int p = 0; p < 2; p++)
        fill_random(tight[p], PIXELS * 4, 3 + (uint32_t)p);
    for (int y = 0; y < SIZE; y++) {
        memcpy(wide_a[y], tight[0] + y * SIZE * 4, SIZE * 4);
        memcpy(wide_b[y], tight[1] + y * SIZE * 4, SIZE * 4);
        for (int x = 0; x < SIZE; x++)
            wide_a[y][4 * x + 3] ^= 0x5a;
    }
    for (int flip = 0; flip < 2; flip++) {
        double of_tight, of_wide;
        SluicePicturePair pair = rgba8_pair(tight[0], tight[1], SIZE, SIZE);
        SluiceMetricMap map = {.pValues = packed};
        CHECK_OK(compute(flip, &pair, &map, NULL, &of_tight));
        pair = rgba8_pair(wide_a, wide_b, SIZE, SIZE);
        pair.rowPitchA = sizeof wide_a[0];
        pair.rowPitchB = sizeof wide_b[0];
        memset(spread, 0x77, sizeof spread);
        float untouched = spread[0][SIZE];
        map = (SluiceMetricMap){spread[0], sizeof spread[0]};
        CHECK_OK(compute(flip, &pair, &map, NULL, &of_wide));
        assert_true(of_tight == of_wide);
        for (int y = 0; y < SIZE; y++) {
            assert_memory_equal(spread[y], packed + y * SIZE, SIZE * sizeof(float));
            for (int x = SIZE; x < SIZE + 3; x++)
                assert_true(spread[y][x] == untouched);
        }
    }
}

static void refused_memory_changes_nothing(void **state)
{
    (void)state;
    static uint8_t a[PIXELS * 4], b[PIXELS * 4];
    fill_random(a, sizeof a, 1);
    fill_random(b, sizeof b, 2);
    SluicePicturePair pair = rgba8_pair(a, b, SIZE, SIZE);
    for (int flip = 0; flip < 2; flip++) {
        SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        uint64_t calls = 0;
        for (; result == SLUICE_ERROR_OUT_OF_HOST_MEMORY; calls++) {
            struct failing_allocator allocator;
            float values[PIXELS] = {-7};
            SluiceMetricMap map = {.pValues = values};
            double mean = -7;
            failing_allocator_init(&allocator, calls);
            result = compute(flip, &pair, &map, &allocator.callbacks, &mean);
            assert_true((result != 0) == (mean == -7) && (result != 0) == (values[0] == -7));
            assert_int_equal(allocator.live_count, 0);
        }
        CHECK_OK(result);
        assert_true(calls > 2);
    }
}

static void wrong_pairs_are_refused(void **state)
{
    (void)state;
    static uint8_t a[PIXELS * 16];
    const SluicePicturePair good = rgba8_pair(a, a, SIZE, SIZE);
    SluicePicturePair bad[11];
    for (int i = 0; i < 11; i++)
        bad[i] = good;
    bad[0].width = 0;
    bad[1].height = 0;
    bad[2].rowPitchA = SIZE * 4 - 1;
    bad[3].rowPitchB = SIZE * 4 - 1;
    bad[4].rowPitchA = SIZE_MAX / 2;
    bad[5].format = (SluicePixelFormat)3;
    for (int i = 6; i < 11; i++)
        bad[i].format = SLUICE_PIXEL_FORMAT_R32_FLOAT;
    bad[7].peak = -1;
    bad[8].peak = INFINITY;
    bad[9].peak = NAN;
    bad[10].peak = 1;
    bad[10].rowPitchB = 4;
    for (int flip = 0; flip < 2; flip++)
        for (int i = 0; i < 11; i++) {
            double mean = 5;
            CHECK_RESULT(compute(flip, &bad[i], NULL, NULL, &mean), SLUICE_ERROR_INVALID_ARGUMENT);
            assert_true(mean == 5);
        }
}

static void wrong_maps_pointers_and_angles_are_refused(void **state)
{
    (void)state;
    static uint8_t a[PIXELS * 4];
    static float values[PIXELS];
    const SluicePicturePair good = rgba8_pair(a, a, SIZE, SIZE);
    SluicePicturePair no_a = good, no_b = good;
    const SluiceMetricMap no_map = {0}, narrow = {values, SIZE * 4 - 4},
                          odd = {values, SIZE * 4 + 1};
    const float angles[] = {0.5f, -1, 4097, NAN, INFINITY};
    double mean;
    no_a.pA = no_b.pB = NULL;
    for (int flip = 0; flip < 2; flip++) {
        CHECK_RESULT(compute(flip, NULL, NULL, NULL, &mean), SLUICE_ERROR_NULL_POINTER);
        CHECK_RESULT(compute(flip, &good, NULL, NULL, NULL), SLUICE_ERROR_NULL_POINTER);
        CHECK_RESULT(compute(flip, &no_a, NULL, NULL, &mean), SLUICE_ERROR_NULL_POINTER);
        CHECK_RESULT(compute(flip, &no_b, NULL, NULL, &mean), SLUICE_ERROR_NULL_POINTER);
        CHECK_RESULT(compute(flip, &good, &no_map, NULL, &mean), SLUICE_ERROR_NULL_POINTER);
        CHECK_RESULT(compute(flip, &good, &narrow, NULL, &mean), SLUICE_ERROR_INVALID_ARGUMENT);
        CHECK_RESULT(compute(flip, &good, &odd, NULL, &mean), SLUICE_ERROR_INVALID_ARGUMENT);
    }
    for (size_t i = 0; i < sizeof angles / sizeof angles[0]; i++)
        CHECK_RESULT(sluiceComputeFlip(&good, angles[i], NULL, NULL, &mean),
                     SLUICE_ERROR_INVALID_ARGUMENT);
}

static void magma_goes_from_black_to_pale_yellow(void **state)
{
    (void)state;
    const float values[8] = {0, 1, 0.5f, 0.0625f, NAN, -1, 2, INFINITY};
    static const uint8_t expected[8][4] = {
        {0, 0, 4, 255}, {252, 253, 191, 255}, {181, 54, 122, 255},  {14, 8, 36, 255},
        {0, 0, 4, 255}, {0, 0, 4, 255},       {252, 253, 191, 255}, {252, 253, 191, 255}};
    uint8_t colors[8][4];
    CHECK_OK(sluiceColorMagma(values, 8, colors[0]));
    assert_memory_equal(colors, expected, sizeof expected);
    CHECK_OK(sluiceColorMagma(NULL, 0, NULL));
    CHECK_RESULT(sluiceColorMagma(NULL, 1, colors[0]), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceColorMagma(values, 1, NULL), SLUICE_ERROR_NULL_POINTER);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(floats_are_clamped_and_nan_is_zero),
        cmocka_unit_test(all_black_is_equal_to_itself),
        cmocka_unit_test(scaled_with_its_peak_nothing_changes),
        cmocka_unit_test(flip_of_light_is_that_of_its_encoding),
        cmocka_unit_test(pitches_and_alpha_do_not_matter),
        cmocka_unit_test(refused_memory_changes_nothing),
        cmocka_unit_test(wrong_pairs_are_refused),
        cmocka_unit_test(wrong_maps_pointers_and_angles_are_refused),
        cmocka_unit_test(magma_goes_from_black_to_pale_yellow),
    };
    return RUN_TESTS(tests);
}
