/* The host's work for a frame ends in time, by a clock of the test. */
#include "../../samples/demand-pbrt/frame_budget.h"

#include "support/test.h"

struct clock {
    double time;
};

static double read_clock(void *user_data)
{
    return ((const struct clock *)user_data)->time;
}

/** Runs a frame of items and a launch. Returns the number of items; the first one always begins. */
static int run_frame(struct frame_budget *budget, struct clock *clock, double item, double launch,
                     double *seconds)
{
    int count = 0;
    frame_budget_begin(budget);
    while (count < 1000 && (frame_budget_has_time(budget) || count == 0)) {
        clock->time += item;
        count++;
    }
    frame_budget_end_work(budget);
    clock->time += launch;
    *seconds = frame_budget_end(budget);
    return count;
}

static void items_and_launch_fit_into_the_budget(void **state)
{
    (void)state;
    struct clock clock = {5.0};
    struct frame_budget budget = {.seconds = 0.016, .now = read_clock, .user_data = &clock};
    double seconds;
    run_frame(&budget, &clock, 0.001, 0.004, &seconds); /* the launch time is still unknown */
    for (int i = 0; i < 100; i++) {
        const int count = run_frame(&budget, &clock, 0.001, 0.004, &seconds);
        assert_in_range(count, 11, 12);
        assert_true(seconds <= 0.016 + 1e-9);
    }
}

static void a_frame_makes_one_item_when_its_launch_alone_is_too_long(void **state)
{
    (void)state;
    struct clock clock = {0.0};
    struct frame_budget budget = {.seconds = 0.016, .now = read_clock, .user_data = &clock};
    double seconds;
    run_frame(&budget, &clock, 0.001, 0.1, &seconds);
    for (int i = 0; i < 10; i++)
        assert_int_equal(run_frame(&budget, &clock, 0.001, 0.1, &seconds), 1);
}

static void one_long_launch_is_forgotten(void **state)
{
    (void)state;
    struct clock clock = {0.0};
    struct frame_budget budget = {.seconds = 0.016, .now = read_clock, .user_data = &clock};
    double seconds;
    int count = 0;
    run_frame(&budget, &clock, 0.001, 0.4, &seconds);
    for (int i = 0; i < 20; i++)
        count = run_frame(&budget, &clock, 0.001, 0.002, &seconds);
    assert_in_range(count, 12, 14);
}

static void without_a_budget_everything_begins(void **state)
{
    (void)state;
    struct clock clock = {0.0};
    struct frame_budget budget = {.now = read_clock, .user_data = &clock};
    double seconds;
    assert_int_equal(run_frame(&budget, &clock, 1.0, 1.0, &seconds), 1000);
    assert_true(seconds > 1000.9 && seconds < 1001.1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(items_and_launch_fit_into_the_budget),
        cmocka_unit_test(a_frame_makes_one_item_when_its_launch_alone_is_too_long),
        cmocka_unit_test(one_long_launch_is_forgotten),
        cmocka_unit_test(without_a_budget_everything_begins),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
