#include "overlay.h"

#include <math.h>

#define NEAREST 1e-3f

/* Returns a position in the camera's axes: right, up, forward. */
static struct vec3 before_camera(const struct view_camera *camera, struct vec3 position)
{
    const struct vec3 forward = view_camera_forward(camera), right = view_camera_right(camera);
    const struct vec3 to = vec3_sub(position, camera->position);
    return (struct vec3){vec3_dot(to, right), vec3_dot(to, vec3_cross(right, forward)),
                         vec3_dot(to, forward)};
}

/* Writes the pixel of a point in front of the camera. */
static void project(const struct view_app *app, struct vec3 point, float xy[2])
{
    const struct view_extent extent = view_camera_extent(&app->camera, app->width / app->height);
    const float distance = app->camera.span > 0 ? 1.0f : point.z;
    xy[0] = app->width / 2 * (1 + point.x / distance / extent.x);
    xy[1] = app->height / 2 * (1 - point.y / distance / extent.y);
}

void overlay_edge(const struct view_app *app, struct vec3 a, struct vec3 b, uint32_t color)
{
    const float near = NEAREST;
    float begin[2], end[2];
    struct vec3 from = before_camera(&app->camera, a), to = before_camera(&app->camera, b);
    if (from.z < near && to.z < near)
        return;
    if (from.z < near)
        from = vec3_mix(from, to, (near - from.z) / (to.z - from.z));
    if (to.z < near)
        to = vec3_mix(to, from, (near - to.z) / (from.z - to.z));
    project(app, from, begin);
    project(app, to, end);
    ui_stroke_behind(begin[0], begin[1], end[0], end[1], color, 2 * ui_scale());
}

void overlay_label(const struct view_app *app, struct vec3 at, const char *text)
{
    float xy[2];
    const struct vec3 point = before_camera(&app->camera, at);
    if (point.z < NEAREST)
        return;
    project(app, point, xy);
    ui_label_behind(xy[0] + 6 * ui_scale(), xy[1], 3 * ui_scale(), text);
}

static float diagonal_of(const struct view_app *app)
{
    struct vec3 bounds[2];
    stage_bounds(app->stage, bounds);
    const struct vec3 box = vec3_sub(bounds[1], bounds[0]);
    return sqrtf(vec3_dot(box, box));
}

static void find_corners(const struct view_app *app, const struct view_camera *camera,
                         float distance, struct vec3 corners[4])
{
    const struct vec3 forward = view_camera_forward(camera), right = view_camera_right(camera);
    const struct vec3 up = vec3_cross(right, forward);
    const struct view_extent extent = view_camera_extent(camera, app->width / app->height);
    const float scale = camera->span > 0 ? 1.0f : distance;
    const float x = extent.x * scale, y = extent.y * scale;
    const struct vec3 center = vec3_add(camera->position, vec3_scale(forward, distance));
    for (int i = 0; i < 4; i++)
        corners[i] = vec3_add(center, vec3_add(vec3_scale(right, i == 0 || i == 3 ? -x : x),
                                               vec3_scale(up, i < 2 ? -y : y)));
}

void overlay_frustum(const struct view_app *app, const struct view_camera *camera, float distance,
                     uint32_t color)
{
    struct vec3 corners[4];
    find_corners(app, camera, distance * diagonal_of(app), corners);
    for (int i = 0; i < 4; i++) {
        overlay_edge(app, corners[i], corners[(i + 1) % 4], color);
        overlay_edge(app, camera->position, corners[i], color);
    }
}
