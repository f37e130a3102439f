#include "oracle/camera.h"

#include <string.h>

/* The window that pbrt takes if a scene names none: the shorter side is [-1, 1]. */
static void usual_window(double width, double height, double window[4])
{
    double shorter = fmin(width, height);
    window[0] = -width / shorter;
    window[1] = width / shorter;
    window[2] = -height / shorter;
    window[3] = height / shorter;
}

static uint32_t cropped(uint32_t pixels, float from, float to)
{
    double count = ceil((double)pixels * (double)to) - ceil((double)pixels * (double)from);
    return count < 1 ? 1 : (uint32_t)count;
}

/* Adapts a window that the scene does not name to a picture with other proportions than the
 * film. */
static void follow(struct oracle_camera *camera, const SluicePbrtSceneInfo *info)
{
    double usual[4];
    usual_window(info->filmWidth, info->filmHeight, usual);
    for (int i = 0; i < 4; i++)
        if (fabs(usual[i] - (double)info->screenWindow[i]) > 1e-5)
            return;
    usual_window(camera->width, camera->height, camera->window);
}

void oracle_camera_init(struct oracle_camera *camera, const SluicePbrtSceneInfo *info,
                        const uint32_t dim[2])
{
    const float *crop = info->cropWindow;
    bool is_whole = crop[0] == 0 && crop[1] == 1 && crop[2] == 0 && crop[3] == 1;
    *camera = (struct oracle_camera){dim[0] ? dim[0] : cropped(info->filmWidth, crop[0], crop[1]),
                                     dim[1] ? dim[1] : cropped(info->filmHeight, crop[2], crop[3]),
                                     info->cameraKind == SLUICE_PBRT_CAMERA_PERSPECTIVE};
    matrix_of(info->cameraToWorld, camera->to_world);
    for (int i = 0; i < 4; i++)
        camera->window[i] = info->screenWindow[i];
    if (is_whole)
        follow(camera, info);
    double *w = camera->window, size[2] = {w[1] - w[0], w[3] - w[2]};
    double part[4] = {w[0] + size[0] * crop[0], w[0] + size[0] * crop[1], w[3] - size[1] * crop[3],
                      w[3] - size[1] * crop[2]};
    double reach = camera->is_perspective ? tan((double)info->fieldOfView * ORACLE_PI / 360) : 1;
    for (int i = 0; i < 4; i++)
        w[i] = part[i] * reach;
}

struct oracle_ray oracle_camera_ray(const struct oracle_camera *camera, double x, double y)
{
    const double *w = camera->window;
    struct vec p = vec(w[0] + (w[1] - w[0]) * x / camera->width,
                       w[3] - (w[3] - w[2]) * y / camera->height, camera->is_perspective ? 1 : 0);
    struct vec forward = camera->is_perspective ? p : vec(0, 0, 1);
    struct vec origin = camera->is_perspective ? vec(0, 0, 0) : p;
    return (struct oracle_ray){apply_point(camera->to_world, origin),
                               unit(apply_vector(camera->to_world, forward)), 1e300, 0};
}

double oracle_camera_spread(const struct oracle_camera *camera)
{
    double height = (camera->window[3] - camera->window[2]) / camera->height;
    return camera->is_perspective ? atan(height) : 0;
}
