#include "panels.h"

#include "controls.h"
#include "panel_traced.h"

#include <stdio.h>
#include <string.h>

#define MIB 1048576.0

/* Sliders have no room for all that the command line takes. */
static double slider_most(const struct control *control)
{
    static const struct {
        const char *name;
        double most;
    } limits[] = {{"standby", 16384},
                  {"timeout", 60},
                  {"textures-per-frame", 1024},
                  {"fade", 2},
                  {"predict", 2},
                  {"source-latency", 1000},
                  {"source-bandwidth", 1000},
                  {"loads-in-flight", 4096},
                  {"source-fails", 64},
                  {"speed", 100},
                  {"frame-cap", 240}};
    for (size_t i = 0; i < sizeof limits / sizeof *limits; i++)
        if (strcmp(limits[i].name, control->option.name) == 0)
            return limits[i].most;
    return control->option.maximum;
}

static void draw_budget(struct view_app *app, const char *label)
{
    char wanted[32];
    double mib = (double)app->settings.budget / MIB;
    const double most = app->facts.all_size > 0 ? (double)app->facts.all_size / MIB * 1.2 : 4096.0;
    if (mib == 0)
        mib = most;
    if (ui_slider_real(label, &mib, 8.0, most, true, mib >= most ? "all there is" : "%.0f MiB"))
        app->settings.budget = mib >= most ? 0 : (uint64_t)mib * 1048576u;
    ui_hint("Most memory for tiles: the picture becomes coarser when it is short. Wanted now: %s. "
            "Double click: no limit. --budget",
            panel_size(app->facts.wanted_size, wanted, sizeof wanted));
    if (ui_double_clicked())
        app->settings.budget = 0;
    static const unsigned presets[] = {16, 64, 256};
    for (int i = 0; i < 3; i++) {
        char text[16];
        snprintf(text, sizeof text, "%u", presets[i]);
        if (ui_button(text, 44 * ui_scale(), 0, app->settings.budget == presets[i] * 1048576ull))
            app->settings.budget = presets[i] * 1048576ull;
        ui_same_line(0);
    }
    if (ui_button("all", 44 * ui_scale(), 0, app->settings.budget == 0))
        app->settings.budget = 0;
}

static void draw_widget(struct view_app *app, const struct control *control, const char *label)
{
    const bool logarithmic = control->flags & CONTROL_LOGARITHMIC;
    const struct option option = control_option(control, &app->settings);
    switch (option.kind) {
    case OPTION_UINT:
        ui_slider_whole(label, option.value, (uint32_t)option.minimum,
                        (uint32_t)slider_most(control), logarithmic);
        break;
    case OPTION_CHOICE: ui_choice(label, option.operand, option.value); break;
    case OPTION_EXTENT: {
        const uint32_t *extent = option.value;
        ui_text(UI_GRAY, "%u x %u pixels", extent[0], extent[1]);
        break;
    }
    default:
        ui_slider_real(label, option.value, option.minimum, slider_most(control), logarithmic,
                       control->format ? control->format : "%.2f");
        break;
    }
}

static void draw_control(struct view_app *app, const struct control *control)
{
    ui_item_width(190 * ui_scale());
    if (control->option.kind == OPTION_BYTES) {
        draw_budget(app, control->label);
        return;
    }
    draw_widget(app, control, control->label);
    ui_hint("%s.%s\nDouble click: %s. --%s", control->option.help,
            control->flags & CONTROL_REOPENS ? " Takes effect when the scene is opened again (F5)."
                                             : "",
            control->option.initial, control->option.name);
    if (ui_double_clicked() && control->option.kind != OPTION_CHOICE)
        control_reset(control, &app->settings);
}

void panel_controls(struct view_app *app)
{
    uint32_t count;
    if (!app->open[PANEL_CONTROLS])
        return;
    if (panel_begin(app, PANEL_CONTROLS, "Controls (U)", 380, 520)) {
        const struct control *controls = controls_get(&count);
        const char *group = "";
        bool open = false;
        for (uint32_t i = 0; i < count; i++) {
            if (stage_traced(app->stage) && !panel_traced_takes(controls[i].option.name))
                continue;
            if (strcmp(group, controls[i].group) != 0)
                open = ui_begin_group(controls[i].group, i == 0);
            group = controls[i].group;
            if (open)
                draw_control(app, &controls[i]);
        }
        ui_space(4);
        if (stage_traced(app->stage))
            ui_paragraph(UI_GRAY, "Controls of feedback, of sources and of comparisons are left "
                                  "out: scenes of pbrt load on demand.");
        if (ui_button("Copy command line (C)", 0, 0, false))
            app_copy_command(app);
        ui_hint("Copies a command that opens the viewer with these settings.");
        ui_same_line(0);
        if (ui_button("All defaults", 0, 0, false))
            controls_set_defaults(&app->settings);
    }
    ui_end_panel();
}
