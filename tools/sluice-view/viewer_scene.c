#include "viewer.h"

#include "controls.h"
#include "played_app.h"
#include "recent.h"
#include "sets.h"
#include "settings_file.h"
#include "shader_files.h"
#include "traced_parts.h"

#include "../common/text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct stage *viewer_create_stage(struct viewer *v, const struct view_settings *settings,
                                  struct scene_data *scene)
{
    const struct stage_request request = {.gpu = &v->gpu,
                                          .threads = settings->threads,
                                          .waits = v->options->deterministic,
                                          .code = v->code[0].words ? v->code : NULL};
    return stage_create(&request, settings, scene);
}

bool viewer_open_now(const struct viewer *v, const struct file_list *paths,
                     struct scene_data *scene)
{
    const struct scene_request request = {.paths = (const char *const *)paths->paths,
                                          .path_count = (uint32_t)paths->count,
                                          .cache = v->options->cache,
                                          .wait = v->options->deterministic};
    return scene_open_paths(&request, scene);
}

struct scene_load *viewer_begin_load(const struct viewer *v, struct file_list *paths,
                                     uint32_t threads)
{
    const struct scene_request how = {.cache = v->options->cache,
                                      .wait = v->options->deterministic,
                                      .gpu = &v->gpu,
                                      .threads = threads};
    return scene_load_begin(paths, &how);
}

struct scene_load *viewer_begin_load_again(const struct viewer *v, uint32_t threads)
{
    struct file_list paths = {0};
    struct scene_load *load = NULL;
    bool copied = true;
    for (size_t i = 0; copied && i < v->paths.count; i++)
        copied = files_add(v->paths.paths[i], &paths);
    if (copied)
        load = viewer_begin_load(v, &paths, threads);
    files_finish(&paths);
    return load;
}

/* Writes v->command: "sluice-view PATH ...". Leaves out paths that do not fit. */
static void name_command(struct viewer *v)
{
    struct text_list words = {0};
    size_t length = strlen("sluice-view --room");
    text_list_add(&words, "sluice-view");
    if (v->paths.count == 0)
        text_list_add(&words, "--room");
    for (size_t i = 0; i < v->paths.count; i++) {
        length += 4 * strlen(v->paths.paths[i]) + 3; /* at most, in quotes */
        if (length >= sizeof v->command)
            break;
        text_list_add(&words, v->paths.paths[i]);
    }
    char *line = text_list_join(&words);
    snprintf(v->command, sizeof v->command, "%s", line);
    free(line);
    text_list_finish(&words);
}

void viewer_close_scene(struct viewer *v)
{
    if (v->stage)
        frames_wait(&v->frames);
    viewer_end_recording(v);
    app_close(&v->app);
    thumbs_end(&v->thumbs);
    viewer_close_other(v);
    stage_destroy(v->stage);
    v->stage = NULL;
}

/* Chooses the camera of --camera. An unknown camera is an error without a window, since nobody
 * would see that another camera is used. */
static bool choose_camera(struct viewer *v)
{
    const char *wanted = v->options->camera;
    const uint32_t camera = app_find_camera(&v->app, wanted);
    if (camera != APP_NO_CAMERA) {
        app_choose_camera(&v->app, camera);
        return true;
    }
    text_say("sluice-view: --camera %s: the file has no such camera; it has %u", wanted,
             stage_camera_count(v->stage));
    for (uint32_t i = 0; i < stage_camera_count(v->stage); i++)
        text_say("sluice-view: camera %u: %s", i, stage_file_camera(v->stage, i)->name);
    app_set_panel(&v->app, PANEL_FILE, true);
    return v->window != NULL;
}

