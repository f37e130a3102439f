#include "panels.h"

#include "actions.h"

#include <string.h>

static void draw_group(const struct action *actions, uint32_t count, const char *group, float x)
{
    for (uint32_t i = 0; i < count; i++) {
        if (strcmp(actions[i].group, group) != 0)
            continue;
        ui_text(UI_ORANGE, "%s", actions[i].shown ? actions[i].shown : actions[i].chord);
        ui_same_line(x);
        ui_text(UI_WHITE, "%s", actions[i].words);
    }
}

/* The one page that may be larger: it was asked for. */
void panel_keys(struct view_app *app)
{
    static const char *const columns[2][3] = {{"Camera", "Views", NULL},
                                              {"Streaming", "Panels", "Program"}};
    uint32_t count;
    const struct action *actions = actions_get(&count);
    const float scale = ui_scale(), pivot[2] = {0.5f, 0.5f};
    const float placement[4] = {app->width / 2, app->height / 2, 0, 0};
    if (!app->open[PANEL_KEYS])
        return;
    float height = 34 * ui_line_height();
    if (height > app->height - 60 * scale)
        height = app->height - 60 * scale;
    if (ui_begin_panel("All keys (F1)", &app->open[PANEL_KEYS], placement, pivot, UI_PANEL_FIT)) {
        for (int column = 0; column < 2; column++) {
            ui_begin_part(column ? "right" : "left", 390 * scale, height);
            for (int i = 0; i < 3 && columns[column][i]; i++) {
                ui_text(UI_BLUE, "%s", columns[column][i]);
                draw_group(actions, count, columns[column][i], 125 * scale);
                ui_space(4 * scale);
            }
            ui_end_part();
            if (column == 0)
                ui_same_line(0);
        }
    }
    ui_end_panel();
}

void panel_menu(struct view_app *app)
{
    uint32_t count;
    const struct action *actions = actions_get(&count);
    if (!app->open[PANEL_MENU])
        return;
    if (panel_begin(app, PANEL_MENU, "Menu (F10)", 340, 560)) {
        const char *group = "";
        for (uint32_t i = 0; i < count; i++) {
            if (strcmp(group, actions[i].group) != 0)
                ui_text(UI_BLUE, "%s", actions[i].group);
            group = actions[i].group;
            if (!actions[i].act)
                continue;
            if (ui_button(actions[i].words, 220 * ui_scale(), 0, false))
                actions[i].act(app, actions[i].argument);
            ui_same_line(0);
            ui_text(UI_GRAY, "%s", actions[i].shown ? actions[i].shown : actions[i].chord);
        }
    }
    ui_end_panel();
}
