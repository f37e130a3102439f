#include "panels.h"

#include "panel_played.h"

#include <math.h>
#include <stdio.h>

#define QUANTILE_SECONDS 0.25
#define PIN_POINTS 6u

struct curve {
    enum facts_series series;
    uint32_t color;
    const char *name;
};

struct graph {
    const char *title, *unit;
    struct curve curves[4];
    uint32_t curve_count;
    double least_top; ///< smallest end of the axis
    bool times;       ///< shows times, which differ between runs
};

static const struct graph graphs[] = {
    {"Memory",
     "MB",
     {{SERIES_RESIDENT, UI_COLOR(86, 180, 233, 255), "resident"},
      {SERIES_WANTED, UI_COLOR(240, 228, 66, 255), "wanted"},
      {SERIES_STANDBY, UI_COLOR(0, 158, 115, 255), "standby"},
      {SERIES_BUDGET, UI_COLOR(213, 94, 0, 255), "budget"}},
     4,
     1,
     false},
    {"Traffic",
     "MB/s",
     {{SERIES_READ, UI_COLOR(86, 180, 233, 255), "read"},
      {SERIES_UPLOADED, UI_COLOR(240, 228, 66, 255), "uploaded"}},
     2,
     1,
     true},
    {"Tiles per frame",
     "",
     {{SERIES_MAPPED, UI_COLOR(86, 180, 233, 255), "mapped"},
      {SERIES_UNMAPPED, UI_COLOR(240, 228, 66, 255), "unmapped"},
      {SERIES_RESTORED, UI_COLOR(0, 158, 115, 255), "restored"}},
     3,
     4,
     false},
    {"Wasted tiles per frame",
     "",
     {{SERIES_CANCELED, UI_COLOR(86, 180, 233, 255), "canceled"},
      {SERIES_STALE, UI_COLOR(240, 228, 66, 255), "stale"},
      {SERIES_FAILED, UI_COLOR(213, 94, 0, 255), "failed"}},
     3,
     4,
     false},
    {"Missing",
     "%",
     {{SERIES_MISSING, UI_COLOR(213, 94, 0, 255), "of what is seen"}},
     1,
     10,
     false},
    {"Mip bias",
     "levels",
     {{SERIES_BIAS, UI_COLOR(213, 94, 0, 255), "memory is short"}},
     1,
     1,
     false},
    {"Binds per frame",
     "",
     {{SERIES_BIND_CALLS, UI_COLOR(86, 180, 233, 255), "calls"},
      {SERIES_BIND_RUNS, UI_COLOR(240, 228, 66, 255), "runs"}},
     2,
     4,
     false},
    {"Feedback per frame",
     "words",
     {{SERIES_FEEDBACK_WORDS, UI_COLOR(86, 180, 233, 255), "read back"}},
     1,
     64,
     false},
    {"Time",
     "ms",
     {{SERIES_FRAME, UI_COLOR(86, 180, 233, 255), "frame"},
      {SERIES_HOST, UI_COLOR(240, 228, 66, 255), "host"},
      {SERIES_GPU, UI_COLOR(0, 158, 115, 255), "GPU"}},
     3,
     17,
     true},
};

static bool is_drawn(const struct view_facts *f, const struct curve *curve)
{
    return curve->series != SERIES_BUDGET || f->budget > 0;
}

/* Returns the decimals of a value: none from 10 on. */
static int digits_of(double value)
{
    return value > 0 && value < 10 ? 1 : 0;
}

/* Returns the age in points of the values in the titles; 0: now. */
static uint32_t shown_age(const struct view_app *app)
{
    const uint32_t age =
        app->pinned > 0 ? history_age_of(&app->facts.history,
                                         (enum history_span)app->settings.graph_span, app->pinned)
                        : 0;
    return age == UINT32_MAX ? 0 : age;
}

/* Pins the values of a time. A click near the pinned line unpins them. */
static void pin(struct view_app *app, enum history_span span, uint32_t age)
{
    const uint32_t shown = shown_age(app);
    const bool again = shown > 0 && (shown > age ? shown - age : age - shown) <= PIN_POINTS;
    app->pinned = again ? 0 : history_time_of(&app->facts.history, span, age);
}

static float x_of(const float r[4], uint32_t age)
{
    return r[0] + r[2] * (1.0f - (float)age / (HISTORY_POINTS - 1));
}

static void draw_hover(struct view_app *app, const struct graph *graph, const float r[4],
                       enum history_span span)
{
    const struct view_facts *f = &app->facts;
    float x, y;
    char text[320];
    if (shown_age(app) > 0)
        ui_stroke(x_of(r, shown_age(app)), r[1], x_of(r, shown_age(app)), r[1] + r[3], UI_WHITE,
                  ui_scale());
    ui_mouse(&x, &y);
    if (!ui_hovered() || x < r[0] || x >= r[0] + r[2])
        return;
    const uint32_t age = (uint32_t)((r[0] + r[2] - x) / r[2] * (float)(HISTORY_POINTS - 1) + 0.5f);
    if (age >= history_count(&f->history, span))
        return;
    int length = snprintf(text, sizeof text, "%.1f s ago", age * f->history.rings[span].step);
    for (uint32_t i = 0; i < graph->curve_count; i++) {
        const double value = (double)history_value(&f->history, span, graph->curves[i].series, age);
        if (is_drawn(f, &graph->curves[i]))
            length += snprintf(text + length, sizeof text - (size_t)length, "\n%s %.*f %s",
                               graph->curves[i].name, digits_of(value), value, graph->unit);
    }
    snprintf(text + length, sizeof text - (size_t)length, "\nClick: keep showing this frame");
    ui_stroke(x, r[1], x, r[1] + r[3], UI_GRAY, 1);
    ui_show_hint(text);
    if (ui_mouse_clicked(0))
        pin(app, span, age);
}

