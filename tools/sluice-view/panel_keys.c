#include "panels.h"

#include "actions.h"

#include <stdio.h>
#include <string.h>

#define KEY_COLUMNS 3

/* Lines of a group: its title and its keys. */
static uint32_t draw_row(const struct action *actions, uint32_t i, float x)
{
    uint32_t lines = 1;
    if (i == 0 || strcmp(actions[i].group, actions[i - 1].group) != 0) {
        ui_text(UI_BLUE, "%s", actions[i].group);
        lines++;
    }
    ui_text(UI_ORANGE, "%s", actions[i].shown ? actions[i].shown : actions[i].chord);
    ui_same_line(x);
    ui_text(UI_WHITE, "%s", actions[i].words);
    return lines;
}

static uint32_t count_lines(const struct action *actions, uint32_t count)
{
    uint32_t lines = count;
    for (uint32_t i = 0; i < count; i++)
        lines += i == 0 || strcmp(actions[i].group, actions[i - 1].group) != 0;
    return lines;
}

/* The one page that may be larger: it was asked for. All of the table, from column to column. */
void panel_keys(struct view_app *app)
{
    uint32_t count, next = 0;
    const struct action *actions = actions_get(&count);
    const float scale = ui_scale(), pivot[2] = {0.5f, 0.5f};
    const float placement[4] = {app->width / 2, app->height / 2, 0, 0};
    if (!app->open[PANEL_KEYS])
        return;
    const uint32_t lines = (count_lines(actions, count) + KEY_COLUMNS - 1) / KEY_COLUMNS + 1;
    ui_begin_tight((float)lines * ui_line_height() > app->height - 60 * scale);
    float height = (float)lines * ui_line_height();
    float width = (app->width - 60 * scale) / KEY_COLUMNS;
    if (height > app->height - 60 * scale)
        height = app->height - 60 * scale;
    if (width > 330 * scale)
        width = 330 * scale;
    if (ui_begin_panel("All keys (F1)", &app->open[PANEL_KEYS], placement, pivot, UI_PANEL_FIT))
        for (int column = 0; column < KEY_COLUMNS; column++) {
            static const char *const ids[KEY_COLUMNS] = {"left", "middle", "right"};
            if (column > 0)
                ui_same_line(0);
            ui_begin_part(ids[column], width, height);
            for (uint32_t drawn = 0; next < count && drawn < lines; next++)
                drawn += draw_row(actions, next, 100 * scale);
            ui_end_part();
        }
    ui_end_panel();
    ui_end_tight();
}

static void draw_cameras(struct view_app *app)
{
    char name[240];
    const uint32_t count = app->stage ? stage_camera_count(app->stage) : 0;
    if (count == 0 || !ui_begin_group("Cameras of the file", false))
        return;
    for (uint32_t i = 0; i < count; i++) {
        const struct file_camera *camera = stage_file_camera(app->stage, i);
        snprintf(name, sizeof name, "%s##camera%u", camera->name, i);
        if (ui_button(name, 220 * ui_scale(), 0, app->file_camera == i))
            app_choose_camera(app, i);
        ui_hint("%s. --camera %u", camera->camera.span > 0 ? "Parallel rays" : "Perspective", i);
        if (camera_path_length(&camera->path) > 0) {
            ui_same_line(0);
            ui_text(UI_GRAY, "%.1f s", (double)camera_path_length(&camera->path));
        }
    }
}

static void draw_recent(struct view_app *app)
{
    char name[160];
    const struct file_list *recent = &app->browser.recent;
    if (recent->count == 0 || !ui_begin_group("Recent files", false))
        return;
    for (size_t i = 0; i < recent->count; i++) {
        const char *path = recent->paths[i], *slash = strrchr(path, '/');
        snprintf(name, sizeof name, "%.100s##recent%zu", slash && slash[1] ? slash + 1 : path, i);
        if (ui_button(name, 220 * ui_scale(), 0, false))
            browser_choose(&app->browser, path);
        ui_hint("%s", path);
    }
}

void panel_menu(struct view_app *app)
{
    uint32_t count;
    const struct action *actions = actions_get(&count);
    if (!app->open[PANEL_MENU])
        return;
    if (panel_begin(app, PANEL_MENU, "Menu (F10)", 340, 560)) {
        const char *group = "";
        draw_recent(app);
        draw_cameras(app);
        for (uint32_t i = 0; i < count; i++) {
            if (strcmp(group, actions[i].group) != 0)
                ui_text(UI_BLUE, "%s", actions[i].group);
            group = actions[i].group;
            if (!actions[i].act)
                continue;
            if (ui_button(actions[i].words, 220 * ui_scale(), 0, false))
                actions_run(app, &actions[i]);
            ui_same_line(0);
            ui_text(UI_GRAY, "%s", actions[i].shown ? actions[i].shown : actions[i].chord);
        }
    }
    ui_end_panel();
}
