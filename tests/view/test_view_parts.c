/* mkdtemp */
#define _XOPEN_SOURCE 700

#include "support/test.h"

#include "budget_need.h"
#include "camera.h"
#include "controls.h"
#include "half_times.h"
#include "keys.h"
#include "mark_words.h"
#include "pbrt_frame.h"
#include "script.h"
#include "sets.h"
#include "settings_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char folder[] = "/tmp/view-parts-XXXXXX";

static void path_in_folder(const char *name, char path[128])
{
    snprintf(path, 128, "%s/%s", folder, name);
}

static void write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

static void a_click_is_a_move_and_a_button_that_is_held_for_a_frame(void **state)
{
    (void)state;
    struct script script;
    assert_true(script_parse("s", "# begin\n10 click 3 4 right\n", &script));
    assert_int_equal(script.count, 3);
    const struct script_step *step = script_next(&script, 10);
    assert_int_equal(step->kind, SCRIPT_MOVE);
    assert_float_equal(step->x, 3, 0);
    assert_null(script_next(&script, 10));
    step = script_next(&script, 11);
    assert_true(step->kind == SCRIPT_BUTTON && step->number == 1 && step->down);
    assert_null(script_next(&script, 11));
    step = script_next(&script, 12);
    assert_true(step->kind == SCRIPT_BUTTON && step->number == 1 && !step->down);
    assert_int_equal(script_last_frame(&script), 12);
    script_finish(&script);
}

static void a_drag_ends_where_it_is_to_end(void **state)
{
    (void)state;
    struct script script;
    float x = 0, y = 0;
    bool down = false;
    assert_true(script_parse("s", "0 drag 10 20 50 -20 4\n", &script));
    for (uint32_t frame = 0; frame <= script_last_frame(&script); frame++)
        for (const struct script_step *step; (step = script_next(&script, frame));) {
            if (step->kind == SCRIPT_BUTTON)
                down = step->down;
            else
                x = step->x, y = step->y;
            if (frame == 3)
                assert_true(down);
        }
    assert_false(down);
    assert_float_equal(x, 50, 0);
    assert_float_equal(y, -20, 0);
    script_finish(&script);
}

static void lines_of_scripts_are_put_in_order_of_frames(void **state)
{
    (void)state;
    struct script script;
    assert_true(script_parse("s", "9 quit\n3 set budget 16\n3 key Shift+R\n", &script));
    const struct script_step *step = script_next(&script, 3);
    assert_int_equal(step->kind, SCRIPT_SET);
    assert_string_equal(step->text, "budget");
    assert_string_equal(step->value, "16");
    step = script_next(&script, 3);
    assert_true(step->kind == SCRIPT_KEY && step->number == VIEW_KEY_SHIFT && step->down);
    step = script_next(&script, 3);
    assert_true(step->kind == SCRIPT_KEY && step->number == 'R' && step->down);
    script_finish(&script);
}

static void wrong_scripts_are_refused(void **state)
{
    (void)state;
    static const char *const wrong[] = {
        "x key 3",     "1 kei 3",      "1 key",      "1 key 33",      "1 click 3",
        "1 click a b", "1 drag 1 2 3", "1 wheel",    "1 set budget",  "1 quit now",
        "1 reset all", "-1 key 3",     "1 hold a 0", "1 click 1e9 3", "99999999999 quit"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        struct script script;
        assert_false(script_parse("wrong", wrong[i], &script));
        assert_null(script.steps);
    }
}

static void scripts_of_the_page_are_read(void **state)
{
    (void)state;
    static const char *const names[] = {"blurry", "budget", "cut",       "driver", "feedback",
                                        "file",   "memory", "reproduce", "thrash", "unseen"};
    char path[512];
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        struct script script;
        snprintf(path, sizeof path, "%s/docs/viewer/%s.txt", getenv("SLUICE_SOURCE_ROOT"),
                 names[i]);
        assert_true(script_read(path, &script));
        assert_true(script.count > 0);
        script_finish(&script);
    }
}

