/* Cameras of the shown file, and the path that the camera follows. */
#include "app.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

uint32_t app_find_camera(const struct view_app *app, const char *text)
{
    char *end = NULL;
    const uint32_t count = app->stage ? stage_camera_count(app->stage) : 0;
    for (uint32_t i = 0; i < count; i++)
        if (strcmp(stage_file_camera(app->stage, i)->name, text) == 0)
            return i;
    const unsigned long number = strtoul(text, &end, 10);
    return isdigit((unsigned char)text[0]) && *end == '\0' && number < count ? (uint32_t)number
                                                                             : APP_NO_CAMERA;
}

void app_choose_camera(struct view_app *app, uint32_t index)
{
    const struct file_camera *camera = stage_file_camera(app->stage, index);
    app->file_camera = index;
    app->camera = camera->camera;
    app->follow = FOLLOW_NOTHING;
    app->touched = true;
    app_say(app, "%s%s", camera->name,
            camera_path_length(&camera->path) > 0 ? ": space plays its path" : "");
}

void app_next_camera(struct view_app *app)
{
    const uint32_t count = app->stage ? stage_camera_count(app->stage) : 0;
    if (count == 0)
        app_say(app, "The file has no cameras");
    else
        app_choose_camera(app, app->file_camera + 1 < count ? app->file_camera + 1 : 0);
}

const struct camera_path *app_path(const struct view_app *app, enum app_follow follow)
{
    if (follow == FOLLOW_PATH)
        return &app->path;
    if (follow == FOLLOW_CAMERA && app->file_camera < stage_camera_count(app->stage))
        return &stage_file_camera(app->stage, app->file_camera)->path;
    return stage_tour(app->stage);
}

void app_play(struct view_app *app)
{
    const bool plays = app->follow != FOLLOW_NOTHING;
    const bool has_camera = app->stage && camera_path_length(app_path(app, FOLLOW_CAMERA)) > 0 &&
                            app->file_camera != APP_NO_CAMERA;
    app->follow = plays                 ? FOLLOW_NOTHING
                  : app->path.count > 0 ? FOLLOW_PATH
                  : has_camera          ? FOLLOW_CAMERA
                                        : FOLLOW_TOUR;
    app->follow_seconds = 0;
    app_say(app, "%s", plays ? "The camera is yours" : "The camera follows a path");
}

void app_follow(struct view_app *app, double seconds)
{
    const struct camera_path *path = app_path(app, app->follow);
    const double length = (double)camera_path_length(path);
    app->follow_seconds += seconds * app->settings.path_speed;
    if (length <= 0)
        return;
    if (app->settings.path_loop == VIEW_ONCE && app->follow_seconds >= length) {
        camera_path_get(path, (float)length, &app->camera);
        app->follow = FOLLOW_NOTHING;
        app->touched = true;
        app_say(app, "The path has ended; space plays it again");
        return;
    }
    camera_path_get(path, (float)fmod(app->follow_seconds, length), &app->camera);
}
