/* strdup, realpath, strtok_r, strcasecmp */
#define _XOPEN_SOURCE 700

#include "viewer.h"

#include "controls.h"
#include "messages.h"
#include "panels.h"
#include "played_app.h"
#include "played_facts.h"
#include "recent.h"
#include "scene_hall.h"
#include "sets.h"
#include "settings_file.h"
#include "texture_actions.h"

#include "../common/clock.h"
#include "../common/log.h"
#include "../common/output_file.h"
#include "../common/text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define EXIT_NO_DEVICE 77
#define USUAL_FRAMES 120u
#define MAX_STEP 0.1
#define SWEEPING_FRAMES 10u /* frames per second while a sweep measures times */

static bool is_cpu(const struct viewer *v)
{
    return v->gpu.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
}

static double render_scale(const struct viewer *v)
{
    const double scale = v->app.settings.render_scale;
    if (scale > 0 || !is_cpu(v))
        return scale > 0 ? scale : 1.0;
    return v->stage && stage_traced(v->stage) ? 0.25 : 0.5;
}

static bool create_gpu(struct viewer *v, bool *unsupported)
{
    static const SluiceResidencyMode modes[] = {
        SLUICE_RESIDENCY_MODE_AUTO, SLUICE_RESIDENCY_MODE_SPARSE, SLUICE_RESIDENCY_MODE_PAGED,
        SLUICE_RESIDENCY_MODE_DENSE};
    struct gpu_request request = {.device = v->options->device,
                                  .validation = v->options->validation,
                                  .modes = {modes[v->app.settings.residency], modes[0]},
                                  .ray_tracing = true,
                                  .build_queue = true,
                                  .buffer_addresses = true,
                                  .byte_pages = true,
                                  .every_mode = true};
    if (v->window)
        request.instance_extensions =
            window_extensions(v->window, &request.instance_extension_count);
    return gpu_create(&request, &v->gpu, unsupported);
}

static void drop(struct viewer *v, const char *path)
{
    struct file_list paths = {0};
    if (files_add(path, &paths))
        viewer_reopen(v, &paths);
    files_finish(&paths);
}

/* Sets B from the command line, which overrides files of settings. `kept`: B has the settings of
 * the file. */
static void begin_b(struct viewer *v, bool kept)
{
    const struct option_texts *texts = &v->options->b;
    if (!kept)
        sets_copy(&v->app.settings, &v->app.b);
    if (texts->count > 0)
        v->app.settings.compared = VIEW_WITH_B;
    for (size_t i = 0; i < texts->count; i++)
        sets_read(&v->app.b, texts->items[i],
                  "sluice-view: --b"); /* cannot fail: options_read has checked the text */
}

static void go_to_frame(struct viewer *v, uint32_t frame)
{
    if (!v->stage || !stage_played(v->stage))
        text_say("sluice-view: frame %u: no recording is shown", frame);
    else
        played_app_go(&v->app, frame);
}

static void take_script_step(struct viewer *v, const struct script_step *step)
{
    struct ui_input *in = &v->input;
    switch (step->kind) {
    case SCRIPT_MOVE:
        in->mouse_x = step->x;
        in->mouse_y = step->y;
        break;
    case SCRIPT_BUTTON: in->buttons[step->number] = step->down; break;
    case SCRIPT_KEY: window_note_key(in, step->number, step->down); break;
    case SCRIPT_WHEEL: in->wheel += step->x; break;
    case SCRIPT_TYPE: window_note_text(in, step->text); break;
    case SCRIPT_DROP: drop(v, step->text); break;
    case SCRIPT_SET: controls_set(&v->app.settings, step->text, step->value, "sluice-view"); break;
    case SCRIPT_SET_B: app_set_b(&v->app, step->text, step->value); break;
    case SCRIPT_DO: texture_actions_do(&v->app, step->text); break;
    case SCRIPT_RECORD: viewer_begin_recording(v, step->text); break;
    case SCRIPT_FRAME: go_to_frame(v, (uint32_t)step->number); break;
    case SCRIPT_SCREENSHOT: snprintf(v->screenshot, sizeof v->screenshot, "%s", step->text); break;
    case SCRIPT_RESET:
        app_reset(&v->app, &v->options->settings, v->stage && !v->options->still);
        begin_b(v, false);
        break;
    case SCRIPT_QUIT: v->app.quit = true; break;
    }
}