static void keys_have_names(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        int key;
        unsigned modifiers;
    } known[] = {{"3", '3', 0},
                 {"a", 'A', 0},
                 {"F12", VIEW_KEY_F12, 0},
                 {"Shift+R", 'R', VIEW_SHIFT},
                 {"Ctrl-q", 'Q', VIEW_CONTROL},
                 {"space", VIEW_KEY_SPACE, 0},
                 {"[", '[', 0},
                 {"Ctrl+Alt+-", '-', VIEW_CONTROL | VIEW_ALT}};
    struct view_chord chord;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        assert_true(view_chord_read(known[i].text, &chord));
        assert_int_equal(chord.key, known[i].key);
        assert_int_equal(chord.modifiers, known[i].modifiers);
    }
    assert_false(view_chord_read("F13", &chord));
    assert_false(view_chord_read("Shift+", &chord));
    assert_false(view_chord_read("", &chord));
}

static void what_a_control_writes_it_reads(void **state)
{
    (void)state;
    uint32_t count;
    const struct control *controls = controls_get(&count);
    struct view_settings settings, other;
    char text[64], again[64];
    controls_set_defaults(&settings);
    assert_true(controls_set(&settings, "budget", "4100K", "t"));
    assert_true(controls_set(&settings, "fade", "250ms", "t"));
    assert_true(controls_set(&settings, "compare-as", "flicker", "t"));
    assert_true(controls_set(&settings, "size", "320x200", "t"));
    controls_set_defaults(&other);
    for (uint32_t i = 0; i < count; i++) {
        control_write(&controls[i], &settings, text, sizeof text);
        assert_true(controls_set(&other, controls[i].option.name, text, "t"));
        assert_string_equal(control_write(&controls[i], &other, again, sizeof again), text);
    }
    assert_int_equal(other.budget, 4198400);
    assert_int_equal(other.compare, VIEW_FLICKER);
}

static void the_command_has_what_is_not_the_default(void **state)
{
    (void)state;
    struct view_settings settings;
    char text[256];
    controls_set_defaults(&settings);
    controls_write_command(&settings, text, sizeof text);
    assert_string_equal(text, "");
    settings.budget = 64u << 20;
    settings.view = VIEW_MISSING;
    controls_write_command(&settings, text, sizeof text);
    assert_string_equal(text, " --budget 64 --view 3");
}

static void wrong_values_change_nothing(void **state)
{
    (void)state;
    struct view_settings settings, before;
    controls_set_defaults(&settings);
    before = settings;
    assert_false(controls_set(&settings, "view", "10", "t"));
    assert_false(controls_set(&settings, "pause", "maybe", "t"));
    assert_false(controls_set(&settings, "probability", "2", "t"));
    assert_false(controls_set(&settings, "nothing", "1", "t"));
    assert_false(controls_set(&settings, "budget", "4095K", "t"));
    assert_memory_equal(&settings, &before, sizeof settings);
}

static void a_camera_at_a_place_looks_at_its_target(void **state)
{
    (void)state;
    const struct vec3 eye = {1, 2, 3}, target = {-4, 3, 7};
    const struct view_camera camera = view_camera_at(eye, target, 1);
    const struct vec3 to = vec3_normalize(vec3_sub(target, eye));
    const struct vec3 forward = view_camera_forward(&camera);
    assert_float_equal(vec3_dot(to, forward), 1, 1e-5f);
    assert_float_equal(vec3_dot(view_camera_right(&camera), forward), 0, 1e-5f);
}

static void walking_forward_keeps_the_height(void **state)
{
    (void)state;
    struct view_camera camera = {.position = {0, 1.5f, 0}, .pitch = -0.7f, .fov = 1};
    struct vec3 center = {0, 0, 0};
    const struct camera_wish wish = {.forward = 1, .factor = 2, .seconds = 0.5f};
    view_camera_move(&camera, &wish, VIEW_WALK, 3.0, &center);
    assert_float_equal(camera.position.y, 1.5f, 1e-6f);
    assert_float_equal(camera.position.z, -3.0f, 1e-5f);
}

