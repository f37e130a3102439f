/* Points of a sweep, and their labels. */
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

#include "help_text.h"
#include "plan.h"

static char help[] = "streaming [OPTION ...]\n\nWords about --nothing [3].\n\nStreaming\n"
                     "  --probability P             that a pixel quad writes [0.0625]\n"
                     "  --lattice                   one pixel in 8x8 writes\n"
                     "  --budget MIB                MiB for tiles at most,\n"
                     "                              in heaps [of 16] [0]\n"
                     "  --residency auto|sparse|paged|dense\n"
                     "                              what makes texels resident [auto]\n"
                     "  --fade=SECONDS              until sharp\n"
                     "  --standby N                 tiles kept (in memory) [1000]\n"
                     "  --in-turns                  one frame (see there)\n"
                     "  --cache DIR                 where pictures are kept (in the\n"
                     "                              home folder)\n"
                     "  --strange NAME              not in the scene's list [a b]\n\nNext\n"
                     "  --help                      this text\n";

static char word[] = "scene", *words[] = {word, NULL};
static const struct program program = {.arguments = {words, 1, 2}, .help = help};

struct plan {
    struct options options;
    struct sweep sweep;
};

static bool build(struct plan *plan, const char *sweeps, const char *bases, bool grid)
{
    *plan = (struct plan){.options = {.scene = &scene_gallery, .grid = grid}};
    if (*sweeps)
        text_list_add_parts(&plan->options.sweeps, sweeps, ' ');
    if (*bases)
        text_list_add_parts(&plan->options.bases, bases, ' ');
    return plan_build(&plan->options, &scene_gallery, &program, &plan->sweep);
}

static void drop(struct plan *plan)
{
    struct sweep *sweep = &plan->sweep;
    for (uint32_t i = 0; i < sweep->point_count; i++) {
        for (uint32_t k = 0; k < sweep->setting_count; k++)
            free(sweep->points[i].values[k]);
        free(sweep->points[i].values);
        free(sweep->points[i].label);
    }
    for (uint32_t k = 0; k < sweep->setting_count; k++) {
        free((void *)(uintptr_t)sweep->settings[k].name);
        free((void *)(uintptr_t)sweep->settings[k].meaning);
        free((void *)(uintptr_t)sweep->settings[k].unit);
    }
    free((void *)(uintptr_t)sweep->settings);
    free(sweep->points);
    options_finish(&plan->options);
}

static void expect_labels(const struct plan *plan, const char *const *labels, uint32_t count)
{
    assert_int_equal(plan->sweep.point_count, count);
    for (uint32_t i = 0; i < count; i++)
        assert_string_equal(plan->sweep.points[i].label, labels[i]);
}

static void expect_entry(const char *name, const char *operand, const char *meaning,
                         const char *default_value)
{
    struct help_entry entry;
    assert_true(help_text_find(help, name, &entry));
    assert_string_equal(entry.operand, operand);
    assert_string_equal(entry.meaning, meaning);
    assert_string_equal(entry.default_value, default_value);
    help_entry_finish(&entry);
}

static void help_text_says_what_an_option_takes_means_and_is(void **state)
{
    struct help_entry entry;
    (void)state;
    expect_entry("probability", "P", "that a pixel quad writes", "0.0625");
    expect_entry("lattice", "", "one pixel in 8x8 writes", "");
    expect_entry("budget", "MIB", "MiB for tiles at most, in heaps [of 16]", "0");
    expect_entry("residency", "auto|sparse|paged|dense", "what makes texels resident", "auto");
    expect_entry("fade", "SECONDS", "until sharp", "");
    expect_entry("standby", "N", "tiles kept (in memory)", "1000");
    expect_entry("cache", "DIR", "where pictures are kept", "");
    expect_entry("in-turns", "", "one frame (see there)", "");
    expect_entry("help", "", "this text", "");
    assert_false(help_text_find(help, "nothing", &entry));
    assert_false(help_text_find(help, "bud", &entry));
    assert_false(help_text_find(help, "", &entry));
    assert_false(help_text_find("", "budget", &entry));
}

static void each_value_is_tried_around_the_base(void **state)
{
    static const char *const labels[] = {"base", "probability 1/4", "probability 1/64", "budget 8",
                                         "lattice on"};
    struct plan plan;
    (void)state;
    assert_true(build(&plan, "probability=1/4,1/64 budget=8 lattice=on", "", false));
    expect_labels(&plan, labels, 5);
    assert_int_equal(plan.sweep.base, 0);
    drop(&plan);
}

static void base_and_what_was_there_are_not_tried_twice(void **state)
{
    static const char *const labels[] = {"base", "probability 0.25", "budget 8"};
    struct plan plan;
    (void)state;
    assert_true(build(&plan, "probability=0.25,1/16,0.0625,1/4 budget=0,8,8.0", "", false));
    expect_labels(&plan, labels, 3);
    drop(&plan);
}

static void grid_is_the_product_with_the_base_on_each_axis(void **state)
{
    static const char *const labels[] = {
        "base",
        "budget 16",
        "budget 8",
        "lattice on",
        "lattice on, budget 16",
        "lattice on, budget 8",
    };
    struct plan plan;
    (void)state;
    assert_true(build(&plan, "lattice=on budget=16,8", "", true));
    expect_labels(&plan, labels, 6);
    drop(&plan);
}

