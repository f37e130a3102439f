/* Recommended points, compared with a naive front, also with noise in the measurements. */
#include "support/test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "recommend.h"

#define MOST_POINTS 40
#define REPEATS 3

enum { QUALITY, MEMORY, TIME, METRIC_COUNT };

static const struct sweep_metric metrics[METRIC_COUNT] = {
    {"flip_mean", "", "", SWEEP_LESS_IS_BETTER},
    {"resident_bytes_peak", "bytes", "", SWEEP_LESS_IS_BETTER},
    {"gpu_ms_median", "ms", "", SWEEP_LESS_IS_BETTER},
};
static const struct recommend_metrics roles = {QUALITY, MEMORY, TIME};

struct rig {
    struct sweep sweep;
    struct sweep_point points[MOST_POINTS];
    double measured[MOST_POINTS][METRIC_COUNT][REPEATS];
    struct sweep_recommendation recommendations[RECOMMEND_COUNT];
};

/* Sets the repeats at fixed distances from the mean, in a different order at each point. */
static void set_point(struct rig *rig, uint32_t index, const double means[METRIC_COUNT],
                      double spread)
{
    rig->points[index] = (struct sweep_point){.state = SWEEP_DONE};
    rig->points[index].measured = &rig->measured[index][0][0];
    for (int m = 0; m < METRIC_COUNT; m++)
        for (uint32_t r = 0; r < REPEATS; r++)
            rig->measured[index][m][r] =
                means[m] * (1.0 + spread * ((index + (index < 3 ? r : 2 * r)) % 3 - 1.0));
}

static void init(struct rig *rig, const double (*means)[METRIC_COUNT], uint32_t count)
{
    *rig = (struct rig){
        .sweep = {.metrics = metrics, .metric_count = METRIC_COUNT, .repeats = REPEATS}};
    rig->sweep.points = rig->points;
    rig->sweep.point_count = count;
    for (uint32_t i = 0; i < count; i++)
        set_point(rig, i, means[i], 0.0);
}

static void expect(struct rig *rig, int quality, int balanced, int small)
{
    recommend(&rig->sweep, &roles, rig->recommendations);
    assert_int_equal(rig->recommendations[0].point, quality);
    assert_int_equal(rig->recommendations[1].point, balanced);
    assert_int_equal(rig->recommendations[2].point, small);
    recommend_finish(rig->recommendations);
}

static void each_rule_has_its_own_best_point(void **state)
{
    static const double means[][METRIC_COUNT] = {
        {0.100, 100, 10}, /* the base */
        {0.050, 150, 10}, /* sharper, within twice the memory */
        {0.040, 250, 10}, /* sharper still, for too much memory */
        {0.105, 60, 10},  /* nearly the base's picture for less */
        {0.190, 20, 10},  /* within twice the error */
        {0.250, 10, 10},  /* beyond it */
        {0.180, 15, 20},  /* too slow */
    };
    struct rig rig;
    (void)state;
    init(&rig, means, sizeof means / sizeof *means);
    expect(&rig, 1, 3, 4);
}

static void a_lone_base_is_all_that_is_recommended(void **state)
{
    static const double means[][METRIC_COUNT] = {{0.1, 100, 10}};
    struct rig rig;
    (void)state;
    init(&rig, means, 1);
    expect(&rig, 0, 0, 0);
}

static void failed_and_unmeasured_points_are_not_recommended(void **state)
{
    static const double means[][METRIC_COUNT] = {
        {0.1, 100, 10}, {0.01, 10, 1}, {0.01, 10, 1}, {0.09, 90, 9}};
    struct rig rig;
    (void)state;
    init(&rig, means, 4);
    rig.points[1].state = SWEEP_FAILED;
    for (int r = 0; r < REPEATS; r++)
        rig.measured[2][TIME][r] = NAN;
    expect(&rig, 3, 3, 3);
    rig.points[0].state = SWEEP_FAILED; /* without the base there are no bounds */
    expect(&rig, -1, -1, -1);
}

static void of_equals_the_cheaper_is_taken(void **state)
{
    static const double means[][METRIC_COUNT] = {
        {0.100, 100, 10}, {0.0800, 180, 10}, {0.0805, 120, 10}, {0.0810, 119.9, 10}};
    struct rig rig;
    (void)state;
    init(&rig, means, 4);
    /* 0.0800 and 0.0805 differ by less than 1 %; 0.0810 by more. */
    recommend(&rig.sweep, &roles, rig.recommendations);
    assert_int_equal(rig.recommendations[0].point, 2);
    recommend_finish(rig.recommendations);
    /* With repeats 2 % apart all three figures are equal, and so is the memory of the last two. */
    for (uint32_t i = 0; i < 4; i++)
        set_point(&rig, i, means[i], 0.02);
    recommend(&rig.sweep, &roles, rig.recommendations);
    assert_int_equal(rig.recommendations[0].point, 2);
    recommend_finish(rig.recommendations);
}

