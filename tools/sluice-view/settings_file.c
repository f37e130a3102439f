/* strdup, realpath, strtok_r, strcasecmp */
#define _XOPEN_SOURCE 700

#include "settings_file.h"

#include "controls.h"
#include "sets.h"

#include "../common/files.h"
#include "../common/input.h"
#include "../common/output_file.h"
#include "../common/text.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define HEADER "sluice-view settings 1"
#define MAX_SIZE (1u << 20)

/* FNV-1a: files of scenes with the same name in other folders differ. */
static uint64_t hash(const char *text)
{
    uint64_t h = 0xcbf29ce484222325u;
    for (; *text; text++)
        h = (h ^ (unsigned char)*text) * 0x100000001b3u;
    return h;
}

bool settings_file_named(const char *name, char *path, size_t size)
{
    const char *config = getenv("XDG_CONFIG_HOME"), *home = getenv("HOME");
    int length = -1;
    if (config && config[0] == '/')
        length = snprintf(path, size, "%s/sluice/%s", config, name);
    else if (home && home[0] == '/')
        length = snprintf(path, size, "%s/.config/sluice/%s", home, name);
    return length > 0 && (size_t)length < size;
}

bool settings_file_path(const char *scene, char *path, size_t size)
{
    char resolved[4096], name[64];
    const char *named = scene[0] ? realpath(scene, resolved) : scene;
    snprintf(name, sizeof name, "view-%016llx.settings",
             (unsigned long long)hash(named ? named : scene));
    return settings_file_named(name, path, size);
}

static bool read_line(char *line, struct view_app *app)
{
    char *value = line + strcspn(line, " ");
    if (*value)
        *value++ = '\0';
    if (strncmp(line, "bookmark-", 9) == 0 && line[9] >= '1' && line[9] <= '9' && !line[10]) {
        app->bookmark_set[line[9] - '1'] = true;
        return view_camera_read(value, &app->bookmarks[line[9] - '1']);
    }
    char *of_b = value + strcspn(value, " ");
    if (strcmp(line, "b") == 0 && *of_b) {
        *of_b++ = '\0';
        return sets_set(&app->b, value, of_b, "sluice-view");
    }
    return controls_set(&app->settings, line, value, "sluice-view");
}

static bool read_text(char *text, struct view_app *app)
{
    char *rest = NULL;
    char *line = strtok_r(text, "\n", &rest);
    if (!line || strcmp(line, HEADER) != 0)
        return false;
    while ((line = strtok_r(NULL, "\n", &rest)))
        if (!read_line(line, app))
            return false;
    return true;
}

void settings_file_set_aside(const char *path, const char *outcome)
{
    char aside[4200];
    snprintf(aside, sizeof aside, "%s.damaged", path);
    if (rename(path, aside) == 0)
        text_say("sluice-view: %s is damaged: it is %s now, and %s", path, aside, outcome);
    else
        text_say("sluice-view: %s is damaged and cannot be renamed: %s", path, strerror(errno));
}

void settings_file_read(const char *path, struct view_app *app)
{
    char *text = NULL;
    size_t size = 0;
    const struct view_settings before = app->settings, before_b = app->b;
    struct view_camera bookmarks[APP_BOOKMARKS];
    bool set[APP_BOOKMARKS];
    memcpy(bookmarks, app->bookmarks, sizeof bookmarks);
    memcpy(set, app->bookmark_set, sizeof set);
    if (!input_read_file(path, MAX_SIZE, &text, &size)) {
        if (errno != ENOENT)
            text_say("sluice-view: %s: %s", path, input_reason(errno));
        return;
    }
    if (strlen(text) != size || !read_text(text, app)) {
        app->settings = before;
        app->b = before_b;
        memcpy(app->bookmarks, bookmarks, sizeof bookmarks);
        memcpy(app->bookmark_set, set, sizeof set);
        settings_file_set_aside(path, "all settings are the defaults");
    }
    free(text);
}

bool settings_file_write(const char *path, const struct view_app *app)
{
    char value[64], camera[160];
    uint32_t count;
    const struct control *controls = controls_get(&count);
    if (!files_make_folders_of(path)) {
        text_say("sluice-view: %s: %s", path, strerror(errno));
        return false;
    }
    struct output_file *output = output_file_begin(path);
    if (!output)
        return false;
    FILE *file = output_file_stream(output);
    fprintf(file, HEADER "\n");
    for (uint32_t i = 0; i < count; i++)
        if (!(controls[i].flags & CONTROL_PASSING) &&
            !control_is_default(&controls[i], &app->settings))
            fprintf(file, "%s %s\n", controls[i].option.name,
                    control_write(&controls[i], &app->settings, value, sizeof value));
    for (uint32_t i = 0; app->settings.compared == VIEW_WITH_B && i < count; i++)
        if (control_is_of_sets(&controls[i]) && !(controls[i].flags & CONTROL_PASSING) &&
            !control_is_default(&controls[i], &app->b))
            fprintf(file, "b %s %s\n", controls[i].option.name,
                    control_write(&controls[i], &app->b, value, sizeof value));
    for (int i = 0; i < APP_BOOKMARKS; i++) {
        const struct view_camera *c = &app->bookmarks[i];
        if (app->bookmark_set[i])
            fprintf(file, "bookmark-%d %s\n", i + 1, view_camera_write(c, camera, sizeof camera));
    }
    return output_file_end(output, true);
}
