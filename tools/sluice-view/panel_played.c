#include "panel_played.h"

#include "played_app.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define LANES 5u
#define MOST_FAILING 6u

static struct played *played_of(const struct view_app *app)
{
    return stage_played(app->stage);
}

void panel_played_jump(struct view_app *app, uint32_t frame)
{
    played_of(app)->playing = false;
    played_app_go(app, frame);
}

static uint32_t missing_of(const struct played_frame *frame)
{
    return played_wanted(frame) - frame->figures[PLAYED_RESIDENT];
}

static void draw_lane_title(const struct view_app *app, const struct played_graph *graph, float x,
                            float y)
{
    char text[96];
    ui_label(x, y, UI_WHITE, graph->title);
    x += ui_text_width(graph->title) + 12 * ui_scale();
    for (uint32_t i = 0; i < graph->curve_count; i++) {
        const struct played_curve *c = &graph->curves[i];
        if (c->figure == PLAYED_BUDGET &&
            played_of(app)->frames[played_of(app)->frame].figures[PLAYED_BUDGET] == 0)
            continue;
        snprintf(text, sizeof text, "%s%s%s", c->name, graph->unit[0] ? ", " : "", graph->unit);
        ui_label(x, y, c->color, text);
        x += ui_text_width(text) + 12 * ui_scale();
    }
}

/* Drags go to the frame under the mouse, wherever in height it is. */
static void follow_mouse(struct view_app *app, float left, float width)
{
    const struct played *p = played_of(app);
    if (!app->dragging || width <= 0)
        return;
    const double part = (double)((app->mouse_x - left) / width);
    const double frame = floor(fmin(fmax(part, 0), 1) * p->frame_count);
    panel_played_jump(app, (uint32_t)frame);
}

void panel_played_picture(struct view_app *app)
{
    const float scale = ui_scale(), margin = 16 * scale, pivot[2] = {0, 0};
    const float placement[4] = {0, 0, app->width, app->height};
    const float top = 60 * scale, bottom = 84 * scale, line = ui_line_height();
    const float height = (app->height - top - bottom) / LANES;
    const struct played *p = played_of(app);
    uint32_t count;
    const struct played_graph *graphs = played_graphs_get(&count);
    ui_fill_behind(0, 0, app->width, app->height, UI_COLOR(24, 28, 34, 255));
    if (ui_begin_panel("recording", NULL, placement, pivot,
                       UI_PANEL_PLAIN | UI_PANEL_NO_INPUT | UI_PANEL_BEHIND))
        for (uint32_t i = 0; i < LANES && i < count && height > 2 * line; i++) {
            const float y = top + height * (float)i;
            const float r[4] = {margin, y + line, app->width - 2 * margin, height - line - 4};
            draw_lane_title(app, &graphs[i], margin, y);
            played_graph_draw(app, &graphs[i], r, 0, p->frame_count - 1,
                              !ui_owns_mouse() && app->mouse_x >= 0);
        }
    ui_end_panel();
    follow_mouse(app, margin, app->width - 2 * margin);
}

static void draw_button(struct view_app *app, const char *label, enum played_action action,
                        bool pressed, const char *hint)
{
    if (ui_button(label, 0, 0, pressed))
        played_app_act(app, (int)action);
    ui_hint("%s", hint);
    ui_same_line(0);
}

static void draw_strip(struct view_app *app)
{
    const float scale = ui_scale(), pivot[2] = {0, 0};
    const float placement[4] = {12 * scale, 12 * scale, 0, 0};
    if (ui_begin_panel("steps", NULL, placement, pivot, UI_PANEL_PLAIN | UI_PANEL_FIT)) {
        draw_button(app, "|<", PLAYED_FIRST, false, "First frame. Home");
        draw_button(app, "<", PLAYED_BACK, false, "Frame before. Shift+N, left");
        draw_button(app, played_of(app)->playing ? "Stop" : "Play", PLAYED_PLAY,
                    played_of(app)->playing, "Plays a frame per frame of the viewer. Space, P");
        draw_button(app, ">", PLAYED_NEXT, false, "Next frame. N, right");
        draw_button(app, ">|", PLAYED_LAST, false, "Last frame. End");
        draw_button(app, "Failed read", PLAYED_NEXT_FAILURE, false,
                    "Next frame in which a read failed. F; Shift+F: the one before");
        draw_button(app, "Eviction", PLAYED_NEXT_LOSS, false,
                    "Next frame in which tiles were evicted that were wanted. E; Shift+E: the one "
                    "before");
        draw_button(app, "Longest", PLAYED_SHOW_LONGEST, false,
                    "The frame with the most time until the next one. L");
    }
    ui_end_panel();
}