static void the_base_stays_where_nothing_is_surely_better(void **state)
{
    static const double means[][METRIC_COUNT] = {
        {0.100, 100, 10}, {0.099, 99, 9.9}, {0.101, 98, 9.8}, {0.098, 101, 10.1}};
    struct rig rig;
    (void)state;
    init(&rig, means, 4);
    for (uint32_t i = 0; i < 4; i++)
        set_point(&rig, i, means[i], 0.05);
    expect(&rig, 0, 0, 0);
}

/* A picture of 40 dB has a tenth of the error of one of 20 dB; 999 dB has none. */
static void decibels_are_compared_as_errors(void **state)
{
    static const struct sweep_metric decibels[METRIC_COUNT] = {
        {"psnr_mean_db", "dB", "", SWEEP_MORE_IS_BETTER},
        {"resident_bytes_peak", "bytes", "", SWEEP_LESS_IS_BETTER},
        {"gpu_ms_median", "ms", "", SWEEP_LESS_IS_BETTER},
    };
    static const double means[][METRIC_COUNT] = {
        {30, 100, 10}, {999, 150, 10}, {29.5, 70, 10}, {24.2, 20, 10}, {23.8, 10, 10}};
    struct rig rig;
    (void)state;
    init(&rig, means, 5);
    rig.sweep.metrics = decibels;
    /* A factor of 1.1 is 0.83 dB, of 2 it is 6.02 dB: 24.2 is within, 23.8 is not. */
    expect(&rig, 1, 2, 3);
    recommend(&rig.sweep, &roles, rig.recommendations);
    assert_non_null(strstr(rig.recommendations[0].rule, "least picture error (psnr_mean_db)"));
    assert_non_null(strstr(rig.recommendations[2].rule, "6 dB above the base's"));
    recommend_finish(rig.recommendations);
}

static void without_a_picture_metric_nothing_is_recommended(void **state)
{
    static const double means[][METRIC_COUNT] = {{0.1, 100, 10}, {0.1, 10, 1}};
    const struct recommend_metrics unknown = {-1, MEMORY, TIME}, timeless = {QUALITY, MEMORY, -1};
    struct rig rig;
    (void)state;
    init(&rig, means, 2);
    recommend(&rig.sweep, &unknown, rig.recommendations);
    for (int i = 0; i < RECOMMEND_COUNT; i++)
        assert_int_equal(rig.recommendations[i].point, -1);
    recommend_finish(rig.recommendations);
    recommend(&rig.sweep, &timeless, rig.recommendations);
    assert_int_equal(rig.recommendations[2].point, 1);
    assert_null(strstr(rig.recommendations[2].rule, "gpu_ms"));
    recommend_finish(rig.recommendations);
}

/* Half as slow again while times are uncertain: uncertainty must not recommend it. */
static void a_slower_point_is_not_balanced_however_noisy_times_are(void **state)
{
    static const double means[][METRIC_COUNT] = {{0.1, 100, 10}, {0.1, 50, 15.2}, {0.1, 80, 11}};
    struct rig rig;
    (void)state;
    init(&rig, means, 3);
    for (uint32_t i = 0; i < 3; i++)
        for (int r = 0; r < REPEATS; r++)
            rig.measured[i][TIME][r] *= r == 0 ? 0.5 : r == 1 ? 1.0 : 4.0;
    recommend(&rig.sweep, &roles, rig.recommendations);
    assert_int_equal(rig.recommendations[1].point, 2);
    recommend_finish(rig.recommendations);
}

/* Seeds and slow hours move both alike. A point that is lower in each repeat is lower. */
static void what_all_repeats_share_hides_no_difference(void **state)
{
    static const double means[][METRIC_COUNT] = {{0.100, 100, 10}, {0.080, 100, 10}};
    struct rig rig;
    (void)state;
    init(&rig, means, 2);
    for (uint32_t i = 0; i < 2; i++)
        for (int r = 0; r < REPEATS; r++)
            rig.measured[i][QUALITY][r] *= 1.0 + r;
    recommend(&rig.sweep, &roles, rig.recommendations);
    assert_int_equal(rig.recommendations[0].point, 1);
    recommend_finish(rig.recommendations);
}

