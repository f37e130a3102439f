#include "inspector_parts.h"

#include "memory_map.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define MAP_WIDTH 82.0f
#define MOST_SQUARES 64u /* along a side; of more tiles, some are shown */

static uint32_t larger(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

/* Holes are dark. */
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

/* `r`: of the level; `over`: the mouse is over the canvas. */
static void draw_level(struct view_app *app, uint32_t texture,
                       const SluiceStreamedTextureLayout *layout, uint32_t level, const float r[4],
                       bool over)
{
    float x, y;
    const uint32_t columns = layout->levelWidthInTiles[level];
    const uint32_t rows = layout->levelHeightInTiles[level];
    const uint32_t step = 1 + (larger(columns, rows) - 1) / MOST_SQUARES;
    const float width = r[2] / (float)columns, height = r[3] / (float)rows;
    const float gap = width * (float)step >= 4 ? 1 : 0;
    ui_mouse(&x, &y);
    for (uint32_t row = 0; row < rows; row += step)
        for (uint32_t column = 0; column < columns; column += step) {
            const uint32_t index = layout->levelFirstTile[level] + row * columns + column;
            const float left = r[0] + (float)column * width, top = r[1] + (float)row * height;
            const float wide = fmaxf(width * (float)step, 1), high = fmaxf(height * (float)step, 1);
            SluiceTileState state = SLUICE_TILE_STATE_FREE;
            SluiceTile tile = {0};
            if (sluiceGetTileState(stage_manager(app->stage),
                                   stage_texture(app->stage, texture)->id, index, &state,
                                   &tile) != SLUICE_SUCCESS)
                continue;
            ui_fill(left, top, fmaxf(wide - gap, 1), fmaxf(high - gap, 1), color_of(state));
            if (over && x >= left && x < left + wide && y >= top && y < top + high)
                hover_tile(app, texture, &tile, state);
        }
}

/* Level 0 to the left, the others in half the size each beside it, as mip chains are drawn. */
void inspector_draw_levels(struct view_app *app, uint32_t texture)
{
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    if (sluiceGetTextureLayout(stage_manager(app->stage), stage_texture(app->stage, texture)->id,
                               &layout) != SLUICE_SUCCESS ||
        layout.desc.regularMipCount == 0)
        return;
    const uint32_t columns = layout.levelWidthInTiles[0], rows = layout.levelHeightInTiles[0];
    const float side = 220 * ui_scale() / (float)larger(columns, rows);
    float r[4], level_r[4] = {0, 0, side * (float)columns, side * (float)rows};
    ui_text(UI_GRAY, "Its levels, a square per tile; dark: not in memory");
    const float gap = 4 * ui_scale();
    ui_canvas(1.5f * level_r[2] + gap, level_r[3] + gap * (float)layout.desc.regularMipCount, r);
    const bool over = ui_hovered();
    level_r[0] = r[0];
    level_r[1] = r[1];
    for (uint32_t level = 0; level < layout.desc.regularMipCount; level++) {
        draw_level(app, texture, &layout, level, level_r, over);
        if (level == 0)
            level_r[0] += level_r[2] + gap;
        else
            level_r[1] += level_r[3] + gap;
        level_r[2] /= 2;
        level_r[3] /= 2;
    }
}

enum map_kind { MAP_RESIDENT, MAP_WANTED, MAP_MISSING, MAP_LOADS, MAP_COUNT };

static const struct {
    const char *title, *hint;
} map_words[MAP_COUNT] = {
    {"resident", "A square per tile of level 0: the finest level that is resident. Red: level 0."},
    {"wanted", "A square per tile of level 0: the finest level that feedback requests, as the "
               "manager remembers it. Dark: none."},
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
    default:
        return level == SLUICE_MIP_UNTOUCHED ? UI_COLOR(30, 34, 40, 255) : panel_level_color(level);
    }
}

static void draw_map(const struct view_app *app, SluiceTextureId id,
                     const SluiceStreamedTextureLayout *layout, enum map_kind kind,
                     const uint8_t *resident, const uint8_t *wanted)
{
    float r[4];
    const uint32_t columns = layout->minMipWidth, rows = layout->minMipHeight;
    const uint32_t step = 1 + (larger(columns, rows) - 1) / MOST_SQUARES;
    const float width = MAP_WIDTH * ui_scale(), cell = width / (float)larger(columns, rows);
    ui_canvas(width, (float)rows * cell + ui_line_height(), r);
    ui_hint("%s", map_words[kind].hint);
    ui_label(r[0], r[1], UI_GRAY, map_words[kind].title);
    for (uint32_t y = 0; y < rows; y += step)
        for (uint32_t x = 0; x < columns; x += step) {
            const size_t at = (size_t)y * columns + x;
            ui_fill(r[0] + (float)x * cell, r[1] + ui_line_height() + (float)y * cell,
                    cell * (float)step, cell * (float)step,
                    map_color(app, id, layout, kind, resident[at], wanted[at], x, y));
        }
}

void inspector_draw_maps(const struct view_app *app, uint32_t texture)
{
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    const SluiceTextureId id = stage_texture(app->stage, texture)->id;
    if (sluiceGetTextureLayout(stage_manager(app->stage), id, &layout) != SLUICE_SUCCESS)
        return;
    const size_t size = (size_t)layout.minMipWidth * layout.minMipHeight;
    uint8_t *maps = malloc(2 * size);
    if (maps &&
        sluiceWriteMinMipData(stage_manager(app->stage), id, layout.minMipWidth, size, maps) ==
            SLUICE_SUCCESS &&
        sluiceWriteRequestedLevels(stage_manager(app->stage), id, layout.minMipWidth, size,
                                   maps + size) == SLUICE_SUCCESS)
        for (int kind = 0; kind < MAP_COUNT; kind++) {
            if (kind > 0)
                ui_same_line(0);
            draw_map(app, id, &layout, (enum map_kind)kind, maps, maps + size);
        }
    free(maps);
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