/* Handles Esc while a scene is being opened: cancels the load. */
static void take_escape(struct viewer *v)
{
    struct ui_input *in = &v->input;
    for (uint32_t i = 0; v->load && i < in->key_count; i++)
        if (in->keys[i].key == VIEW_KEY_ESCAPE && in->keys[i].down) {
            memmove(&in->keys[i], &in->keys[i + 1], (in->key_count - i - 1) * sizeof *in->keys);
            in->key_count--;
            viewer_cancel_load(v);
            return;
        }
}

static void gather_input(struct viewer *v)
{
    struct file_list dropped;
    v->input.wheel = 0;
    v->input.key_count = 0;
    v->input.text[0] = '\0';
    if (v->window) {
        window_poll(v->window, &v->input);
        if (window_dropped(v->window, &dropped))
            viewer_reopen(v, &dropped);
        files_finish(&dropped);
        v->app.quit |= window_closed(v->window);
    }
    for (const struct script_step *step; (step = script_next(&v->script, v->frame));)
        take_script_step(v, step);
    take_escape(v);
}

static double next_step(struct viewer *v)
{
    uint32_t cap = v->app.settings.frame_cap;
    if (!v->window)
        return 1.0 / (cap ? cap : 60);
    if (v->trade.state == TRADE_RUNS && (cap == 0 || cap > SWEEPING_FRAMES))
        cap = SWEEPING_FRAMES;
    if (cap > 0)
        clock_sleep_until(v->last_time + 1.0 / cap);
    const double now = clock_seconds();
    double step = now - v->last_time;
    v->last_time = now;
    v->app.facts.real_seconds = step;
    return step > MAX_STEP ? MAX_STEP : step > 1e-4 ? step : 1e-4;
}

static void name_screenshot(struct viewer *v, char *path, size_t size)
{
    do
        snprintf(path, size, "sluice-view-%02u.png", ++v->screenshot_number);
    while (access(path, F_OK) == 0 && v->screenshot_number < 1000);
}

static void begin_large(struct viewer *v)
{
    char path[64];
    name_screenshot(v, path, sizeof path);
    if (!large_picture_begin(&v->gpu, 2 * v->frames.target.width, 2 * v->frames.target.height, path,
                             &v->large))
        app_say(&v->app, "No picture at twice the resolution: Shift+I says why");
}

static void answer_requests(struct viewer *v)
{
    struct view_app *app = &v->app;
    if (app->restart && v->stage && !stage_traced(v->stage))
        stage_restart(v->stage);
    else if (app->restart) /* a traced scene is opened again, with a new loader */
        app->reload = true;
    viewer_reopen_if_needed(v);
    if (app->reload)
        viewer_reopen(v, NULL);
    viewer_open_chosen(v);
    if (app->screenshot)
        name_screenshot(v, v->screenshot, sizeof v->screenshot);
    if (app->screenshot_large && v->stage && stage_streamer(v->stage))
        begin_large(v);
    app->screenshot_large = false;
    if (app->trace && v->recorder)
        viewer_end_recording(v);
    else if (app->trace)
        viewer_begin_recording(v, NULL);
    viewer_swap(v);
    viewer_apply(v);
    if (v->stage && app->step_tile && stage_streamer(v->stage))
        sluiceStepVulkanLoads(stage_streamer(v->stage), 1);
    if (v->window)
        window_set_full_screen(v->window, app->settings.full_screen != 0);
    if (app->reload_shaders)
        viewer_reload_shaders(v);
    viewer_follow_trade(v);
    app->restart = app->reload = app->trace = app->step_tile = false;
}