static void repeats_that_do_not_count_are_passed_over(void **state)
{
    static const double means[][METRIC_COUNT] = {{0.1, 100, 10}, {0.1, 50, 10}};
    struct rig rig;
    (void)state;
    init(&rig, means, 2);
    rig.measured[0][TIME][0] = rig.measured[1][TIME][0] = NAN;
    expect(&rig, 1, 1, 1);
}

/* With one repeat, a time 5 % lower does not count, and a figure a third lower does. */
static void a_figure_of_one_run_counts_where_it_is_far_off_but_a_time_never(void **state)
{
    static const double means[][METRIC_COUNT] = {{0.1, 100, 10}, {0.1, 100, 9.5}};
    struct rig rig;
    (void)state;
    init(&rig, means, 2);
    for (uint32_t i = 0; i < 2; i++)
        rig.measured[i][TIME][0] = rig.measured[i][TIME][1] = NAN;
    expect(&rig, 0, 0, 0);
    rig.measured[1][TIME][2] = 6.6;
    expect(&rig, 0, 0, 0);
    for (uint32_t i = 0; i < 2; i++)
        rig.measured[i][MEMORY][0] = rig.measured[i][MEMORY][1] = NAN;
    rig.measured[1][MEMORY][2] = 95;
    expect(&rig, 0, 0, 0);
    rig.measured[1][MEMORY][2] = 60;
    expect(&rig, 1, 1, 1);
}

static void what_nobody_chooses_is_not_recommended(void **state)
{
    static const double means[][METRIC_COUNT] = {{0.1, 100, 10}, {0.05, 50, 5}, {0.09, 90, 9}};
    static const struct sweep_setting settings[] = {{"source-latency", "", "ms", true},
                                                    {"budget", "", "MiB", false}};
    char zero[] = "0", more[] = "20";
    char *base[] = {zero, zero}, *slow_disk[] = {more, zero}, *small[] = {zero, more};
    struct rig rig;
    (void)state;
    init(&rig, means, 3);
    rig.sweep.settings = settings;
    rig.sweep.setting_count = 2;
    rig.points[0].values = base;
    rig.points[1].values = slow_disk;
    rig.points[2].values = small;
    expect(&rig, 2, 2, 2);
}