static void orbit_keeps_the_distance(void **state)
{
    (void)state;
    struct vec3 center = {1, 0, -2};
    struct view_camera camera = view_camera_at((struct vec3){1, 1, 3}, center, 1);
    const struct camera_wish wish = {.look_right = 0.7f, .look_up = 0.2f, .seconds = 0.1f};
    view_camera_move(&camera, &wish, VIEW_ORBIT, 1.0, &center);
    const struct vec3 away = vec3_sub(camera.position, center);
    assert_float_equal(sqrtf(vec3_dot(away, away)), sqrtf(26), 1e-4f);
    assert_float_equal(vec3_dot(vec3_normalize(away), view_camera_forward(&camera)), -1, 1e-5f);
}

static void paths_are_read_as_they_were_written(void **state)
{
    (void)state;
    char file[128];
    struct camera_path path = {0}, read;
    struct view_camera camera;
    path_in_folder("path", file);
    const struct view_camera a = {.position = {0, 1, 2}, .yaw = 3.0f, .pitch = 0.1f, .fov = 1};
    const struct view_camera b = {.position = {4, 1, 2},
                                  .yaw = -3.0f,
                                  .pitch = 0.3f,
                                  .fov = 1,
                                  .roll = 0.2f,
                                  .span = 3,
                                  .aspect = 1.5f};
    assert_true(camera_path_add(&path, 0, &a));
    assert_true(camera_path_add(&path, 2, &b));
    assert_true(camera_path_write(file, &path));
    assert_true(camera_path_read(file, &read));
    assert_int_equal(read.count, 2);
    assert_memory_equal(&read.points[0].camera, &a, sizeof a);
    assert_memory_equal(&read.points[1].camera, &b, sizeof b);
    assert_true(camera_path_get(&read, 1, &camera));
    assert_float_equal(camera.position.x, 2, 1e-6f);
    /* 3 to -3 radians is a turn of 0.28, not of 6 */
    assert_float_equal(cosf(camera.yaw), -1, 1e-4f);
    camera_path_finish(&path);
    camera_path_finish(&read);
    write_text(file, "0 1 2 3 0 0 1\nnot a number\n");
    assert_false(camera_path_read(file, &read));
    write_text(file, "1 1 2 3 0 0 1\n0 1 2 3 0 0 1\n");
    assert_false(camera_path_read(file, &read));
}

static void settings_come_back_from_their_file(void **state)
{
    (void)state;
    char file[128];
    struct view_app *app = calloc(1, sizeof *app), *read = calloc(1, sizeof *read);
    path_in_folder("settings", file);
    controls_set_defaults(&app->settings);
    controls_set_defaults(&read->settings);
    app->settings.budget = 32u << 20;
    app->settings.pause = 1; /* passes */
    app->settings.compared = VIEW_WITH_B;
    controls_set_defaults(&app->b);
    controls_set_defaults(&read->b);
    app->b.anisotropy = 2;
    app->b.source_fails = 3; /* passes */
    app->bookmarks[2] =
        (struct view_camera){.position = {1, 2, 3}, .yaw = 0.5f, .pitch = 0.25f, .fov = 1};
    app->bookmark_set[2] = true;
    assert_true(settings_file_write(file, app));
    settings_file_read(file, read);
    assert_int_equal(read->settings.budget, 32u << 20);
    assert_int_equal(read->settings.pause, 0);
    assert_int_equal(read->settings.compared, VIEW_WITH_B);
    assert_int_equal(read->b.anisotropy, 2);
    assert_int_equal(read->b.budget, 0);
    assert_int_equal(read->b.source_fails, 0);
    assert_true(read->bookmark_set[2] && !read->bookmark_set[1]);
    assert_float_equal(read->bookmarks[2].pitch, 0.25f, 0);
    free(app);
    free(read);
}

static struct view_settings other_than(const struct view_settings *settings)
{
    struct view_settings other = *settings;
    other.budget += 8u << 20;
    other.timeout += 1;
    other.anisotropy += 1;
    other.feedback = !other.feedback;
    other.source_latency += 10;
    return other;
}

