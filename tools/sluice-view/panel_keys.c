#include "panels.h"

#include "actions.h"

#include <stdio.h>
#include <string.h>

#define KEY_COLUMNS 3
#define MOST_ROWS 160u

/** Actions that apply to the shown scene or recording. */
struct rows {
    const struct action *actions[MOST_ROWS];
    uint32_t count;
};

static void list_rows(const struct view_app *app, struct rows *rows)
{
    uint32_t count;
    const struct action *actions = actions_get(&count);
    rows->count = 0;
    for (uint32_t i = 0; i < count && rows->count < MOST_ROWS; i++)
        if (actions_lists(app, &actions[i]))
            rows->actions[rows->count++] = &actions[i];
}

static bool begins_group(const struct rows *rows, uint32_t i)
{
    return i == 0 || strcmp(rows->actions[i]->group, rows->actions[i - 1]->group) != 0;
}

static const char *keys_of(const struct action *action)
{
    return action->shown ? action->shown : action->chord;
}

/* Number of lines of a group: its title and its keys. */
static uint32_t draw_row(const struct rows *rows, uint32_t i, float x)
{
    if (begins_group(rows, i))
        ui_text(UI_BLUE, "%s", rows->actions[i]->group);
    ui_text(UI_ORANGE, "%s", keys_of(rows->actions[i]));
    ui_same_line(x);
    ui_text(UI_WHITE, "%s", rows->actions[i]->words);
    return begins_group(rows, i) ? 2 : 1;
}

static uint32_t count_lines(const struct rows *rows)
{
    uint32_t lines = rows->count;
    for (uint32_t i = 0; i < rows->count; i++)
        lines += begins_group(rows, i);
    return lines;
}

/* Draws the keys column by column. This page may be larger than other panels. */
void panel_keys(struct view_app *app)
{
    uint32_t next = 0;
    struct rows rows;
    const float scale = ui_scale(), pivot[2] = {0.5f, 0.5f};
    const float placement[4] = {app->width / 2, app->height / 2, 0, 0};
    if (!app->open[PANEL_KEYS])
        return;
    list_rows(app, &rows);
    const uint32_t columns = app->width < 800 * scale ? KEY_COLUMNS - 1 : KEY_COLUMNS;
    const uint32_t lines = (count_lines(&rows) + columns - 1) / columns + 1;
    ui_begin_tight((float)lines * ui_line_height() > app->height - 60 * scale);
    float height = (float)lines * ui_line_height();
    float width = (app->width - 60 * scale) / (float)columns;
    if (height > app->height - 60 * scale)
        height = app->height - 60 * scale;
    if (width > 330 * scale)
        width = 330 * scale;
    if (ui_begin_panel("All keys (F1)", &app->open[PANEL_KEYS], placement, pivot, UI_PANEL_FIT))
        for (uint32_t column = 0; column < columns; column++) {
            static const char *const ids[KEY_COLUMNS] = {"left", "middle", "right"};
            if (column > 0)
                ui_same_line(0);
            ui_begin_part(ids[column], width, height);
            for (uint32_t drawn = 0; next < rows.count && drawn < lines; next++)
                drawn += draw_row(&rows, next, 100 * scale);
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
    struct rows rows;
    if (!app->open[PANEL_MENU])
        return;
    if (panel_begin(app, PANEL_MENU, "Menu (F10)", 340, 560)) {
        list_rows(app, &rows);
        draw_recent(app);
        draw_cameras(app);
        for (uint32_t i = 0; i < rows.count; i++) {
            const struct action *action = rows.actions[i];
            if (begins_group(&rows, i))
                ui_text(UI_BLUE, "%s", action->group);
            if (!action->act)
                continue;
            if (ui_button(action->words, 220 * ui_scale(), 0, false))
                actions_run(app, action);
            ui_same_line(0);
            ui_text(UI_GRAY, "%s", keys_of(action));
        }
    }
    ui_end_panel();
}
