#include "viewer.h"

#include "scene_open.h"

#include <stdio.h>
#include <string.h>

static struct stage *create_stage(struct viewer *v, const struct view_settings *settings,
                                  bool everything)
{
    struct scene_data scene;
    const struct scene_request opening = {.paths = (const char *const *)v->paths.paths,
                                          .path_count = (uint32_t)v->paths.count,
                                          .cache = v->options->cache,
                                          .wait = v->options->deterministic};
    const struct stage_request request = {
        .gpu = &v->gpu, .threads = v->options->threads, .everything = everything};
    return scene_open(&opening, &scene) ? stage_create(&request, settings, &scene) : NULL;
}

/* The second streamer of a comparison lives as long as the comparison is shown. */
bool viewer_fit_other(struct viewer *v)
{
    const struct view_settings *s = &v->app.settings;
    const bool truth = s->view == VIEW_TRUTH;
    const bool wanted = v->stage && (truth || s->compare != VIEW_COMPARE_OFF);
    const int kind = truth ? VIEW_WITH_EVERYTHING : s->compared;
    if (v->other && (!wanted || v->other_kind != kind)) {
        if (!frames_wait(&v->frames))
            return false;
        stage_destroy(v->other);
        v->other = NULL;
    }
    if (!wanted || v->other)
        return true;
    struct view_settings settings = *s;
    settings.budget = kind == VIEW_WITH_BUDGET ? 16u << 20 : 0;
    v->other_kind = kind;
    v->other = create_stage(v, &settings, kind == VIEW_WITH_EVERYTHING);
    if (v->other)
        return true;
    v->app.settings.compare = VIEW_COMPARE_OFF;
    if (truth)
        v->app.settings.view = VIEW_PICTURE;
    return true;
}

/* "sluice-view PATH ..."; paths that do not fit are left out. */
static void name_command(struct viewer *v)
{
    size_t length = (size_t)snprintf(v->command, sizeof v->command, "sluice-view");
    for (size_t i = 0; i < v->paths.count; i++) {
        const char *path = v->paths.paths[i];
        if (length + strlen(path) + 2 > sizeof v->command)
            return;
        length += (size_t)snprintf(v->command + length, sizeof v->command - length, " %s", path);
    }
}

bool viewer_open_scene(struct viewer *v, bool walks)
{
    name_command(v);
    v->stage = create_stage(v, &v->app.settings, false);
    v->applied = v->app.settings;
    if (!v->stage)
        return false;
    return app_open(&v->app, v->stage, walks);
}

void viewer_close_scene(struct viewer *v)
{
    if (v->stage)
        frames_wait(&v->frames);
    app_close(&v->app);
    stage_destroy(v->other);
    stage_destroy(v->stage);
    v->stage = v->other = NULL;
}

/* Exchanges the scene's paths with others. */
static void swap_paths(struct viewer *v, struct file_list *paths)
{
    const struct file_list before = v->paths;
    v->paths = *paths;
    *paths = before;
}

void viewer_reopen(struct viewer *v, struct file_list *paths)
{
    const struct view_camera camera = v->app.camera;
    viewer_close_scene(v);
    if (paths)
        swap_paths(v, paths);
    if (viewer_open_scene(v, false)) {
        if (paths)
            app_say(&v->app, "Opened %s", stage_name(v->stage));
        else
            v->app.camera = camera;
        return;
    }
    viewer_close_scene(v);
    app_say(&v->app, "Cannot open %s; the terminal says why",
            v->paths.count > 0 ? v->paths.paths[0] : "the room");
    if (!paths)
        return;
    swap_paths(v, paths);
    viewer_open_scene(v, false);
}