static void sets_share_nothing_but_what_is_of_both(void **state)
{
    (void)state;
    struct view_settings a, b, second;
    char text[512];
    controls_set_defaults(&a);
    a.view = VIEW_MISSING;
    a.pause = 1;
    a.compared = VIEW_WITH_B;
    b = other_than(&a);
    b.view = VIEW_PICTURE;
    b.pause = 0;
    second = sets_of_second(&a, &b);
    assert_int_equal(second.view, VIEW_MISSING);
    assert_int_equal(second.pause, 1);
    sets_write(&second, &b, text, sizeof text);
    assert_string_equal(text, "");
    a.budget = 4u << 20; /* B does not follow */
    second = sets_of_second(&a, &b);
    assert_int_equal(second.budget, 8u << 20);
    sets_write(&a, &b, text, sizeof text);
    assert_string_equal(text, "budget=8,timeout=2,feedback=off,source-latency=10,anisotropy=9");
    sets_write(&b, &b, text, sizeof text);
    assert_string_equal(text, "");
}

static void sets_that_are_swapped_twice_are_as_before(void **state)
{
    (void)state;
    struct view_settings a, b, a_before, b_before, second;
    controls_set_defaults(&a);
    b = other_than(&a);
    a.compared = VIEW_WITH_B;
    a_before = a;
    b_before = b;
    sets_swap(&a, &b);
    assert_int_equal(a.budget, b_before.budget);
    assert_int_equal(b.budget, a_before.budget);
    sets_swap(&a, &b);
    assert_memory_equal(&a, &a_before, sizeof a);
    assert_memory_equal(&b, &b_before, sizeof b);
    a.compared = VIEW_WITH_EVERYTHING;
    sets_swap(&a, &b);
    assert_int_equal(a.load, VIEW_LOAD_EVERYTHING);
    assert_int_equal(b.load, VIEW_LOAD_WANTED);
    sets_swap(&a, &b);
    second = sets_of_second(&a, &b);
    assert_int_equal(second.load, VIEW_LOAD_EVERYTHING);
    assert_int_equal(a.load, VIEW_LOAD_WANTED);
}

static void view_8_compares_with_everything_whatever_b_is(void **state)
{
    (void)state;
    struct view_settings a, second;
    controls_set_defaults(&a);
    a.compared = VIEW_WITH_B;
    a.view = VIEW_TRUTH;
    const struct view_settings b = other_than(&a);
    second = sets_of_second(&a, &b);
    assert_int_equal(second.load, VIEW_LOAD_EVERYTHING);
    assert_int_equal(second.budget, 0);
    assert_int_equal(second.anisotropy, a.anisotropy);
}

/* 1,100 frames of 1 ms and more each: the ring keeps the last 1,024. */
static void medians_are_those_of_the_last_frames(void **state)
{
    (void)state;
    struct half_series *series = calloc(1, sizeof *series);
    assert_true(half_series_median(series, 64) < 0);
    half_series_add(series, 5e-3);
    assert_float_equal(half_series_median(series, 64), 5, 1e-4);
    half_series_add(series, 1e-3);
    assert_float_equal(half_series_median(series, 64), 3, 1e-4);
    assert_int_equal(half_series_count(series, 64), 2);
    series->count = 0;
    for (int i = 1; i <= 1100; i++)
        half_series_add(series, i / 1e3);
    assert_int_equal(half_series_count(series, UINT32_MAX), HALF_TIMES_MOST);
    assert_float_equal(half_series_median(series, 3), 1099, 1e-1);
    assert_float_equal(half_series_median(series, HALF_TIMES_MOST), 1100 - 1023.0 / 2, 1e-1);
    free(series);
}

