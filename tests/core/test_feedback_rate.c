/** Compares the chances predicted by feedback_rate.h with the formula in long double. */
#include <math.h>
#include <string.h>

#include <sluice/feedback_rate.h>

#include "support/test.h"

#define STEP (1.0L / 8388608)

/* 60 Hz, 1 s timeout, 1000 textures, 10 per frame: 6 turns per timeout. */
static SluiceFeedbackRate usual(SluiceFeedbackSelection selection, uint32_t side, bool in_turns)
{
    return (SluiceFeedbackRate){.structSize = sizeof(SluiceFeedbackRate),
                                .selection = selection,
                                .regionWidth = side,
                                .regionHeight = side,
                                .textureCount = 1000,
                                .inTurns = in_turns,
                                .frameRate = 60,
                                .timeoutSeconds = 10};
}

static double miss_of(const SluiceFeedbackRate *rate, double probability)
{
    double miss = -1;
    CHECK_OK(sluicePredictFeedbackMiss(rate, probability, &miss));
    return miss;
}

static uint64_t random_state;

static double draw(void)
{
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return (double)(random_state >> 11) * 0x1p-53;
}

static double draw_magnitude(double least, double greatest)
{
    return least * pow(greatest / least, draw());
}

static uint32_t draw_count(double greatest)
{
    return (uint32_t)draw_magnitude(1, greatest);
}

/* A frame lasts a second: whole frames and whole turns need no rounding. */
static SluiceFeedbackRate draw_rate(long double *draws)
{
    uint32_t turn = draw_count(300), turns = draw_count(1e4), per_frame = draw_count(50);
    SluiceFeedbackRate rate = {.structSize = sizeof rate,
                               .selection = draw() < 0.5 ? SLUICE_FEEDBACK_SELECTION_RANDOM_PIXELS
                                                         : SLUICE_FEEDBACK_SELECTION_RANDOM_QUADS,
                               .regionWidth = draw_count(31622),
                               .regionHeight = draw_count(31622),
                               .textureCount = turn * per_frame,
                               .texturesPerFrame = per_frame,
                               .inTurns = draw() < 0.5,
                               .frameRate = 1,
                               .timeoutSeconds = (double)turn * turns};
    bool quads = rate.selection == SLUICE_FEEDBACK_SELECTION_RANDOM_QUADS;
    uint32_t across = quads ? (rate.regionWidth + 1) / 2 : rate.regionWidth;
    uint32_t down = quads ? (rate.regionHeight + 1) / 2 : rate.regionHeight;
    *draws = (long double)across * down * turns * (rate.inTurns ? 1 : turn);
    return rate;
}

static void misses_are_those_of_long_double_within_the_stated_error(void **state)
{
    (void)state;
    random_state = 1;
    long double worst = 0;
    for (uint32_t i = 0, compared = 0; compared < 200000; i++) {
        long double draws;
        SluiceFeedbackRate rate = draw_rate(&draws);
        double p =
            draw() < 0.5 ? draw_magnitude(1e-9, 1) : draw_magnitude(1e-3, 700) / (double)draws;
        if (!(p <= 1))
            continue;
        long double power = draws * log1pl(-(long double)p);
        compared++;
        double miss = miss_of(&rate, p);
        if (power < -700) {
            assert_true(miss >= 0 && miss < 1e-303);
            continue;
        }
        long double error = fabsl((long double)miss / expl(power) - 1) / (1 - power);
        worst = error > worst ? error : worst;
    }
    print_message("# largest error / (1 - ln miss): %.2Lg\n", worst);
    assert_true(worst <= 5e-16L);
}

static void chosen_probability_is_the_least_step_that_is_enough(void **state)
{
    (void)state;
    random_state = 2;
    for (uint32_t i = 0; i < 100000; i++) {
        long double draws;
        SluiceFeedbackRate rate = draw_rate(&draws);
        double allowed = draw_magnitude(1e-300, 0.999);
        float p = -1;
        CHECK_OK(sluiceChooseFeedbackProbability(&rate, allowed, &p));
        assert_true(miss_of(&rate, (double)p) <= allowed);
        assert_true(fmodl((long double)p, STEP) == 0 && (long double)p >= STEP);
        if ((long double)p > STEP) /* 1e-12: rounding may choose either of two steps */
            assert_true(draws * log1pl(-((long double)p - STEP)) > logl(allowed) * (1 + 1e-12L));
    }
}

