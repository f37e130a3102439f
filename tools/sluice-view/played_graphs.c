/* Graphs of a recording. The picture and the panel of graphs draw them. */
#include "panel_played.h"

#include <math.h>
#include <stdio.h>

#define MOST_COLUMNS 2048u

#define BLUE UI_COLOR(86, 180, 233, 255)
#define YELLOW UI_COLOR(240, 228, 66, 255)
#define GREEN UI_COLOR(0, 158, 115, 255)
#define RED UI_COLOR(213, 94, 0, 255)

static const struct played_graph graphs[] = {
    {"Memory",
     "MB",
     "Tiles that are resident and wanted, unwanted ones that stay, the heaps, and what the "
     "configuration allows.",
     {{PLAYED_RESIDENT, 1, BLUE, "resident"},
      {PLAYED_STANDBY, 1, GREEN, "standby"},
      {PLAYED_HEAPS, 1, YELLOW, "heaps"},
      {PLAYED_BUDGET, 1, RED, "allowed"}},
     4,
     1,
     true,
     true},
    {"Missing tiles",
     "",
     "Tiles that are wanted and not resident: in the queue, loading, or failed.",
     {{PLAYED_REQUESTED, 1, YELLOW, "queued"},
      {PLAYED_LOADING, 1, BLUE, "loading"},
      {PLAYED_FAILING, 1, RED, "failed"},
      {PLAYED_GIVEN_UP, 1, UI_COLOR(204, 121, 167, 255), "given up"}},
     4,
     4,
     false,
     false},
    {"Tiles per frame",
     "",
     "Tiles that were loaded, whose slots were given back, and that came back from standby.",
     {{PLAYED_LOADED, 1, BLUE, "loaded"},
      {PLAYED_EVICTED, 1, YELLOW, "evicted"},
      {PLAYED_RESTORED, 1, GREEN, "restored"}},
     3,
     4,
     false,
     false},
    {"Trouble per frame",
     "",
     "Reads that failed; lost: wanted tiles that were evicted; loads that were canceled, or that "
     "nothing "
     "requested any more.",
     {{PLAYED_FAILED, 1, RED, "failed"},
      {PLAYED_LOST, 1, UI_ORANGE, "lost"},
      {PLAYED_CANCELED, 1, BLUE, "canceled"},
      {PLAYED_STALE, 1, YELLOW, "stale"}},
     4,
     4,
     false,
     false},
    {"Time per frame",
     "ms",
     "Between the time stamps of frames, if a tick is a microsecond: recordings do not tell.",
     {{PLAYED_MICROSECONDS, 1e-3, BLUE, "until the next"}},
     1,
     1,
     false,
     false},
    {"Feedback per frame",
     "maps",
     "Maps that the manager was given.",
     {{PLAYED_MAPS, 1, BLUE, "read"}},
     1,
     4,
     false,
     false},
    {"Mip bias",
     "levels",
     "Memory is short: all requests become coarser by so much.",
     {{PLAYED_BIAS, 1.0 / 16, RED, "memory is short"}},
     1,
     1,
     false,
     false},
};

const struct played_graph *played_graphs_get(uint32_t *count)
{
    *count = (uint32_t)(sizeof graphs / sizeof *graphs);
    return graphs;
}

static double factor_of(const struct played *p, const struct played_graph *graph,
                        const struct played_curve *curve)
{
    const bool heaps = curve->figure == PLAYED_HEAPS || curve->figure == PLAYED_BUDGET;
    if (!graph->bytes)
        return curve->factor;
    return curve->factor * p->begin.tileSize * (heaps ? p->begin.heapTileCapacity : 1u) / 1e6;
}

/* Finds the largest value per column, so that peaks stay visible. */
static void find_peaks(const struct played *p, enum played_figure figure, uint32_t first,
                       uint32_t last, uint32_t columns, uint32_t *peaks)
{
    const uint64_t frames = (uint64_t)last - first + 1;
    for (uint32_t column = 0; column < columns; column++) {
        const uint32_t begin = first + (uint32_t)(frames * column / columns);
        uint32_t end = first + (uint32_t)(frames * (column + 1) / columns);
        end = end > begin ? end : begin + 1;
        peaks[column] = played_peak(p, figure, begin, end);
    }
}

static void draw_curve(const uint32_t *peaks, uint32_t columns, double factor, double top,
                       const float r[4], uint32_t color)
{
    float xy[4 * MOST_COLUMNS]; /* steps: points of sharp peaks would leave the graph */
    for (uint32_t i = 0; i < columns; i++) {
        xy[4 * i] = r[0] + r[2] * (float)i / (float)columns;
        xy[4 * i + 2] = r[0] + r[2] * (float)(i + 1) / (float)columns;
        xy[4 * i + 1] = xy[4 * i + 3] =
            r[1] + r[3] * (float)(0.99 - 0.96 * factor * peaks[i] / top);
    }
    ui_polyline(xy, 2 * columns, color, 1.5f * ui_scale());
}

static float x_of(const float r[4], uint32_t first, uint32_t last, uint32_t frame)
{
    return r[0] + r[2] * ((float)(frame - first) + 0.5f) / (float)(last - first + 1);
}