/* Returns true if FLIP needs copies of this frame's pictures. */
static bool follow_flip(struct viewer *v, const struct stage_draw *draw, struct frames_end *end,
                        VkCommandBuffer commands)
{
    const bool wanted =
        v->other && app_shows_difference(&v->app) && v->app.settings.difference != VIEW_PIXELS;
    const bool copies = flip_map_begin_frame(&v->flip, &v->gpu, v->frames.number, wanted,
                                             draw->width, draw->height);
    ui_texels_record(&v->flip.texels, commands);
    if (v->flip.texels.filled)
        end->views[UI_TEXTURE_FLIP] = v->flip.texels.image.view;
    return copies;
}

/* Notes the motion in each frame, since --predict may be set at any time. */
static void note_motion(struct viewer *v)
{
    const struct view_camera *camera = &v->app.camera;
    float look[4][4];
    view_camera_matrix(camera, look);
    (void)sluiceAddCameraFrame(&v->motion, &look[0][0],
                               v->app.seconds); /* on failure the motion is unknown */
}

static struct stage_ahead look_ahead(struct viewer *v, const struct stage_draw *draw)
{
    const SluiceLookAheadInfo info = {.structSize = sizeof info,
                                      .seconds = draw->settings->predict,
                                      .frameIndex = draw->number,
                                      .pictureWidth = draw->width,
                                      .pictureHeight = draw->height};
    SluiceLookAhead ahead = {.structSize = sizeof ahead};
    if (sluicePredictCamera(&v->motion, &info, &ahead) != SLUICE_SUCCESS || !ahead.draw)
        return (struct stage_ahead){.draw = false};
    return (struct stage_ahead){true, view_camera_of_matrix(ahead.viewMatrix, &draw->camera),
                                ahead.width, ahead.height, ahead.lodBias};
}

/* Records one picture. Half 0 is A. Writes time stamps while both halves are drawn. */
static bool record_half(struct viewer *v, uint32_t half, struct stage_draw *draw, VkBuffer copy,
                        struct frames_end *end, VkCommandBuffer commands)
{
    const double begin = clock_seconds();
    draw->copy = copy;
    draw->ahead = look_ahead(v, draw);
    if (v->other)
        frames_begin_half(&v->frames, half);
    if (!stage_record(half == 0 ? v->stage : v->other, draw, commands, end))
        return false;
    if (v->other) {
        frames_end_half(&v->frames, half);
        half_series_add(&v->app.times[half].host, clock_seconds() - begin);
    }
    if (v->frames.halves_known >> half & 1)
        half_series_add(&v->app.times[half].gpu, v->frames.half_seconds[half]);
    return true;
}

/* Records both pictures. The order alternates, so that neither half is always last. */
static bool record_halves(struct viewer *v, const struct stage_draw *draw, bool copies,
                          struct frames_end *end, VkCommandBuffer commands)
{
    static const uint32_t textures[2] = {UI_TEXTURE_PICTURE, UI_TEXTURE_OTHER};
    struct view_settings settings[2] = {v->app.settings, viewer_second_settings(v)};
    VkImageView views[2] = {VK_NULL_HANDLE, VK_NULL_HANDLE};
    note_motion(v);
    for (uint32_t i = 0; i < 2; i++) {
        const uint32_t half = v->other ? (uint32_t)(i + v->frames.number) % 2 : i;
        struct stage_draw own = *draw;
        if (half == 1 && !v->other)
            continue;
        own.settings = &settings[half];
        if (half == 0 && v->large.path[0]) {
            own.large = &v->large.target;
            own.large_copy = v->large.pixels.buffer;
        }
        settings[half].pause = settings[half].pause && !v->app.step;
        if (!record_half(v, half, &own, copies ? v->flip.pictures[half].buffer : VK_NULL_HANDLE,
                         end, commands))
            return false;
        views[half] = end->views[UI_TEXTURE_PICTURE];
    }
    for (uint32_t half = 0; half < 2; half++)
        if (views[half])
            end->views[textures[half]] = views[half];
    if (v->other)
        v->app.truth_part = stage_resident_part(v->other);
    return true;
}