static void scripts_set_a_and_b(void **state)
{
    (void)state;
    struct script script;
    assert_true(script_parse("s", "3 set budget 16\n4 set b budget 32\n", &script));
    assert_int_equal(script.count, 2);
    assert_int_equal(script.steps[0].kind, SCRIPT_SET);
    assert_int_equal(script.steps[1].kind, SCRIPT_SET_B);
    assert_string_equal(script.steps[1].text, "budget");
    assert_string_equal(script.steps[1].value, "32");
    script_finish(&script);
    assert_false(script_parse("s", "3 set c budget 16\n", &script));
    assert_false(script_parse("s", "3 set b budget\n4 set b\n", &script));
}

static void a_damaged_file_of_settings_is_set_aside(void **state)
{
    (void)state;
    char file[128], aside[160];
    struct view_app *app = calloc(1, sizeof *app);
    path_in_folder("damaged", file);
    snprintf(aside, sizeof aside, "%s.damaged", file);
    write_text(file, "sluice-view settings 1\nbudget 16\nspeed fast\n");
    controls_set_defaults(&app->settings);
    settings_file_read(file, app);
    assert_int_equal(app->settings.budget, 0);
    assert_int_equal(access(file, F_OK), -1);
    assert_int_equal(access(aside, F_OK), 0);
    free(app);
}

/* Bits as shaders/scene_marks.glsl reads them. */
/* pbrt's LookAt: x to the right of the picture, y up, z ahead, as columns. */
static void look_at(const float eye[3], const float point[3], const float up[3], bool mirrored,
                    float m[12])
{
    const struct vec3 ahead =
        vec3_normalize((struct vec3){point[0] - eye[0], point[1] - eye[1], point[2] - eye[2]});
    const struct vec3 right = vec3_normalize(vec3_cross((struct vec3){up[0], up[1], up[2]}, ahead));
    const struct vec3 over = vec3_cross(ahead, right);
    const float sign = mirrored ? -1.0f : 1.0f;
    const float columns[12] = {sign * right.x, over.x, ahead.x, eye[0],
                               sign * right.y, over.y, ahead.y, eye[1],
                               sign * right.z, over.z, ahead.z, eye[2]};
    memcpy(m, columns, sizeof columns);
}

static const struct {
    float eye[3], point[3], up[3];
    bool mirrored;
} pbrt_cameras[] = {
    {{0, -5, 0}, {0, 0, 0}, {0, 0, 1}, false},  {{0, -5, 0}, {0, 0, 0}, {0, 0, 1}, true},
    {{3, 2, 9}, {1, 1, 0}, {0, 1, 0}, false},   {{3, 2, 9}, {1, 1, 0}, {0, 1, 0}, true},
    {{3, 2, 9}, {1, 1, 0}, {0, -1, 0}, false},  {{2, 3, 9}, {1, 1, 0}, {0.3f, 1, 0.2f}, true},
    {{9, 3, 2}, {1, 1, 0}, {0.4f, 0, 1}, false}};

#define PBRT_CAMERAS (sizeof pbrt_cameras / sizeof *pbrt_cameras)

static void make_frame(size_t i, float m[12], struct pbrt_frame *frame)
{
    const SluicePbrtBounds box = {{-1, -2, -3}, {5, 6, 7}};
    look_at(pbrt_cameras[i].eye, pbrt_cameras[i].point, pbrt_cameras[i].up,
            pbrt_cameras[i].mirrored, m);
    pbrt_frame_init(m, &box, 1.0f, frame);
}

static float column_dot(const float a[12], int i, const float b[12], int k)
{
    return a[i] * b[k] + a[4 + i] * b[4 + k] + a[8 + i] * b[8 + k];
}

static void a_scenes_camera_comes_back_as_it_was(void **state)
{
    (void)state;
    for (size_t i = 0; i < PBRT_CAMERAS; i++) {
        struct pbrt_frame frame;
        float m[12], back[12], near[12];
        make_frame(i, m, &frame);
        pbrt_frame_matrix(&frame, &frame.camera, back);
        assert_memory_equal(back, m, sizeof m);
        struct view_camera camera = frame.camera;
        camera.yaw += 1e-6f; /* the formula of moved cameras agrees */
        pbrt_frame_matrix(&frame, &camera, near);
        for (int k = 0; k < 12; k++)
            assert_float_equal(near[k], m[k], 1e-4f);
    }
}