static void base_can_be_another(void **state)
{
    static const char *const labels[] = {"base", "probability 1/16"};
    struct text_list arguments = {0};
    struct plan plan;
    (void)state;
    assert_true(build(&plan, "probability=1/16,1/8", "probability=1/8 lattice=on fade=0.5", false));
    expect_labels(&plan, labels, 2);
    plan_add_arguments(&plan.sweep, &plan.sweep.points[1], &program, &arguments);
    char *line = text_list_join(&arguments);
    assert_string_equal(line, "--probability 1/16 --lattice --standby 1024 --budget 0 "
                              "--residency auto --fade 0.5");
    free(line);
    text_list_finish(&arguments);
    drop(&plan);
}

/* Settings that the program lacks are left out. Options known from --help alone can be swept. */
static void settings_are_those_of_the_program(void **state)
{
    static const char *const labels[] = {"base", "strange c d"};
    struct plan plan = {.options = {.scene = &scene_gallery}};
    (void)state;
    text_list_add(&plan.options.sweeps, "strange=c d");
    assert_true(plan_build(&plan.options, &scene_gallery, &program, &plan.sweep));
    expect_labels(&plan, labels, 2);
    const struct sweep_setting *last = &plan.sweep.settings[plan.sweep.setting_count - 1];
    assert_string_equal(last->name, "strange");
    assert_string_equal(last->meaning, "not in the scene's list");
    assert_string_equal(plan.sweep.points[0].values[plan.sweep.setting_count - 1], "a b");
    for (uint32_t i = 0; i < plan.sweep.setting_count; i++)
        assert_string_not_equal(plan.sweep.settings[i].name, "timeout");
    drop(&plan);
}

/* The gallery's plan, as far as this program has the options. Its grid names an option that the
 * program lacks. */
static void built_in_plans_keep_to_what_the_program_has(void **state)
{
    static const char *const quick[] = {
        "base",      "probability 1/4", "probability 1/64", "probability 1/256", "lattice on",
        "standby 0", "budget 8",        "budget 16",        "residency paged"};
    struct plan plan;
    (void)state;
    assert_true(build(&plan, "", "", false));
    expect_labels(&plan, quick, sizeof quick / sizeof *quick);
    drop(&plan);
    plan = (struct plan){.options = {.scene = &scene_gallery, .full = true}};
    assert_true(plan_build(&plan.options, &scene_gallery, &program, &plan.sweep));
    assert_true(plan.sweep.point_count > sizeof quick / sizeof *quick);
    for (uint32_t i = 0; i < plan.sweep.point_count; i++)
        assert_null(strchr(plan.sweep.points[i].label, ','));
    drop(&plan);
}

static void what_cannot_be_meant_is_refused(void **state)
{
    static const char *const sweeps[] = {"nothing=1", "budget",    "budget=",     "=1",
                                         "budget=1,", "budget=,1", "lattice=yes", "bud=1"};
    struct plan plan;
    (void)state;
    for (size_t i = 0; i < sizeof sweeps / sizeof *sweeps; i++) {
        if (build(&plan, sweeps[i], "", false))
            fail_msg("taken: --sweep %s", sweeps[i]);
        drop(&plan);
        assert_false(build(&plan, sweeps[i], "", true));
        drop(&plan);
    }
    assert_false(build(&plan, "", "budget=", false));
    drop(&plan);
    assert_false(build(&plan, "", "nothing=1", false));
    drop(&plan);
}

static void grids_beyond_all_measure_are_refused(void **state)
{
    struct plan plan;
    (void)state;
    assert_false(build(&plan,
                       "budget=1,2,3,4,5,6,7,8,9 standby=1,2,3,4,5,6,7,8,9 "
                       "fade=1,2,3,4,5,6,7,8,9 strange=1,2,3,4,5,6,7,8,9 "
                       "probability=0.1,0.2",
                       "", true));
    assert_true(plan.sweep.point_count <= 1000);
    drop(&plan);
}

static void values_are_compared_as_numbers(void **state)
{
    (void)state;
    assert_true(plan_same_value("1/16", "0.0625"));
    assert_true(plan_same_value("8", "8.0"));
    assert_true(plan_same_value("auto", "auto"));
    assert_false(plan_same_value("1/16", "1/17"));
    assert_false(plan_same_value("auto", "8"));
    assert_false(plan_same_value("", "0"));
    assert_false(plan_same_value("1/0", "2/0"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(help_text_says_what_an_option_takes_means_and_is),
        cmocka_unit_test(each_value_is_tried_around_the_base),
        cmocka_unit_test(base_and_what_was_there_are_not_tried_twice),
        cmocka_unit_test(grid_is_the_product_with_the_base_on_each_axis),
        cmocka_unit_test(base_can_be_another),
        cmocka_unit_test(settings_are_those_of_the_program),
        cmocka_unit_test(built_in_plans_keep_to_what_the_program_has),
        cmocka_unit_test(what_cannot_be_meant_is_refused),
        cmocka_unit_test(grids_beyond_all_measure_are_refused),
        cmocka_unit_test(values_are_compared_as_numbers),
    };
    return RUN_TESTS(tests);
}