static void marks_accumulate_unless_they_are_made_in_turns(void **state)
{
    (void)state;
    SluiceFeedbackRate all = usual(SLUICE_FEEDBACK_SELECTION_RANDOM_PIXELS, 1, false);
    SluiceFeedbackRate turns = usual(SLUICE_FEEDBACK_SELECTION_RANDOM_PIXELS, 1, true);
    assert_true(fabs(miss_of(&all, 0.001) - pow(0.999, 600)) < 1e-15);
    assert_true(fabs(miss_of(&turns, 0.001) - pow(0.999, 6)) < 1e-15);
    all.textureCount = turns.textureCount = 7; /* fewer textures than are read back per frame */
    assert_true(miss_of(&all, 0.001) == miss_of(&turns, 0.001));
}

/* Fractions of frames and turns are rounded down. 0.29 * 100 counts as 29 despite float
 * rounding. */
static void whole_frames_and_turns_count(void **state)
{
    (void)state;
    SluiceFeedbackRate rate = usual(SLUICE_FEEDBACK_SELECTION_RANDOM_PIXELS, 1, false);
    rate.textureCount = 1;
    rate.timeoutSeconds = 0.29, rate.frameRate = 100;
    assert_true(fabs(miss_of(&rate, 0.5) - 0x1p-29) < 1e-20);
    rate.frameRate = 103.4;
    assert_true(fabs(miss_of(&rate, 0.5) - 0x1p-29) < 1e-20);
    rate = usual(SLUICE_FEEDBACK_SELECTION_RANDOM_PIXELS, 1, true);
    rate.timeoutSeconds = 3.3; /* 1.98 turns: some timeouts have one only */
    assert_true(miss_of(&rate, 0.25) == 0.75);
}

static void newest_map_counts_without_a_timeout(void **state)
{
    (void)state;
    SluiceFeedbackRate all = usual(SLUICE_FEEDBACK_SELECTION_RANDOM_PIXELS, 1, false);
    SluiceFeedbackRate turns = usual(SLUICE_FEEDBACK_SELECTION_RANDOM_PIXELS, 1, true);
    all.timeoutSeconds = turns.timeoutSeconds = 0;
    assert_true(miss_of(&turns, 0.25) == 0.75);
    assert_true(fabs(miss_of(&all, 0.01) - pow(0.99, 100)) < 1e-15);
}

static void endless_timeout_misses_nothing_that_is_ever_marked(void **state)
{
    (void)state;
    for (int selection = 0; selection < 4; selection++) {
        SluiceFeedbackRate rate = usual((SluiceFeedbackSelection)selection, 1, false);
        rate.timeoutSeconds = INFINITY;
        float p = -1;
        assert_true(miss_of(&rate, 1e-9) == 0);
        CHECK_OK(sluiceChooseFeedbackProbability(&rate, 0, &p));
        bool lattice = selection == SLUICE_FEEDBACK_SELECTION_LATTICE;
        assert_true(p == (lattice ? 1.0f / 64 : (float)STEP));
        assert_true(miss_of(&rate, 0) == (lattice ? 0 : 1));
    }
}

static void ends_of_the_probability_are_never_and_always(void **state)
{
    (void)state;
    for (int selection = 0; selection < 3; selection++) {
        SluiceFeedbackRate rate = usual((SluiceFeedbackSelection)selection, 4000000000u, false);
        SluiceFeedbackDelay delay = {.structSize = sizeof delay};
        assert_true(miss_of(&rate, 0) == 1);
        assert_true(miss_of(&rate, 1) == 0);
        assert_true(miss_of(&rate, 1e-9) == 0);
        CHECK_OK(sluicePredictFeedbackDelay(&rate, 0, &delay));
        assert_true(isinf(delay.median) && isinf(delay.percentile99));
        CHECK_OK(sluicePredictFeedbackDelay(&rate, 1, &delay));
        assert_true(delay.median == 100 && delay.percentile99 == 100);
        float p = -1;
        CHECK_OK(sluiceChooseFeedbackProbability(&rate, 0, &p));
        assert_true(p == 1);
    }
}

