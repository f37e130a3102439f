/* The copied command line, and the pages that name all keys and options. */
#include "support/test.h"

#include "actions.h"
#include "controls.h"
#include "options.h"
#include "sets.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_WORDS 256

/* Another value than the default, as a user would write it. */
static void choose_value(const struct option *option, char *text, size_t size)
{
    const char *last = option->operand ? strrchr(option->operand, '|') : NULL;
    switch (option->kind) {
    case OPTION_CHOICE:
        assert_non_null(last);
        snprintf(text, size, "%s", last + 1);
        if (strcmp(text, option->initial) == 0)
            snprintf(text, size, "%.*s", (int)strcspn(option->operand, "|"), option->operand);
        break;
    case OPTION_UINT:
        snprintf(text, size, "%.0f",
                 option->minimum + (atof(option->initial) == option->minimum + 2 ? 3 : 2));
        break;
    case OPTION_EXTENT: snprintf(text, size, "320x200"); break;
    case OPTION_BYTES: snprintf(text, size, "123"); break;
    default: snprintf(text, size, "%.9g", option->minimum + 0.123456789); break;
    }
}

static enum option_outcome read_command(char *line, struct view_options *options)
{
    char *words[MAX_WORDS];
    int count = 0;
    for (char *word = strtok(line, " "); word && count < MAX_WORDS; word = strtok(NULL, " "))
        words[count++] = word;
    assert_true(count < MAX_WORDS);
    return options_read(count, words, options);
}

static void options_replace_kept_settings_also_by_their_default(void **state)
{
    (void)state;
    struct view_options options;
    struct view_settings kept;
    char line[] = "sluice-view --budget 0 --anisotropy=4";
    assert_int_equal(read_command(line, &options), OPTIONS_RUN);
    controls_set_defaults(&kept);
    kept.budget = 64u << 20;
    kept.anisotropy = 2;
    kept.standby = 7;
    controls_take_given(&options.settings, options.given, &kept);
    assert_int_equal(kept.budget, 0);
    assert_int_equal(kept.anisotropy, 4);
    assert_int_equal(kept.standby, 7);
}

static void every_setting_and_the_camera_come_back_from_the_copied_command(void **state)
{
    (void)state;
    static struct view_app app; /* large */
    static char line[16384], value[64];
    uint32_t count;
    int nothing;
    struct view_options options;
    struct view_camera camera;
    const struct control *controls = controls_get(&count);
    app.program = "sluice-view --room";
    controls_set_defaults(&app.settings);
    for (uint32_t i = 0; i < count; i++) {
        choose_value(&controls[i].option, value, sizeof value);
        assert_true(controls_set(&app.settings, controls[i].option.name, value, "t"));
        if (control_is_default(&controls[i], &app.settings))
            fail_msg("--%s %s is the default", controls[i].option.name, value);
    }
    app.b = app.settings;
    app.camera = (struct view_camera){
        .position = {0.1f, -2.3f, 4e-5f}, .yaw = 1.0f / 3, .pitch = -0.7f, .fov = 1.2f};
    app.stage = (struct stage *)(void *)&nothing; /* there is one */
    app_write_command(&app, line, sizeof line);
    assert_int_equal(read_command(line, &options), OPTIONS_RUN);
    assert_true(options.room);
    assert_true(options.fresh); /* settings that were kept are not defaults */
    assert_memory_equal(&options.settings, &app.settings, sizeof app.settings);
    assert_true(view_camera_read(options.camera, &camera));
    assert_memory_equal(&camera, &app.camera, sizeof camera);
}

/* A has other values than the defaults, and B the defaults: nothing may be left out. */
static void every_setting_of_b_comes_back_from_the_copied_command(void **state)
{
    (void)state;
    static struct view_app app;
    static char line[16384], value[64];
    uint32_t count, written = 0;
    struct view_options options;
    struct view_settings b;
    const struct control *controls = controls_get(&count);
    app.program = "sluice-view --room";
    controls_set_defaults(&app.settings);
    controls_set_defaults(&app.b);
    app.settings.compared = VIEW_WITH_B;
    for (uint32_t i = 0; i < count; i++) {
        if (!control_is_of_sets(&controls[i]))
            continue;
        choose_value(&controls[i].option, value, sizeof value);
        assert_true(controls_set(&app.settings, controls[i].option.name, value, "t"));
        written++;
    }
    assert_true(written > 15);
    app_write_command(&app, line, sizeof line);
    assert_int_equal(read_command(line, &options), OPTIONS_RUN);
    assert_int_equal(options.settings.compared, VIEW_WITH_B);
    b = options.settings;
    for (size_t i = 0; i < options.b.count; i++)
        assert_true(sets_read(&b, options.b.items[i], "t"));
    assert_int_equal(options.b.count, 1);
    for (uint32_t i = 0; i < count; i++)
        if (control_is_of_sets(&controls[i]) && !control_is_default(&controls[i], &b))
            fail_msg("%s of B is not the default", controls[i].option.name);
}