static bool begin_walk(struct viewer *v)
{
    bool found = true;
    if (stage_played(v->stage)) {
        played_app_go(&v->app, v->options->cursor);
        return true;
    }
    if (v->options->camera && view_camera_read(v->options->camera, &v->app.camera)) {
        v->app.follow = FOLLOW_NOTHING;
        v->app.touched = true;
    } else if (v->options->camera) {
        found = choose_camera(v);
    }
    if (v->options->play)
        v->app.follow = FOLLOW_PATH;
    if (v->gpu.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU &&
        v->app.settings.render_scale <= 0 && !v->options->deterministic)
        app_say(&v->app,
                "Drawn by the CPU: the picture has %s the window's resolution (--render-scale)",
                stage_traced(v->stage) ? "a quarter of" : "half");
    return found;
}

/** Settings of the shown scene, kept while another scene is tried. */
struct kept_settings {
    struct view_settings settings, b;
    struct view_camera bookmarks[APP_BOOKMARKS];
    bool bookmark_set[APP_BOOKMARKS];
    char path[4096];
};

/* Keeps settings of the window and settings that no file keeps. They do not belong to a scene. */
static void keep_window(const struct view_settings *before, struct view_settings *settings)
{
    char value[64];
    uint32_t count;
    const struct control *controls = controls_get(&count);
    for (uint32_t i = 0; i < count; i++)
        if (controls[i].flags & CONTROL_PASSING || strcmp(controls[i].group, "Window") == 0)
            controls_set(settings, controls[i].option.name,
                         control_write(&controls[i], before, value, sizeof value), "sluice-view");
}

/* Keeps the settings of the shown scene, and takes the settings of the next one. A scene without a
 * file begins with the present settings. */
static void change_settings(struct viewer *v, const struct file_list *paths,
                            struct kept_settings *before)
{
    struct view_app *app = &v->app;
    before->settings = app->settings;
    before->b = app->b;
    memcpy(before->bookmarks, app->bookmarks, sizeof app->bookmarks);
    memcpy(before->bookmark_set, app->bookmark_set, sizeof app->bookmark_set);
    memcpy(before->path, v->settings_path, sizeof before->path);
    if (v->settings_path[0])
        settings_file_write(v->settings_path, app);
    memset(app->bookmark_set, 0, sizeof app->bookmark_set); /* they are places of that scene */
    if (!v->settings_path[0])
        return;
    settings_file_path(paths->count > 0 ? paths->paths[0] : "", v->settings_path,
                       sizeof v->settings_path);
    if (files_size(v->settings_path) == 0)
        return;
    controls_set_defaults(&app->settings);
    controls_set_defaults(&app->b);
    settings_file_read(v->settings_path, app);
    keep_window(&before->settings, &app->settings);
}

static void restore_settings(struct viewer *v, const struct kept_settings *before)
{
    v->app.settings = before->settings;
    v->app.b = before->b;
    memcpy(v->app.bookmarks, before->bookmarks, sizeof before->bookmarks);
    memcpy(v->app.bookmark_set, before->bookmark_set, sizeof before->bookmark_set);
    memcpy(v->settings_path, before->path, sizeof before->path);
}

/* Adds the scene to the recent files. Reads the list again, since another viewer may have changed
 * it. The browser begins at the scene. */
static void note_recent(struct viewer *v, bool first)
{
    struct browser *b = &v->app.browser;
    const bool is_named = v->paths.count == 1 && (!first || v->options->words.count > 0);
    snprintf(b->scene, sizeof b->scene, "%s", v->paths.count > 0 ? v->paths.paths[0] : "");
    if (!is_named)
        return;
    if (v->recent_path[0])
        recent_read(v->recent_path, &b->recent);
    if (recent_add(v->paths.paths[0], &b->recent) && v->recent_path[0])
        recent_write(v->recent_path, &b->recent);
}

/* Opens the panel of files if a file could not be opened or has unsupported parts. */
static void note_file(struct viewer *v, const struct file_list *paths, bool opened)
{
    if (file_facts_note(&v->app.file, (const char *const *)paths->paths, paths->count, opened))
        app_set_panel(&v->app, PANEL_FILE, true);
}

/** Camera and selection, kept when a scene is opened again. */
struct kept_place {
    struct view_camera camera;
    struct vec3 center;
    enum app_follow follow;
    double follow_seconds;
    bool touched;
    uint32_t selected, file_camera;
    struct stage_pick inspect;
};