static bool record(struct viewer *v, struct frames_end *end, VkCommandBuffer commands)
{
    const double scale = v->app.picture_scale;
    struct stage_draw draw = {.settings = &v->app.settings,
                              .camera = v->app.camera,
                              .width = (uint32_t)(v->input.width * scale + 0.5),
                              .height = (uint32_t)(v->input.height * scale + 0.5),
                              .number = v->frames.number,
                              .time_stamp = v->clock};
    draw.width = draw.width < 16 ? 16 : draw.width;
    draw.height = draw.height < 16 ? 16 : draw.height;
    if (!v->stage || stage_played(v->stage))
        return true;
    const bool copies = follow_flip(v, &draw, end, commands);
    if (v->app.open[PANEL_TEXTURES])
        thumbs_begin(&v->thumbs, &v->gpu, v->stage, v->options->deterministic);
    thumbs_record(&v->thumbs, v->frames.number, commands);
    if (v->thumbs.texels.filled)
        end->views[UI_TEXTURE_THUMBS] = v->thumbs.texels.image.view;
    return record_halves(v, &draw, copies, end, commands);
}

static bool write_figures(struct viewer *v)
{
    if (!v->csv)
        return true;
    FILE *file = output_file_stream(v->csv);
    if (v->frame == 0) {
        fprintf(file, "frame");
        for (int i = 0; i < SERIES_COUNT; i++)
            fprintf(file, ",%s", facts_series_name((enum facts_series)i));
        fprintf(file, "\n");
    }
    fprintf(file, "%u", v->frame);
    for (int i = 0; i < SERIES_COUNT; i++)
        fprintf(file, ",%.6g", (double)v->app.facts.latest[i]);
    return fprintf(file, "\n") > 0;
}

/* Acquires an image before the frame records commands, so that none must be abandoned. */
static enum swapchain_outcome acquire(struct viewer *v, struct frames_end *end)
{
    uint32_t width, height;
    window_size(v->window, &width, &height);
    if (width == 0 || height == 0)
        return SWAPCHAIN_OUTDATED;
    viewer_follow_vsync(v);
    if (v->swapchain.outdated || width != v->swapchain.width || height != v->swapchain.height) {
        if (!frames_wait(&v->frames))
            return SWAPCHAIN_FAILED;
        vkQueueWaitIdle(v->gpu.queue);
        enum swapchain_outcome outcome =
            swapchain_create(&v->gpu, window_surface(v->window), width, height, &v->swapchain);
        if (outcome != SWAPCHAIN_GOOD)
            return outcome;
        viewer_say_vsync(v);
    }
    if ((v->frames.target.width != v->swapchain.width ||
         v->frames.target.height != v->swapchain.height) &&
        !frames_resize(&v->frames, v->swapchain.width, v->swapchain.height))
        return SWAPCHAIN_FAILED;
    end->swapchain = &v->swapchain;
    return swapchain_acquire(&v->swapchain, frames_slot(&v->frames), &end->image);
}

static bool draw_frame(struct viewer *v, double step)
{
    struct ui_geometry geometry;
    struct frames_end end = {.geometry = &geometry};
    if (!viewer_follow_size(v))
        return false;
    if (v->window) {
        enum swapchain_outcome outcome = acquire(v, &end);
        if (outcome != SWAPCHAIN_GOOD)
            return outcome == SWAPCHAIN_OUTDATED;
    }
    VkCommandBuffer commands = viewer_fit_other(v) ? frames_begin(&v->frames) : VK_NULL_HANDLE;
    if (!commands)
        return false;
    const double begin = clock_seconds();
    v->input.width = (float)v->frames.target.width;
    v->input.height = (float)v->frames.target.height;
    v->input.seconds = (float)step;
    const int panels = v->app.settings.panels;
    v->app.picture_scale = (float)render_scale(v);
    ui_begin_frame(&v->input);
    app_input(&v->app, &v->input);
    app_move(&v->app, step);
    if (v->stage && stage_played(v->stage)) /* the cursor has moved */
        played_facts_update(v->stage, &v->app.facts);
    if (v->app.screenshot && v->app.screenshot_plain)
        v->app.settings.panels = 1;
    panels_draw(&v->app);
    if (v->app.screenshot && v->app.screenshot_plain)
        v->app.settings.panels = panels;
    ui_end_frame(&geometry);
    answer_requests(v);
    if (!v->app.settings.pause || v->app.step)
        v->clock += (uint64_t)(step * 1e6);
    end.read = v->screenshot[0] != '\0';
    if (!record(v, &end, commands) || !frames_end(&v->frames, &end))
        return false;
    v->app.step = v->app.screenshot = false;
    v->app.facts.host_seconds = clock_seconds() - begin;
    v->app.facts.gpu_seconds = v->frames.gpu_seconds;
    if (v->window && swapchain_present(&v->swapchain, end.image) == SWAPCHAIN_FAILED)
        return false;
    if (v->other) {
        const struct view_settings b = viewer_second_settings(v);
        v->app.facts_b.host_seconds = v->app.facts.host_seconds;
        v->app.facts_b.gpu_seconds = v->app.facts.gpu_seconds;
        v->app.facts_b.real_seconds = v->app.facts.real_seconds;
        facts_update(&v->app.facts_b, v->other, &b, step);
    }
    if (v->stage) {
        facts_update(&v->app.facts, v->stage, &v->app.settings, step);
        summary_add(&v->summary, &v->app.facts);
    }
    return true;
}