/* With any up vector, mirrored or not, the camera moves to the picture's right and ahead. */
static void steps_and_turns_go_where_the_picture_shows_them(void **state)
{
    (void)state;
    const float turn = 0.3f;
    for (size_t i = 0; i < PBRT_CAMERAS; i++) {
        struct pbrt_frame frame;
        float m[12], moved[12], turned[12];
        make_frame(i, m, &frame);
        struct view_camera camera = frame.camera;
        const struct vec3 step =
            vec3_add(vec3_scale(view_camera_right(&camera), 2), view_camera_forward(&camera));
        camera.position = vec3_add(camera.position, step);
        pbrt_frame_matrix(&frame, &camera, moved);
        const bool rolls = pbrt_cameras[i].up[0] != 0;
        for (int r = 0; r < 3 && !rolls; r++)
            assert_float_equal(moved[4 * r + 3] - m[4 * r + 3],
                               frame.unit * (2 * m[4 * r] + m[4 * r + 2]), 1e-4f);
        camera = frame.camera;
        camera.yaw += turn;
        pbrt_frame_matrix(&frame, &camera, turned);
        assert_true(column_dot(turned, 2, m, 0) > 0.2f); /* now it looks to the right */
        for (int k = 0; k < 3; k++) { /* and is still a camera of the same kind */
            assert_float_equal(column_dot(turned, k, turned, k), 1, 1e-4f);
            assert_float_equal(column_dot(turned, k, turned, (k + 1) % 3), 0, 1e-4f);
        }
    }
}

static void words_of_tiles_hold_reason_thrash_and_age(void **state)
{
    (void)state;
    assert_int_equal(mark_word(MARK_BUDGET, false, 0), 2);
    assert_int_equal(mark_word(MARK_FAILED, true, 62499), 3 + 16);
    assert_int_equal(mark_word(MARK_NOTHING, false, 2 * 1000000), 32u << 16);
    assert_int_equal(mark_word(MARK_LIMIT, true, UINT64_MAX), 5u + 16 + 0xFFFF0000u);
    assert_int_equal(mark_word(MARK_NOTHING, false, 65535u * 62500ull), 0xFFFF0000u);
}

static void each_reason_has_its_pattern(void **state)
{
    static const enum mark_reason patterns[] = {
        [SLUICE_COARSE_FINEST] = MARK_NOTHING,    [SLUICE_COARSE_ENOUGH] = MARK_NOT_SEEN,
        [SLUICE_COARSE_NOT_SEEN] = MARK_NOT_SEEN, [SLUICE_COARSE_HIDDEN] = MARK_LIMIT,
        [SLUICE_COARSE_LIMIT] = MARK_LIMIT,       [SLUICE_COARSE_MIP_BIAS] = MARK_LIMIT,
        [SLUICE_COARSE_QUEUED] = MARK_COMING,     [SLUICE_COARSE_BANDWIDTH] = MARK_COMING,
        [SLUICE_COARSE_READING] = MARK_COMING,    [SLUICE_COARSE_UPLOADING] = MARK_COMING,
        [SLUICE_COARSE_FADING] = MARK_COMING,     [SLUICE_COARSE_BUDGET] = MARK_BUDGET,
        [SLUICE_COARSE_FAILED] = MARK_FAILED};
    (void)state;
    for (size_t i = 0; i < sizeof patterns / sizeof *patterns; i++)
        assert_int_equal(mark_reason_of((SluiceCoarseReason)i), patterns[i]);
}

/* Tiles one by one: each region wants a tile of each level from its own on. */
static uint64_t count_tiles(const uint8_t *map, uint32_t levels, uint32_t added)
{
    uint64_t count = 0;
    for (uint32_t level = 0; level < levels; level++) {
        bool wanted[7][5] = {{false}};
        for (uint32_t y = 0; y < 7; y++)
            for (uint32_t x = 0; x < 5; x++)
                if (map[y * 5 + x] != SLUICE_MIP_UNTOUCHED && map[y * 5 + x] + added <= level)
                    wanted[y >> level][x >> level] = true;
        for (uint32_t i = 0; i < 35; i++)
            count += wanted[i / 5][i % 5];
    }
    return count;
}