static struct kept_place keep_place(const struct view_app *app)
{
    return (struct kept_place){app->camera,  app->center,   app->follow,      app->follow_seconds,
                               app->touched, app->selected, app->file_camera, app->inspect};
}

static void restore_place(struct view_app *app, const struct kept_place *place)
{
    app->camera = place->camera;
    app->center = place->center;
    app->follow = place->follow;
    app->follow_seconds = place->follow_seconds;
    app->touched = place->touched;
    app->selected = place->selected;
    app->file_camera = place->file_camera;
    app->inspect = place->inspect;
}

/* Shows another scene. On failure the old scene stays. Exchanges `paths`, if not NULL, with the
 * paths of the old scene. */
static bool show(struct viewer *v, struct scene_data *scene, struct file_list *paths)
{
    const bool first = !v->stage;
    struct kept_settings kept;
    if (!first && paths)
        change_settings(v, paths, &kept);
    struct stage *stage = viewer_create_stage(v, &v->app.settings, scene);
    if (!stage) {
        if (!first && paths)
            restore_settings(v, &kept);
        return false;
    }
    const struct kept_place place = keep_place(&v->app);
    viewer_close_scene(v);
    v->stage = stage;
    v->applied = v->app.settings;
    v->asked = false;
    if (paths) {
        const struct file_list before = v->paths;
        v->paths = *paths;
        *paths = before;
    }
    name_command(v);
    if (paths)
        note_recent(v, first);
    if (!app_open(&v->app, stage, first && !v->options->still))
        return false;
    if (first && v->options->record)
        viewer_begin_recording(v, v->options->record);
    if (first)
        return begin_walk(v);
    if (paths) {
        app_say(&v->app, "Opened %s", stage_name(stage));
        note_file(v, &v->paths, true);
    } else {
        restore_place(&v->app, &place);
    }
    return true;
}

static void say_failed(struct viewer *v, const struct file_list *paths)
{
    note_file(v, paths, false);
    app_say(&v->app, "Cannot open %s: Shift+I says why",
            paths->count > 0 ? paths->paths[0] : "the room");
}

/* Cancels the load without a wait. Its thread may read a large file for long. */
static void park_load(struct viewer *v)
{
    if (v->load)
        scene_load_keep_canceled(v->load, &v->canceled);
    v->load = NULL;
}

/* Begins a load. Cancels a load that is not done. */
static bool begin_load(struct viewer *v, struct file_list *paths)
{
    park_load(v);
    file_facts_begin(&v->app.file);
    v->loads_again = v->loads_chosen = false;
    v->load = viewer_begin_load(v, paths, v->app.settings.threads);
    return v->load != NULL;
}

/* Begins to open the shown scene again. Keeps a load that runs, since it replaces the scene anyway.
 */
static bool begin_load_again(struct viewer *v)
{
    if (v->load)
        return true;
    file_facts_begin(&v->app.file);
    v->loads_again = true;
    v->load = viewer_begin_load_again(v, v->app.settings.threads);
    return v->load != NULL;
}

bool viewer_open_scene(struct viewer *v)
{
    struct scene_data scene;
    struct file_list paths = v->paths;
    file_facts_begin(&v->app.file);
    name_command(v);
    v->paths = (struct file_list){0};
    if (v->window)
        return begin_load(v, &paths);
    const bool shown = viewer_open_now(v, &paths, &scene) && show(v, &scene, &paths);
    files_finish(&paths);
    return shown;
}

void viewer_reopen(struct viewer *v, struct file_list *paths)
{
    struct scene_data scene;
    if (v->window && (paths ? begin_load(v, paths) : begin_load_again(v))) {
        v->loads_chosen |= paths != NULL;
        return;
    }
    if (!v->window)
        file_facts_begin(&v->app.file);
    if (v->window || !viewer_open_now(v, paths ? paths : &v->paths, &scene) ||
        !show(v, &scene, paths))
        say_failed(v, paths ? paths : &v->paths);
}