/* One corner of one pixel is drawn once in four frames, in whole rounds. */
static void shared_corners_need_rounds_of_four_frames(void **state)
{
    (void)state;
    SluiceFeedbackRate rate = usual(SLUICE_FEEDBACK_SELECTION_SHARED_QUADS, 1, false);
    rate.textureCount = 1;
    rate.frameRate = 1;
    rate.timeoutSeconds = 11;
    float p = -1;
    assert_true(miss_of(&rate, 0.5) == 0.25);
    rate.timeoutSeconds = 3;
    assert_true(miss_of(&rate, 1) == 1);
    CHECK_RESULT(sluiceChooseFeedbackProbability(&rate, 0.5, &p), SLUICE_ERROR_LIMIT_EXCEEDED);
    assert_true(p == -1);
    rate.regionWidth = rate.regionHeight = 7; /* 3 x 3 quads, whatever the turn */
    assert_true(fabs(miss_of(&rate, 0.5) - 0x1p-27) < 1e-20);
}

static void corners_in_turns_need_an_odd_number_of_frames_between(void **state)
{
    (void)state;
    SluiceFeedbackRate rate = usual(SLUICE_FEEDBACK_SELECTION_SHARED_QUADS, 1, true);
    SluiceFeedbackDelay delay = {.structSize = sizeof delay};
    assert_true(miss_of(&rate, 1) == 1);
    CHECK_OK(sluicePredictFeedbackDelay(&rate, 1, &delay));
    assert_true(isinf(delay.median));
    rate.textureCount = 990; /* 99 frames: 6 turns in 10 s */
    assert_true(miss_of(&rate, 0.75) == 0.25);
}

static void lattice_meets_eight_by_eight_pixels_in_every_frame(void **state)
{
    (void)state;
    SluiceFeedbackRate rate = usual(SLUICE_FEEDBACK_SELECTION_LATTICE, 8, true);
    SluiceFeedbackDelay delay = {.structSize = sizeof delay};
    rate.timeoutSeconds = 0;
    assert_true(miss_of(&rate, 0) == 0);
    CHECK_OK(sluicePredictFeedbackDelay(&rate, 0, &delay));
    assert_true(delay.median == 100 && delay.percentile99 == 100);
}

/* The lattice visits a pixel once in 64 frames. After n frames the miss chance is 1 - n / 64. */
static void lattice_meets_one_pixel_in_sixty_four_frames(void **state)
{
    (void)state;
    SluiceFeedbackRate rate = usual(SLUICE_FEEDBACK_SELECTION_LATTICE, 1, false);
    SluiceFeedbackDelay delay = {.structSize = sizeof delay};
    rate.textureCount = 1;
    rate.frameRate = 1;
    for (uint32_t n = 1; n <= 64; n++) {
        rate.timeoutSeconds = n;
        assert_true(miss_of(&rate, 0) == 1 - n / 64.0);
    }
    CHECK_OK(sluicePredictFeedbackDelay(&rate, 0, &delay));
    assert_true(delay.median == 32 && delay.percentile99 == 64);
}

/* After 100 frames the lattice is 36 steps further: these turns visit 16 of its 64 positions. */
static void lattice_in_turns_may_never_come_to_a_pixel(void **state)
{
    (void)state;
    SluiceFeedbackRate rate = usual(SLUICE_FEEDBACK_SELECTION_LATTICE, 1, true);
    SluiceFeedbackDelay delay = {.structSize = sizeof delay};
    float p = -1;
    rate.timeoutSeconds = INFINITY;
    assert_true(miss_of(&rate, 0) == 0.75);
    CHECK_RESULT(sluiceChooseFeedbackProbability(&rate, 0.5, &p), SLUICE_ERROR_LIMIT_EXCEEDED);
    CHECK_OK(sluicePredictFeedbackDelay(&rate, 0, &delay));
    assert_true(isinf(delay.median));
    rate.textureCount = 990;
    assert_true(miss_of(&rate, 0) == 0);
}