static void the_need_of_coarser_requests_is_that_of_their_tiles(void **state)
{
    (void)state;
    uint8_t map[35], scratch[35];
    uint32_t seed = 1;
    for (int round = 0; round < 50; round++) {
        struct budget_need need = {0};
        for (int i = 0; i < 35; i++) {
            seed = seed * 1664525u + 1013904223u;
            map[i] = seed >> 30 == 0 ? SLUICE_MIP_UNTOUCHED : (uint8_t)((seed >> 20) % 5);
        }
        memcpy(scratch, map, sizeof map);
        budget_need_add(&need, scratch, 5, 7, 4, 2);
        for (uint32_t added = 0; added < 6; added++)
            assert_int_equal(budget_need_bytes(&need, added),
                             65536 * (2 + count_tiles(map, 4, added)));
    }
}

static void levels_to_add_lie_between_those_whose_needs_surround_the_budget(void **state)
{
    (void)state;
    const struct budget_need need = {.tails = 10, .tiles = {90, 30, 10}};
    assert_float_equal(budget_need_levels(&need, 100 * 65536), 0, 0);
    assert_float_equal(budget_need_levels(&need, 70 * 65536), 0.5, 1e-9);
    assert_float_equal(budget_need_levels(&need, 40 * 65536), 1, 1e-9);
    assert_float_equal(budget_need_levels(&need, 15 * 65536), 2.5, 1e-9);
    assert_float_equal(budget_need_levels(&need, 9 * 65536), BUDGET_NEED_LEVELS - 1, 0);
}

static int make_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    static const char *const names[] = {"path", "settings", "damaged.damaged"};
    char path[128];
    (void)state;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        path_in_folder(names[i], path);
        unlink(path);
    }
    return rmdir(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_click_is_a_move_and_a_button_that_is_held_for_a_frame),
        cmocka_unit_test(a_drag_ends_where_it_is_to_end),
        cmocka_unit_test(lines_of_scripts_are_put_in_order_of_frames),
        cmocka_unit_test(wrong_scripts_are_refused),
        cmocka_unit_test(scripts_of_the_page_are_read),
        cmocka_unit_test(keys_have_names),
        cmocka_unit_test(what_a_control_writes_it_reads),
        cmocka_unit_test(the_command_has_what_is_not_the_default),
        cmocka_unit_test(wrong_values_change_nothing),
        cmocka_unit_test(a_camera_at_a_place_looks_at_its_target),
        cmocka_unit_test(walking_forward_keeps_the_height),
        cmocka_unit_test(orbit_keeps_the_distance),
        cmocka_unit_test(paths_are_read_as_they_were_written),
        cmocka_unit_test(settings_come_back_from_their_file),
        cmocka_unit_test(sets_share_nothing_but_what_is_of_both),
        cmocka_unit_test(sets_that_are_swapped_twice_are_as_before),
        cmocka_unit_test(view_8_compares_with_everything_whatever_b_is),
        cmocka_unit_test(medians_are_those_of_the_last_frames),
        cmocka_unit_test(scripts_set_a_and_b),
        cmocka_unit_test(a_damaged_file_of_settings_is_set_aside),
        cmocka_unit_test(a_scenes_camera_comes_back_as_it_was),
        cmocka_unit_test(steps_and_turns_go_where_the_picture_shows_them),
        cmocka_unit_test(words_of_tiles_hold_reason_thrash_and_age),
        cmocka_unit_test(each_reason_has_its_pattern),
        cmocka_unit_test(the_need_of_coarser_requests_is_that_of_their_tiles),
        cmocka_unit_test(levels_to_add_lie_between_those_whose_needs_surround_the_budget),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
