#include "camera.h"

#include <math.h>
#include <string.h>

#include "transform.h"

static uint32_t part(uint32_t pixels, float from, float to)
{
    const float size = ceilf((float)pixels * to) - ceilf((float)pixels * from);
    return size >= 1.0f ? (uint32_t)size : 1;
}

void camera_size(const struct scene *scene, const struct pbrt_options *options, uint32_t size[2])
{
    const SluicePbrtSceneInfo *info = &scene->info;
    const float *crop = info->cropWindow;
    size[0] = options->dim[0] ? options->dim[0] : part(info->filmWidth, crop[0], crop[1]);
    size[1] = options->dim[1] ? options->dim[1] : part(info->filmHeight, crop[2], crop[3]);
}

/** pbrt's default: [-1, 1] is the shorter side. */
static void default_window(float width, float height, float window[4])
{
    const float x = width > height ? width / height : 1.0f;
    const float y = width > height ? 1.0f : height / width;
    window[0] = -x, window[1] = x, window[2] = -y, window[3] = y;
}

/* Without a window in the scene, the window has the picture's aspect ratio. */
static void choose_window(const SluicePbrtSceneInfo *info, const uint32_t size[2], float window[4])
{
    const float *crop = info->cropWindow;
    float usual[4];
    memcpy(window, info->screenWindow, sizeof info->screenWindow);
    default_window((float)info->filmWidth, (float)info->filmHeight, usual);
    for (int i = 0; i < 4; i++)
        if (fabsf(usual[i] - window[i]) > 1e-4f)
            return;
    if (crop[0] == 0.0f && crop[1] == 1.0f && crop[2] == 0.0f && crop[3] == 1.0f)
        default_window((float)size[0], (float)size[1], window);
}

static void write_vector(const float m[12], float x, float y, float z, float out[3])
{
    const float v[3] = {x, y, z};
    transform_vector(m, v, out);
}

void camera_matrix(const struct scene *scene, const struct camera_view *view, float matrix[12])
{
    memcpy(matrix, scene->info.cameraToWorld, sizeof scene->info.cameraToWorld);
    if (view->given)
        camera_look_at(view, scene->info.cameraToWorld, matrix);
}

void camera_constants(const struct scene *scene, const float m[12], const uint32_t size[2],
                      struct PbrtLaunch *c)
{
    const SluicePbrtSceneInfo *info = &scene->info;
    const float *crop = info->cropWindow;
    const bool perspective = info->cameraKind == SLUICE_PBRT_CAMERA_PERSPECTIVE;
    const float scale =
        perspective ? tanf(0.5f * info->fieldOfView * 3.14159265358979f / 180.0f) : 1.0f;
    float window[4];
    choose_window(info, size, window);
    const float width = window[1] - window[0], height = window[3] - window[2];
    const float left = window[0] + crop[0] * width, top = window[3] - crop[2] * height;
    const float across = (crop[1] - crop[0]) * width, along = (crop[3] - crop[2]) * height;
    c->width = size[0];
    c->height = size[1];
    for (int i = 0; i < 3; i++)
        c->eye[i] = m[4 * i + 3];
    write_vector(m, left * scale, top * scale, perspective ? 1.0f : 0.0f, c->corner);
    write_vector(m, across * scale, 0, 0, c->right);
    write_vector(m, 0, -along * scale, 0, c->down);
    write_vector(m, 0, 0, 1, c->forward);
    c->flags |= perspective ? 0 : PBRT_LAUNCH_ORTHOGRAPHIC;
    const float pixel = fabsf(along) * scale / (float)size[1];
    const float unit =
        sqrtf(m[1] * m[1] + m[5] * m[5] + m[9] * m[9]); /* length of the camera's y axis */
    c->spread = perspective ? atanf(pixel) : pixel * unit;
}