static void names_and_values_that_b_does_not_have_are_refused(void **state)
{
    (void)state;
    static const char *const wrong[] = {
        "bugdet=16", "budget=2",  "budget",          "=16",
        "view=3",    "pause=on",  "probability=2",   "budget=16,,fade=0",
        "load=some", "fade=0 16", "budget=16;fade=0"};
    struct view_options options;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char program[] = "sluice-view", option[] = "--b", text[64];
        char *words[] = {program, option, text};
        snprintf(text, sizeof text, "%s", wrong[i]);
        if (options_read(3, words, &options) != OPTIONS_ERROR)
            fail_msg("--b %s was taken", wrong[i]);
    }
    char twice[] = "sluice-view --b budget=16,fade=0 --b probability=1/512";
    assert_int_equal(read_command(twice, &options), OPTIONS_RUN);
    assert_int_equal(options.b.count, 2);
}

static void a_camera_that_moves_is_not_in_the_command(void **state)
{
    (void)state;
    static struct view_app app;
    char line[256];
    int nothing;
    app.program = "sluice-view scene.gltf";
    app.stage = (struct stage *)(void *)&nothing;
    app.follow = FOLLOW_TOUR;
    controls_set_defaults(&app.settings);
    app_write_command(&app, line, sizeof line);
    assert_string_equal(line, "sluice-view scene.gltf --fresh");
}

static void wrong_cameras_are_refused(void **state)
{
    (void)state;
    static const char *const wrong[] = {"",           "1,2,3,4,5",  "1,2,3,4,5,0",   "1,2,3,4,5,1,",
                                        "1,2,3,4,5,", "1,,2,3,4,1", "1,2,3,4,nan,1", "1;2;3;4;5;1"};
    struct view_camera camera;
    struct view_options options;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        if (view_camera_read(wrong[i], &camera))
            fail_msg("\"%s\" was taken", wrong[i]);
    char line[] = "sluice-view --room --camera 1,2";
    assert_int_equal(read_command(line, &options), OPTIONS_ERROR);
}

static void every_control_says_what_it_is(void **state)
{
    (void)state;
    uint32_t count;
    const struct control *controls = controls_get(&count);
    for (uint32_t i = 0; i < count; i++)
        if (!controls[i].group || !controls[i].label || !controls[i].option.help ||
            strlen(controls[i].option.help) < 10)
            fail_msg("--%s has no sentence", controls[i].option.name);
}

/* A chord that is in the table twice would do one of both. */
static void no_key_means_two_things(void **state)
{
    (void)state;
    uint32_t count;
    const struct action *actions = actions_get(&count);
    for (uint32_t i = 0; i < count; i++) {
        struct view_chord a, b;
        if (!actions[i].chord)
            continue;
        assert_true(view_chord_read(actions[i].chord, &a));
        for (uint32_t k = 0; k < i; k++)
            if (actions[k].chord && view_chord_read(actions[k].chord, &b) && a.key == b.key &&
                a.modifiers == b.modifiers)
                fail_msg("%s means \"%s\" and \"%s\"", actions[i].chord, actions[k].words,
                         actions[i].words);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(options_replace_kept_settings_also_by_their_default),
        cmocka_unit_test(every_setting_and_the_camera_come_back_from_the_copied_command),
        cmocka_unit_test(every_setting_of_b_comes_back_from_the_copied_command),
        cmocka_unit_test(names_and_values_that_b_does_not_have_are_refused),
        cmocka_unit_test(a_camera_that_moves_is_not_in_the_command),
        cmocka_unit_test(wrong_cameras_are_refused),
        cmocka_unit_test(every_control_says_what_it_is),
        cmocka_unit_test(no_key_means_two_things),
    };
    return RUN_TESTS(tests);
}
