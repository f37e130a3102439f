#include "support/test.h"

#include "history.h"

#include <math.h>

#define SERIES 2u
#define FRAME_SECONDS 0.0625 /* a power of two: sums are exact */

static double value_of(uint32_t frame)
{
    return frame * 2654435761u >> 12;
}

/* The largest value of the frames whose begin is in [from, to) seconds. */
static double largest(uint32_t frames, double from, double to)
{
    double most = 0;
    for (uint32_t i = 0; i < frames; i++)
        if (i * FRAME_SECONDS >= from && i * FRAME_SECONDS < to)
            most = fmax(most, value_of(i));
    return most;
}

static void points_of_all_spans_have_the_largest_of_their_frames(void **state)
{
    (void)state;
    enum { FRAMES = 20000 };
    struct history history;
    assert_true(history_create(SERIES, &history));
    for (uint32_t i = 0; i < FRAMES; i++) {
        const float values[SERIES] = {(float)value_of(i), 1};
        history_add(&history, FRAME_SECONDS, values);
    }
    for (int span = HISTORY_MINUTE; span < HISTORY_SPANS; span++) {
        const double step = history.rings[span].step, now = (FRAMES - 1) * FRAME_SECONDS;
        const uint32_t count = history_count(&history, (enum history_span)span);
        assert_true(count > HISTORY_POINTS / 2 && count <= HISTORY_POINTS);
        float values[HISTORY_POINTS];
        assert_int_equal(history_read(&history, (enum history_span)span, 0, values), count);
        for (uint32_t age = 0; age < count; age++) {
            const double begin = (floor(now / step + 1e-9) - age) * step;
            const double is = (double)history_value(&history, (enum history_span)span, 0, age);
            assert_float_equal(is, largest(FRAMES, begin - 1e-9, begin + step - 1e-9), 0);
            assert_float_equal(values[age], is, 0);
            assert_float_equal(history_value(&history, (enum history_span)span, 1, age), 1, 0);
        }
    }
    history_destroy(&history);
}

/* A click in a graph keeps such a time. */
static void a_time_names_the_same_point_while_frames_pass(void **state)
{
    (void)state;
    struct history history;
    assert_true(history_create(SERIES, &history));
    for (uint32_t i = 0; i < 200; i++)
        history_add(&history, FRAME_SECONDS, (const float[SERIES]){(float)value_of(i), 1});
    for (int span = 0; span < HISTORY_SPANS; span++) {
        const enum history_span s = (enum history_span)span;
        for (uint32_t age = 0; age < history_count(&history, s); age++)
            assert_int_equal(history_age_of(&history, s, history_time_of(&history, s, age)), age);
    }
    const double time = history_time_of(&history, HISTORY_10_SECONDS, 40);
    const float value = history_value(&history, HISTORY_10_SECONDS, 0, 40);
    for (uint32_t i = 0; i < 100; i++) {
        history_add(&history, FRAME_SECONDS, (const float[SERIES]){(float)i, 1});
        const uint32_t age = history_age_of(&history, HISTORY_10_SECONDS, time);
        assert_true(age > 40);
        assert_float_equal(history_value(&history, HISTORY_10_SECONDS, 0, age), value, 0);
    }
    for (uint32_t i = 0; i < 100; i++)
        history_add(&history, FRAME_SECONDS, (const float[SERIES]){1, 1});
    assert_int_equal(history_age_of(&history, HISTORY_10_SECONDS, time), UINT32_MAX);
    assert_int_equal(history_age_of(&history, HISTORY_10_SECONDS, 1e6), UINT32_MAX);
    assert_true(history_age_of(&history, HISTORY_ALL, time) < HISTORY_POINTS);
    history_destroy(&history);
}

static void a_frame_that_is_longer_than_a_point_fills_all_that_it_passes(void **state)
{
    (void)state;
    struct history history;
    const float values[4] = {7, 8, 9, 10};
    assert_true(history_create(1, &history));
    history_add(&history, 0.5, &values[0]); /* 30 points of 1/60 s until the next begins */
    history_add(&history, 100, &values[1]);
    assert_int_equal(history_count(&history, HISTORY_10_SECONDS), 31);
    assert_float_equal(history_value(&history, HISTORY_10_SECONDS, 0, 30), 7, 0);
    assert_float_equal(history_value(&history, HISTORY_10_SECONDS, 0, 29), 8, 0);
    history_add(&history, 1, &values[2]);
    assert_int_equal(history_count(&history, HISTORY_10_SECONDS), HISTORY_POINTS);
    assert_float_equal(history_value(&history, HISTORY_10_SECONDS, 0, HISTORY_POINTS - 1), 9, 0);
    assert_true(history.rings[HISTORY_ALL].step * HISTORY_POINTS > 100.5);
    history_destroy(&history);
}

static void quantiles_of_frame_times_are_those_of_the_sorted_times(void **state)
{
    static const double parts[] = {0.5, 0.99, 1.0};
    (void)state;
    struct history history;
    const float none = 0;
    double seconds[3];
    assert_true(history_create(1, &history));
    history_frame_times(&history, HISTORY_ALL, parts, 3, seconds);
    assert_float_equal(seconds[1], 0, 0);
    history_add(&history, 5, &none); /* long ago: not among the last 10 seconds */
    for (int i = 0; i < 101; i++)
        history_add(&history, (i * 37 % 101 + 1) / 512.0, &none); /* 1/512 to 101/512, mixed */
    history_frame_times(&history, HISTORY_10_SECONDS, parts, 3, seconds);
    assert_true(seconds[2] <= 101 / 512.0);
    history_frame_times(&history, HISTORY_MINUTE, parts, 3, seconds);
    assert_float_equal(seconds[0], 51 / 512.0, 0);  /* the 51st of 102 */
    assert_float_equal(seconds[1], 101 / 512.0, 0); /* the 101st */
    assert_float_equal(seconds[2], 5, 0);
    history_destroy(&history);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_time_names_the_same_point_while_frames_pass),
        cmocka_unit_test(points_of_all_spans_have_the_largest_of_their_frames),
        cmocka_unit_test(a_frame_that_is_longer_than_a_point_fills_all_that_it_passes),
        cmocka_unit_test(quantiles_of_frame_times_are_those_of_the_sorted_times),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
