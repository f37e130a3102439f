/* strdup, realpath, strtok_r, strcasecmp */
#define _XOPEN_SOURCE 700

#include "camera.h"

#include "../common/input.h"
#include "../common/output_file.h"
#include "../common/text.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265f
#define MAX_PITCH 1.5f
#define MAX_POINTS 1000000u
#define MAX_FILE_SIZE (128u << 20)

struct vec3 view_camera_forward(const struct view_camera *camera)
{
    return (struct vec3){sinf(camera->yaw) * cosf(camera->pitch), sinf(camera->pitch),
                         -cosf(camera->yaw) * cosf(camera->pitch)};
}

/* Returns the right axis without the roll, so that the camera moves along the horizon. */
static struct vec3 level_right(const struct view_camera *camera)
{
    return (struct vec3){cosf(camera->yaw), 0, sinf(camera->yaw)};
}

struct vec3 view_camera_right(const struct view_camera *camera)
{
    const struct vec3 right = level_right(camera);
    if (camera->roll == 0)
        return right;
    const struct vec3 up = vec3_cross(right, view_camera_forward(camera));
    return vec3_sub(vec3_scale(right, cosf(camera->roll)), vec3_scale(up, sinf(camera->roll)));
}

struct view_camera view_camera_at(struct vec3 eye, struct vec3 target, float fov)
{
    const struct vec3 to = vec3_sub(target, eye);
    const float flat = sqrtf(to.x * to.x + to.z * to.z);
    return (struct view_camera){
        .position = eye, .yaw = atan2f(to.x, -to.z), .pitch = atan2f(to.y, flat), .fov = fov};
}

struct view_extent view_camera_extent(const struct view_camera *camera, float aspect)
{
    const float y = camera->span > 0 ? camera->span : tanf(camera->fov / 2);
    const float more = camera->aspect > aspect && aspect > 0 ? camera->aspect / aspect : 1.0f;
    return (struct view_extent){y * more * aspect, y * more};
}

void view_camera_matrix(const struct view_camera *camera, float m[4][4])
{
    const struct vec3 forward = view_camera_forward(camera), right = view_camera_right(camera);
    const struct vec3 up = vec3_cross(right, forward), eye = camera->position;
    const float columns[4][4] = {
        {right.x, up.x, -forward.x, 0},
        {right.y, up.y, -forward.y, 0},
        {right.z, up.z, -forward.z, 0},
        {-vec3_dot(right, eye), -vec3_dot(up, eye), vec3_dot(forward, eye), 1}};
    memcpy(m, columns, sizeof columns);
}

struct view_camera view_camera_of_axes(struct vec3 eye, struct vec3 forward, struct vec3 up,
                                       const struct view_camera *lens)
{
    struct view_camera camera = view_camera_at(eye, vec3_add(eye, forward), lens->fov);
    forward = vec3_normalize(forward);
    if (forward.x * forward.x + forward.z * forward.z < 1e-12f) /* looks straight up or down */
        camera.yaw = atan2f(up.x, -up.z) + (forward.y > 0 ? PI : 0.0f);
    camera.pitch = asinf(fmaxf(-1.0f, fminf(1.0f, forward.y)));
    const struct vec3 right = vec3_normalize(vec3_cross(forward, up));
    const struct vec3 level = level_right(&camera);
    const struct vec3 level_up = vec3_cross(level, view_camera_forward(&camera));
    camera.roll = atan2f(-vec3_dot(right, level_up), vec3_dot(right, level));
    camera.roll = fabsf(camera.roll) < 1e-6f ? 0.0f : camera.roll;
    camera.span = lens->span;
    camera.aspect = lens->aspect;
    return camera;
}

struct view_camera view_camera_of_matrix(const float m[16], const struct view_camera *lens)
{
    const struct vec3 up = {m[1], m[5], m[9]}, forward = {-m[2], -m[6], -m[10]};
    const struct vec3 eye = {-(m[0] * m[12] + m[1] * m[13] + m[2] * m[14]),
                             -(m[4] * m[12] + m[5] * m[13] + m[6] * m[14]),
                             -(m[8] * m[12] + m[9] * m[13] + m[10] * m[14])};
    return view_camera_of_axes(eye, forward, up, lens);
}