void viewer_open_chosen(struct viewer *v)
{
    char path[BROWSER_PATH];
    struct file_list paths = {0};
    if (!browser_take(&v->app.browser, path, sizeof path))
        return;
    if (!path[0] || files_add(path, &paths))
        viewer_reopen(v, &paths);
    files_finish(&paths);
}

void viewer_reopen_if_needed(struct viewer *v)
{
    const struct view_settings *now = &v->app.settings;
    if (!v->stage || stage_played(v->stage) || v->load || ui_any_active() ||
        !sets_must_reopen(stage_opened(v->stage), now) ||
        (stage_traced(v->stage) && stage_opened(v->stage)->threads == now->threads) ||
        (v->asked && !sets_must_reopen(&v->reopened, now)))
        return;
    v->asked = v->app.reload = true;
    v->reopened = *now;
}

/* The scene of the command line was canceled for a file that cannot be opened. */
static void open_room_instead(struct viewer *v)
{
    struct file_list room = {0};
    if (v->stage || !v->loads_chosen)
        return;
    v->loads_chosen = false;
    v->load = viewer_begin_load(v, &room, v->app.settings.threads);
}

static bool end_load(struct viewer *v)
{
    struct scene_data scene;
    struct file_list paths;
    struct scene_load *load = v->load;
    v->load = NULL;
    const bool opened = scene_load_end(load, &scene, &paths);
    v->app.said_seconds = 0;
    if (!opened || !show(v, &scene, v->loads_again ? NULL : &paths)) {
        say_failed(v, &paths);
        open_room_instead(v);
    }
    files_finish(&paths);
    return v->stage || v->load;
}

bool viewer_watch_load(struct viewer *v)
{
    char text[160];
    scene_load_drop_canceled(&v->canceled, false);
    if (!v->load)
        return v->stage != NULL;
    if (scene_load_done(v->load))
        return end_load(v);
    scene_load_describe(v->load, text, sizeof text);
    app_say(&v->app, "%s", text);
    return true;
}

void viewer_cancel_load(struct viewer *v)
{
    struct file_list room = {0};
    if (!v->load)
        return;
    park_load(v);
    v->app.said_seconds = 0;
    app_say(&v->app, "Canceled");
    if (!v->stage)
        begin_load(v, &room);
}

void viewer_end_load(struct viewer *v)
{
    park_load(v);
    viewer_park_other(v);
    scene_load_drop_canceled(&v->canceled, true);
    if (v->other_parts)
        traced_parts_destroy(traced_parts_end(v->other_parts));
    v->other_parts = NULL;
}

/* Uses shaders in all streamers, and in scenes that are opened later. On failure none changes. */
static bool use_shaders(struct viewer *v, struct shader_code code[SCENE_SHADER_COUNT])
{
    if (!frames_wait(&v->frames) || !stage_prepare_shaders(v->stage, code))
        return false;
    if (v->other && !stage_prepare_shaders(v->other, code)) {
        stage_drop_shaders(v->stage);
        return false;
    }
    stage_take_shaders(v->stage);
    if (v->other)
        stage_take_shaders(v->other);
    shader_files_finish(v->code);
    memcpy(v->code, code, sizeof v->code);
    return true;
}

void viewer_reload_shaders(struct viewer *v)
{
    char text[4200];
    struct shader_code code[SCENE_SHADER_COUNT];
    const char *missing = shader_files_missing(text, sizeof text);
    v->app.reload_shaders = false;
    if (missing || !v->stage || !stage_streamer(v->stage)) {
        app_say(&v->app, "%s", missing ? missing : "This scene has no shaders to compile again");
        return;
    }
    if (!shader_files_compile(code)) {
        app_say(&v->app, "The shaders stay as they were: Shift+I says why");
        return;
    }
    const bool used = use_shaders(v, code);
    app_say(&v->app, "%s", used ? "The shaders were compiled again" : "The shaders do not fit");
    if (!used)
        shader_files_finish(code);
}
