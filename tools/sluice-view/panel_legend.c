#include "panels.h"

#include "feedback_words.h"
#include "panel_compare.h"
#include "panel_traced.h"
#include "tile_marks.h"

#include <sluice/metrics.h>

#include <math.h>
#include <stdio.h>

#define SWATCH_WIDTH 22.0f

/* Draws the pattern of a reason over a swatch. Same pattern as markPattern in
 * shaders/view_colors.glsl. */
static void draw_pattern(enum mark_reason reason, const float r[4])
{
    const uint32_t dark = UI_COLOR(10, 10, 10, 255);
    const float scale = ui_scale(), right = r[0] + r[2], bottom = r[1] + r[3];
    const float size = r[3];
    switch (reason) {
    case MARK_COMING:
        for (float x = r[0] + 3 * scale; x + 3 * scale < right; x += 7 * scale)
            ui_fill(x, r[1] + size / 2 - 2 * scale, 4 * scale, 4 * scale, dark);
        break;
    case MARK_BUDGET:
        for (float x = r[0]; x + size <= right + 1; x += 7 * scale)
            ui_stroke(x, bottom, x + size, r[1], dark, 2.5f * scale);
        break;
    case MARK_FAILED:
        for (float x = r[0]; x + size <= right + 1; x += 8 * scale) {
            ui_stroke(x, bottom, x + size, r[1], dark, 1.5f * scale);
            ui_stroke(x, r[1], x + size, bottom, dark, 1.5f * scale);
        }
        break;
    case MARK_NOT_SEEN:
        for (float y = r[1] + 2 * scale; y < bottom; y += 5 * scale)
            ui_fill(r[0], y, r[2], 2 * scale, dark);
        break;
    case MARK_LIMIT:
        for (float x = r[0] + 3 * scale; x < right; x += 6 * scale)
            ui_fill(x, r[1], 2 * scale, size, dark);
        break;
    default: break;
    }
}

static void draw_swatch(uint32_t color, enum mark_reason reason, const char *words)
{
    float r[4];
    ui_canvas(SWATCH_WIDTH * ui_scale(), ui_line_height() - 4 * ui_scale(), r);
    r[1] += 2 * ui_scale();
    r[3] -= 2 * ui_scale();
    ui_fill(r[0], r[1], r[2], r[3], color);
    draw_pattern(reason, r);
    ui_same_line(0);
    ui_text(UI_WHITE, "%s", words);
}

static void draw_color(uint32_t color, const char *words)
{
    draw_swatch(color, MARK_NOTHING, words);
}

static void draw_levels(void)
{
    char words[32];
    for (uint32_t level = 0; level < 8; level++) {
        snprintf(words, sizeof words, "level %u%s", level,
                 level == 0   ? ", finest"
                 : level == 7 ? " or coarser"
                              : "");
        draw_color(panel_level_color(level), words);
    }
}

static void draw_missing(void)
{
    const uint32_t yellow = UI_COLOR(240, 228, 66, 255);
    draw_color(UI_COLOR(255, 255, 255, 60), "as sharp as wanted");
    draw_color(yellow, "1 level is missing");
    draw_color(UI_COLOR(230, 159, 0, 255), "2 levels");
    draw_color(UI_COLOR(213, 94, 0, 255), "3 levels or more");
    ui_text(UI_GRAY, "because");
    draw_swatch(yellow, MARK_COMING, "a load is on its way");
    draw_swatch(yellow, MARK_BUDGET, "memory is short");
    draw_swatch(yellow, MARK_FAILED, "reading failed");
    draw_swatch(yellow, MARK_NOT_SEEN, "feedback has not asked so far");
    draw_swatch(yellow, MARK_LIMIT, "a limit was set");
    draw_color(UI_COLOR(86, 180, 233, 255), "the file has no finer level");
}

static void draw_ages(void)
{
    draw_color(UI_COLOR(253, 231, 37, 255), "less than 0.5 s in memory");
    draw_color(UI_COLOR(122, 209, 81, 255), "2 s");
    draw_color(UI_COLOR(34, 168, 132, 255), "10 s");
    draw_color(UI_COLOR(42, 120, 142, 255), "1 min");
    draw_color(UI_COLOR(65, 68, 135, 255), "longer");
    draw_swatch(UI_COLOR(255, 0, 255, 255), MARK_FAILED, "3 loads in 10 s: thrashes");
}

static void draw_writers(const struct view_app *app)
{
    char words[96];
    const uint32_t count = feedback_texture_count(app->stage);
    draw_color(UI_COLOR(255, 217, 51, 255), "wrote feedback in this frame:");
    ui_text(UI_GRAY, "%s", feedback_writers(&app->settings, count, words, sizeof words));
}

static void draw_checks(void)
{
    ui_text(UI_GRAY, "texels of level 0 per pixel");
    draw_color(UI_COLOR(5, 48, 97, 255), "less than 1/4: blurry");
    draw_color(UI_COLOR(103, 169, 207, 255), "1/4 to 0.7");
    draw_color(UI_COLOR(247, 247, 247, 255), "about 1");
    draw_color(UI_COLOR(253, 174, 97, 255), "1.5 to 4");
    draw_color(UI_COLOR(215, 72, 39, 255), "4 to 16");
    draw_color(UI_COLOR(92, 58, 20, 255), "more: coarser levels serve");
    draw_color(UI_COLOR(255, 0, 255, 255), "nothing is resident");
}