static uint32_t next_random(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

/* One repeat leaves 10 % of uncertainty. Less memory then does not excuse a worse picture. */
static void what_a_rule_names_is_never_worse_than_the_base(void **state)
{
    static const double means[][METRIC_COUNT] = {
        {0.100, 100, 10}, /* the base */
        {0.107, 40, 10},  /* equal within the uncertainty, and smaller */
        {0.080, 190, 10}, /* surely better for more memory */
        {0.086, 105, 10}, /* equal to the previous one, and smaller */
    };
    struct rig rig;
    (void)state;
    init(&rig, means, 2);
    rig.sweep.repeats = 1;
    for (uint32_t i = 0; i < 4; i++) /* metrics one after another, as there is one repeat */
        for (int m = 0; m < METRIC_COUNT; m++)
            (&rig.measured[i][0][0])[m] = means[i][m];
    expect(&rig, 0, 1, 1);
    rig.points[2] = rig.points[3] = rig.points[1];
    for (uint32_t i = 2; i < 4; i++)
        rig.points[i].measured = &rig.measured[i][0][0];
    rig.sweep.point_count = 4;
    expect(&rig, 3, 1, 1);
}

/* For any measurements and any number of repeats. */
static void no_recommendation_is_below_the_base_in_its_own_figure(void **state)
{
    static const int goals[RECOMMEND_COUNT] = {QUALITY, MEMORY, MEMORY};
    uint32_t seed = 3;
    (void)state;
    for (int round = 0; round < 500; round++) {
        double means[MOST_POINTS][METRIC_COUNT];
        struct rig rig;
        for (uint32_t i = 0; i < 8; i++)
            for (int m = 0; m < METRIC_COUNT; m++)
                means[i][m] = 1.0 + 0.01 * (next_random(&seed) % 30);
        init(&rig, (const double(*)[METRIC_COUNT])means, 8);
        recommend(&rig.sweep, &roles, rig.recommendations);
        for (int r = 0; r < RECOMMEND_COUNT; r++)
            assert_true(means[rig.recommendations[r].point][goals[r]] <= means[0][goals[r]]);
        recommend_finish(rig.recommendations);
    }
}

static void rules_say_what_equal_means(void **state)
{
    static const double means[][METRIC_COUNT] = {{0.1, 100, 10}};
    struct rig rig;
    (void)state;
    init(&rig, means, 1);
    recommend(&rig.sweep, &roles, rig.recommendations);
    assert_non_null(strstr(rig.recommendations[0].rule, "equal: less than 1 % apart"));
    assert_non_null(strstr(rig.recommendations[0].rule, "never more than the base's"));
    recommend_finish(rig.recommendations);
    rig.sweep.repeats = 1;
    recommend(&rig.sweep, &roles, rig.recommendations);
    assert_non_null(strstr(rig.recommendations[0].rule, "equal: less than 10 % apart"));
    recommend_finish(rig.recommendations);
}

static bool is_dominated(const double (*means)[METRIC_COUNT], uint32_t count, uint32_t point)
{
    for (uint32_t i = 0; i < count; i++) {
        bool no_worse = true, better = false;
        for (int m = 0; m < METRIC_COUNT; m++) {
            no_worse = no_worse && means[i][m] <= means[point][m];
            better = better || means[i][m] < 0.98 * means[point][m];
        }
        if (no_worse && better)
            return true;
    }
    return false;
}

static void what_is_recommended_is_never_dominated(void **state)
{
    uint32_t seed = 1;
    (void)state;
    for (int round = 0; round < 500; round++) {
        double means[MOST_POINTS][METRIC_COUNT];
        uint32_t count = 1 + next_random(&seed) % MOST_POINTS;
        for (uint32_t i = 0; i < count; i++)
            for (int m = 0; m < METRIC_COUNT; m++)
                means[i][m] = 1.0 + next_random(&seed) % 30;
        struct rig rig;
        init(&rig, (const double(*)[METRIC_COUNT])means, count);
        recommend(&rig.sweep, &roles, rig.recommendations);
        for (int r = 0; r < RECOMMEND_COUNT; r++) {
            int64_t point = rig.recommendations[r].point;
            if (point >= 0)
                assert_false(
                    is_dominated((const double(*)[METRIC_COUNT])means, count, (uint32_t)point));
        }
        recommend_finish(rig.recommendations);
    }
}

/* Measures again, each repeat within 3 % of the truth. */
static void noise_within_the_intervals_does_not_change_them(void **state)
{
    static const double truth[][METRIC_COUNT] = {
        {0.100, 100, 10}, {0.060, 150, 10}, {0.040, 250, 10}, {0.100, 60, 10}, {0.170, 20, 10}};
    uint32_t seed = 7;
    (void)state;
    for (int round = 0; round < 200; round++) {
        struct rig rig;
        init(&rig, truth, 5);
        for (uint32_t i = 0; i < 5; i++) {
            for (int m = 0; m < METRIC_COUNT; m++)
                for (int r = 0; r < REPEATS; r++)
                    rig.measured[i][m][r] =
                        truth[i][m] * (1.0 + 0.03 * (next_random(&seed) % 2001 / 1000.0 - 1.0));
        }
        expect(&rig, 1, 3, 4);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_rule_has_its_own_best_point),
        cmocka_unit_test(a_lone_base_is_all_that_is_recommended),
        cmocka_unit_test(failed_and_unmeasured_points_are_not_recommended),
        cmocka_unit_test(of_equals_the_cheaper_is_taken),
        cmocka_unit_test(the_base_stays_where_nothing_is_surely_better),
        cmocka_unit_test(a_slower_point_is_not_balanced_however_noisy_times_are),
        cmocka_unit_test(what_all_repeats_share_hides_no_difference),
        cmocka_unit_test(repeats_that_do_not_count_are_passed_over),
        cmocka_unit_test(a_figure_of_one_run_counts_where_it_is_far_off_but_a_time_never),
        cmocka_unit_test(what_nobody_chooses_is_not_recommended),
        cmocka_unit_test(decibels_are_compared_as_errors),
        cmocka_unit_test(without_a_picture_metric_nothing_is_recommended),
        cmocka_unit_test(what_a_rule_names_is_never_worse_than_the_base),
        cmocka_unit_test(no_recommendation_is_below_the_base_in_its_own_figure),
        cmocka_unit_test(rules_say_what_equal_means),
        cmocka_unit_test(what_is_recommended_is_never_dominated),
        cmocka_unit_test(noise_within_the_intervals_does_not_change_them),
    };
    return RUN_TESTS(tests);
}
