#include "panel_traced.h"

#include "traced.h"

#include <stdio.h>
#include <string.h>

static const struct {
    const char *chord, *why;
} refused[] = {
    {"Shift+N", "Tiles are not stepped one by one: a launch loads all that its rays lack"},
    {"Ctrl+M", "Demand loaders keep no list of standby tiles to trim: the budget evicts"},
    {"Shift+M", "Demand loaders move no tiles together: the budget gives memory back"},
    {"delete", "Textures of pbrt scenes are not evicted one by one: Shift+R drops all"},
    {"Ctrl+T", "Sweeps are for streamed scenes: what they change does nothing here"},
};

#define REFUSED_COUNT (sizeof refused / sizeof *refused)

const char *panel_traced_refuses(const char *chord)
{
    for (size_t i = 0; i < REFUSED_COUNT; i++)
        if (strcmp(refused[i].chord, chord) == 0)
            return refused[i].why;
    return NULL;
}

bool panel_traced_takes(const char *control)
{
    static const char *const names[] = {"standby",        "timeout",          "residency",
                                        "load",           "feedback",         "feedback-by",
                                        "texture-sets",   "misses-to-forget", "prefetch-levels",
                                        "texel-filter",   "finest-level",     "alpha-test",
                                        "probability",    "tiles-per-frame",  "loads-in-flight",
                                        "fade",           "borders",          "textures-per-frame",
                                        "source-latency", "source-bandwidth", "source-fails",
                                        "predict",        "wireframe",        "event-reason",
                                        "events-of"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(names[i], control) == 0)
            return false;
    return true;
}

void panel_traced_latency(const struct view_app *app)
{
    const uint64_t *buckets = stage_traced(app->stage)->now.latencyHistogram;
    const uint32_t count = 24;
    uint64_t most = 1;
    float r[4];
    for (uint32_t i = 0; i < count; i++)
        most = buckets[i] > most ? buckets[i] : most;
    ui_paragraph(UI_GRAY, "From a request to the end of its read or fill. Bars: less than 1, 2, 4, "
                          "8, ... microseconds.");
    ui_canvas(0, 90 * ui_scale(), r);
    const float step = r[2] / (float)count;
    for (uint32_t i = 0; i < count && !app->deterministic; i++) {
        const float height = r[3] * (float)((double)buckets[i] / (double)most);
        ui_fill(r[0] + (float)i * step, r[1], step - 2, r[3], UI_COLOR(30, 34, 40, 255));
        ui_fill(r[0] + (float)i * step, r[1] + r[3] - height, step - 2, height,
                UI_COLOR(86, 180, 233, 255));
    }
    ui_hint("The longest bar has %llu reads and fills.", (unsigned long long)most);
}

static void draw_event(const struct view_app *app, const struct traced_event *event, int row)
{
    static const char *const kinds[] = {"texture is opened", "tile", "mip tail"};
    const char *name = event->picture < app->facts.texture_count
                           ? stage_texture(app->stage, event->picture)->name
                           : "-";
    ui_table_row(row, false);
    ui_table_cell(UI_WHITE, "%llu", (unsigned long long)event->launch);
    ui_table_cell(UI_WHITE, "%s", name);
    ui_table_cell(UI_WHITE, "%s", kinds[event->kind]);
    if (event->kind == SLUICE_DEMAND_MISS_TILE) {
        ui_table_cell(UI_WHITE, "%u", event->level);
        ui_table_cell(UI_WHITE, "%u, %u", event->x, event->y);
    } else {
        ui_table_cell(UI_GRAY, "-");
        ui_table_cell(UI_GRAY, "-");
    }
}

void panel_traced_events(struct view_app *app)
{
    const struct traced *t = stage_traced(app->stage);
    const bool all = app->selected >= app->facts.texture_count;
    int shown = 0;
    if (app->facts.now.failedTileCount > 0)
        ui_text(UI_RED, "%u reads failed; the terminal says where", app->facts.now.failedTileCount);
    ui_text(UI_GRAY, "What rays missed first, newest on top. %s",
            all ? "All textures." : "The selected texture.");
    if (!ui_begin_table("events", "Launch=99999|Texture|Missed|Level|Tile=99, 99", 0, false))
        return;
    for (uint32_t age = 0; age < t->event_count && shown < 200; age++) {
        const struct traced_event *event =
            &t->events[(t->event_next + TRACED_EVENTS - 1 - age) % TRACED_EVENTS];
        if (all || event->picture == app->selected)
            draw_event(app, event, shown++);
    }
    ui_end_table();
}

void panel_traced_inspector(const struct view_app *app)
{
    const struct traced *t = stage_traced(app->stage);
    char text[400];
    bool good;
    const char *why = traced_explain(t, app->selected, &good, text, sizeof text);
    if (app->inspect.hit && app->inspect.texture == app->selected)
        ui_paragraph(UI_GRAY, t->picked);
    ui_text(UI_GRAY, "Why no finer level?");
    ui_paragraph(good ? UI_WHITE : UI_ORANGE, why);
    if (app->selected >= t->picture_count)
        return;
    const struct traced_picture *p = &t->pictures[app->selected];
    ui_line();
    ui_text(UI_WHITE, "%u of %u tiles resident, %u on their way", p->resident_count, p->tile_count,
            p->pending_count);
    if (p->finest < p->texture.level_count)
        ui_text(UI_GRAY, "finest level in memory: %u of 0 to %u", p->finest,
                p->texture.level_count - 1);
    ui_text(UI_GRAY, "%u pages missed by rays, %u tiles arrived, %u left", p->asked, p->arrived,
            p->left);
    ui_hint("Arrived and left: as far as the viewer saw it, which looks once per frame.");
    ui_paragraph(UI_GRAY, p->texture.path);
}

void panel_traced_device(const struct view_app *app)
{
    const struct traced *t = stage_traced(app->stage);
    ui_paragraph(UI_WHITE, app->gpu->ray_tracing
                               ? "rays: by the ray-tracing pipeline of the device"
                               : "rays: by a compute shader, which is slower: the device has no "
                                 "ray-tracing pipeline");
    ui_text(UI_GRAY, "%s",
            app->gpu->has_build_queue ? "meshes are built on a queue of their own"
                                      : "meshes are built between launches");
    ui_text(UI_GRAY, "%u launches, %u samples per pixel", t->launches.count, t->sample);
}