static void show_values(const struct played *p, const struct played_graph *graph, uint32_t frame)
{
    char text[320];
    int length = snprintf(text, sizeof text, "frame %u", frame);
    for (uint32_t i = 0; i < graph->curve_count; i++) {
        const struct played_curve *c = &graph->curves[i];
        const double value = factor_of(p, graph, c) * p->frames[frame].figures[c->figure];
        length +=
            snprintf(text + length, sizeof text - (size_t)length, "\n%s %.*f %s", c->name,
                     value > 0 && value < 10 && floor(value) < value ? 1 : 0, value, graph->unit);
    }
    snprintf(text + length, sizeof text - (size_t)length, "\nClick: go there");
    ui_show_hint(text);
}

uint32_t played_graph_draw(const struct view_app *app, const struct played_graph *graph,
                           const float r[4], uint32_t first, uint32_t last, bool over)
{
    const struct played *p = stage_played(app->stage);
    uint32_t peaks[PLAYED_CURVES][MOST_COLUMNS];
    const uint32_t frames = last - first + 1;
    uint32_t columns = r[2] > 8 ? (uint32_t)r[2] / 2 : 4;
    double top = graph->least_top;
    float x, y;
    columns = columns < MOST_COLUMNS ? columns : MOST_COLUMNS;
    columns = columns < frames ? columns : frames;
    for (uint32_t i = 0; i < graph->curve_count; i++) {
        find_peaks(p, graph->curves[i].figure, first, last, columns, peaks[i]);
        for (uint32_t k = 0; k < columns; k++)
            top = fmax(top, factor_of(p, graph, &graph->curves[i]) * peaks[i][k]);
    }
    ui_fill(r[0], r[1], r[2], r[3], UI_COLOR(30, 34, 40, 255));
    for (uint32_t i = 0; i < graph->curve_count; i++)
        if (graph->curves[i].figure != PLAYED_BUDGET || p->frames[p->frame].figures[PLAYED_BUDGET])
            draw_curve(peaks[i], columns, factor_of(p, graph, &graph->curves[i]), top, r,
                       graph->curves[i].color);
    if (p->frame >= first && p->frame <= last) {
        const float at = x_of(r, first, last, p->frame);
        ui_stroke(at, r[1], at, r[1] + r[3], UI_WHITE, ui_scale());
    }
    ui_mouse(&x, &y);
    if (!over || x < r[0] || x >= r[0] + r[2] || y < r[1] || y >= r[1] + r[3])
        return UINT32_MAX;
    const uint32_t frame = first + (uint32_t)((x - r[0]) / r[2] * (float)frames);
    const uint32_t under = frame < last ? frame : last;
    const float at = x_of(r, first, last, under);
    ui_stroke(at, r[1], at, r[1] + r[3], UI_GRAY, ui_scale());
    show_values(p, graph, under);
    return under;
}

static void draw_title(const struct played *p, const struct played_graph *graph)
{
    const uint32_t *figures = p->frames[p->frame].figures;
    ui_text(UI_WHITE, "%s", graph->title);
    ui_hint("%s", graph->hint);
    for (uint32_t i = 0; i < graph->curve_count; i++) {
        const struct played_curve *c = &graph->curves[i];
        const double value = factor_of(p, graph, c) * figures[c->figure];
        if (c->figure == PLAYED_BUDGET && figures[PLAYED_BUDGET] == 0)
            continue;
        ui_same_line(0);
        ui_text(c->color, "%s %.*f", c->name,
                value > 0 && value < 10 && floor(value) < value ? 1 : 0, value);
    }
    ui_same_line(0);
    ui_text(UI_GRAY, "%s", graph->unit);
}

/* Returns the first frame at a time or later. */
static uint32_t frame_at(const struct played *p, uint64_t time)
{
    uint32_t low = 0, high = p->frame_count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (p->frames[middle].time < time)
            low = middle + 1;
        else
            high = middle;
    }
    return low < p->frame_count ? low : p->frame_count - 1;
}

/* Finds the shown span around the cursor. */
static void find_span(const struct view_app *app, uint32_t *first, uint32_t *last)
{
    static const uint64_t seconds[] = {10, 60};
    const struct played *p = stage_played(app->stage);
    *first = 0;
    *last = p->frame_count - 1;
    if (app->settings.graph_span >= HISTORY_ALL)
        return;
    const uint64_t half = seconds[app->settings.graph_span] * PLAYED_TICKS_PER_SECOND / 2;
    const uint64_t now = p->frames[p->frame].time;
    *first = frame_at(p, now > half ? now - half : 0);
    *last = frame_at(p, now < UINT64_MAX - half ? now + half : UINT64_MAX);
    *first = *first < p->frame ? *first : p->frame;
    *last = *last > p->frame ? *last : p->frame;
}

void panel_played_graphs(struct view_app *app)
{
    static const char *const names[] = {"10 s", "1 min", "all"};
    struct played *p = stage_played(app->stage);
    uint32_t first, last, go = UINT32_MAX, count;
    const struct played_graph *all = played_graphs_get(&count);
    for (int i = 0; i < HISTORY_SPANS; i++) {
        if (ui_button(names[i], 0, 0, app->settings.graph_span == i))
            app->settings.graph_span = i;
        ui_hint("Time around the cursor that the graphs show. --graph-span");
        ui_same_line(0);
    }
    ui_text(UI_GRAY, "a point: largest of its frames; click: go there");
    find_span(app, &first, &last);
    for (uint32_t i = 0; i < count; i++) {
        float r[4];
        draw_title(p, &all[i]);
        ui_canvas(0, 46 * ui_scale(), r);
        const uint32_t under = played_graph_draw(app, &all[i], r, first, last, ui_hovered());
        if (under != UINT32_MAX && ui_mouse_clicked(0))
            go = under;
    }
    if (go != UINT32_MAX)
        panel_played_jump(app, go);
}
