/* Checks sizes, mips, samples and rates against the format's facts and by counting. */
#include "neural_train/train_plan.h"
#include "neural_train/train_schedule.h"

#include "support/test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static char message[256];

static void on_log(void *user, SluiceLogSeverity severity, const char *text)
{
    (void)user, (void)severity;
    snprintf(message, sizeof message, "%s", text);
}

static const SluiceLogCallback log_of_test = {NULL, on_log};
static const SluiceNeuralTrainingChannel channels[16];
static const float texel;
#define FOUR_MIPS &texel, &texel, &texel, &texel
static const float *const mips[16] = {FOUR_MIPS, FOUR_MIPS, FOUR_MIPS, FOUR_MIPS}; /* not read */

static SluiceNeuralCompressorCreateInfo info_of(uint32_t width, uint32_t height, uint32_t scale)
{
    return (SluiceNeuralCompressorCreateInfo){.structSize =
                                                  sizeof(SluiceNeuralCompressorCreateInfo),
                                              .width = width,
                                              .height = height,
                                              .channelCount = 4,
                                              .pChannels = channels,
                                              .ppMips = mips,
                                              .gridSizeScale = scale,
                                              .stepCount = 1000};
}

static struct slc_train_plan plan_of(uint32_t width, uint32_t height, uint32_t scale)
{
    struct slc_train_plan plan;
    SluiceNeuralCompressorCreateInfo info = info_of(width, height, scale);
    CHECK_OK(slc_train_plan_init(&plan, &info, &log_of_test));
    return plan;
}

/* Expected values are those of LibNTC's files of these sizes. */
static void mips_use_the_latents_that_the_format_says(void **state)
{
    (void)state;
    static const struct {
        uint32_t scale, images[10];
    } cases[] = {{4, {0, 0, 0, 2, 2, 4, 4, 6, 6, 6}},
                 {2, {0, 0, 0, 2, 2, 4, 4, 6, 6, 6}},
                 {3, {0, 0, 0, 2, 2, 4, 4, 6, 6, 6}},
                 {6, {0, 0, 0, 0, 2, 2, 4, 4, 6, 6}}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct slc_train_plan plan = plan_of(512, 512, cases[i].scale);
        assert_int_equal(plan.mip_count, 10);
        assert_int_equal(plan.images[0].width, 512 / cases[i].scale);
        for (uint32_t m = 0; m < 10 && plan.image_count == 8; m++)
            assert_int_equal(slc_train_first_image(&plan, m), cases[i].images[m]);
    }
    struct slc_train_plan plan = plan_of(512, 512, 4);
    assert_float_equal(slc_train_position_scale(&plan, 0), 0.125f, 0.0f);
    assert_float_equal(slc_train_position_lod(&plan, 0), -0.75f, 0.0f);
    assert_float_equal(slc_train_position_lod(&plan, 2), -0.25f, 0.0f);
    plan = plan_of(300, 200, 4);
    assert_int_equal(plan.images[1].width, 37);
    assert_int_equal(plan.images[1].height, 25);
}

static void every_mip_has_samples(void **state)
{
    (void)state;
    for (uint32_t size = 1; size <= 1024; size *= 2)
        for (uint32_t scale = 1; scale <= 6; scale++) {
            struct slc_train_plan plan = plan_of(size, size / 2 ? size / 2 : 1, scale);
            uint32_t table[TRAIN_TABLE_WORDS], tiles = 0;
            slc_train_write_table(&plan, table);
            for (uint32_t m = 0; m < plan.mip_count; m++) {
                const uint32_t *mip = table + m * TRAIN_MIP_WORDS;
                assert_int_equal(mip[TRAIN_MIP_FIRST_TILE], tiles);
                assert_true(plan.mip_tiles[m] > 0);
                /* Strata cover the mip. */
                assert_true((uint64_t)mip[TRAIN_MIP_STRATUM] * plan.mip_tiles[m] * TRAIN_TILE >=
                            (uint64_t)mip[TRAIN_MIP_WIDTH] * mip[TRAIN_MIP_HEIGHT]);
                tiles += plan.mip_tiles[m];
            }
            assert_int_equal(tiles, plan.tile_count);
            assert_true(tiles < 65536 / TRAIN_TILE + plan.mip_count);
        }
}

static void sums_of_gradients_fit_into_32_bits(void **state)
{
    (void)state;
    for (uint32_t size = 4; size <= 4096; size *= 4) {
        struct slc_train_plan plan = plan_of(size, size, 4);
        double unit = (double)slc_train_latent_unit(&plan);
        /* A sample adds at most 8 to its four corners in total. Worst case: all samples meet at one
         * texel. */
        double samples = 0.0;
        for (uint32_t m = 0; m < plan.mip_count; m++)
            if (slc_train_first_image(&plan, m) == plan.image_count - 2)
                samples += plan.mip_tiles[m] * (double)TRAIN_TILE;
        const struct slc_latent_image *last = &plan.images[plan.image_count - 1];
        double crowd = fmin(samples, 8.0 * samples / (last->width * (double)last->height));
        assert_true(crowd * 8.0 * unit <= 2147483648.0);
        assert_true(unit >= 1024.0);
    }
}