static void draw_title(const struct view_app *app, const struct graph *graph)
{
    const struct view_facts *f = &app->facts;
    const uint32_t age = shown_age(app);
    ui_text(UI_WHITE, "%s", graph->title);
    for (uint32_t i = 0; i < graph->curve_count; i++) {
        const enum facts_series series = graph->curves[i].series;
        const double value =
            (double)(age > 0
                         ? history_value(&f->history, (enum history_span)app->settings.graph_span,
                                         series, age)
                         : f->latest[series]);
        if (!is_drawn(f, &graph->curves[i]))
            continue;
        ui_same_line(0);
        ui_text(graph->curves[i].color, "%s %.*f", graph->curves[i].name, digits_of(value), value);
    }
    ui_same_line(0);
    ui_text(UI_GRAY, "%s", graph->unit);
}

/* Draws a curve. Leaves out points between equal neighbors, which do not change the line. */
static void draw_curve(const float *values, uint32_t count, const float r[4], double top,
                       uint32_t color)
{
    float xy[2 * HISTORY_POINTS];
    uint32_t points = 0;
    const float per_value = r[3] * 0.96f / (float)top, per_age = r[2] / (HISTORY_POINTS - 1);
    for (uint32_t age = 0; age < count; age++) {
        if (age > 0 && age + 1 < count && values[age] == values[age - 1] &&
            values[age] == values[age + 1])
            continue;
        xy[2 * points] = r[0] + r[2] - (float)age * per_age;
        xy[2 * points++ + 1] = r[1] + r[3] - values[age] * per_value;
    }
    /* Whole pixels, since fractional widths take twice the vertices. */
    ui_polyline(xy, points, color, floorf(1.5f * ui_scale() + 0.5f));
}

static void draw_curves(const struct view_facts *f, const struct graph *graph,
                        enum history_span span, const float r[4])
{
    float values[4][HISTORY_POINTS];
    uint32_t count = 0;
    float top = (float)graph->least_top;
    for (uint32_t i = 0; i < graph->curve_count; i++) {
        count = history_read(&f->history, span, graph->curves[i].series, values[i]);
        for (uint32_t age = 0; age < count; age++)
            top = values[i][age] > top ? values[i][age] : top;
    }
    ui_fill(r[0], r[1], r[2], r[3], UI_COLOR(30, 34, 40, 255));
    for (uint32_t i = 0; i < graph->curve_count; i++)
        if (is_drawn(f, &graph->curves[i]))
            draw_curve(values[i], count, r, (double)top, graph->curves[i].color);
}

static void draw_graph(struct view_app *app, const struct graph *graph, enum history_span span)
{
    const struct view_facts *f = &app->facts;
    const float height = 46 * ui_scale();
    float r[4];
    if (!ui_in_sight(ui_line_height() + height)) {
        ui_space(ui_line_height() + height);
        return;
    }
    draw_title(app, graph);
    ui_canvas(0, height, r);
    draw_curves(f, graph, span, r);
    draw_hover(app, graph, r, span);
}

/* Draws quantiles of at most the last 3600 frames. Sorts them some times per second. */
static void draw_quantiles(struct view_app *app, enum history_span span)
{
    static const double parts[] = {0.5, 0.99};
    struct app_quantiles *q = &app->quantiles;
    if (app->seconds >= q->next || app->seconds < q->next - QUANTILE_SECONDS || q->span != span) {
        history_frame_times(&app->facts.history, span, parts, 2, q->seconds);
        q->next = app->seconds + QUANTILE_SECONDS;
        q->span = span;
    }
    ui_text(UI_WHITE, "Frames%s: half within %.1f ms (p50), 99 %% within %.1f ms (p99)",
            app->headless ? ", time by number" : "", 1e3 * q->seconds[0], 1e3 * q->seconds[1]);
    ui_hint("Quantiles over the shown span, at most over the last %u frames.", HISTORY_FRAMES);
}

static void draw_spans(struct view_app *app)
{
    static const char *const names[] = {"10 s", "1 min", "all"};
    for (int i = 0; i < HISTORY_SPANS; i++) {
        if (ui_button(names[i], 0, 0, app->settings.graph_span == i))
            app->settings.graph_span = i;
        ui_hint("Time that the graphs show. --graph-span");
        ui_same_line(0);
    }
    const uint32_t age = shown_age(app);
    const double step = app->facts.history.rings[app->settings.graph_span].step;
    if (age > 0 && ui_button("Now", 0, 0, false))
        app->pinned = 0;
    if (age > 0) {
        ui_hint("Shows the present values. A click on the white line does so, too.");
        ui_same_line(0);
        ui_text(UI_ORANGE, "values of %.1f s ago", age * step);
    } else {
        ui_text(UI_GRAY, "a point: largest of its frames; click: keep its values");
    }
}

void panel_graphs(struct view_app *app)
{
    if (!app->open[PANEL_GRAPHS])
        return;
    if (app->stage && stage_played(app->stage)) {
        if (panel_begin(app, PANEL_GRAPHS, "Over time (G)", 480, 480))
            panel_played_graphs(app);
        ui_end_panel();
        return;
    }
    if (panel_begin(app, PANEL_GRAPHS, "Over time (G)", 480, 480)) {
        const enum history_span span = (enum history_span)app->settings.graph_span;
        draw_spans(app);
        if (!app->deterministic)
            draw_quantiles(app, span);
        for (size_t i = 0; i < sizeof graphs / sizeof *graphs; i++)
            if (!(app->deterministic && graphs[i].times))
                draw_graph(app, &graphs[i], span);
    }
    ui_end_panel();
}
