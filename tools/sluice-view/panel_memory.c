#include "panels.h"

#include <stdio.h>

static const struct {
    SluiceTileState state;
    uint32_t color;
    const char *name;
} states[] = {{SLUICE_TILE_STATE_MAPPED, UI_COLOR(86, 180, 233, 255), "resident"},
              {SLUICE_TILE_STATE_STANDBY, UI_COLOR(0, 120, 90, 255), "standby"},
              {SLUICE_TILE_STATE_ALLOCATED, UI_COLOR(240, 228, 66, 255), "loading"},
              {SLUICE_TILE_STATE_CANCELED, UI_COLOR(204, 121, 167, 255), "canceled"}};

#define STATE_COUNT (sizeof states / sizeof *states)

static SluiceStreamedTextureManager *manager_of(const struct view_app *app)
{
    SluiceStreamedTextureManager *manager = NULL;
    sluiceGetVulkanStreamerManager(stage_streamer(app->stage), &manager);
    return manager;
}

static uint32_t index_of(const struct view_app *app, SluiceTextureId id)
{
    for (uint32_t i = 0; i < app->facts.texture_count; i++)
        if (stage_texture(app->stage, i)->id == id)
            return i;
    return STAGE_NO_TEXTURE;
}

static void draw_hover(struct view_app *app, const SluiceTile *tile, SluiceTileState state,
                       uint32_t slot)
{
    char text[256];
    const uint32_t index = index_of(app, tile->textureId);
    if (index == STAGE_NO_TEXTURE)
        return;
    snprintf(text, sizeof text, "%s: level %u, tile %u, %u\nslot %u, %s",
             stage_texture(app->stage, index)->name, tile->mipLevel, tile->x, tile->y, slot,
             state == SLUICE_TILE_STATE_STANDBY ? "standby" : "resident");
    ui_show_hint(text);
    if (ui_mouse_clicked(0))
        app->selected = index;
}

static uint32_t color_of(SluiceTileState state)
{
    for (size_t i = 0; i < STATE_COUNT; i++)
        if (states[i].state == state)
            return states[i].color;
    return UI_GRAY;
}

/* Returns whether the heap exists. */
static bool draw_heap(struct view_app *app, uint32_t heap, uint32_t columns, float cell)
{
    float r[4], x, y;
    SluiceTile tile;
    const SluiceStreamedTextureManager *manager = manager_of(app);
    if (sluiceGetSlotTile(manager, heap, 0, &tile) != SLUICE_SUCCESS)
        return false;
    const uint32_t slots = STAGE_HEAP_TILES, rows = (slots + columns - 1) / columns;
    ui_canvas((float)columns * cell, (float)rows * cell + 6 * ui_scale(), r);
    const bool hovered = ui_hovered();
    ui_mouse(&x, &y);
    ui_fill(r[0], r[1], (float)columns * cell, (float)rows * cell, UI_COLOR(30, 34, 40, 255));
    for (uint32_t slot = 0; slot < slots; slot++) {
        SluiceTileState state = SLUICE_TILE_STATE_FREE;
        const float left = r[0] + (float)(slot % columns) * cell;
        const float top = r[1] + (float)(slot / columns) * cell;
        if (sluiceGetSlotTile(manager, heap, slot, &tile) != SLUICE_SUCCESS ||
            tile.textureId == SLUICE_NO_TEXTURE ||
            sluiceGetTileState(manager, tile.textureId, tile.tileIndex, &state, NULL) !=
                SLUICE_SUCCESS)
            continue;
        ui_fill(left, top, cell - 1, cell - 1, color_of(state));
        if (app->selected != STAGE_NO_TEXTURE && index_of(app, tile.textureId) == app->selected)
            ui_frame(left, top, cell - 1, cell - 1, UI_WHITE);
        if (hovered && x >= left && x < left + cell && y >= top && y < top + cell)
            draw_hover(app, &tile, state, slot);
    }
    return true;
}

static void draw_sums(struct view_app *app)
{
    const struct view_facts *f = &app->facts;
    char resident[32], standby[32], device[32], tails[32];
    ui_text(UI_WHITE, "%s resident, of it %s standby: %.1f %% of all",
            panel_size(f->resident_size, resident, sizeof resident),
            panel_size(f->standby_size, standby, sizeof standby),
            f->all_size ? 100.0 * (double)f->resident_size / (double)f->all_size : 0.0);
    ui_text(UI_GRAY, "%s of device memory for tiles, in %u heaps",
            panel_size(f->memory_size, device, sizeof device), f->now.heapCount);
    ui_text(f->budget && f->tails_size > f->budget ? UI_ORANGE : UI_GRAY,
            "%s of mip tails, which no budget evicts",
            panel_size(f->tails_size, tails, sizeof tails));
    ui_hint("Each texture keeps the tiles of its coarsest levels (its mip tail), so that there is "
            "always something to show. Heaps with such tiles stay, too.");
    for (size_t i = 0; i < STATE_COUNT; i++) {
        float r[4];
        ui_canvas(14 * ui_scale(), 14 * ui_scale(), r);
        ui_fill(r[0], r[1] + 2 * ui_scale(), r[2], r[3], states[i].color);
        ui_same_line(0);
        ui_text(UI_GRAY, "%s", states[i].name);
        if (i + 1 < STATE_COUNT)
            ui_same_line(0);
    }
}

static void draw_buttons(struct view_app *app)
{
    uint32_t moved = 0;
    if (ui_button("Compact", 0, 0, false)) {
        sluiceCompactVulkanStreamer(stage_streamer(app->stage), 64, &moved);
        app_say(app, "Moved %u tiles", moved);
    }
    ui_hint("Moves at most 64 tiles together, so that heaps become empty and are freed.");
    ui_same_line(0);
    if (ui_button("Trim standby", 0, 0, false))
        sluiceTrimStandbyTiles(manager_of(app), 0);
    ui_hint("Evicts all tiles that nothing requests.");
}

void panel_memory(struct view_app *app)
{
    if (!app->open[PANEL_MEMORY])
        return;
    if (panel_begin(app, PANEL_MEMORY, "Memory (M)", 440, 420)) {
        const float cell = 12 * ui_scale();
        draw_sums(app);
        draw_buttons(app);
        for (uint32_t heap = 0, drawn = 0; heap < 4096 && drawn < app->facts.now.heapCount; heap++)
            drawn += draw_heap(app, heap, 32, cell);
    }
    ui_end_panel();
}
