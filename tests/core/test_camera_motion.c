/* Compares predicted cameras with known motions. */
#include "support/test.h"

#include <sluice/camera_motion.h>

#include <math.h>
#include <string.h>

#define FRAME (1.0 / 60.0)

#define MOTION_FRAMES SLUICE_CAMERA_FRAMES

struct vec3 {
    float x, y, z;
};

struct camera {
    struct vec3 eye, target;
};

static struct vec3 to(struct vec3 a, struct vec3 b)
{
    return (struct vec3){b.x - a.x, b.y - a.y, b.z - a.z};
}

static double dot(struct vec3 a, struct vec3 b)
{
    return (double)a.x * b.x + (double)a.y * b.y + (double)a.z * b.z;
}

static struct vec3 unit(struct vec3 a)
{
    double length = sqrt(dot(a, a));
    return (struct vec3){(float)(a.x / length), (float)(a.y / length), (float)(a.z / length)};
}

static struct vec3 cross(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* Writes the usual view matrix: x to the right, y up, z back. */
static void view_matrix(const struct camera *c, float m[16])
{
    struct vec3 axes[3];
    axes[2] = unit(to(c->target, c->eye));
    axes[0] = unit(cross((struct vec3){0, 1, 0}, axes[2]));
    axes[1] = cross(axes[2], axes[0]);
    for (int i = 0; i < 3; i++) {
        m[i] = axes[i].x, m[4 + i] = axes[i].y, m[8 + i] = axes[i].z;
        m[12 + i] = (float)-dot(axes[i], c->eye);
        m[4 * i + 3] = 0.0f;
    }
    m[15] = 1.0f;
}

static SluiceResult motion_add(SluiceCameraMotion *motion, const struct camera *camera,
                               double seconds)
{
    float m[16];
    view_matrix(camera, m);
    return sluiceAddCameraFrame(motion, m, seconds);
}

/* Predicts with a `target` one meter away. */
static bool motion_look_ahead(const SluiceCameraMotion *motion, double seconds,
                              struct camera *ahead)
{
    const SluiceLookAheadInfo info = {
        .structSize = sizeof info, .seconds = seconds, .pictureWidth = 1, .pictureHeight = 1};
    SluiceLookAhead out = {.structSize = sizeof out};
    CHECK_OK(sluicePredictCamera(motion, &info, &out));
    const float *m = out.viewMatrix;
    double eye[3];
    for (int i = 0; i < 3; i++)
        eye[i] = -((double)m[4 * i] * m[12] + (double)m[4 * i + 1] * m[13] +
                   (double)m[4 * i + 2] * m[14]);
    ahead->eye = (struct vec3){(float)eye[0], (float)eye[1], (float)eye[2]};
    ahead->target =
        (struct vec3){(float)(eye[0] - m[2]), (float)(eye[1] - m[6]), (float)(eye[2] - m[10])};
    return out.draw;
}

static double distance_between(struct vec3 a, struct vec3 b)
{
    return hypot(hypot((double)a.x - b.x, (double)a.y - b.y), (double)a.z - b.z);
}

static void assert_near(struct vec3 got, struct vec3 expected, double tolerance)
{
    double distance = distance_between(got, expected);
    if (!(distance <= tolerance))
        fail_msg("(%g %g %g) is %g from (%g %g %g)", got.x, got.y, got.z, distance, expected.x,
                 expected.y, expected.z);
}

static bool is_finite(const struct camera *camera)
{
    return isfinite(camera->eye.x) && isfinite(camera->eye.y) && isfinite(camera->eye.z) &&
           isfinite(camera->target.x) && isfinite(camera->target.y) && isfinite(camera->target.z);
}

/** Returns a camera at x that looks along -z. Only x varies. */
static struct camera at(double x)
{
    return (struct camera){{(float)x, 1.6f, 0.0f}, {(float)x, 1.6f, -1.0f}};
}

/** Feeds x = path(t) in frames of uneven length that end at `now`. */
static SluiceCameraMotion follow(double (*path)(double), double now)
{
    static const double steps[] = {0.9, 1.3, 0.7, 1.1, 1.0, 0.8};
    SluiceCameraMotion motion = {0};
    double t = now - 5.8 * FRAME;
    for (int i = 0; i < 6; i++) {
        t += steps[i] * FRAME;
        struct camera camera = at(path(t));
        motion_add(&motion, &camera, t);
    }
    return motion;
}

static void check_path(double (*path)(double), double now, double ahead, double expected)
{
    SluiceCameraMotion motion = follow(path, now);
    struct camera camera;
    assert_true(motion_look_ahead(&motion, ahead, &camera));
    assert_near(camera.eye, at(expected).eye, 2e-3);
    assert_near(camera.target, at(expected).target, 2e-3);
}

static double evenly(double t)
{
    return 1.5 * t - 2.0;
}

static double speeding_up(double t)
{
    return 0.5 + t * t;
}

static double slowing_down(double t)
{
    return 3.0 * t - 2.0 * t * t; /* to a halt at t = 0.75 */
}

static double standing(double t)
{
    (void)t;
    return 4.0;
}

static void even_motion_goes_on(void **state)
{
    (void)state;
    for (double ahead = 0.05; ahead < 2.0; ahead *= 2.0)
        check_path(evenly, 1.0, ahead, evenly(1.0 + ahead));
}

static void motion_that_speeds_up_goes_on(void **state)
{
    (void)state;
    check_path(speeding_up, 1.0, 0.1, speeding_up(1.1));
    check_path(speeding_up, 1.0, 0.5, speeding_up(1.5));
}

static void motion_that_slows_down_ends_at_its_halt(void **state)
{
    (void)state;
    check_path(slowing_down, 0.4, 0.1, slowing_down(0.5));
    check_path(slowing_down, 0.4, 0.35, slowing_down(0.75));
    check_path(slowing_down, 0.4, 0.6, slowing_down(0.75));
    check_path(slowing_down, 0.4, 30.0, slowing_down(0.75));
}

static struct camera turned(double angle)
{
    return (struct camera){{1.0f, 1.6f, -2.0f},
                           {1.0f + (float)sin(angle), 1.6f, -2.0f - (float)cos(angle)}};
}

static void a_turn_goes_on(void **state)
{
    (void)state;
    SluiceCameraMotion motion = {0};
    struct camera ahead, camera;
    for (int i = 0; i < MOTION_FRAMES; i++) {
        camera = turned(0.9 * i * FRAME);
        motion_add(&motion, &camera, i * FRAME);
    }
    assert_true(motion_look_ahead(&motion, 0.4, &ahead));
    assert_near(ahead.eye, camera.eye, 1e-5);
    assert_near(ahead.target, turned(0.9 * ((MOTION_FRAMES - 1) * FRAME + 0.4)).target, 0.02);
}

static void who_stands_still_stays(void **state)
{
    (void)state;
    SluiceCameraMotion motion = follow(standing, 1.0);
    struct camera ahead;
    assert_false(motion_look_ahead(&motion, 0.5, &ahead));
    assert_near(ahead.eye, at(4.0).eye, 1e-5);
    assert_near(ahead.target, at(4.0).target, 1e-5);
}

static void nothing_is_said_of_now_or_without_a_past(void **state)
{
    (void)state;
    SluiceCameraMotion motion = {0};
    struct camera ahead;
    assert_false(motion_look_ahead(&motion, 0.5, &ahead));
    for (int i = 0; i < MOTION_FRAMES; i++) {
        struct camera camera = at(0.1 * i);
        assert_false(motion_look_ahead(&motion, 0.5, &ahead));
        motion_add(&motion, &camera, i * FRAME);
    }
    assert_true(motion_look_ahead(&motion, 0.5, &ahead));
    assert_false(motion_look_ahead(&motion, 0.0, &ahead));
    assert_near(ahead.eye, at(0.1 * (MOTION_FRAMES - 1)).eye, 1e-5);
}

static void a_jump_is_no_motion(void **state)
{
    (void)state;
    SluiceCameraMotion motion = {0};
    struct camera ahead;
    for (int i = 0; i < 2 * MOTION_FRAMES; i++) {
        struct camera camera = at(i < MOTION_FRAMES ? 0.0 : 25.0);
        motion_add(&motion, &camera, i * FRAME);
        assert_false(motion_look_ahead(&motion, 0.3, &ahead));
        assert_near(ahead.eye, camera.eye, 1e-5);
    }
}

/* A jump of position or rotation stops the prediction of both. */
static void a_jump_while_the_camera_turns_is_no_motion(void **state)
{
    (void)state;
    SluiceCameraMotion motion = {0};
    for (int i = 0; i < 3 * MOTION_FRAMES; i++) {
        struct camera camera = turned(0.9 * i * FRAME), ahead;
        if (i >= MOTION_FRAMES) {
            camera.eye.x += 25.0f;
            camera.target.x += 25.0f;
        }
        motion_add(&motion, &camera, i * FRAME);
        bool moves = motion_look_ahead(&motion, 0.3, &ahead);
        bool has_jump = i >= MOTION_FRAMES && i < 2 * MOTION_FRAMES - 1;
        assert_int_equal(moves, i >= MOTION_FRAMES - 1 && !has_jump);
    }
}

static void a_pause_is_forgotten_over(void **state)
{
    (void)state;
    SluiceCameraMotion motion = follow(evenly, 1.0);
    struct camera camera = at(evenly(9.0)), ahead;
    motion_add(&motion, &camera, 9.0);
    assert_false(motion_look_ahead(&motion, 0.3, &ahead));
    motion = follow(evenly, 1.0);
    camera = at(evenly(1.0));
    motion_add(&motion, &camera, 1.0); /* repeats the time */
    assert_false(motion_look_ahead(&motion, 0.3, &ahead));
}

static uint32_t random_state;

/** Returns a number from -1 to 1. */
static double draw(void)
{
    random_state = random_state * 1664525u + 1013904223u;
    return (double)random_state / 2147483648.0 - 1.0;
}

/* The fitted speed is at most twice that of the fastest step. Acceleration adds as much again. */
static void no_tremble_makes_the_way_longer_than_four_times_the_fastest_step(void **state)
{
    (void)state;
    random_state = 7;
    for (int round = 0; round < 2000; round++) {
        SluiceCameraMotion motion = {0};
        struct camera ahead, before = at(0.0);
        double fastest = 0.0, seconds = 0.5 + 0.5 * draw();
        for (int i = 0; i < MOTION_FRAMES; i++) {
            struct camera camera = {{(float)draw(), (float)draw(), (float)draw()},
                                    {(float)draw(), (float)draw(), -5.0f}};
            if (i > 0)
                fastest = fmax(fastest, distance_between(camera.eye, before.eye) / FRAME);
            before = camera;
            motion_add(&motion, &camera, i * FRAME);
        }
        (void)motion_look_ahead(&motion, seconds, &ahead);
        assert_true(is_finite(&ahead));
        assert_true(distance_between(ahead.eye, before.eye) <= 4.001 * fastest * seconds);
        assert_true(fabs(distance_between(ahead.target, ahead.eye) - 1.0) < 1e-3);
    }
}

static void nothing_makes_a_place_that_is_no_number(void **state)
{
    (void)state;
    static const float odd[] = {0.0f, 1.0f, -1.0f, 1e-38f, 1e10f, 3e38f, INFINITY, NAN};
    static const double times[] = {0.0, 1e-300, 1e-3, 0.1, 1e300, INFINITY, NAN};
    const int odd_count = sizeof odd / sizeof *odd, time_count = sizeof times / sizeof *times;
    uint32_t refused = 0, drawn = 0;
    random_state = 11;
    for (int round = 0; round < 20000; round++) {
        SluiceCameraMotion motion = {0};
        SluiceLookAhead out = {.structSize = sizeof out};
        double now = 0.0;
        for (int i = 0; i < 8; i++) {
            struct camera camera = at(0.1 * i);
            float m[16];
            view_matrix(&camera, m);
            for (int k = 0; k < (round % 4); k++) /* positions more often than axes */
                m[k == 2 ? (round / 4) % 16 : 12 + k] =
                    odd[(int)((draw() * 0.5 + 0.5) * odd_count) % odd_count];
            double step = times[(int)((draw() * 0.5 + 0.5) * time_count) % time_count];
            now = round % 2 ? i * FRAME : now + step;
            refused += sluiceAddCameraFrame(&motion, m, now) != SLUICE_SUCCESS;
        }
        for (int i = 0; i < time_count; i++) {
            const SluiceLookAheadInfo info = {.structSize = sizeof info,
                                              .seconds = times[i],
                                              .pictureWidth = 640,
                                              .pictureHeight = 361};
            CHECK_OK(sluicePredictCamera(&motion, &info, &out));
            drawn += out.draw;
            for (int k = 0; k < 16; k++)
                assert_true(isfinite(out.viewMatrix[k]));
            assert_true(out.width == 160 && out.height == 91 && out.lodBias == -2.0f);
        }
    }
    assert_true(refused > 1000 && drawn > 1000);
}

/* Roll is part of the rotation. Mirrored matrices of other conventions rotate alike. */
static void all_axes_turn_alike(void **state)
{
    (void)state;
    SluiceCameraMotion plain = {0}, flipped = {0};
    const SluiceLookAheadInfo info = {.structSize = sizeof info,
                                      .seconds = 0.3,
                                      .frameIndex = 1,
                                      .pictureWidth = 9,
                                      .pictureHeight = 8,
                                      .shrink = 2};
    SluiceLookAhead a = {.structSize = sizeof a}, b = a;
    for (int i = 0; i < MOTION_FRAMES; i++) {
        struct camera camera = turned(0.9 * i * FRAME);
        float m[16], n[16];
        view_matrix(&camera, m);
        for (int k = 0; k < 16; k++) /* z forward */
            n[k] = k % 4 == 2 ? -m[k] : m[k];
        CHECK_OK(sluiceAddCameraFrame(&plain, m, i * FRAME));
        CHECK_OK(sluiceAddCameraFrame(&flipped, n, i * FRAME));
    }
    CHECK_OK(sluicePredictCamera(&plain, &info, &a));
    CHECK_OK(sluicePredictCamera(&flipped, &info, &b));
    assert_true(a.draw && b.draw && a.width == 5 && a.height == 4 && a.lodBias == -1.0f);
    assert_float_equal(a.seconds, 0.15, 1e-12);
    for (int k = 0; k < 16; k++)
        assert_float_equal(a.viewMatrix[k], (k % 4 == 2 ? -1.0f : 1.0f) * b.viewMatrix[k], 1e-5);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) { /* still a rotation */
            double sum = 0.0;
            for (int c = 0; c < 3; c++)
                sum += (double)a.viewMatrix[4 * c + i] * a.viewMatrix[4 * c + k];
            assert_float_equal(sum, i == k, 1e-5);
        }
    SluiceLookAheadInfo wrong = info;
    wrong.pictureHeight = 0;
    CHECK_RESULT(sluicePredictCamera(&plain, &wrong, &a), SLUICE_ERROR_INVALID_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(even_motion_goes_on),
        cmocka_unit_test(motion_that_speeds_up_goes_on),
        cmocka_unit_test(motion_that_slows_down_ends_at_its_halt),
        cmocka_unit_test(a_turn_goes_on),
        cmocka_unit_test(who_stands_still_stays),
        cmocka_unit_test(nothing_is_said_of_now_or_without_a_past),
        cmocka_unit_test(a_jump_is_no_motion),
        cmocka_unit_test(a_jump_while_the_camera_turns_is_no_motion),
        cmocka_unit_test(a_pause_is_forgotten_over),
        cmocka_unit_test(no_tremble_makes_the_way_longer_than_four_times_the_fastest_step),
        cmocka_unit_test(nothing_makes_a_place_that_is_no_number),
        cmocka_unit_test(all_axes_turn_alike),
    };
    return RUN_TESTS(tests);
}
