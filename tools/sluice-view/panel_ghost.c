#include "panels.h"

#include <math.h>

#define NEAREST 1e-3f
#define NEAR_PART 0.02f /* of the scene's diagonal */
#define FAR_PART 0.25f

/* Position before the camera: right, up, forward. */
static struct vec3 before_camera(const struct view_camera *camera, struct vec3 position)
{
    const struct vec3 forward = view_camera_forward(camera), right = view_camera_right(camera);
    const struct vec3 to = vec3_sub(position, camera->position);
    return (struct vec3){vec3_dot(to, right), vec3_dot(to, vec3_cross(right, forward)),
                         vec3_dot(to, forward)};
}

static void draw_edge(const struct view_app *app, struct vec3 a, struct vec3 b)
{
    const float near = NEAREST;
    const float size = app->height / 2 / tanf(app->camera.fov / 2);
    struct vec3 from = before_camera(&app->camera, a), to = before_camera(&app->camera, b);
    if (from.z < near && to.z < near)
        return;
    if (from.z < near)
        from = vec3_mix(from, to, (near - from.z) / (to.z - from.z));
    if (to.z < near)
        to = vec3_mix(to, from, (near - to.z) / (from.z - to.z));
    ui_stroke_behind(app->width / 2 + from.x / from.z * size,
                     app->height / 2 - from.y / from.z * size, app->width / 2 + to.x / to.z * size,
                     app->height / 2 - to.y / to.z * size, UI_ORANGE, 2 * ui_scale());
}

static void find_corners(const struct view_app *app, float distance, struct vec3 corners[4])
{
    const struct view_camera *camera = &app->frozen;
    const struct vec3 forward = view_camera_forward(camera), right = view_camera_right(camera);
    const struct vec3 up = vec3_cross(right, forward);
    const float y = distance * tanf(camera->fov / 2), x = y * app->width / app->height;
    const struct vec3 center = vec3_add(camera->position, vec3_scale(forward, distance));
    for (int i = 0; i < 4; i++)
        corners[i] = vec3_add(center, vec3_add(vec3_scale(right, i == 0 || i == 3 ? -x : x),
                                               vec3_scale(up, i < 2 ? -y : y)));
}

void panel_ghost(const struct view_app *app)
{
    struct vec3 bounds[2], near[4], far[4];
    if (!app->is_frozen || !app->stage || app->height <= 0)
        return;
    stage_bounds(app->stage, bounds);
    const struct vec3 box = vec3_sub(bounds[1], bounds[0]);
    const float diagonal = sqrtf(vec3_dot(box, box));
    find_corners(app, NEAR_PART * diagonal, near);
    find_corners(app, FAR_PART * diagonal, far);
    for (int i = 0; i < 4; i++) {
        draw_edge(app, near[i], near[(i + 1) % 4]);
        draw_edge(app, far[i], far[(i + 1) % 4]);
        draw_edge(app, app->frozen.position, far[i]);
    }
}