static void latents_learn_until_the_int8_network_ends(void **state)
{
    (void)state;
    struct slc_train_plan plan = plan_of(64, 64, 4);
    struct slc_train_push push, last;
    slc_train_write_push(&plan, 0, &push);
    /* Adam's first step equals the rate, which starts at its half: factors such as 0.1 / (1 - 0.9)
     * cancel. */
    assert_float_equal(push.networkRate, 0.5 * 0.02 * sqrt(0.01) / 0.1, 1e-6);
    slc_train_write_push(&plan, 20, &last);
    assert_float_equal(last.networkRate * (1.0 - pow(0.9, 21.0)) / sqrt(1.0 - pow(0.99, 21.0)),
                       0.02, 2e-5); /* all of it after a fiftieth of the steps */
    assert_true(push.flags & TRAIN_LATENTS);
    slc_train_write_push(&plan, 999, &push);
    slc_train_write_push(&plan, 1000, &last);
    assert_true(push.flags & TRAIN_LATENTS && !(last.flags & TRAIN_LATENTS));
    assert_true(push.networkRate < 1e-6f && push.latentRate < 1e-5f); /* after the cosine */
    assert_float_equal(last.networkRate, 0.5 * 0.2 * 0.02, 1e-6);
    assert_true(last.flags & TRAIN_ROUND_LATENTS && last.flags & TRAIN_QUANTIZE_NETWORK);
    assert_int_equal(slc_train_total_steps(&plan), 1050);
    slc_train_write_push(&plan, 999, &push);
    slc_train_write_push(&plan, 1000, &last);
    assert_true(!(push.flags & TRAIN_FP8) && push.nextFlags & TRAIN_FP8 && last.flags & TRAIN_FP8);
    slc_train_write_push(&plan, UINT32_MAX, &push);
    assert_true(push.flags == 0 && push.nextFlags == slc_train_flags(&plan, 0));
}

static void wrong_values_are_named(void **state)
{
    (void)state;
    static const struct {
        const char *said;
        size_t field;
        uint32_t value;
    } cases[] = {
#define FIELD(name) offsetof(SluiceNeuralCompressorCreateInfo, name)
        {"width is 0, must be 1 to 16384", FIELD(width), 0},
        {"height is 16385, must be 1 to 16384", FIELD(height), 16385},
        {"mipCount is 8, must be 0 to 7", FIELD(mipCount), 8},
        {"channelCount is 17, must be 1 to 16", FIELD(channelCount), 17},
        {"gridSizeScale is 7, must be 0 to 6", FIELD(gridSizeScale), 7},
        {"featureCount is 6, must be a multiple of 4", FIELD(featureCount), 6},
        {"batchSize is 48, must be a multiple of 32", FIELD(batchSize), 48},
        {"stepCount is 10000001, must be 0 to 10000000", FIELD(stepCount), 10000001},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct slc_train_plan plan;
        SluiceNeuralCompressorCreateInfo info = info_of(64, 64, 4);
        memcpy((char *)&info + cases[i].field, &cases[i].value, sizeof cases[i].value);
        CHECK_RESULT(slc_train_plan_init(&plan, &info, &log_of_test),
                     SLUICE_ERROR_INVALID_ARGUMENT);
        assert_string_equal(message, cases[i].said);
    }
    struct slc_train_plan plan;
    SluiceNeuralCompressorCreateInfo info = info_of(64, 64, 4);
    info.latentRate = NAN;
    CHECK_RESULT(slc_train_plan_init(&plan, &info, &log_of_test), SLUICE_ERROR_INVALID_ARGUMENT);
    assert_string_equal(message, "latentRate is nan, must be 0 to 1");
}

/* Only the remainder fits into 32 bits: buffers would be too small, and shaders would write beyond
 * them. */
static void latents_that_32_bits_cannot_count_are_refused(void **state)
{
    (void)state;
    struct slc_train_plan plan;
    SluiceNeuralCompressorCreateInfo info = info_of(16384, 12289, 1);
    CHECK_RESULT(slc_train_plan_init(&plan, &info, &log_of_test), SLUICE_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(message, "at most 2^30"));
    info.gridSizeScale = 4;
    CHECK_OK(slc_train_plan_init(&plan, &info, &log_of_test));
}

static void a_mip_that_is_missing_is_refused(void **state)
{
    (void)state;
    const float *some[16];
    struct slc_train_plan plan;
    SluiceNeuralCompressorCreateInfo info = info_of(64, 64, 4);
    memcpy(some, mips, sizeof some);
    some[6] = NULL;
    info.ppMips = some;
    CHECK_RESULT(slc_train_plan_init(&plan, &info, &log_of_test), SLUICE_ERROR_NULL_POINTER);
    info.mipCount = 6;
    CHECK_OK(slc_train_plan_init(&plan, &info, &log_of_test));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mips_use_the_latents_that_the_format_says),
        cmocka_unit_test(every_mip_has_samples),
        cmocka_unit_test(sums_of_gradients_fit_into_32_bits),
        cmocka_unit_test(latents_learn_until_the_int8_network_ends),
        cmocka_unit_test(wrong_values_are_named),
        cmocka_unit_test(latents_that_32_bits_cannot_count_are_refused),
        cmocka_unit_test(a_mip_that_is_missing_is_refused),
    };
    return RUN_TESTS(tests);
}
