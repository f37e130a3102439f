#include "panels.h"

#include "controls.h"
#include "feedback_words.h"
#include "panel_compare.h"
#include "panel_traced.h"
#include "played_app.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#define MIB 1048576.0
#define LEAST_MIB 8.0
#define SLIDER_WIDTH 190.0f

/* Returns the end of a slider, which may be below the maximum of the command line. */
static double slider_most(const struct control *control)
{
    static const struct {
        const char *name;
        double most;
    } limits[] = {{"standby", 16384},
                  {"timeout", 60},
                  {"textures-per-frame", 1024},
                  {"misses-to-forget", 64},
                  {"threads", 32},
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

/* Position of a size on the slider, 0 to 1. */
static float place_of(double mib, double most)
{
    const double place = mib > LEAST_MIB ? log(mib / LEAST_MIB) / log(most / LEAST_MIB) : 0.0;
    return (float)(place < 1.0 ? place : 1.0);
}

/* Draws marks under the slider: memory wanted now, and memory of all tiles. */
static void draw_budget_ticks(const struct view_app *app, double most)
{
    float r[4];
    const float scale = ui_scale(), width = 2 * scale;
    ui_canvas(SLIDER_WIDTH * scale, 8 * scale, r);
    const float wanted = place_of((double)app->facts.wanted_size / MIB, most);
    const float all = place_of((double)app->facts.all_size / MIB, most);
    ui_fill(r[0], r[1], r[2] * wanted, 3 * scale, UI_COLOR(70, 150, 220, 255));
    ui_fill(r[0] + r[2] * wanted - width / 2, r[1], width, 8 * scale, UI_WHITE);
    ui_fill(r[0] + r[2] * all - width / 2, r[1], width, 8 * scale, UI_GRAY);
    ui_hint("White mark: wanted now. Gray mark: everything.");
}

/* Draws the memory that requests need, while the slider is held. */
static void draw_budget_ghost(struct view_app *app)
{
    char size[32];
    const struct budget_need need = facts_budget_need(&app->facts, app->stage);
    const double levels = budget_need_levels(&need, app->dragged_budget);
    const double now = app->facts.now.globalMipBias / 16.0;
    panel_size(budget_need_bytes(&need, 0), size, sizeof size);
    if (levels > 0 && app->dragged_budget < need.tails * SLUICE_DEFAULT_TILE_SIZE)
        ui_text(UI_RED, "mip tails alone need %s",
                panel_size(need.tails * SLUICE_DEFAULT_TILE_SIZE, size, sizeof size));
    else if (levels > 0)
        ui_text(UI_ORANGE, "needs %s: about %.1f level%s coarser", size, levels,
                levels < 1.05 ? "" : "s");
    else if (now > 0)
        ui_text(UI_WHITE, "finer than now, which is %.1f level%s coarser", now,
                now < 1.05 ? "" : "s");
    else
        ui_text(UI_WHITE, "needs %s: as sharp as wanted", size);
}

static void draw_budget_slider(struct view_app *app, const char *label, double most)
{
    const uint64_t budget = app->dragged_budget ? app->dragged_budget : app->settings.budget;
    double mib = (double)budget / MIB;
    if (mib == 0 || mib > most)
        mib = most;
    ui_slider_real(label, &mib, LEAST_MIB, most, true, mib >= most ? "all there is" : "%.0f MiB");
    const uint64_t chosen = (uint64_t)mib * 1048576u;
    const bool active = ui_active();
    if (ui_released())
        app->settings.budget = mib >= most ? 0 : chosen;
    app->dragged_budget = active ? chosen : 0;
}

static void draw_budget(struct view_app *app, const char *label)
{
    char wanted[32];
    const double all = (double)app->facts.all_size / MIB * 1.2;
    const double most = all > 2 * LEAST_MIB ? all : all > 0 ? 2 * LEAST_MIB : 4096.0;
    draw_budget_slider(app, label, most);
    if (!app->dragged_budget)
        ui_hint(
            "Most memory for tiles. The picture becomes coarser when memory is short. Takes effect "
            "when the slider is released.\nDouble click or Delete: no limit. Enter: type MiB. "
            "--budget");
    if (ui_double_clicked() || ui_deleted())
        app->settings.budget = 0;
    panel_size(app->facts.wanted_size, wanted, sizeof wanted);
    draw_budget_ticks(app, most);
    if (app->dragged_budget && !stage_traced(app->stage))
        draw_budget_ghost(app);
    else
        ui_text(UI_GRAY, "wanted now: %s", wanted);
    static const unsigned presets[] = {16, 64, 256};
    for (int i = 0; i < 3; i++) {
        char text[16];
        snprintf(text, sizeof text, "%u", presets[i]);
        if (ui_button(text, 44 * ui_scale(), 0, app->settings.budget == presets[i] * 1048576ull))
            app->settings.budget = presets[i] * 1048576ull;
        ui_hint("Most memory for tiles, in MiB. --budget %s", text);
        ui_same_line(0);
    }
    if (ui_button("all", 44 * ui_scale(), 0, app->settings.budget == 0))
        app->settings.budget = 0;
    ui_hint("As much memory as the device has. --budget 0");
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
    case OPTION_EXTENT:
        ui_type_extent(label, option.value, (uint32_t)option.minimum, (uint32_t)option.maximum);
        break;
    default:
        ui_slider_real(label, option.value, option.minimum, slider_most(control), logarithmic,
                       control->format ? control->format : "%.2f");
        break;
    }
}

/* Draws the number of frames until feedback notices a region of 8 x 8 pixels. */
static void draw_feedback_outlook(const struct view_app *app)
{
    const uint32_t count = app->stage ? feedback_texture_count(app->stage) : 1;
    const struct feedback_outlook outlook = feedback_outlook_of(&app->settings, count);
    if (!outlook.known)
        return;
    if (outlook.missed < 1e-4)
        ui_text(UI_GRAY, "seen within %.0f frames, missed less than 0.01 %%", outlook.frames);
    else
        ui_text(outlook.missed > 0.01 ? UI_ORANGE : UI_GRAY,
                "seen within %.0f frames, missed %.2g %%", outlook.frames, 100 * outlook.missed);
    ui_hint(
        "Predicted for regions of 8 x 8 pixels: frames until 99 of 100 regions are noticed, and "
        "the part of visible regions that is evicted because no map shows them within --timeout.");
}

static void draw_sizes(struct view_app *app)
{
    static const uint32_t sizes[][2] = {{960, 540}, {1280, 720}, {1920, 1080}};
    uint32_t *now = app->settings.size;
    for (int i = 0; i < 3; i++) {
        char text[32];
        snprintf(text, sizeof text, "%ux%u", sizes[i][0], sizes[i][1]);
        if (i > 0)
            ui_same_line(0);
        if (ui_button(text, 0, 0, now[0] == sizes[i][0] && now[1] == sizes[i][1])) {
            now[0] = sizes[i][0];
            now[1] = sizes[i][1];
        }
        ui_hint("Pixels of the window. --size %s", text);
    }
}

static void draw_control(struct view_app *app, const struct control *control)
{
    ui_item_width(SLIDER_WIDTH * ui_scale());
    if (control->option.kind == OPTION_BYTES) {
        draw_budget(app, control->label);
        return;
    }
    const bool unused = control->offset == offsetof(struct view_settings, probability) &&
                        app->settings.feedback_by != VIEW_BY_QUADS;
    ui_begin_disabled(unused);
    draw_widget(app, control, control->label);
    ui_end_disabled();
    ui_hint("%s.%s\nDouble click or Delete: %s. --%s", control->option.help,
            control->flags & CONTROL_REOPENS  ? " The scene is opened again."
            : control->flags & CONTROL_STARTS ? " Takes effect when the program begins."
                                              : "",
            control->option.initial, control->option.name);
    if (ui_double_clicked() || ui_deleted())
        control_reset(control, &app->settings);
    if (control->option.kind == OPTION_EXTENT)
        draw_sizes(app);
    if (control->offset == offsetof(struct view_settings, probability))
        draw_feedback_outlook(app);
}

void panel_controls(struct view_app *app)
{
    uint32_t count;
    if (!app->open[PANEL_CONTROLS])
        return;
    if (panel_begin(app, PANEL_CONTROLS, "Controls (U)", 380, 520)) {
        const struct control *controls = controls_get(&count);
        struct panel_compare_set set;
        if (!stage_played(app->stage))
            panel_compare_choose(app);
        panel_compare_begin_set(app, &set);
        const char *group = "";
        bool open = false;
        for (uint32_t i = 0; i < count; i++) {
            if (stage_traced(app->stage) && !panel_traced_takes(controls[i].option.name))
                continue;
            if (stage_played(app->stage) && !played_app_takes(controls[i].option.name))
                continue;
            if (set.is_b && !control_is_of_sets(&controls[i]))
                continue;
            if (strcmp(group, controls[i].group) != 0)
                open = ui_begin_group(controls[i].group, i == 0);
            group = controls[i].group;
            if (open)
                draw_control(app, &controls[i]);
        }
        panel_compare_end_set(app, &set);
        ui_space(4);
        if (stage_traced(app->stage))
            ui_paragraph(UI_GRAY, "Controls of feedback and of sources are left out: scenes of "
                                  "pbrt load on demand.");
        if (ui_button("Copy command line (C)", 0, 0, false))
            app_copy_command(app);
        ui_hint("Copies a command that opens the viewer with these settings.");
        ui_same_line(0);
        if (ui_button("All defaults", 0, 0, false)) {
            controls_set_defaults(set.is_b ? &app->b : &app->settings);
            app->settings.compared = set.is_b ? VIEW_WITH_B : app->settings.compared;
        }
    }
    ui_end_panel();
}