/* Draws colors and scale of FLIP, its mean, and its value under the mouse. */
static void draw_flip(const struct view_app *app)
{
    enum { STEPS = 64 };
    float values[STEPS], r[4];
    uint8_t colors[STEPS][4];
    const struct flip_map *flip = app->flip;
    for (int i = 0; i < STEPS; i++)
        values[i] = (float)i / (STEPS - 1);
    sluiceColorMagma(values, STEPS, colors[0]);
    ui_canvas(STEPS * 3 * ui_scale(), 12 * ui_scale(), r);
    for (int i = 0; i < STEPS; i++)
        ui_fill(r[0] + (float)i * r[2] / STEPS, r[1], r[2] / STEPS + 1, r[3],
                UI_COLOR(colors[i][0], colors[i][1], colors[i][2], 255));
    ui_canvas(r[2], ui_line_height(), r);
    ui_label(r[0], r[1], UI_GRAY, "0");
    ui_label(r[0] + (r[2] - ui_text_width("FLIP")) / 2, r[1], UI_GRAY, "FLIP");
    ui_label(r[0] + r[2] - ui_text_width("1"), r[1], UI_GRAY, "1");
    if (!flip || !flip->known) {
        ui_text(UI_GRAY, "FLIP is being computed");
        return;
    }
    const float here = flip_map_at(flip, app->mouse_x / app->width, app->mouse_y / app->height);
    ui_text(UI_WHITE, "FLIP: mean %.4f", flip->shown_mean);
    if (here >= 0)
        ui_text(UI_WHITE, "under the mouse: %.3f", (double)here);
}

static void draw_differences(const struct view_app *app)
{
    if (app->settings.view == VIEW_TRUTH)
        ui_text(UI_GRAY, "black: as if everything were resident");
    if (app->settings.difference != VIEW_FLIP)
        ui_text(UI_GRAY, "pixels: differences times %.0f (--gain)", app->settings.gain);
    if (app->settings.difference != VIEW_PIXELS)
        draw_flip(app);
    if (app->settings.view == VIEW_TRUTH && app->truth_part < 1.0)
        ui_text(UI_ORANGE, "%.0f %% of the truth is loaded", floor(100.0 * app->truth_part));
}

static const char *const view_names[] = {"",
                                         "Picture",
                                         "Resident level",
                                         "Missing levels",
                                         "Wanted level",
                                         "Age of tiles",
                                         "Textures",
                                         "Feedback written",
                                         "Difference to the truth",
                                         "Checks"};

static void draw_traced_missing(void)
{
    const uint32_t yellow = UI_COLOR(240, 228, 66, 255);
    draw_color(UI_COLOR(128, 128, 128, 255), "as sharp as wanted");
    draw_color(yellow, "1 level, a shape or a material is missing");
    draw_color(UI_COLOR(230, 159, 0, 255), "2 levels");
    draw_color(UI_COLOR(213, 94, 0, 255), "3 levels or more");
    ui_text(UI_GRAY, "because");
    draw_swatch(yellow, MARK_COMING, "rays requested it");
    draw_swatch(yellow, MARK_BUDGET, "memory is short");
}

/* Draws the legend of a view of traced scenes. False if the view has no legend of its own there. */
static bool draw_traced(const struct view_app *app)
{
    switch (app->settings.view) {
    case VIEW_MISSING: draw_traced_missing(); return true;
    case VIEW_WRITTEN: ui_text(UI_GRAY, "dots: pixels whose rays requested something"); return true;
    default: return false;
    }
}

static void draw_legend(const struct view_app *app)
{
    if (app_shows_difference(app)) {
        draw_differences(app);
        return;
    }
    if (stage_traced(app->stage) && draw_traced(app))
        return;
    switch (app->settings.view) {
    case VIEW_RESIDENT:
    case VIEW_WANTED: draw_levels(); break;
    case VIEW_MISSING: draw_missing(); break;
    case VIEW_AGE: draw_ages(); break;
    case VIEW_IDENTITY:
        ui_text(UI_GRAY, "a color per texture; white edges:");
        ui_text(UI_GRAY, "a side that is no power of two");
        break;
    case VIEW_WRITTEN: draw_writers(app); break;
    case VIEW_CHECKS: draw_checks(); break;
    default: break;
    }
}

static bool side_is_open(const struct view_app *app, bool right)
{
    for (int i = 0; i < PANEL_COUNT; i++)
        if (app->open[i] && panel_is_right((enum app_panel)i) == right)
            return true;
    return false;
}

/* Draws the legend in a lower corner, on a side without a panel. Between two panels only its title
 * has room. */
void panel_legend(struct view_app *app)
{
    const float scale = ui_scale(), margin = 12 * scale;
    const bool left = side_is_open(app, false), right = side_is_open(app, true);
    const float pivot[2] = {left && !right ? 1 : 0, 1};
    const float beside = (app->width - app->line_width) / 2 - margin; /* room beside the line */
    const float bottom = app->line_width > 0 && app->legend_width > beside ? 86 * scale : margin;
    const float placement[4] = {left && !right ? app->width - margin : margin, app->height - bottom,
                                0, 0};
    const uint32_t view = app->settings.view;
    const bool differs = app_shows_difference(app), compares = app_compares(app);
    const bool colors = view > VIEW_PICTURE && view <= VIEW_CHECKS;
    app->legend_width = 0;
    if (!differs && !compares && !colors)
        return;
    if (ui_begin_panel("legend", NULL, placement, pivot, UI_PANEL_PLAIN | UI_PANEL_FIT)) {
        if (compares)
            panel_compare_figures(app);
        if (compares && (differs || colors))
            ui_line();
        if (differs && view != VIEW_TRUTH)
            ui_text(UI_BLUE, "V  Difference of A and B");
        else if (colors)
            ui_text(UI_BLUE, "%u  %s", view, view_names[view]);
        if (!(left && right) && app->height >= 480 * scale)
            draw_legend(app);
        panel_probe(app);
        app->legend_width = ui_panel_width();
    }
    ui_end_panel();
}