static void draw_warnings(const struct view_app *app)
{
    const struct played *p = played_of(app);
    if (p->damaged) {
        ui_text(UI_ORANGE, "the file is damaged behind frame %u", p->frame_count - 1);
        ui_hint("%s", p->message);
    }
    if (p->end.divergedEvent > 0) {
        ui_text(UI_ORANGE, "decisions differ from the recorded ones");
        ui_hint("From call %llu on. Another version of the library made the recording.",
                (unsigned long long)p->end.divergedEvent);
    }
    if (p->lost_events > 0) {
        ui_text(UI_ORANGE, "%llu events are not shown", (unsigned long long)p->lost_events);
        ui_hint("A call changed more tiles than the list of events keeps.");
    }
}

void panel_played_now(struct view_app *app)
{
    const struct played *p = played_of(app);
    const struct view_facts *f = &app->facts;
    const struct played_frame *frame = &p->frames[p->frame];
    const float scale = ui_scale(), pivot[2] = {1, 0};
    const float placement[4] = {app->width - 12 * scale, 12 * scale, 0, 0};
    char resident[32], memory[32];
    draw_strip(app);
    if (ui_begin_panel("now", NULL, placement, pivot, UI_PANEL_PLAIN | UI_PANEL_FIT)) {
        ui_text(UI_WHITE, "frame %u of 0 to %u", p->frame, p->frame_count - 1);
        ui_text(UI_GRAY, "time stamp %llu", (unsigned long long)frame->time);
        ui_hint("In ticks of the program that was recorded.");
        ui_text(UI_WHITE, "%s in %s of heaps",
                panel_size(f->resident_size, resident, sizeof resident),
                panel_size(f->memory_size, memory, sizeof memory));
        ui_text(UI_GRAY, "%u tiles missing   %u in flight", missing_of(frame),
                f->now.loadsInFlight);
        if (frame->figures[PLAYED_REFUSED] > 0)
            ui_text(UI_ORANGE, "%u heap%s refused", frame->figures[PLAYED_REFUSED],
                    frame->figures[PLAYED_REFUSED] == 1 ? " was" : "s were");
        if (f->now.globalMipBias > 0)
            ui_text(UI_RED, "memory is short: +%.1f level", f->now.globalMipBias / 16.0);
        if (f->now.failedTileCount + f->now.givenUpTileCount > 0)
            ui_text(UI_RED, "%u tile%s failed to load (K)",
                    f->now.failedTileCount + f->now.givenUpTileCount,
                    f->now.failedTileCount + f->now.givenUpTileCount == 1 ? "" : "s");
        draw_warnings(app);
    }
    ui_end_panel();
}

const char *panel_played_line(const struct view_app *app, char *text, size_t size)
{
    const struct played *p = played_of(app);
    const uint32_t *figures = p->frames[p->frame].figures;
    snprintf(text, size, "frame %u  ·  %u tiles missing  ·  %u loaded, %u lost, %u failed",
             p->frame, missing_of(&p->frames[p->frame]), figures[PLAYED_LOADED],
             figures[PLAYED_LOST], figures[PLAYED_FAILED]);
    return text;
}

/* Buckets of 0, 1, 2-3, 4-7, ... frames. */
static void draw_bars(const uint64_t *counts)
{
    uint64_t buckets[12] = {0}, most = 1;
    float r[4];
    for (uint32_t frames = 0; frames <= TILE_LOG_MOST_WAIT; frames++) {
        int bucket = 0;
        while (bucket < 11 && frames >> bucket)
            bucket++;
        buckets[bucket] += counts[frames];
    }
    for (int i = 0; i < 12; i++)
        most = buckets[i] > most ? buckets[i] : most;
    ui_canvas(0, 26 * ui_scale(), r);
    ui_hint("Bars: 0, 1, 2-3, 4-7, ... frames. The longest bar has %llu loads.",
            (unsigned long long)most);
    for (int i = 0; i < 12; i++) {
        const float step = r[2] / 12, left = r[0] + step * (float)i;
        const float high = r[3] * (float)((double)buckets[i] / (double)most);
        ui_fill(left, r[1], step - 2, r[3], UI_COLOR(30, 34, 40, 255));
        ui_fill(left, r[1] + r[3] - high, step - 2, high, UI_COLOR(86, 180, 233, 255));
    }
}

