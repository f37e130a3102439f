/* Means of a few repeats: Student's t against tables and against its density. */
#include "support/test.h"

#include <math.h>

#include "statistics.h"

/* Abramowitz and Stegun, table 26.10, with more digits. */
static void student_t_is_that_of_tables(void **state)
{
    static const struct {
        uint32_t degrees;
        double confidence, t;
    } rows[] = {
        {1, 0.95, 12.7062047362},
        {2, 0.95, 4.30265272991},
        {3, 0.95, 3.18244630528},
        {4, 0.95, 2.77644510520},
        {5, 0.95, 2.57058183661},
        {9, 0.95, 2.26215716280},
        {10, 0.95, 2.22813885196},
        {30, 0.95, 2.04227245630},
        {100, 0.95, 1.98397151845},
        {120, 0.95, 1.97993040505},
        {5, 0.99, 4.03214298356},
        {7, 0.90, 1.89457860506},
        {1, 0.5, 1.0},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        double t = statistics_student_t(rows[i].degrees, rows[i].confidence);
        if (fabs(t - rows[i].t) > 1e-8 * rows[i].t)
            fail_msg("t of %u degrees is %.12g, not %.12g", rows[i].degrees, t, rows[i].t);
    }
}

/* Integrates the density (1 + t^2 / n)^(-(n + 1) / 2), divided by sqrt(n pi) gamma(n/2) /
 * gamma((n+1)/2). */
static double chance_within(double t, uint32_t degrees)
{
    const int steps = 20000; /* Simpson's rule */
    double n = degrees, sum = 0.0, step = t / steps;
    for (int i = 0; i <= steps; i++) {
        double x = i * step, weight = i == 0 || i == steps ? 1.0 : i % 2 ? 4.0 : 2.0;
        sum += weight * exp(-0.5 * (n + 1.0) * log1p(x * x / n));
    }
    return 2.0 * sum * step / 3.0 * exp(lgamma(0.5 * (n + 1.0)) - lgamma(0.5 * n)) /
           sqrt(n * 3.14159265358979323846);
}

static void density_within_t_integrates_to_the_confidence(void **state)
{
    (void)state;
    for (uint32_t degrees = 1; degrees <= 60; degrees++) {
        double t = statistics_student_t(degrees, 0.95);
        assert_true(fabs(chance_within(t, degrees) - 0.95) < 1e-9);
    }
}

static void many_degrees_give_the_normal_distribution(void **state)
{
    (void)state;
    assert_true(fabs(statistics_student_t(1000000, 0.95) - 1.95996398454) < 1e-5);
}

/* 2, 4, 4, 4, 5, 5, 7, 9: mean 5, squares of deviations 32. */
static void interval_is_t_standard_errors_wide(void **state)
{
    const double values[] = {2, 4, 4, 4, 5, 5, 7, 9};
    (void)state;
    struct sweep_estimate e = statistics_estimate(values, 8);
    assert_int_equal(e.count, 8);
    assert_true(e.mean == 5.0 && e.least == 2.0 && e.most == 9.0);
    assert_true(fabs(e.half_width - 2.36462425159 * sqrt(32.0 / 7.0 / 8.0)) < 1e-9);
}

static void equal_values_have_no_interval(void **state)
{
    const double values[] = {0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1};
    (void)state;
    for (uint32_t count = 2; count <= 7; count++) {
        struct sweep_estimate e = statistics_estimate(values, count);
        assert_true(e.mean == 0.1 && e.half_width == 0.0);
    }
}

static void one_value_has_a_mean_and_no_known_interval(void **state)
{
    const double value = 3.0;
    (void)state;
    struct sweep_estimate e = statistics_estimate(&value, 1);
    assert_true(e.mean == 3.0 && e.least == 3.0 && e.most == 3.0 && isnan(e.half_width));
    e = statistics_estimate(&value, 0);
    assert_true(isnan(e.mean) && isnan(e.half_width) && isnan(e.least) && isnan(e.most));
    assert_int_equal(e.count, 0);
}

static void repeats_without_the_figure_do_not_count(void **state)
{
    const double values[] = {NAN, 1.0, NAN, 3.0};
    (void)state;
    struct sweep_estimate e = statistics_estimate(values, 4);
    assert_int_equal(e.count, 2);
    assert_true(e.mean == 2.0);
    assert_true(fabs(e.half_width - 12.7062047362 * sqrt(2.0 / 2.0)) < 1e-9);
}

static void differences_do_not_show_what_both_share(void **state)
{
    const double base[] = {10.0, 20.0, NAN, 50.0}, values[] = {11.0, 21.0, 7.0, 51.0};
    (void)state;
    struct sweep_estimate e = statistics_paired(values, base, 4);
    assert_int_equal(e.count, 3);
    assert_true(e.mean == 1.0 && e.half_width == 0.0);
}

/* Errors of 1e-4, 1e-4 and none: two thirds of 1e-4, and 999 is far from all of them. */
static void pictures_without_error_do_not_lift_a_mean_of_decibels(void **state)
{
    const double values[] = {40.0, 999.0, 40.0, NAN}, equal[] = {999.0, 999.0}, far[] = {30, 40};
    (void)state;
    struct sweep_estimate e = statistics_decibels(values, 4);
    assert_int_equal(e.count, 3);
    assert_true(fabs(e.mean - 41.7609125906) < 1e-9);
    assert_true(e.least == 40.0 && e.most == 999.0);
    /* 4.30265 standard errors of 1e-4 / 3, of a mean of 2e-4 / 3 */
    assert_true(fabs(e.half_width - 4.34294481903 * 4.30265272991 / 2.0) < 1e-6);
    assert_true(statistics_decibels(equal, 2).mean == 999.0);
    assert_true(statistics_decibels(equal, 2).half_width == 0.0);
    assert_true(statistics_decibels(far, 2).mean == 35.0);
}

static void no_decibels_lie_between_some_error_and_none(void **state)
{
    const double base[] = {30.0, 999.0, 999.0, 40.0}, values[] = {999.0, 50.0, 999.0, 41.0};
    (void)state;
    struct sweep_estimate e = statistics_paired_decibels(values, base, 4);
    assert_int_equal(e.count, 2);
    assert_true(e.least == 0.0 && e.most == 1.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(student_t_is_that_of_tables),
        cmocka_unit_test(density_within_t_integrates_to_the_confidence),
        cmocka_unit_test(many_degrees_give_the_normal_distribution),
        cmocka_unit_test(interval_is_t_standard_errors_wide),
        cmocka_unit_test(equal_values_have_no_interval),
        cmocka_unit_test(one_value_has_a_mean_and_no_known_interval),
        cmocka_unit_test(repeats_without_the_figure_do_not_count),
        cmocka_unit_test(differences_do_not_show_what_both_share),
        cmocka_unit_test(pictures_without_error_do_not_lift_a_mean_of_decibels),
        cmocka_unit_test(no_decibels_lie_between_some_error_and_none),
    };
    return RUN_TESTS(tests);
}
