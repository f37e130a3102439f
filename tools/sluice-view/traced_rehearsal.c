#include "traced_rehearsal.h"

#include "controls.h"
#include "traced.h"

#define SIDE 16u

static void draw(const struct gpu *gpu, const struct scene_data *scene)
{
    struct scene_data share = {0};
    struct view_settings settings;
    const struct stage_request request = {.gpu = gpu, .threads = 1};
    controls_set_defaults(&settings);
    settings.view = VIEW_RESIDENT;
    if (!scene_pbrt_share(scene->pbrt, scene, &share))
        return;
    struct stage *stage = stage_create(&request, &settings, &share);
    const struct stage_draw draw = {
        .settings = &settings, .camera = scene->camera, .width = SIDE, .height = SIDE};
    if (stage)
        (void)traced_trace_once(stage_traced(stage), &draw);
    stage_destroy(stage);
}

void traced_rehearse(const struct gpu *gpu, const struct scene_data *scene)
{
    struct gpu second;
    bool unsupported = false;
    const struct gpu_request request = {
        .device = gpu->properties.deviceName,
        .modes = {SLUICE_RESIDENCY_MODE_PAGED, SLUICE_RESIDENCY_MODE_PAGED},
        .ray_tracing = true,
        .buffer_addresses = true,
        .byte_pages = true,
        .first = gpu};
    if (gpu->properties.deviceType != VK_PHYSICAL_DEVICE_TYPE_CPU ||
        !gpu_create(&request, &second, &unsupported))
        return;
    draw(&second, scene);
    gpu_destroy(&second);
}
