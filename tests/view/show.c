#include "show.h"

#include "panels.h"
#include "scene_data.h"

#include <stdlib.h>

static struct show *show;

static void choose_settings(struct view_settings *settings)
{
    settings->residency = VIEW_PAGED;
    settings->anisotropy = 4;
    settings->probability = 1;
    settings->textures_per_frame = 0;
    settings->fade = 0;
    settings->panels = 1; /* off */
}

int show_begin(void **state)
{
    (void)state;
    struct scene_data scene = {0};
    bool unsupported = false;
    show = calloc(1, sizeof *show);
    app_init(&show->app);
    choose_settings(&show->app.settings);
    const struct gpu_request request = {
        .modes = {SLUICE_RESIDENCY_MODE_PAGED, SLUICE_RESIDENCY_MODE_AUTO}};
    if (!ui_create(1) || !gpu_create(&request, &show->gpu, &unsupported))
        return unsupported ? 0 : -1;
    show->app.gpu = &show->gpu;
    show->app.deterministic = true;
    show->app.picture_scale = 1;
    const struct stage_request stage = {.gpu = &show->gpu, .threads = 1};
    if (!frames_create(&show->gpu, SHOW_WIDTH, SHOW_HEIGHT, &show->frames) ||
        !scene_data_make_room(&scene))
        return -1;
    show->stage = stage_create(&stage, &show->app.settings, &scene);
    return show->stage && app_open(&show->app, show->stage, false) ? 0 : -1;
}

int show_end(void **state)
{
    (void)state;
    if (show->stage)
        frames_wait(&show->frames);
    app_finish(&show->app);
    stage_destroy(show->stage);
    frames_destroy(&show->frames);
    gpu_destroy(&show->gpu);
    ui_destroy();
    free(show);
    return 0;
}

struct show *show_get(void)
{
    if (!show->stage)
        SKIP_TEST("no Vulkan device");
    return show;
}

SluiceStreamedTextureManager *show_manager(void)
{
    SluiceStreamedTextureManager *manager = NULL;
    sluiceGetVulkanStreamerManager(stage_streamer(show->stage), &manager);
    return manager;
}

const uint8_t *show_draw(void)
{
    struct view_app *app = &show->app;
    struct ui_geometry geometry;
    struct frames_end end = {.geometry = &geometry, .read = true};
    const struct ui_input input = {.width = SHOW_WIDTH,
                                   .height = SHOW_HEIGHT,
                                   .seconds = SHOW_FRAME_MICROSECONDS / 1e6f,
                                   .mouse_x = -1,
                                   .mouse_y = -1};
    VkCommandBuffer commands = frames_begin(&show->frames);
    assert_true(commands != VK_NULL_HANDLE);
    ui_begin_frame(&input);
    app_input(app, &input);
    panels_draw(app);
    ui_end_frame(&geometry);
    show->clock += SHOW_FRAME_MICROSECONDS;
    stage_apply(show->stage, &app->settings);
    const struct stage_draw draw = {.settings = &app->settings,
                                    .camera = app->camera,
                                    .width = SHOW_WIDTH,
                                    .height = SHOW_HEIGHT,
                                    .number = show->frames.number,
                                    .time_stamp = show->clock};
    assert_true(stage_record(show->stage, &draw, commands, &end));
    assert_true(frames_end(&show->frames, &end));
    const uint8_t *pixels = frames_pixels(&show->frames);
    assert_true(frames_wait(&show->frames) && stage_settle(show->stage));
    facts_update(&app->facts, show->stage, &app->settings, SHOW_FRAME_MICROSECONDS / 1e6);
    return pixels;
}