static float mix_angle(float a, float b, float part)
{
    float turn = fmodf(b - a, 2 * PI);
    if (turn > PI)
        turn -= 2 * PI;
    if (turn < -PI)
        turn += 2 * PI;
    return a + turn * part;
}

/* Numbers of a camera: the first six, or nine. */
static bool take_numbers(const float *n, struct view_camera *camera)
{
    *camera = (struct view_camera){{n[0], n[1], n[2]}, n[3], n[4], n[5], n[6], n[7], n[8]};
    return n[5] > 0.01f && n[5] < 3.0f && n[7] >= 0 && n[8] >= 0;
}

bool view_camera_read(const char *text, struct view_camera *camera)
{
    float n[9] = {0};
    char *end = NULL;
    int count = 0;
    do {
        n[count++] = strtof(text, &end);
        if (end == text || !isfinite(n[count - 1]))
            return false;
        text = end + 1;
    } while (count < 9 && (*end == ',' || *end == ' '));
    return *end == '\0' && (count == 6 || count == 9) && take_numbers(n, camera);
}

/* ",roll,span,aspect" of cameras that have them. */
static void write_more(const struct view_camera *c, char separator, char text[64])
{
    text[0] = '\0';
    if (c->roll != 0 || c->span != 0 || c->aspect != 0)
        snprintf(text, 64, "%c%.9g%c%.9g%c%.9g", separator, (double)c->roll, separator,
                 (double)c->span, separator, (double)c->aspect);
}

const char *view_camera_write(const struct view_camera *c, char *text, size_t size)
{
    char more[64];
    write_more(c, ',', more);
    snprintf(text, size, "%.9g,%.9g,%.9g,%.9g,%.9g,%.9g%s", (double)c->position.x,
             (double)c->position.y, (double)c->position.z, (double)c->yaw, (double)c->pitch,
             (double)c->fov, more);
    return text;
}

struct view_camera view_camera_mix(const struct view_camera *a, const struct view_camera *b,
                                   float part)
{
    return (struct view_camera){
        vec3_mix(a->position, b->position, part),  mix_angle(a->yaw, b->yaw, part),
        a->pitch + (b->pitch - a->pitch) * part,   a->fov + (b->fov - a->fov) * part,
        mix_angle(a->roll, b->roll, part),         a->span + (b->span - a->span) * part,
        a->aspect + (b->aspect - a->aspect) * part};
}

static void look(struct view_camera *camera, float right, float up)
{
    camera->yaw += right;
    camera->pitch = fmaxf(-MAX_PITCH, fminf(MAX_PITCH, camera->pitch + up));
}

static void orbit(struct view_camera *camera, const struct camera_wish *wish, struct vec3 *center)
{
    struct vec3 away = vec3_sub(camera->position, *center);
    float distance = sqrtf(vec3_dot(away, away));
    look(camera, -wish->look_right, -wish->look_up);
    distance *= powf(0.88f, wish->dolly) * powf(0.4f, wish->forward * wish->seconds);
    const struct vec3 right = vec3_scale(level_right(camera), -wish->pan_right * distance);
    const struct vec3 up = {0, wish->pan_up * distance, 0};
    *center = vec3_add(*center, vec3_add(right, up));
    camera->yaw -= wish->right * wish->seconds;
    camera->position = vec3_sub(*center, vec3_scale(view_camera_forward(camera), distance));
}

