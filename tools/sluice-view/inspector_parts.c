#include "inspector_parts.h"

#include "memory_map.h"

#include <math.h>
#include <stdio.h>

#define MAP_WIDTH 82.0f
#define MOST_SQUARES 64u /* squares per side; with more tiles only some are shown */

static uint32_t larger(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

/* Returns the color of a state. Missing tiles are dark. */
static uint32_t color_of(SluiceTileState state)
{
    switch (state) {
    case SLUICE_TILE_STATE_FREE: return UI_COLOR(30, 34, 40, 255);
    case SLUICE_TILE_STATE_REQUESTED: return UI_COLOR(120, 110, 40, 255);
    case SLUICE_TILE_STATE_FAILED:
    case SLUICE_TILE_STATE_GIVEN_UP: return UI_COLOR(213, 94, 0, 255);
    default: return memory_state_color(state);
    }
}

static const char *const state_words[] = {"not in memory", "requested", "loading", "resident",
                                          "standby",       "canceled",  "failed",  "given up"};

static void describe_tile(const struct view_app *app, const SluiceTile *tile, SluiceTileState state,
                          char *text, size_t size)
{
    const struct tile_log_tile *log =
        tile_log_get(&app->facts.log, tile->textureId, tile->tileIndex);
    const bool has_slot =
        state >= SLUICE_TILE_STATE_ALLOCATED && state <= SLUICE_TILE_STATE_CANCELED;
    int length = snprintf(text, size, "Level %u, tile %u, %u: %s", tile->mipLevel, tile->x, tile->y,
                          state_words[state]);
    if (has_slot)
        length += snprintf(text + length, size - (size_t)length, "\nheap %u, slot %u", tile->heapId,
                           tile->slot);
    if (log && log->loads > 0)
        length +=
            snprintf(text + length, size - (size_t)length, "\nloaded %u time%s, last %.1f s ago",
                     log->loads, log->loads == 1 ? "" : "s",
                     (double)(stage_now(app->stage) - log->loaded_time) / STAGE_TICKS_PER_SECOND);
    if (log && log->failures > 0)
        snprintf(text + length, size - (size_t)length, "\nfailed %u time%s", log->failures,
                 log->failures == 1 ? "" : "s");
}

static void hover_tile(struct view_app *app, uint32_t texture, const SluiceTile *tile,
                       SluiceTileState state)
{
    char text[256];
    describe_tile(app, tile, state, text, sizeof text);
    ui_show_hint(text);
    if (ui_double_clicked() && !stage_played(app->stage))
        app_look_at_tile(app, texture, tile);
}

/* A run of adjacent squares of one color, drawn as one rectangle. */
struct run {
    float left, top, right, bottom;
    uint32_t color;
};

static void end_run(struct run *run)
{
    if (run->right > run->left)
        ui_fill(run->left, run->top, run->right - run->left, run->bottom - run->top, run->color);
    run->right = run->left;
}

static void add_square(struct run *run, const float r[4], float gap, uint32_t color)
{
    if (gap > 0) {
        ui_fill(r[0], r[1], fmaxf(r[2] - gap, 1), fmaxf(r[3] - gap, 1), color);
        return;
    }
    if (run->right > run->left && (run->color != color || run->top != r[1]))
        end_run(run);
    if (!(run->right > run->left))
        *run = (struct run){r[0], r[1], r[0], r[1] + r[3], color};
    run->right = r[0] + r[2];
}

/* Shows the tile under the mouse, with its present state. */
static void hover_level(struct view_app *app, uint32_t texture,
                        const SluiceStreamedTextureLayout *layout, uint32_t level, float column,
                        float row)
{
    SluiceTileState state = SLUICE_TILE_STATE_FREE;
    SluiceTile tile = {0};
    const uint32_t columns = layout->levelWidthInTiles[level];
    if (!(column >= 0 && row >= 0) || column >= (float)columns ||
        row >= (float)layout->levelHeightInTiles[level])
        return;
    const uint32_t index =
        layout->levelFirstTile[level] + (uint32_t)row * columns + (uint32_t)column;
    if (sluiceGetTileState(stage_manager(app->stage), stage_texture(app->stage, texture)->id, index,
                           &state, &tile) == SLUICE_SUCCESS)
        hover_tile(app, texture, &tile, state);
}

/* Draws a level into rectangle `r`. `over`: the mouse is over the canvas. */
static void draw_level(struct view_app *app, uint32_t texture, uint32_t level, const float r[4],
                       bool over)
{
    float x, y;
    const SluiceStreamedTextureLayout *layout = &app->maps.layout;
    const uint32_t columns = layout->levelWidthInTiles[level];
    const uint32_t rows = layout->levelHeightInTiles[level];
    const uint32_t step = 1 + (larger(columns, rows) - 1) / MOST_SQUARES;
    const float width = r[2] / (float)columns, height = r[3] / (float)rows;
    const float gap = width * (float)step >= 4 ? 1 : 0;
    struct run run = {0};
    for (uint32_t row = 0; row < rows; row += step)
        for (uint32_t column = 0; column < columns; column += step) {
            const uint32_t index = layout->levelFirstTile[level] + row * columns + column;
            const float square[4] = {r[0] + (float)column * width, r[1] + (float)row * height,
                                     fmaxf(width * (float)step, 1), fmaxf(height * (float)step, 1)};
            add_square(&run, square, gap, color_of((SluiceTileState)app->maps.states[index]));
        }
    end_run(&run);
    ui_mouse(&x, &y);
    if (over)
        hover_level(app, texture, layout, level, (x - r[0]) / width, (y - r[1]) / height);
}

/* Level 0 is on the left. Each following level has half the size. */
void inspector_draw_levels(struct view_app *app, uint32_t texture)
{
    if (!inspector_maps_update(&app->maps, app->stage, texture, app->seconds) ||
        app->maps.layout.desc.regularMipCount == 0)
        return;
    const SluiceStreamedTextureLayout *layout = &app->maps.layout;
    const uint32_t columns = layout->levelWidthInTiles[0], rows = layout->levelHeightInTiles[0];
    const float side = 220 * ui_scale() / (float)larger(columns, rows);
    float r[4], level_r[4] = {0, 0, side * (float)columns, side * (float)rows};
    ui_text(UI_GRAY, "Its levels, a square per tile; dark: not in memory");
    const float gap = 4 * ui_scale();
    ui_canvas(1.5f * level_r[2] + gap, level_r[3] + gap * (float)layout->desc.regularMipCount, r);
    const bool over = ui_hovered();
    level_r[0] = r[0];
    level_r[1] = r[1];
    for (uint32_t level = 0; level < layout->desc.regularMipCount; level++) {
        draw_level(app, texture, level, level_r, over);
        if (level == 0)
            level_r[0] += level_r[2] + gap;
        else
            level_r[1] += level_r[3] + gap;
        level_r[2] /= 2;
        level_r[3] /= 2;
    }
}

/* Maps, four per row. */
enum map_kind { MAP_FEEDBACK, MAP_WANTED, MAP_RESIDENT, MAP_MISSING, MAP_LOADS, MAP_COUNT };

static const struct {
    const char *title, *hint;
} map_words[MAP_COUNT] = {
    {"feedback", "A square per region of feedback: the finest level that shaders marked there, as "
                 "it was read back last. Red: level 0; dark: no mark. In turns of textures, so it "
                 "flickers where few pixels write."},
    {"wanted", "A square per tile of level 0: the finest level that feedback requests, as the "
               "manager remembers it. Dark: none."},
    {"resident", "A square per tile of level 0: the finest level that is resident (MinMip map). "
                 "Red: level 0."},
    {"missing", "Levels that are requested and not resident. Yellow: 1; orange: 2; red: 3 or more. "
                "Dark: nothing is missing."},
    {"loads", "How often the resident tile there was loaded. Dark: never; blue: once; yellow: "
              "twice; orange: more often."}};

static uint32_t missing_color(uint32_t missing)
{
    return missing == 0   ? UI_COLOR(30, 34, 40, 255)
           : missing == 1 ? UI_COLOR(240, 228, 66, 255)
           : missing == 2 ? UI_COLOR(230, 159, 0, 255)
                          : UI_COLOR(213, 94, 0, 255);
}

static uint32_t loads_color(uint32_t loads)
{
    return loads == 0   ? UI_COLOR(30, 34, 40, 255)
           : loads == 1 ? UI_COLOR(0, 114, 178, 255)
           : loads == 2 ? UI_COLOR(240, 228, 66, 255)
                        : UI_COLOR(213, 94, 0, 255);
}

static uint32_t loads_at(const struct view_app *app, SluiceTextureId id,
                         const SluiceStreamedTextureLayout *layout, uint32_t x, uint32_t y,
                         uint32_t level)
{
    uint32_t index = layout->regularTileCount;
    if (level < layout->desc.regularMipCount) {
        const uint32_t width = layout->levelWidthInTiles[level];
        const uint32_t height = layout->levelHeightInTiles[level];
        const uint32_t column = x >> level < width ? x >> level : width - 1;
        const uint32_t row = y >> level < height ? y >> level : height - 1;
        index = layout->levelFirstTile[level] + row * width + column;
    }
    const struct tile_log_tile *log = tile_log_get(&app->facts.log, id, index);
    return log ? log->loads : 0;
}

static uint32_t level_color(uint8_t level)
{
    return level == SLUICE_MIP_UNTOUCHED ? UI_COLOR(30, 34, 40, 255) : panel_level_color(level);
}

static uint32_t map_color(const struct view_app *app, SluiceTextureId id,
                          const SluiceStreamedTextureLayout *layout, enum map_kind kind,
                          uint8_t resident, uint8_t wanted, uint32_t x, uint32_t y)
{
    const uint8_t level = kind == MAP_RESIDENT ? resident : wanted;
    switch (kind) {
    case MAP_MISSING:
        return missing_color(wanted != SLUICE_MIP_UNTOUCHED && resident > wanted
                                 ? (uint32_t)(resident - wanted)
                                 : 0u);
    case MAP_LOADS:
        return loads_color(
            resident == SLUICE_MIP_UNTOUCHED ? 0 : loads_at(app, id, layout, x, y, resident));
    default: return level_color(level);
    }
}

static void draw_map(const struct view_app *app, enum map_kind kind)
{
    float r[4];
    const struct inspector_maps *m = &app->maps;
    const bool marks = kind == MAP_FEEDBACK;
    const uint32_t columns = marks ? m->feedback_layout.feedbackWidth : m->layout.minMipWidth;
    const uint32_t rows = marks ? m->feedback_layout.feedbackHeight : m->layout.minMipHeight;
    const uint32_t step = 1 + (larger(columns, rows) - 1) / MOST_SQUARES;
    const float width = MAP_WIDTH * ui_scale(), cell = width / (float)larger(columns, rows);
    struct run run = {0};
    ui_canvas(width, (float)rows * cell + ui_line_height(), r);
    ui_hint("%s", map_words[kind].hint);
    ui_label(r[0], r[1], UI_GRAY, map_words[kind].title);
    for (uint32_t y = 0; y < rows; y += step)
        for (uint32_t x = 0; x < columns; x += step) {
            const size_t at = (size_t)y * columns + x;
            const float square[4] = {r[0] + (float)x * cell,
                                     r[1] + ui_line_height() + (float)y * cell, cell * (float)step,
                                     cell * (float)step};
            add_square(&run, square, 0,
                       marks ? level_color(m->feedback[at])
                             : map_color(app, m->id, &m->layout, kind, m->resident[at],
                                         m->requested[at], x, y));
        }
    end_run(&run);
}

void inspector_draw_maps(struct view_app *app, uint32_t texture)
{
    if (!inspector_maps_update(&app->maps, app->stage, texture, app->seconds))
        return;
    for (int kind = app->maps.feedback_known ? MAP_FEEDBACK : MAP_WANTED; kind < MAP_COUNT;
         kind++) {
        draw_map(app, (enum map_kind)kind);
        if (kind != MAP_MISSING && kind + 1 < MAP_COUNT)
            ui_same_line(0);
    }
}

void inspector_draw_tile(const struct view_app *app, uint32_t texture)
{
    struct view_probe probe = app->probe;
    char text[256];
    const bool under_mouse = probe.known && probe.texture == texture;
    if (!under_mouse && app->inspect.hit && app->inspect.texture == texture)
        probe_point(app->stage, &app->facts, &app->inspect, &probe);
    if (!probe.known || probe.texture != texture)
        return;
    describe_tile(app, &probe.tile, probe.state, text, sizeof text);
    ui_text(UI_WHITE, "%s: texel %u, %u", under_mouse ? "Under the mouse" : "Here", probe.texel[0],
            probe.texel[1]);
    ui_paragraph(UI_GRAY, text);
}