static void draw_stage(const uint64_t *counts, const char *name, const char *hint)
{
    ui_text(UI_WHITE, "%s", name);
    ui_hint("%s", hint);
    ui_same_line(110 * ui_scale());
    ui_text(UI_GRAY, "p50 %u   p99 %u   most %u frames", tile_log_wait_of(counts, 0.5),
            tile_log_wait_of(counts, 0.99), tile_log_wait_of(counts, 1.0));
    draw_bars(counts);
}

void panel_played_latency(const struct view_app *app)
{
    const struct tile_log *log = &app->facts.log;
    ui_text(UI_GRAY, "%llu loads up to this frame, in frames", (unsigned long long)log->loads);
    draw_stage(log->waits, "whole way", "From the request of a tile until it is resident.");
    draw_stage(log->stages->queue, "queue", "From the request until the tile is handed out.");
    draw_stage(log->stages->load, "load",
               "From the hand-out until the answer: read, bind and copy together.");
    ui_paragraph(UI_GRAY, "A recording holds calls of the manager. It does not know when a shader "
                          "wrote the feedback, when a read, a bind or a copy began or ended, nor "
                          "the file: the same panel of the running scene has these.");
}

void panel_played_failures(struct view_app *app)
{
    const struct view_facts *f = &app->facts;
    uint32_t failing = 0;
    for (uint32_t i = 0; i < f->texture_count; i++)
        if (f->textures[i].statistics.failedTotal > 0 && failing++ < MOST_FAILING)
            ui_text(UI_RED, "%s: %u failed so far", stage_texture(app->stage, i)->name,
                    f->textures[i].statistics.failedTotal);
    if (failing > MOST_FAILING)
        ui_text(UI_RED, "and %u textures more", failing - MOST_FAILING);
}

void panel_played_device(const struct view_app *app)
{
    const struct played *p = played_of(app);
    const SluiceTracePlayerState *s = &p->begin;
    char size[32];
    ui_text(UI_WHITE, "%s: %u frames, %llu calls", stage_name(app->stage), p->frame_count,
            (unsigned long long)p->end.eventCount);
    ui_text(UI_GRAY, "recorded by Sluice %u.%u.%u, format %u", s->libraryVersion >> 22,
            s->libraryVersion >> 12 & 1023u, s->libraryVersion & 4095u, s->formatVersion);
    ui_text(UI_GRAY, "heaps of %u tiles, tiles of %u KiB%s", s->heapTileCapacity,
            s->tileSize / 1024, s->alwaysMapPackedTiles ? ", mip tails are always loaded" : "");
    ui_text(p->end.divergedEvent > 0 || p->damaged ? UI_ORANGE : UI_GRAY, "hash %016llx: %s",
            (unsigned long long)p->end.decisionHash,
            p->damaged                 ? "the end is missing"
            : p->end.divergedEvent > 0 ? "decisions differ"
                                       : "all decisions as recorded");
    ui_text(UI_GRAY, "%u checkpoints, %s, every %u frames", p->point_count,
            panel_size(p->point_size, size, sizeof size), p->stride);
    ui_hint(
        "Saved states, from which steps back begin. --json and docs/viewer.md give their cost.");
}

void panel_played_reason(const struct view_app *app)
{
    const SluiceTextureStatistics *s = &app->facts.textures[app->selected].statistics;
    const uint32_t *f = played_of(app)->frames[played_of(app)->frame].figures;
    char text[256];
    const bool good = s->wantedTileCount <= s->residentTileCount && s->requestedTileCount == 0;
    ui_text(UI_GRAY, "Why no finer level?");
    if (good)
        snprintf(text, sizeof text, "Nothing that was wanted is missing.");
    else if (s->requestedTileCount == 0)
        snprintf(text, sizeof text, "%u of %u wanted tiles are resident; %s.", s->residentTileCount,
                 s->wantedTileCount,
                 s->failedTotal > 0 ? "reads failed, or others are loading" : "others are loading");
    else
        snprintf(text, sizeof text,
                 "%u of its tiles wait in the queue, of %u in all; %u tiles are loading%s.",
                 s->requestedTileCount, f[PLAYED_REQUESTED], f[PLAYED_LOADING],
                 f[PLAYED_FREE_SLOTS] == 0 ? ", and no slot is free" : "");
    ui_paragraph(good ? UI_WHITE : UI_ORANGE, text);
}
