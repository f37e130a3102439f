/** How long regions wait for their detail: short runs, written down frame by frame. */
#include "support/test.h"

#include "streaming/needs_wait.h"

#include <math.h>
#include <string.h>

#include "sluice/shared/texture_table.h"

/*
 * A run of one region: per frame what it needs and what is shown, in digits; '.' is untouched, or
 * nothing shown, and '+' a level on its way to 0.
 */
static struct needs_wait run(const char *needed, const char *shown)
{
    struct needs_wait wait;
    assert_int_equal(strlen(needed), strlen(shown));
    assert_true(needs_wait_begin(&wait, 1));
    for (size_t i = 0; needed[i]; i++) {
        uint8_t level = needed[i] == '.' ? SLUICE_MIP_UNTOUCHED : (uint8_t)(needed[i] - '0');
        uint16_t texel = SLUICE_SHOWN_NOTHING;
        if (shown[i] == '+')
            texel = 17;
        else if (shown[i] != '.')
            texel = (uint16_t)((shown[i] - '0') * SLUICE_SHOWN_STEPS +
                               (shown[i] == '0' ? 0 : SLUICE_SHOWN_MARGIN));
        assert_true(needs_wait_add_frame(&wait, &level, &texel));
    }
    assert_true(needs_wait_end(&wait));
    return wait;
}

static void check(const char *needed, const char *shown, uint64_t count, uint64_t unmet,
                  double shortest, double longest)
{
    struct needs_wait wait = run(needed, shown);
    assert_int_equal(wait.count, count);
    assert_int_equal(wait.unmet, unmet);
    assert_true(needs_wait_quantile(&wait, 0.0) == shortest);
    assert_true(needs_wait_quantile(&wait, 1.0) == longest);
    needs_wait_finish(&wait);
}

static void a_wait_lasts_until_its_level_is_shown(void **state)
{
    (void)state;
    check("22222", "44322", 1, 0, 3, 3);
    check("22222", "44100", 1, 0, 2, 2);
    check("..222", "4432.", 1, 0, 1, 1);
}

static void what_is_shown_at_once_is_a_wait_of_0(void **state)
{
    (void)state;
    check("33", "33", 1, 0, 0, 0);
    check("3.3", "000", 2, 0, 0, 0);
}

static void a_level_on_its_way_is_not_shown_yet(void **state)
{
    (void)state;
    check("0000", "1+++", 1, 1, 4, 4);
    check("0000", "1++0", 1, 0, 3, 3);
    check("1111", "2+11", 1, 0, 1, 1);
}

static void a_wait_that_nobody_needs_any_more_counts_as_long_as_it_was(void **state)
{
    (void)state;
    check("22...", "44444", 1, 1, 2, 2);
    check("2233", "4433", 1, 1, 2, 2);
    check("222", "444", 1, 1, 3, 3);
}

static void a_finer_need_is_a_wait_of_its_own_beside_the_coarser(void **state)
{
    (void)state;
    check("444222222", "999994422", 2, 0, 4, 5);
    check("4422", "4422", 2, 0, 0, 0);
}

static void a_coarser_need_is_no_wait(void **state)
{
    (void)state;
    check("2234", "2234", 1, 0, 0, 0);
    check("23232", "22222", 3, 0, 0, 0);
}

static void quantiles_and_the_mean_are_those_of_all_waits(void **state)
{
    (void)state;
    /* A region per wait: 0 waits 0 frames, 1 waits 1, ..., 9 waits 9. */
    struct needs_wait wait;
    uint8_t levels[10] = {0};
    uint16_t shown[10];
    assert_true(needs_wait_begin(&wait, 10));
    for (uint32_t frame = 0; frame < 10; frame++) {
        for (uint32_t i = 0; i < 10; i++)
            shown[i] = i <= frame ? 0 : 300;
        assert_true(needs_wait_add_frame(&wait, levels, shown));
    }
    assert_true(needs_wait_end(&wait));
    assert_int_equal(wait.count, 10);
    assert_int_equal(wait.unmet, 0);
    assert_true(needs_wait_quantile(&wait, 0.5) == 4);
    assert_true(needs_wait_quantile(&wait, 0.51) == 5);
    assert_true(needs_wait_quantile(&wait, 0.99) == 9);
    assert_true(needs_wait_mean(&wait) == 4.5);
    needs_wait_finish(&wait);
}

static void a_run_that_needs_nothing_has_no_quantiles(void **state)
{
    (void)state;
    struct needs_wait wait = run("....", "0123");
    assert_int_equal(wait.count, 0);
    assert_true(isnan(needs_wait_quantile(&wait, 0.5)));
    assert_true(isnan(needs_wait_mean(&wait)));
    needs_wait_finish(&wait);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_wait_lasts_until_its_level_is_shown),
        cmocka_unit_test(what_is_shown_at_once_is_a_wait_of_0),
        cmocka_unit_test(a_level_on_its_way_is_not_shown_yet),
        cmocka_unit_test(a_wait_that_nobody_needs_any_more_counts_as_long_as_it_was),
        cmocka_unit_test(a_finer_need_is_a_wait_of_its_own_beside_the_coarser),
        cmocka_unit_test(a_coarser_need_is_no_wait),
        cmocka_unit_test(quantiles_and_the_mean_are_those_of_all_waits),
        cmocka_unit_test(a_run_that_needs_nothing_has_no_quantiles),
    };
    return RUN_TESTS(tests);
}
