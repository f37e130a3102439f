#include "panels.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define MAX_POINTS 600

struct curve {
    enum facts_series series;
    uint32_t color;
    const char *name;
};

struct graph {
    const char *title, *unit;
    struct curve curves[4];
    uint32_t curve_count;
    double least_top; ///< the axis ends there or higher
    bool times;       ///< differs from run to run
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
      {SERIES_CANCELED, UI_COLOR(0, 158, 115, 255), "canceled"},
      {SERIES_FAILED, UI_COLOR(213, 94, 0, 255), "failed"}},
     4,
     4,
     false},
    {"Sharp", "%", {{SERIES_SHARP, UI_COLOR(86, 180, 233, 255), "of what is seen"}}, 1, 100, false},
    {"Mip bias",
     "levels",
     {{SERIES_BIAS, UI_COLOR(213, 94, 0, 255), "memory is short"}},
     1,
     1,
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

/* The largest of the frames of a point, so that no peak is lost. */
static float value_at(const struct view_facts *f, enum facts_series series, uint32_t point,
                      uint32_t points, uint32_t frames)
{
    const uint32_t first = (uint32_t)((uint64_t)point * frames / points);
    uint32_t end = (uint32_t)((uint64_t)(point + 1) * frames / points);
    float most = 0;
    if (end <= first)
        end = first + 1;
    for (uint32_t age = first; age < end; age++)
        most = fmaxf(most, facts_value(f, series, age));
    return most;
}

static void draw_hover(const struct view_facts *f, const struct graph *graph, const float r[4],
                       uint32_t points, uint32_t frames)
{
    float x, y;
    char text[256];
    int length = 0;
    ui_mouse(&x, &y);
    if (!ui_hovered() || x < r[0] || x >= r[0] + r[2])
        return;
    const uint32_t point = (uint32_t)((r[0] + r[2] - x) / r[2] * (float)points);
    length +=
        snprintf(text, sizeof text, "%u frames ago", (unsigned)((uint64_t)point * frames / points));
    for (uint32_t i = 0; i < graph->curve_count; i++)
        length += snprintf(
            text + length, sizeof text - (size_t)length, "\n%s %.1f %s", graph->curves[i].name,
            (double)value_at(f, graph->curves[i].series, point, points, frames), graph->unit);
    ui_stroke(x, r[1], x, r[1] + r[3], UI_GRAY, 1);
    ui_show_hint(text);
}

static void draw_graph(const struct view_facts *f, const struct graph *graph, uint32_t frames)
{
    float r[4], xy[2 * MAX_POINTS];
    const uint32_t points = frames < MAX_POINTS ? frames : MAX_POINTS;
    double top = graph->least_top;
    for (uint32_t i = 0; i < graph->curve_count; i++)
        for (uint32_t age = 0; age < frames; age++)
            top = fmax(top, (double)facts_value(f, graph->curves[i].series, age));
    ui_text(UI_WHITE, "%s", graph->title);
    for (uint32_t i = 0; i < graph->curve_count; i++) {
        if (graph->curves[i].series == SERIES_BUDGET && f->budget == 0)
            continue;
        ui_same_line(0);
        ui_text(graph->curves[i].color, "%s %.*f", graph->curves[i].name,
                facts_value(f, graph->curves[i].series, 0) < 10 ? 1 : 0,
                (double)facts_value(f, graph->curves[i].series, 0));
    }
    ui_same_line(0);
    ui_text(UI_GRAY, "%s", graph->unit);
    ui_canvas(0, 46 * ui_scale(), r);
    ui_fill(r[0], r[1], r[2], r[3], UI_COLOR(30, 34, 40, 255));
    for (uint32_t i = 0; i < graph->curve_count; i++) {
        if (graph->curves[i].series == SERIES_BUDGET && f->budget == 0)
            continue;
        for (uint32_t point = 0; point < points; point++) {
            const double value =
                (double)value_at(f, graph->curves[i].series, point, points, frames);
            xy[2 * point] =
                r[0] + r[2] * (1.0f - (float)point / (float)(points > 1 ? points - 1 : 1));
            xy[2 * point + 1] = r[1] + r[3] * (float)(1.0 - 0.96 * value / top);
        }
        ui_polyline(xy, points, graph->curves[i].color, 1.5f * ui_scale());
    }
    draw_hover(f, graph, r, points, frames);
}

void panel_graphs(struct view_app *app)
{
    static const uint32_t spans[] = {600, 3600};
    if (!app->open[PANEL_GRAPHS])
        return;
    if (panel_begin(app, PANEL_GRAPHS, "Over time (G)", 480, 480)) {
        const uint32_t known = app->facts.history_count;
        for (size_t i = 0; i < sizeof graphs / sizeof *graphs; i++)
            if (known > 0 && !(app->deterministic && graphs[i].times))
                draw_graph(&app->facts, &graphs[i], known < spans[0] ? known : spans[0]);
    }
    ui_end_panel();
}

static const char *const stage_names[] = {"feedback", "queue", "read", "bind", "copy"};

static void draw_stage(const SluiceLoadStageCounts *stage, const char *name)
{
    float r[4];
    uint64_t most = 1;
    for (int i = 0; i < SLUICE_STAGE_BUCKET_COUNT; i++)
        most = stage->buckets[i] > most ? stage->buckets[i] : most;
    ui_text(UI_WHITE, "%s", name);
    ui_same_line(90 * ui_scale());
    ui_text(UI_GRAY, "%.1f frames on average, at most %llu",
            stage->count ? (double)stage->frameSum / (double)stage->count : 0.0,
            (unsigned long long)stage->frameMax);
    ui_canvas(0, 26 * ui_scale(), r);
    ui_hint("How many maps or tiles left this stage after 0, 1, 2 to 3, 4 to 7, ... frames.");
    const float step = r[2] / SLUICE_STAGE_BUCKET_COUNT;
    for (int i = 0; i < SLUICE_STAGE_BUCKET_COUNT; i++) {
        const float height = r[3] * (float)((double)stage->buckets[i] / (double)most);
        ui_fill(r[0] + (float)i * step, r[1], step - 2, r[3], UI_COLOR(30, 34, 40, 255));
        ui_fill(r[0] + (float)i * step, r[1] + r[3] - height, step - 2, height,
                UI_COLOR(86, 180, 233, 255));
    }
}

void panel_latency(struct view_app *app)
{
    if (!app->open[PANEL_LATENCY])
        return;
    if (panel_begin(app, PANEL_LATENCY, "Latency (Y)", 420, 360)) {
        ui_paragraph(UI_GRAY, "From a mark of a shader to the picture. Bars: 0, 1, 2-3, 4-7, ... "
                              "frames.");
        for (int i = 0; i < SLUICE_LOAD_STAGE_COUNT; i++)
            draw_stage(&app->facts.stages.stages[i], stage_names[i]);
    }
    ui_end_panel();
}