void view_camera_move(struct view_camera *camera, const struct camera_wish *wish, int motion,
                      double speed, struct vec3 *center)
{
    camera->span *= powf(0.88f, wish->dolly);
    if (motion == VIEW_ORBIT) {
        orbit(camera, wish, center);
        return;
    }
    look(camera, wish->look_right, wish->look_up);
    struct vec3 forward = view_camera_forward(camera);
    if (motion == VIEW_WALK)
        forward = (struct vec3){sinf(camera->yaw), 0, -cosf(camera->yaw)};
    const float step = (float)speed * wish->factor * wish->seconds;
    struct vec3 move =
        vec3_add(vec3_scale(forward, wish->forward), vec3_scale(level_right(camera), wish->right));
    move.y += wish->up;
    const float pan = (float)speed * 2.0f;
    move =
        vec3_add(vec3_scale(move, step), vec3_scale(level_right(camera), -wish->pan_right * pan));
    move.y += wish->pan_up * pan;
    camera->position = vec3_add(camera->position, move);
}

bool camera_path_add(struct camera_path *path, float seconds, const struct view_camera *camera)
{
    if (path->count == path->capacity) {
        size_t capacity = 2 * path->capacity + 256;
        struct camera_path_point *points = realloc(path->points, capacity * sizeof *points);
        if (!points)
            return false;
        path->points = points;
        path->capacity = capacity;
    }
    path->points[path->count++] = (struct camera_path_point){seconds, *camera};
    return true;
}

void camera_path_finish(struct camera_path *path)
{
    free(path->points);
    *path = (struct camera_path){0};
}

float camera_path_length(const struct camera_path *path)
{
    return path->count > 0 ? path->points[path->count - 1].seconds : 0.0f;
}

bool camera_path_get(const struct camera_path *path, float seconds, struct view_camera *camera)
{
    size_t next = 0;
    if (path->count == 0)
        return false;
    while (next < path->count && path->points[next].seconds <= seconds)
        next++;
    if (next == 0 || next == path->count) {
        *camera = path->points[next == 0 ? 0 : path->count - 1].camera;
        return true;
    }
    const struct camera_path_point *a = &path->points[next - 1], *b = &path->points[next];
    *camera =
        view_camera_mix(&a->camera, &b->camera, (seconds - a->seconds) / (b->seconds - a->seconds));
    return true;
}

static bool read_point(const char *line, struct camera_path *path)
{
    struct view_camera camera;
    float n[10] = {0};
    char *end = NULL;
    int count = 0;
    for (; count < 10 && line[strspn(line, " \t\r")]; count++, line = end) {
        n[count] = strtof(line, &end);
        if (end == line || !isfinite(n[count]))
            return false;
    }
    return (count == 7 || count == 10) && line[strspn(line, " \t\r")] == '\0' &&
           take_numbers(n + 1, &camera) && n[0] >= 0 && n[0] >= camera_path_length(path) &&
           path->count < MAX_POINTS && camera_path_add(path, n[0], &camera);
}

bool camera_path_read(const char *name, struct camera_path *path)
{
    char *text = NULL;
    size_t size = 0;
    *path = (struct camera_path){0};
    if (!input_read_file(name, MAX_FILE_SIZE, &text, &size)) {
        text_say("sluice-view: %s: %s", name, input_reason(errno));
        return false;
    }
    bool good = true;
    unsigned number = 1;
    char *rest = NULL;
    for (char *line = strtok_r(text, "\n", &rest); good && line;
         line = strtok_r(NULL, "\n", &rest), number += good)
        good = read_point(line, path);
    free(text);
    if (good && path->count > 0)
        return true;
    text_say("sluice-view: %s: line %u is no \"seconds x y z yaw pitch fov\" in order of time",
             name, number);
    camera_path_finish(path);
    return false;
}

bool camera_path_write(const char *name, const struct camera_path *path)
{
    struct output_file *output = output_file_begin(name);
    if (!output)
        return false;
    for (size_t i = 0; i < path->count; i++) {
        const struct view_camera *c = &path->points[i].camera;
        char more[64];
        write_more(c, ' ', more);
        fprintf(output_file_stream(output), "%.9g %.9g %.9g %.9g %.9g %.9g %.9g%s\n",
                (double)path->points[i].seconds, (double)c->position.x, (double)c->position.y,
                (double)c->position.z, (double)c->yaw, (double)c->pitch, (double)c->fov, more);
    }
    return output_file_end(output, true);
}