/* Notes the outcome of a screenshot. Without a window a failure ends the program. */
static bool note_picture(struct viewer *v, const char *path, bool written)
{
    if (written)
        app_say(&v->app, "Wrote %s", path);
    else
        app_say(&v->app, "Cannot write %s: Shift+I says why", path);
    return written || v->window;
}

static bool finish_frame(struct viewer *v)
{
    bool good = write_figures(v);
    if (v->screenshot[0]) {
        good = note_picture(v, v->screenshot, frames_write(&v->frames, v->screenshot)) && good;
        v->screenshot[0] = '\0';
    }
    if (v->large.path[0]) {
        char path[sizeof v->large.path];
        memcpy(path, v->large.path, sizeof path);
        good = note_picture(v, path, large_picture_end(&v->frames, &v->large)) && good;
    }
    if (v->options->deterministic && v->stage)
        good = frames_wait(&v->frames) && stage_settle(v->stage) &&
               (!v->other || stage_settle(v->other)) && good;
    if (v->options->deterministic)
        flip_map_settle(&v->flip);
    if (v->options->deterministic)
        trade_wait(&v->trade);
    return good;
}

static uint32_t frame_count(const struct viewer *v)
{
    if (v->options->frames)
        return v->options->frames;
    if (v->window)
        return UINT32_MAX;
    return v->script.count ? script_last_frame(&v->script) + 1 : USUAL_FRAMES;
}

/* Processor time of all threads, in seconds. */
static double processor_seconds(void)
{
    return (double)clock() / CLOCKS_PER_SEC;
}

/* Notes the time of the first picture. Waits once for its frame, to measure. */
static bool note_first_picture(struct viewer *v)
{
    if (!v->stage || v->first_picture > 0)
        return true;
    if (!frames_wait(&v->frames))
        return false;
    v->first_picture = clock_seconds() - v->begin;
    v->first_processor = processor_seconds();
    v->first_frame = v->frame;
    return true;
}

static bool run_frames(struct viewer *v)
{
    const uint32_t count = frame_count(v);
    v->last_time = clock_seconds();
    for (v->frame = 0; v->frame < count && !v->app.quit; v->frame++) {
        const double step = next_step(v);
        gather_input(v);
        if (!viewer_watch_load(v))
            return false;
        if (v->options->screenshot && v->frame + 1 == count)
            snprintf(v->screenshot, sizeof v->screenshot, "%s", v->options->screenshot);
        if (!draw_frame(v, step) || !note_first_picture(v) || !finish_frame(v))
            return false;
    }
    return true;
}

/* Prints the times of A and B in the last frames with equal settings. */
static void print_halves(const struct view_app *app)
{
    static const char names[2] = {'a', 'b'};
    for (int i = 0; i < 2; i++)
        printf("{\"name\": \"gpu_ms_median_%c\", \"value\": %.4f, \"unit\": \"ms\"}\n"
               "{\"name\": \"host_ms_median_%c\", \"value\": %.4f, \"unit\": \"ms\"}\n",
               names[i], half_series_median(&app->times[i].gpu, HALF_TIMES_MOST), names[i],
               half_series_median(&app->times[i].host, HALF_TIMES_MOST));
    printf("{\"name\": \"frames_compared\", \"value\": %u, \"unit\": \"\"}\n"
           "{\"name\": \"resident_b\", \"value\": %llu, \"unit\": \"B\"}\n"
           "{\"name\": \"sharp_b\", \"value\": %.4f, \"unit\": \"\"}\n",
           half_series_count(&app->times[1].gpu, HALF_TIMES_MOST),
           (unsigned long long)app->facts_b.resident_size, app->facts_b.sharp);
}