static void expect_refused(SluiceFeedbackRate rate, double probability)
{
    double miss = -1;
    SluiceFeedbackDelay delay = {sizeof delay, -1, -1};
    CHECK_RESULT(sluicePredictFeedbackMiss(&rate, probability, &miss),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluicePredictFeedbackDelay(&rate, probability, &delay),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    assert_true(miss == -1 && delay.median == -1 && delay.percentile99 == -1);
}

static void values_out_of_range_are_refused(void **state)
{
    (void)state;
    const SluiceFeedbackRate good = usual(SLUICE_FEEDBACK_SELECTION_RANDOM_QUADS, 8, false);
    const double bad_times[] = {-1, -INFINITY, NAN}, bad_rates[] = {0, -60, INFINITY, NAN};
    SluiceFeedbackRate rate = good;
    const double bad_shares[] = {-1e-9, 1.0000001, NAN, INFINITY};
    for (size_t i = 0; i < 4; i++)
        expect_refused(good, bad_shares[i]);
    for (size_t i = 0; i < 3; i++, rate = good)
        rate.timeoutSeconds = bad_times[i], expect_refused(rate, 0.5);
    for (size_t i = 0; i < 4; i++, rate = good)
        rate.frameRate = bad_rates[i], expect_refused(rate, 0.5);
    rate.regionWidth = 0, expect_refused(rate, 0.5), rate = good;
    rate.regionHeight = 0, expect_refused(rate, 0.5), rate = good;
    rate.textureCount = 0, expect_refused(rate, 0.5), rate = good;
    rate.selection = (SluiceFeedbackSelection)4, expect_refused(rate, 0.5);
}

static void choice_refuses_what_cannot_be_allowed(void **state)
{
    (void)state;
    const SluiceFeedbackRate good = usual(SLUICE_FEEDBACK_SELECTION_RANDOM_QUADS, 8, false);
    const double bad[] = {-1e-9, 1, 2, NAN, INFINITY};
    float p = -1;
    for (size_t i = 0; i < 5; i++)
        CHECK_RESULT(sluiceChooseFeedbackProbability(&good, bad[i], &p),
                     SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceChooseFeedbackProbability(NULL, 0.1, &p), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceChooseFeedbackProbability(&good, 0.1, NULL), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluicePredictFeedbackMiss(&good, 0.1, NULL), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluicePredictFeedbackDelay(NULL, 0.1, NULL), SLUICE_ERROR_NULL_POINTER);
    assert_true(p == -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(misses_are_those_of_long_double_within_the_stated_error),
        cmocka_unit_test(chosen_probability_is_the_least_step_that_is_enough),
        cmocka_unit_test(marks_accumulate_unless_they_are_made_in_turns),
        cmocka_unit_test(whole_frames_and_turns_count),
        cmocka_unit_test(newest_map_counts_without_a_timeout),
        cmocka_unit_test(endless_timeout_misses_nothing_that_is_ever_marked),
        cmocka_unit_test(ends_of_the_probability_are_never_and_always),
        cmocka_unit_test(shared_corners_need_rounds_of_four_frames),
        cmocka_unit_test(corners_in_turns_need_an_odd_number_of_frames_between),
        cmocka_unit_test(lattice_meets_eight_by_eight_pixels_in_every_frame),
        cmocka_unit_test(lattice_meets_one_pixel_in_sixty_four_frames),
        cmocka_unit_test(lattice_in_turns_may_never_come_to_a_pixel),
        cmocka_unit_test(values_out_of_range_are_refused),
        cmocka_unit_test(choice_refuses_what_cannot_be_allowed),
    };
    return RUN_TESTS(tests);
}
