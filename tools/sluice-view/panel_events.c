#include "panels.h"

#include "event_rows.h"
#include "panel_played.h"
#include "panel_traced.h"

#include <stdio.h>
#include <string.h>

#define MOST_ROWS 200u
#define MOST_FAILURES 6u
#define MOST_PATH 36u /* bytes of a path that are shown */

static const char *const state_names[] = {"free",    "requested", "loading", "resident",
                                          "standby", "canceled",  "failed",  "given up"};
static const char *const reason_names[] = {"feedback", "added",   "taken up", "prefetched",
                                           "answered", "retried", "evicted",  "unmapped",
                                           "called",   "removed"};
#define REASON_WORDS                                                                               \
    "all reasons|feedback|added|taken up|prefetched|answered|retried|evicted|unmapped|called|"     \
    "removed"

/* Returns the end of a path, which has the name of the file. */
static const char *end_of(const char *path, const char **before)
{
    const size_t length = strlen(path);
    *before = length > MOST_PATH ? "..." : "";
    return length > MOST_PATH ? path + length - MOST_PATH : path;
}

/* Draws source, offset and result of a failed read, and a button to retry. */
static void draw_failure(struct view_app *app, uint32_t texture)
{
    const struct stage_texture *t = stage_texture(app->stage, texture);
    const SluiceTileLoaderStatistics *reads = &app->facts.textures[texture].reads;
    char label[32], where[48] = "";
    const char *before, *path = end_of(t->path[0] ? t->path : t->name, &before);
    snprintf(label, sizeof label, "Retry##%u", texture);
    if (ui_button(label, 0, 0, false))
        sluiceRetryVulkanSource(stage_streamer(app->stage), stage_source(app->stage, texture));
    ui_hint("Reads its failed tiles again at once.");
    ui_same_line(0);
    if (reads->lastFailureOffset != SLUICE_UNKNOWN_OFFSET && reads->failedCount > 0)
        snprintf(where, sizeof where, " at offset 0x%llx",
                 (unsigned long long)reads->lastFailureOffset);
    ui_text(UI_RED, "%s%s: %u failed: %s%s", before, path,
            app->facts.textures[texture].statistics.failedTotal,
            reads->failedCount > 0 ? sluiceGetResultName(reads->lastFailure) : "not read yet",
            where);
    ui_hint("%s", t->path[0] ? t->path : "It is not in a file.");
}

static void draw_failures(struct view_app *app)
{
    const struct view_facts *f = &app->facts;
    uint32_t failing = 0;
    for (uint32_t i = 0; i < f->texture_count; i++)
        if (f->textures[i].statistics.failedTotal > 0 && failing++ < MOST_FAILURES)
            draw_failure(app, i);
    if (failing > MOST_FAILURES)
        ui_text(UI_RED, "and %u textures more", failing - MOST_FAILURES);
    if (f->now.failedTileCount + f->now.givenUpTileCount == 0)
        return;
    if (ui_button("Retry all", 0, 0, false))
        sluiceRetryVulkanSource(stage_streamer(app->stage), NULL);
    ui_hint("Reads all failed tiles of all textures again at once.");
    ui_same_line(0);
    ui_text(UI_RED, "%u tiles have failed, %u of them were given up for now",
            f->now.failedTileCount + f->now.givenUpTileCount, f->now.givenUpTileCount);
}

static void draw_filters(struct view_app *app)
{
    bool selected = app->settings.events_of == VIEW_EVENTS_OF_SELECTED;
    ui_item_width(130 * ui_scale());
    ui_choice("##reason", REASON_WORDS, &app->settings.event_reason);
    ui_hint("Reasons that are listed. --event-reason");
    ui_same_line(0);
    ui_begin_disabled(app->selected >= app->facts.texture_count);
    if (ui_check("selected texture alone", &selected))
        app->settings.events_of = selected ? VIEW_EVENTS_OF_SELECTED : VIEW_EVENTS_OF_ALL;
    ui_end_disabled();
    ui_hint("Click a surface to select its texture. Click the background to list events of all "
            "textures. --events-of");
    ui_same_line(0);
    if (selected && app->selected < app->facts.texture_count)
        ui_text(UI_BLUE, "%s", stage_texture(app->stage, app->selected)->name);
    else
        ui_text(UI_GRAY, "newest first");
}

struct event_list {
    struct view_app *app;
    const SluiceTileEvent *rows[MOST_ROWS];
    float name_width;
};

/* Draws an event. The reason is on the left, so that narrow panels show it. */
static void draw_row(void *user_data, uint32_t row)
{
    const struct event_list *list = user_data;
    struct view_app *app = list->app;
    const SluiceTileEvent *event = list->rows[row];
    char shortened[256];
    SluiceTile tile = {0};
    uint32_t texture = 0;
    tile_log_index(&app->facts.log, event->textureId, &texture);
    sluiceGetTileState(stage_manager(app->stage), event->textureId, event->tileIndex, NULL, &tile);
    const char *name = stage_texture(app->stage, texture)->name;
    const char *from = state_names[event->from], *to = state_names[event->to];
    const char *reason = reason_names[event->reason];
    const bool played = stage_played(app->stage);
    const bool now = played && event->mark == stage_played(app->stage)->frame;
    if (ui_table_row((int)row, false) && played)
        panel_played_jump(app, (uint32_t)event->mark);
    ui_hint("Frame %llu: %.200s\nlevel %u, tile %u, %u: was %s, is %s\nreason: %s%s",
            (unsigned long long)event->mark, name, tile.mipLevel, tile.x, tile.y, from, to, reason,
            played ? "\nClick: go to the frame" : "");
    ui_table_cell(now ? UI_BLUE : UI_WHITE, "%llu", (unsigned long long)event->mark);
    ui_table_cell(UI_WHITE, "%s",
                  panel_shorten(name, list->name_width, shortened, sizeof shortened));
    ui_table_cell(UI_GRAY, "%s", reason);
    ui_table_cell(UI_GRAY, "%s", from);
    ui_table_cell(event->to >= SLUICE_TILE_STATE_FAILED ? UI_RED : UI_WHITE, "%s", to);
    ui_table_cell(UI_WHITE, "%u", tile.mipLevel);
    ui_table_cell(UI_WHITE, "%u, %u", tile.x, tile.y);
}

static void draw_streamer(struct view_app *app)
{
    struct event_list list = {.app = app, .name_width = ui_panel_width() / 4};
    const bool one = app->settings.events_of == VIEW_EVENTS_OF_SELECTED &&
                     app->selected < app->facts.texture_count;
    if (stage_played(app->stage))
        panel_played_failures(app);
    else
        draw_failures(app);
    draw_filters(app);
    const uint32_t count =
        event_rows_find(&app->facts, (uint32_t)app->settings.event_reason,
                        one ? app->selected : STAGE_NO_TEXTURE, list.rows, MOST_ROWS);
    if (!ui_begin_table("events",
                        "Frame=99999|Texture|Reason=prefetched|From=requested|To=requested|Level|"
                        "Tile=99, 99",
                        0, false))
        return;
    ui_table_rows(count, draw_row, &list);
    ui_end_table();
}

void panel_events(struct view_app *app)
{
    if (!app->open[PANEL_EVENTS])
        return;
    if (panel_begin(app, PANEL_EVENTS, "Events (K)", 600, 420)) {
        if (stage_traced(app->stage))
            panel_traced_events(app);
        else
            draw_streamer(app);
    }
    ui_end_panel();
}