static void print_summary(struct viewer *v)
{
    const struct view_facts *f = &v->app.facts;
    if (!v->stage)
        return;
    if (v->options->json && stage_played(v->stage)) {
        played_print_json(v->stage, f);
        return;
    }
    if (v->options->json) {
        gpu_print_json(&v->gpu);
        if (v->app.present_mode)
            printf("{\"name\": \"present mode\", \"value\": \"%s\", \"unit\": \"\"}\n",
                   v->app.present_mode);
        printf("{\"name\": \"frames\", \"value\": %u, \"unit\": \"\"}\n"
               "{\"name\": \"textures\", \"value\": %llu, \"unit\": \"B\"}\n"
               "{\"name\": \"resident\", \"value\": %llu, \"unit\": \"B\"}\n"
               "{\"name\": \"sharp\", \"value\": %.4f, \"unit\": \"\"}\n"
               "{\"name\": \"tiles loaded\", \"value\": %llu, \"unit\": \"\"}\n"
               "{\"name\": \"tiles failed\", \"value\": %llu, \"unit\": \"\"}\n"
               "{\"name\": \"first picture\", \"value\": %.3f, \"unit\": \"s\"}\n"
               "{\"name\": \"processor time of first picture\", \"value\": %.3f, \"unit\": \"s\"}\n"
               "{\"name\": \"processor time per frame\", \"value\": %.3f, \"unit\": \"ms\"}\n",
               v->frame, (unsigned long long)f->all_size, (unsigned long long)f->resident_size,
               f->sharp, (unsigned long long)f->now.tilesMapped,
               (unsigned long long)f->now.tilesFailed, v->first_picture, v->first_processor,
               v->frame > v->first_frame + 1 ? (processor_seconds() - v->first_processor) * 1e3 /
                                                   (v->frame - v->first_frame - 1)
                                             : 0.0);
        view_summary_print(&v->summary, f);
        if (app_compares(&v->app))
            print_halves(&v->app);
        if (v->flip.known)
            printf("{\"name\": \"FLIP\", \"value\": %.6f, \"unit\": \"\"}\n", v->flip.shown_mean);
        return;
    }
    char all[32], resident[32];
    if (stage_played(v->stage)) {
        const struct played *p = stage_played(v->stage);
        printf("%s: frame %u of 0 to %u, %u textures, %s resident\n", stage_name(v->stage),
               p->frame, p->frame_count - 1, p->texture_count,
               panel_size(f->resident_size, resident, sizeof resident));
        return;
    }
    printf("%s: %u frames, %s of textures, %s in memory, %.0f %% sharp\n", stage_name(v->stage),
           v->frame, panel_size(f->all_size, all, sizeof all),
           panel_size(f->resident_size, resident, sizeof resident), 100.0 * f->sharp);
}

static bool prepare(struct viewer *v, bool *unsupported)
{
    const struct view_options *o = v->options;
    double scale = v->app.settings.ui_scale;
    uint32_t width = v->app.settings.size[0], height = v->app.settings.size[1];
    if (!o->headless && !(v->window = window_open("Sluice", width, height)))
        return false;
    if (scale <= 0)
        scale = v->window ? window_scale(v->window) : 1.0;
    if (!ui_create((float)scale) || !create_gpu(v, unsupported))
        return false;
    if (v->window) {
        if (!window_create_surface(v->window, &v->gpu))
            return false;
        window_size(v->window, &width, &height);
        window_share_clipboard(v->window);
        v->swapchain.outdated = true;
    }
    v->app.gpu = &v->gpu;
    v->app.flip = &v->flip;
    v->app.trade = &v->trade;
    v->app.thumbs = &v->thumbs;
    return frames_create(&v->gpu, width, height, &v->frames);
}

