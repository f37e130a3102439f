/* The two sets of settings of a comparison. Each has a streamer and facts of its own. */
#include "viewer.h"

#include "scene_pbrt.h"
#include "sets.h"
#include "traced_parts.h"

#include "../common/text.h"

#include <string.h>

/* Settings of A that wait until the scene is opened again do not act on B either. */
struct view_settings viewer_second_settings(const struct viewer *v)
{
    struct view_settings a = v->app.settings;
    if (v->stage)
        sets_copy_opened(stage_opened(v->stage), &a);
    return sets_of_second(&a, &v->app.b);
}

void viewer_park_other(struct viewer *v)
{
    if (v->other_load)
        scene_load_keep_canceled(v->other_load, &v->canceled);
    v->other_load = NULL;
}

static void close_other(struct viewer *v)
{
    if (!v->other)
        return;
    if (v->thumbs.stage == v->other) /* possible after a swap */
        thumbs_end(&v->thumbs);
    facts_destroy(&v->app.facts_b);
    stage_destroy(v->other);
    v->other = v->app.other = NULL;
}

void viewer_close_other(struct viewer *v)
{
    viewer_park_other(v);
    close_other(v);
}

static void forget_times(struct viewer *v)
{
    memset(v->app.times, 0, sizeof v->app.times);
    frames_forget_halves(&v->frames);
}

/* A scene of pbrt is shared with A, with programs of its own. */
static bool take_scene(struct viewer *v, struct scene_data *scene)
{
    struct file_list paths;
    if (stage_share_scene(v->stage, scene)) {
        if (v->other_parts)
            scene->pbrt->parts = traced_parts_end(v->other_parts);
        v->other_parts = NULL;
        return true;
    }
    if (!v->other_load)
        return !v->window && viewer_open_now(v, &v->paths, scene);
    struct scene_load *load = v->other_load;
    v->other_load = NULL;
    const bool opened = scene_load_end(load, scene, &paths);
    files_finish(&paths);
    return opened;
}

/* Panels name textures of A and B by the same numbers. */
static bool is_same_scene(const struct viewer *v)
{
    const uint32_t a = stage_texture_count(v->stage), b = stage_texture_count(v->other);
    if (a != b)
        text_say("sluice-view: the files of the scene have changed: A has %u textures, B would "
                 "have %u; F5 opens the scene again",
                 a, b);
    return a == b;
}

static bool open_other(struct viewer *v, const struct view_settings *settings)
{
    struct scene_data scene;
    if (!take_scene(v, &scene))
        return false;
    v->other = viewer_create_stage(v, settings, &scene);
    if (v->other && (!is_same_scene(v) || !facts_create(&v->app.facts_b, v->other))) {
        stage_destroy(v->other);
        v->other = NULL;
    }
    if (!v->other)
        return false;
    v->app.facts_b.frame = v->app.facts.frame;
    v->app.facts_b.seconds = v->app.facts.seconds;
    v->app.facts_b.frame_seconds = v->app.facts.frame_seconds;
    v->app.other = v->other;
    v->applied_b = *settings;
    forget_times(v);
    return true;
}

/* Returns true if the second stage can be created without a long wait. A window draws the first
 * picture while a thread reads the second scene, or compiles its programs for rays. */
static bool is_prepared(struct viewer *v, const struct view_settings *settings)
{
    bool done;
    if (!v->window)
        return true;
    if (stage_traced(v->stage)) {
        if (!v->other_parts)
            v->other_parts = traced_parts_begin(&v->gpu, settings->threads);
        done = !v->other_parts || traced_parts_done(v->other_parts);
    } else {
        if (!v->other_load)
            v->other_load = viewer_begin_load_again(v, settings->threads);
        done = !v->other_load || scene_load_done(v->other_load);
    }
    if (!done)
        app_say(&v->app, "The second picture is being prepared");
    return done;
}

/* Keeps the second streamer while its picture is shown, and until its successor is prepared. Held
 * sliders and numbers being typed do not open it again in each frame. */
bool viewer_fit_other(struct viewer *v)
{
    struct view_app *app = &v->app;
    if (!v->stage || stage_played(v->stage))
        return true;
    const bool wanted = app_has_second(app);
    const struct view_settings settings = viewer_second_settings(v);
    const bool held = v->input.buttons[0] || ui_any_active();
    const bool needed =
        wanted && (!v->other || sets_must_reopen(stage_opened(v->other), &settings));
    const bool opens = needed && !(v->other && held) && is_prepared(v, &settings);
    if (v->other && (opens || !wanted)) {
        if (!frames_wait(&v->frames))
            return false;
        close_other(v);
    }
    if (!needed)
        viewer_park_other(v);
    if (!opens || open_other(v, &settings))
        return true;
    app_say(app, "The second picture cannot be drawn: Shift+I says why");
    app->settings.compare = VIEW_COMPARE_OFF;
    app->keeps_b = app->swap = false;
    if (app->settings.view == VIEW_TRUTH)
        app->settings.view = VIEW_PICTURE;
    return true;
}

static void apply(struct stage *stage, const struct view_settings *now,
                  struct view_settings *applied, struct viewer *v)
{
    if (!stage || memcmp(applied, now, sizeof *now) == 0)
        return;
    stage_apply(stage, now);
    *applied = *now;
    forget_times(v);
}

void viewer_apply(struct viewer *v)
{
    struct view_settings a = v->app.settings, b = viewer_second_settings(v);
    a.pause = b.pause = a.pause && !v->app.step;
    apply(v->stage, &a, &v->applied, v);
    apply(v->other, &b, &v->applied_b, v);
}

/* Exchanges pointers and figures. No tile is loaded, evicted or copied. */
void viewer_swap(struct viewer *v)
{
    struct view_app *app = &v->app;
    if (!app->swap || !v->other)
        return; /* the second streamer is opened before the next frame */
    const struct view_facts facts = app->facts;
    const struct view_settings applied = v->applied;
    const struct half_times times = app->times[0];
    struct stage *stage = v->stage;
    viewer_end_recording(v);
    app_end_demonstration(app);
    sets_swap(&app->settings, &app->b);
    v->stage = app->stage = v->other;
    v->other = app->other = stage;
    app->facts = app->facts_b;
    app->facts_b = facts;
    v->applied = v->applied_b;
    v->applied_b = applied;
    app->times[0] = app->times[1];
    app->times[1] = times;
    frames_swap_halves(&v->frames);
    app->swap = false;
    app_say(app, "A and B are swapped. The swap loads and evicts nothing");
}
