/* Cameras and their paths in glTF files, against other ways to compute them in long double. */
#define _XOPEN_SOURCE 700

#include "support/test.h"

#include "gltf_animation.h"
#include "gltf_cameras.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define KEYS 6

typedef long double real;

/* Numbers from 0 to 1 that are the same in each run. */
static double draw(void)
{
    static uint32_t seed = 12345;
    seed = seed * 1664525u + 1013904223u;
    return (double)(seed >> 8) / 16777216.0;
}

/* As "%.5f" writes it. */
static double round5(double value)
{
    char text[32];
    snprintf(text, sizeof text, "%.5f", value);
    return strtod(text, NULL);
}

/* Quaternions as x, y, z, w. */
struct quaternion {
    real x, y, z, w;
};

static struct quaternion multiply(struct quaternion a, struct quaternion b)
{
    return (struct quaternion){a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                               a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
                               a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
                               a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

static struct quaternion unit(const double *q)
{
    const real x = (real)q[0], y = (real)q[1], z = (real)q[2], w = (real)q[3];
    const real n = sqrtl(x * x + y * y + z * z + w * w);
    return (struct quaternion){x / n, y / n, z / n, w / n};
}

/* q0 (q0^-1 q1)^part: a turn about one axis, as much of it as the time is. */
static struct quaternion turn_part(struct quaternion a, struct quaternion b, real part)
{
    const struct quaternion back = {-a.x, -a.y, -a.z, a.w};
    struct quaternion turn = multiply(back, b);
    if (turn.w < 0)
        turn = (struct quaternion){-turn.x, -turn.y, -turn.z, -turn.w};
    const real length = sqrtl(turn.x * turn.x + turn.y * turn.y + turn.z * turn.z);
    const real angle = atan2l(length, turn.w) * part;
    const real s = length > 0 ? sinl(angle) / length : 0;
    return multiply(a, (struct quaternion){turn.x * s, turn.y * s, turn.z * s, cosl(angle)});
}

/* Hermite's spline as Bezier's: points by thirds of the tangents, then means of means. */
static real bezier(real a, real tangent_a, real b, real tangent_b, real time, real part)
{
    real p[4] = {a, a + tangent_a * time / 3, b - tangent_b * time / 3, b};
    for (int n = 3; n > 0; n--)
        for (int i = 0; i < n; i++)
            p[i] += (p[i + 1] - p[i]) * part;
    return p[0];
}

/* Walks from the last key back. */
static void expected(const struct gltf_track *t, double seconds, bool before, real value[4])
{
    const int n = (int)t->components, keys = t->interpolation == TRACK_CUBIC ? 3 : 1;
    const int at = keys == 3 ? n : 0;
    int key = (int)t->count - 1;
    while (key > 0 && (t->times[key] > seconds || (before && t->times[key] == seconds)))
        key--;
    const double *a = t->values + key * keys * n, *b = a + keys * n;
    const bool last = key + 1 == (int)t->count;
    const real time = last ? 1 : (real)t->times[key + 1] - (real)t->times[key];
    real part = ((real)seconds - (real)t->times[key]) / time;
    if (last || part < 0 || t->interpolation == TRACK_STEP)
        part = 0;
    for (int i = 0; i < n; i++)
        value[i] = keys == 3 && !last ? bezier((real)a[at + i], (real)a[2 * n + i], (real)b[at + i],
                                               (real)b[i], time, part)
                   : last || part <= 0 ? (real)a[at + i]
                                       : (real)a[i] * (1 - part) + (real)b[i] * part;
    if (t->path != TRACK_ROTATION)
        return;
    struct quaternion q;
    const double now[4] = {(double)value[0], (double)value[1], (double)value[2], (double)value[3]};
    if (t->interpolation == TRACK_LINEAR && part > 0)
        q = turn_part(unit(a), unit(b), part);
    else
        q = unit(now);
    value[0] = q.x;
    value[1] = q.y;
    value[2] = q.z;
    value[3] = q.w;
}

static void fill_track(struct gltf_track *track, double *times, double *values)
{
    double now = draw();
    for (uint32_t i = 0; i < track->count; i++, now += 0.1 + draw())
        times[i] = now;
    for (uint32_t i = 0; i < 3 * track->count * track->components; i++)
        values[i] = 4 * draw() - 2;
    track->times = times;
    track->values = values;
}

static void values_between_keys_are_those_of_another_formula(void **state)
{
    (void)state;
    double times[KEYS], values[3 * 4 * KEYS], got[4];
    real wanted[4];
    for (int round = 0; round < 200; round++) {
        struct gltf_track track = {.path = (enum gltf_track_path)(round % 3),
                                   .interpolation = (enum gltf_interpolation)(round / 3 % 3),
                                   .count = 1 + (uint32_t)(draw() * KEYS),
                                   .components = round % 3 == TRACK_ROTATION ? 4 : 3};
        fill_track(&track, times, values);
        for (int i = 0; i < 60; i++) {
            const bool before = i % 2 != 0;
            const double at = i < 12 && i / 2 < (int)track.count
                                  ? times[i / 2]
                                  : draw() * (times[track.count - 1] + 1);
            gltf_track_at(&track, at, before, got);
            expected(&track, at, before, wanted);
            double sign = 1; /* q and -q are one turn */
            if (track.path == TRACK_ROTATION &&
                got[0] * (double)wanted[0] + got[1] * (double)wanted[1] +
                        got[2] * (double)wanted[2] + got[3] * (double)wanted[3] <
                    0)
                sign = -1;
            for (uint32_t k = 0; k < track.components; k++)
                if (!(fabs(got[k] - sign * (double)wanted[k]) < 1e-9))
                    fail_msg("round %d, %g s: [%u] is %.12g, not %.12g", round, at, k, got[k],
                             (double)wanted[k]);
        }
    }
}

/* Text of a glTF file; floats are added to its buffer. */
static struct {
    uint8_t bytes[65536];
    size_t size;
    char accessors[8192];
    uint32_t count;
} made;

static void begin_file(void)
{
    memset(&made, 0, sizeof made);
}

/* Returns the number of the accessor. */
static uint32_t add_floats(const char *type, uint32_t count, uint32_t components,
                           const float *values)
{
    snprintf(made.accessors + strlen(made.accessors),
             sizeof made.accessors - strlen(made.accessors),
             "%s{\"bufferView\":0,\"byteOffset\":%zu,\"componentType\":5126,\"count\":%u,"
             "\"type\":\"%s\"}",
             made.count ? "," : "", made.size, count, type);
    memcpy(made.bytes + made.size, values, (size_t)count * components * sizeof *values);
    made.size += (size_t)count * components * sizeof *values;
    return made.count++;
}

/* `rest`: nodes, cameras and animations. */
static bool open_file(const char *rest, struct gltf_file *file)
{
    static char text[262144];
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    size_t length = (size_t)snprintf(
        text, sizeof text,
        "{\"asset\":{\"version\":\"2.0\"},%s,\"accessors\":[%s],\"bufferViews\":[{\"buffer\":0,"
        "\"byteLength\":%zu}],\"buffers\":[{\"byteLength\":%zu,\"uri\":\"data:a/b;base64,",
        rest, made.accessors, made.size, made.size);
    for (size_t i = 0; i < made.size; i += 3) { /* sizes are multiples of 12, or zeros follow */
        const uint32_t word =
            (uint32_t)made.bytes[i] << 16 | (uint32_t)made.bytes[i + 1] << 8 | made.bytes[i + 2];
        for (int k = 0; k < 4; k++)
            text[length++] = digits[word >> (18 - 6 * k) & 63];
    }
    strcpy(text + length, "\"}]}");
    return gltf_open_bytes("/nowhere/cameras.gltf", text, strlen(text), file);
}

static char noted[1024];

static void note(void *user, const char *where, const char *problem)
{
    (void)user;
    snprintf(noted + strlen(noted), sizeof noted - strlen(noted), "%s: %s\n", where, problem);
}

static void read_cameras(struct gltf_file *file, struct file_cameras *cameras)
{
    noted[0] = '\0';
    if (file->error[0])
        fail_msg("%s", file->error);
    assert_true(gltf_read_cameras(file, note, NULL, cameras));
}

static void all_cameras_of_a_file_are_read_with_their_lenses(void **state)
{
    (void)state;
    struct gltf_file file;
    struct file_cameras c;
    const float zero = 0;
    begin_file();
    add_floats("SCALAR", 1, 1, &zero);
    assert_true(open_file(
        "\"nodes\":[{\"camera\":0,\"name\":\"left eye\",\"translation\":[1,2,3]},"
        "{\"camera\":1,\"scale\":[5,5,5]},{\"camera\":0,\"rotation\":[0,0.70710678,0,0.70710678]},"
        "{\"camera\":2}],"
        "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.8,\"aspectRatio\":2,"
        "\"znear\":0.1}},{\"name\":\"plan\",\"type\":\"orthographic\",\"orthographic\":{\"xmag\":3,"
        "\"ymag\":1.5,\"znear\":0,\"zfar\":9}},{\"type\":\"perspective\",\"perspective\":{}}]",
        &file));
    read_cameras(&file, &c);
    assert_int_equal(c.count, 3);
    assert_string_equal(c.items[0].name, "left eye");
    assert_float_equal(c.items[0].camera.position.y, 2, 0);
    assert_float_equal(c.items[0].camera.fov, 0.8f, 0);
    assert_float_equal(c.items[0].camera.aspect, 2, 0);
    assert_string_equal(c.items[1].name, "plan");
    assert_float_equal(c.items[1].camera.span, 1.5f, 0);
    assert_float_equal(c.items[1].camera.aspect, 2, 0);
    assert_string_equal(c.items[2].name, "camera 2");
    assert_float_equal(c.items[2].camera.yaw, -1.57079633f, 1e-5f); /* to the left, along -x */
    assert_string_equal(noted, "cameras[2]: its yfov is not 0.01 to 3\n");
    file_cameras_finish(&c);
    gltf_finish(&file);
}

/* The parent turns by a quarter in a second: the camera flies along an arc around the origin. */
static void a_parent_that_turns_carries_its_camera_along_an_arc(void **state)
{
    (void)state;
    static const float times[] = {0.5f, 1.5f};
    static const float turns[] = {0, 0, 0, 1, 0, 0.70710678f, 0, 0.70710678f};
    struct gltf_file file;
    struct file_cameras c;
    char rest[1024];
    begin_file();
    const uint32_t input = add_floats("SCALAR", 2, 1, times);
    const uint32_t output = add_floats("VEC4", 2, 4, turns);
    snprintf(
        rest, sizeof rest,
        "\"nodes\":[{\"children\":[1],\"scale\":[2,2,2]},{\"camera\":0,\"translation\":[0,1,4]}]"
        ",\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1}}],"
        "\"animations\":[{\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":"
        "\"rotation\"}}],\"samplers\":[{\"input\":%u,\"output\":%u}]}]",
        input, output);
    assert_true(open_file(rest, &file));
    read_cameras(&file, &c);
    assert_int_equal(c.count, 1);
    assert_float_equal(camera_path_length(&c.items[0].path), 1.5f, 1e-6f);
    for (float at = 0; at <= 1.5f; at += 0.013f) {
        struct view_camera camera;
        const float angle = at < 0.5f ? 0 : (at - 0.5f) * 1.57079633f;
        assert_true(camera_path_get(&c.items[0].path, at, &camera));
        assert_float_equal(camera.position.x, 8 * sinf(angle), 2e-3f);
        assert_float_equal(camera.position.y, 2, 1e-5f);
        assert_float_equal(camera.position.z, 8 * cosf(angle), 2e-3f);
        assert_float_equal(camera.yaw, -angle, 1e-4f);
        assert_float_equal(camera.pitch, 0, 1e-5f);
        assert_float_equal(camera.roll, 0, 1e-5f);
    }
    file_cameras_finish(&c);
    gltf_finish(&file);
}

static void steps_jump_at_their_times_and_each_animation_has_a_camera(void **state)
{
    (void)state;
    static const float times[] = {0, 1, 2};
    static const float places[] = {0, 0, 0, 10, 0, 0, 20, 0, 0};
    struct gltf_file file;
    struct file_cameras c;
    struct view_camera camera;
    char rest[2048];
    begin_file();
    const uint32_t input = add_floats("SCALAR", 3, 1, times);
    const uint32_t output = add_floats("VEC3", 3, 3, places);
    static const char channels[] =
        "\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":\"translation\"}}]";
    char samplers[256];
    snprintf(samplers, sizeof samplers, "\"samplers\":[{\"input\":%u,\"output\":%u,", input,
             output);
    snprintf(rest, sizeof rest,
             "\"nodes\":[{\"camera\":0,\"name\":\"eye\"}],\"cameras\":[{\"type\":\"perspective\","
             "\"perspective\":{\"yfov\":1}}],\"animations\":[{%s,%s\"interpolation\":\"STEP\"}]},"
             "{\"name\":\"fly\",%s,%s\"interpolation\":\"LINEAR\"}]}]",
             channels, samplers, channels, samplers);
    assert_true(open_file(rest, &file));
    read_cameras(&file, &c);
    assert_int_equal(c.count, 2);
    assert_string_equal(c.items[1].name, "eye: fly");
    static const float at[] = {0, 0.999f, 1, 1.999f, 2, 3}, x[] = {0, 0, 10, 10, 20, 20};
    for (int i = 0; i < 6; i++) {
        assert_true(camera_path_get(&c.items[0].path, at[i], &camera));
        assert_float_equal(camera.position.x, x[i], 0);
        assert_true(camera_path_get(&c.items[1].path, at[i], &camera));
        assert_float_equal(camera.position.x, 10 * fminf(at[i], 2), 1e-3f);
    }
    file_cameras_finish(&c);
    gltf_finish(&file);
}

/* Moves points step by step: scale, turn by q v q^-1, translation. */
static void chains_of_nodes_are_products_of_their_moves(void **state)
{
    (void)state;
    for (int round = 0; round < 20; round++) {
        char rest[2048] = "\"nodes\":[";
        double t[3][3], q[3][4], s[3][3], m[16];
        struct gltf_file file;
        const float zero = 0;
        begin_file();
        add_floats("SCALAR", 1, 1, &zero);
        for (int n = 0; n < 3; n++) {
            for (int k = 0; k < 4; k++)
                q[n][k] = round5(2 * draw() - 1);
            for (int k = 0; k < 3; k++) {
                t[n][k] = round5(8 * draw() - 4);
                s[n][k] = round5(draw() + 0.5);
            }
            snprintf(rest + strlen(rest), sizeof rest - strlen(rest),
                     "%s{\"translation\":[%.5f,%.5f,%.5f],\"rotation\":[%.5f,%.5f,%.5f,%.5f],"
                     "\"scale\":[%.5f,%.5f,%.5f]%s}",
                     n ? "," : "", t[n][0], t[n][1], t[n][2], q[n][0], q[n][1], q[n][2], q[n][3],
                     s[n][0], s[n][1], s[n][2],
                     n == 0   ? ",\"children\":[1]"
                     : n == 1 ? ",\"children\":[2]"
                              : "");
        }
        strcat(rest, "]");
        assert_true(open_file(rest, &file));
        const struct gltf_chain chain = {{0, 1, 2}, 3};
        gltf_chain_matrix(&file, &chain, NULL, 0, false, m);
        gltf_finish(&file);
        real p[3] = {1, 2, 3};
        for (int n = 2; n >= 0; n--) {
            const struct quaternion turn = unit(q[n]), back = {-turn.x, -turn.y, -turn.z, turn.w};
            const struct quaternion v = {p[0] * (real)s[n][0], p[1] * (real)s[n][1],
                                         p[2] * (real)s[n][2], 0};
            const struct quaternion to = multiply(multiply(turn, v), back);
            p[0] = to.x + (real)t[n][0];
            p[1] = to.y + (real)t[n][1];
            p[2] = to.z + (real)t[n][2];
        }
        for (int r = 0; r < 3; r++)
            assert_float_equal(m[r] + 2 * m[4 + r] + 3 * m[8 + r] + m[12 + r], (double)p[r], 1e-9);
    }
}

static void broken_animations_are_refused_with_their_place(void **state)
{
    (void)state;
    static const float grow[] = {0, 1, 2}, same[] = {0, 1, 1}, back[] = {0, 2, 1},
                       negative[] = {-1, 0, 1}, places[27] = {0}, huge[] = {0, 1, 1e9f};
    float not_a_number[9] = {0};
    not_a_number[4] = NAN;
    const struct {
        const float *times;
        uint32_t values, components;
        const float *numbers;
        const char *path, *interpolation, *cause;
    } rows[] = {
        {grow, 3, 3, places, "translation", "LINEAR", NULL},
        {grow, 9, 3, places, "translation", "CUBICSPLINE", NULL},
        {grow, 3, 3, places, "pointer", "LINEAR", NULL},
        {same, 3, 3, places, "translation", "LINEAR", "samplers[0]: time 2 is 1; times grow"},
        {back, 3, 3, places, "translation", "LINEAR", "samplers[0]: time 2 is 1; times grow"},
        {negative, 3, 3, places, "translation", "LINEAR", "samplers[0]: time 0 is -1"},
        {huge, 3, 3, places, "translation", "LINEAR", "samplers[0]: time 2 is 1e+09"},
        {grow, 2, 3, places, "translation", "LINEAR", "channels[0]: accessors[1] has 2 elements"},
        {grow, 3, 3, places, "translation", "CUBICSPLINE", "9 of 3 floats are needed"},
        {grow, 3, 3, places, "rotation", "LINEAR", "3 of 4 floats are needed"},
        {grow, 3, 3, places, "translation", "SMOOTH", "samplers[0].interpolation is not LINEAR"},
        {grow, 3, 3, not_a_number, "scale", "LINEAR", "has no number that can be used at 4"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char rest[1024];
        struct gltf_file file;
        begin_file();
        add_floats("SCALAR", 3, 1, rows[i].times);
        add_floats(rows[i].components == 3 ? "VEC3" : "VEC4", rows[i].values, rows[i].components,
                   rows[i].numbers);
        snprintf(rest, sizeof rest,
                 "\"nodes\":[{}],\"animations\":[{\"channels\":[{\"sampler\":0,\"target\":{"
                 "\"node\":0,\"path\":\"%s\"}}],\"samplers\":[{\"input\":0,\"output\":1,"
                 "\"interpolation\":\"%s\"}]}]",
                 rows[i].path, rows[i].interpolation);
        const bool opened = open_file(rest, &file);
        if (opened != !rows[i].cause || (rows[i].cause && !strstr(file.error, rows[i].cause)))
            fail_msg("row %zu: %s: %s", i, rows[i].cause, file.error);
        gltf_finish(&file);
    }
}

static void cameras_keep_their_axes_and_come_back_from_text(void **state)
{
    (void)state;
    for (int i = 0; i < 300; i++) {
        char text[256];
        struct vec3 forward = {(float)draw() - 0.5f, (float)draw() - 0.5f, (float)draw() - 0.5f};
        const struct vec3 other = {(float)draw() - 0.5f, (float)draw() - 0.5f,
                                   (float)draw() - 0.5f};
        const struct view_camera lens = {.fov = 1, .span = i % 2 ? 3.0f : 0.0f, .aspect = 1.5f};
        if (i < 20) /* straight down and up */
            forward = (struct vec3){0, i < 10 ? -1.0f : 1.0f, 0};
        forward = vec3_normalize(forward);
        const struct vec3 up = vec3_normalize(vec3_cross(vec3_cross(forward, other), forward));
        const struct view_camera camera =
            view_camera_of_axes((struct vec3){1, 2, 3}, forward, up, &lens);
        struct view_camera read;
        float m[4][4];
        view_camera_matrix(&camera, m);
        assert_float_equal(-m[0][2] * forward.x - m[1][2] * forward.y - m[2][2] * forward.z, 1,
                           1e-5f);
        assert_float_equal(m[0][1] * up.x + m[1][1] * up.y + m[2][1] * up.z, 1, 1e-5f);
        assert_true(view_camera_read(view_camera_write(&camera, text, sizeof text), &read));
        assert_memory_equal(&read, &camera, sizeof read);
        float flat[16];
        memcpy(flat, m, sizeof flat);
        const struct view_camera again = view_camera_of_matrix(flat, &lens);
        assert_float_equal(again.position.z, 3, 1e-5f);
        assert_float_equal(cosf(again.roll - camera.roll), 1, 1e-5f);
    }
}

static void a_narrow_picture_keeps_the_width_of_the_camera(void **state)
{
    (void)state;
    const struct view_camera eye = {.fov = 1, .aspect = 2},
                             plan = {.fov = 1, .span = 3, .aspect = 2};
    assert_float_equal(view_camera_extent(&eye, 4).y, tanf(0.5f), 1e-6f);
    assert_float_equal(view_camera_extent(&eye, 1).x, 2 * tanf(0.5f), 1e-6f);
    assert_float_equal(view_camera_extent(&plan, 4).x, 12, 1e-5f);
    assert_float_equal(view_camera_extent(&plan, 0.5f).x, 6, 1e-5f);
    assert_float_equal(view_camera_extent(&plan, 0.5f).y, 12, 1e-5f);
}

static void the_wheel_makes_the_view_of_parallel_rays_smaller(void **state)
{
    (void)state;
    struct view_camera camera = {.fov = 1, .span = 2, .aspect = 1};
    struct vec3 center = {0, 0, -1};
    const struct camera_wish wish = {.dolly = 2, .factor = 1, .seconds = 0.1f};
    view_camera_move(&camera, &wish, VIEW_WALK, 1.0, &center);
    assert_float_equal(camera.span, 2 * 0.88f * 0.88f, 1e-6f);
    assert_float_equal(camera.position.z, 0, 0);
    camera.span = 0;
    view_camera_move(&camera, &wish, VIEW_FLY, 1.0, &center);
    assert_float_equal(camera.span, 0, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_between_keys_are_those_of_another_formula),
        cmocka_unit_test(all_cameras_of_a_file_are_read_with_their_lenses),
        cmocka_unit_test(a_parent_that_turns_carries_its_camera_along_an_arc),
        cmocka_unit_test(steps_jump_at_their_times_and_each_animation_has_a_camera),
        cmocka_unit_test(chains_of_nodes_are_products_of_their_moves),
        cmocka_unit_test(broken_animations_are_refused_with_their_place),
        cmocka_unit_test(cameras_keep_their_axes_and_come_back_from_text),
        cmocka_unit_test(a_narrow_picture_keeps_the_width_of_the_camera),
        cmocka_unit_test(the_wheel_makes_the_view_of_parallel_rays_smaller),
    };
    return RUN_TESTS(tests);
}