/* Reads files of settings, which override defaults; the command line overrides both. --headless
 * reads none. */
static void read_settings(struct viewer *v)
{
    const struct view_options *o = v->options;
    const char *scene = o->words.count > 0 ? o->words.items[0] : "";
    v->app.settings = o->settings;
    if (!o->headless && !o->fresh &&
        settings_file_named("view-recent.list", v->recent_path, sizeof v->recent_path))
        recent_read(v->recent_path, &v->app.browser.recent);
    else
        v->recent_path[0] = '\0';
    if (o->headless || o->fresh ||
        !settings_file_path(scene, v->settings_path, sizeof v->settings_path)) {
        v->settings_path[0] = '\0';
        begin_b(v, false);
        return;
    }
    controls_set_defaults(&v->app.settings);
    controls_set_defaults(&v->app.b);
    settings_file_read(v->settings_path, &v->app);
    const bool kept = v->app.settings.compared == VIEW_WITH_B;
    controls_take_given(&o->settings, o->given, &v->app.settings);
    begin_b(v, kept);
}

static bool begin(struct viewer *v)
{
    const struct view_options *o = v->options;
    if (o->script && !script_read(o->script, &v->script))
        return false;
    if (o->csv && !(v->csv = output_file_begin(o->csv)))
        return false;
    if (o->play && !camera_path_read(o->play, &v->app.path))
        return false;
    if (v->window && !draw_frame(v, 0.016)) /* shows "Opening the scene ..." */
        return false;
    return viewer_open_scene(v);
}

static void finish(struct viewer *v)
{
    viewer_end_load(v);
    trade_finish(&v->trade);
    viewer_close_scene(v);
    shader_files_finish(v->code);
    frames_wait(&v->frames);
    flip_map_destroy(&v->flip);
    large_picture_drop(&v->gpu, &v->large);
    frames_destroy(&v->frames);
    app_finish(&v->app);
    swapchain_destroy(&v->swapchain);
    window_destroy_surface(v->window, &v->gpu);
    gpu_destroy(&v->gpu);
    ui_destroy();
    window_close(v->window);
    script_finish(&v->script);
    files_finish(&v->paths);
    log_finish();
    messages_end();
}

/* Adds the hall, if it is installed, to a command line without scenes. */
static bool add_hall(struct viewer *v)
{
    char path[4200];
    return v->paths.count > 0 || v->options->room || !scene_hall_find(path, sizeof path) ||
           files_add(path, &v->paths);
}

int viewer_run(const struct view_options *options)
{
    struct viewer *v = calloc(1, sizeof *v);
    bool unsupported = false, good = false;
    if (!v)
        return EXIT_FAILURE;
    v->options = options;
    v->begin = clock_seconds();
    messages_begin();
    v->input.mouse_x = v->input.mouse_y = -1; /* mouse outside of the picture */
    app_init(&v->app);
    for (size_t i = 0; i < options->words.count; i++)
        if (!files_add(options->words.items[i], &v->paths))
            return EXIT_FAILURE;
    if (!add_hall(v))
        return EXIT_FAILURE;
    read_settings(v);
    v->app.program = v->command;
    v->app.deterministic = options->deterministic;
    v->app.headless = options->headless;
    if (prepare(v, &unsupported) && begin(v))
        good = run_frames(v);
    viewer_end_recording(v);
    good = good && !v->recording_failed;
    if (good)
        print_summary(v);
    if (v->stage && v->settings_path[0]) /* also after the device was lost */
        settings_file_write(v->settings_path, &v->app);
    if (v->csv)
        good = output_file_end(v->csv, good) && good;
    const unsigned messages = atomic_load(&v->gpu.validation_messages);
    finish(v);
    free(v);
    if (messages > 0)
        fprintf(stderr, "the validation layers had %u messages\n", messages);
    if (unsupported)
        return EXIT_NO_DEVICE;
    return good && messages == 0 ? text_exit_status(EXIT_SUCCESS) : EXIT_FAILURE;
}
