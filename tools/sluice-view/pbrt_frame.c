#include "pbrt_frame.h"

#include <math.h>
#include <string.h>

#define DIAGONAL 20.0f
#define LEAST_UPRIGHT 0.3f /* smallest part of the picture's up vector along y or z */

static struct vec3 column_of(const float m[12], int column)
{
    const struct vec3 v = {m[column], m[4 + column], m[8 + column]};
    const float length = sqrtf(vec3_dot(v, v));
    return vec3_scale(v, length > 0 ? 1 / length : 0);
}

static struct vec3 unit_vector(int axis, float sign)
{
    return (struct vec3){axis == 0 ? sign : 0, axis == 1 ? sign : 0, axis == 2 ? sign : 0};
}

/* Returns the axis, y or z, that is more upright in the picture; x if neither is upright. */
static int find_up(const float up[3])
{
    const int axis = fabsf(up[2]) > fabsf(up[1]) ? 2 : 1;
    return fabsf(up[axis]) < LEAST_UPRIGHT && fabsf(up[0]) > fabsf(up[axis]) ? 0 : axis;
}

static float unit_of(const SluicePbrtBounds *box)
{
    float square = 0;
    for (int i = 0; i < 3; i++)
        square += (box->most[i] - box->least[i]) * (box->most[i] - box->least[i]);
    const float unit = sqrtf(square) / DIAGONAL;
    return box->least[0] <= box->most[0] && isfinite(unit) && unit > 0 ? unit : 1.0f;
}

static struct vec3 to_viewer(const struct pbrt_frame *f, struct vec3 v)
{
    return (struct vec3){vec3_dot(f->axes[0], v), vec3_dot(f->axes[1], v), vec3_dot(f->axes[2], v)};
}

static struct vec3 to_world(const struct pbrt_frame *f, struct vec3 v)
{
    return vec3_add(vec3_scale(f->axes[0], v.x),
                    vec3_add(vec3_scale(f->axes[1], v.y), vec3_scale(f->axes[2], v.z)));
}

void pbrt_frame_init(const float camera_to_world[12], const SluicePbrtBounds *box, float fov,
                     struct pbrt_frame *f)
{
    const struct vec3 right = column_of(camera_to_world, 0), up = column_of(camera_to_world, 1);
    const struct vec3 forward = column_of(camera_to_world, 2);
    const float upright[3] = {up.x, up.y, up.z};
    const int axis = find_up(upright);
    const bool mirrored = vec3_dot(right, vec3_cross(forward, up)) < 0;
    *f = (struct pbrt_frame){.unit = unit_of(box)};
    memcpy(f->scene_to_world, camera_to_world, sizeof f->scene_to_world);
    f->axes[1] = unit_vector(axis, upright[axis] < 0 ? -1.0f : 1.0f);
    f->axes[2] = unit_vector((axis + 1) % 3, 1);
    f->axes[0] = vec3_scale(vec3_cross(f->axes[1], f->axes[2]), mirrored ? -1.0f : 1.0f);
    const struct vec3 ahead = to_viewer(f, forward);
    const float eye[3] = {camera_to_world[3], camera_to_world[7], camera_to_world[11]};
    f->camera =
        (struct view_camera){.position = pbrt_frame_position(f, eye),
                             .yaw = atan2f(ahead.x, -ahead.z),
                             .pitch = atan2f(ahead.y, sqrtf(ahead.x * ahead.x + ahead.z * ahead.z)),
                             .fov = fov};
}

struct vec3 pbrt_frame_position(const struct pbrt_frame *f, const float world[3])
{
    return vec3_scale(to_viewer(f, (struct vec3){world[0], world[1], world[2]}), 1 / f->unit);
}

/* Writes the axes of a camera in the world: right, up and forward. */
static void write_axes(const struct pbrt_frame *f, const struct view_camera *camera,
                       struct vec3 axes[3])
{
    const struct vec3 forward = view_camera_forward(camera), right = view_camera_right(camera);
    axes[0] = to_world(f, right);
    axes[1] = to_world(f, vec3_cross(right, forward));
    axes[2] = to_world(f, forward);
}

static bool is_same(const struct view_camera *a, const struct view_camera *b)
{
    return memcmp(&a->position, &b->position, sizeof a->position) == 0 && a->yaw == b->yaw &&
           a->pitch == b->pitch;
}

/* Turns the scene's camera by the rotation from its view to the view of `camera`. */
void pbrt_frame_matrix(const struct pbrt_frame *f, const struct view_camera *camera,
                       float matrix[12])
{
    struct vec3 from[3], to[3];
    memcpy(matrix, f->scene_to_world, sizeof f->scene_to_world);
    if (is_same(camera, &f->camera))
        return;
    write_axes(f, &f->camera, from);
    write_axes(f, camera, to);
    for (int column = 0; column < 3; column++) {
        const float *m = f->scene_to_world;
        const struct vec3 v = {m[column], m[4 + column], m[8 + column]};
        struct vec3 turned = {0, 0, 0};
        for (int i = 0; i < 3; i++)
            turned = vec3_add(turned, vec3_scale(to[i], vec3_dot(from[i], v)));
        matrix[column] = turned.x;
        matrix[4 + column] = turned.y;
        matrix[8 + column] = turned.z;
    }
    const struct vec3 eye = vec3_scale(to_world(f, camera->position), f->unit);
    matrix[3] = eye.x;
    matrix[7] = eye.y;
    matrix[11] = eye.z;
}
