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

struct vec3 view_camera_right(const struct view_camera *camera)
{
    return (struct vec3){cosf(camera->yaw), 0, sinf(camera->yaw)};
}

struct view_camera view_camera_at(struct vec3 eye, struct vec3 target, float fov)
{
    const struct vec3 to = vec3_sub(target, eye);
    const float flat = sqrtf(to.x * to.x + to.z * to.z);
    return (struct view_camera){eye, atan2f(to.x, -to.z), atan2f(to.y, flat), fov};
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

bool view_camera_read(const char *text, struct view_camera *camera)
{
    float n[6];
    char *end = NULL;
    for (int i = 0; i < 6; i++, text = end + (*end == ',')) {
        n[i] = strtof(text, &end);
        if (end == text || !isfinite(n[i]) || (i < 5 && *end != ',' && *end != ' '))
            return false;
    }
    *camera = (struct view_camera){{n[0], n[1], n[2]}, n[3], n[4], n[5]};
    return *end == '\0' && n[5] > 0.01f && n[5] < 3.0f;
}

const char *view_camera_write(const struct view_camera *c, char *text, size_t size)
{
    snprintf(text, size, "%.9g,%.9g,%.9g,%.9g,%.9g,%.9g", (double)c->position.x,
             (double)c->position.y, (double)c->position.z, (double)c->yaw, (double)c->pitch,
             (double)c->fov);
    return text;
}

struct view_camera view_camera_mix(const struct view_camera *a, const struct view_camera *b,
                                   float part)
{
    return (struct view_camera){
        vec3_mix(a->position, b->position, part), mix_angle(a->yaw, b->yaw, part),
        a->pitch + (b->pitch - a->pitch) * part, a->fov + (b->fov - a->fov) * part};
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
    const struct vec3 right = vec3_scale(view_camera_right(camera), -wish->pan_right * distance);
    const struct vec3 up = {0, wish->pan_up * distance, 0};
    *center = vec3_add(*center, vec3_add(right, up));
    camera->yaw -= wish->right * wish->seconds;
    camera->position = vec3_sub(*center, vec3_scale(view_camera_forward(camera), distance));
}

void view_camera_move(struct view_camera *camera, const struct camera_wish *wish, int motion,
                      double speed, struct vec3 *center)
{
    if (motion == VIEW_ORBIT) {
        orbit(camera, wish, center);
        return;
    }
    look(camera, wish->look_right, wish->look_up);
    struct vec3 forward = view_camera_forward(camera);
    if (motion == VIEW_WALK)
        forward = (struct vec3){sinf(camera->yaw), 0, -cosf(camera->yaw)};
    const float step = (float)speed * wish->factor * wish->seconds;
    struct vec3 move = vec3_add(vec3_scale(forward, wish->forward),
                                vec3_scale(view_camera_right(camera), wish->right));
    move.y += wish->up;
    const float pan = (float)speed * 2.0f;
    move = vec3_add(vec3_scale(move, step),
                    vec3_scale(view_camera_right(camera), -wish->pan_right * pan));
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
    float n[7];
    char *end = NULL;
    for (int i = 0; i < 7; i++, line = end) {
        n[i] = strtof(line, &end);
        if (end == line || !isfinite(n[i]))
            return false;
    }
    const struct view_camera camera = {{n[1], n[2], n[3]}, n[4], n[5], n[6]};
    return line[strspn(line, " \t\r")] == '\0' && n[6] > 0.01f && n[6] < 3.0f && n[0] >= 0 &&
           n[0] >= camera_path_length(path) && path->count < MAX_POINTS &&
           camera_path_add(path, n[0], &camera);
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
        fprintf(output_file_stream(output), "%.9g %.9g %.9g %.9g %.9g %.9g %.9g\n",
                (double)path->points[i].seconds, (double)c->position.x, (double)c->position.y,
                (double)c->position.z, (double)c->yaw, (double)c->pitch, (double)c->fov);
    }
    return output_file_end(output, true);
}
