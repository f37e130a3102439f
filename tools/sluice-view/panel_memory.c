#include "panels.h"

#include "memory_map.h"
#include "panel_traced.h"

#include <stdio.h>

#define COLUMNS 32u

static const char *state_name(SluiceTileState state)
{
    switch (state) {
    case SLUICE_TILE_STATE_MAPPED: return "resident";
    case SLUICE_TILE_STATE_STANDBY: return "standby";
    case SLUICE_TILE_STATE_ALLOCATED: return "loading";
    case SLUICE_TILE_STATE_CANCELED: return "canceled";
    default: return "retiring";
    }
}

static void draw_hover(struct view_app *app, const struct memory_slot *slot)
{
    const SluiceTile *tile = &slot->tile;
    char text[320], age[48] = "";
    if (slot->age >= 0)
        snprintf(age, sizeof age, "\nloaded %.1f s ago, %u load%s", slot->age, slot->loads,
                 slot->loads == 1 ? "" : "s");
    snprintf(text, sizeof text,
             "%.120s: level %u, tile %u, %u\nheap %u, slot %u: %s%s\nClick: inspect%s",
             stage_texture(app->stage, slot->texture)->name, tile->mipLevel, tile->x, tile->y,
             tile->heapId, tile->slot, state_name(slot->state), age,
             stage_played(app->stage) ? "" : "; double click: look at it");
    ui_show_hint(text);
    if (ui_double_clicked() && !stage_played(app->stage))
        app_look_at_tile(app, slot->texture, tile);
    else if (ui_mouse_clicked(0))
        app->selected = slot->texture;
}

static void draw_slots(const struct view_app *app, const struct memory_shown *slots,
                       const float r[4], float cell)
{
    for (uint32_t i = 0; i < stage_heap_tiles(app->stage); i++) {
        const float left = r[0] + (float)(i % COLUMNS) * cell;
        const float top = r[1] + (float)(i / COLUMNS) * cell;
        if (slots[i].color == 0)
            continue;
        ui_fill(left, top, cell - 1, cell - 1, slots[i].color);
        if (slots[i].texture == app->selected)
            ui_frame(left, top, cell - 1, cell - 1, UI_WHITE);
    }
}

static void hover_heap(struct view_app *app, uint32_t heap, const float r[4], float cell)
{
    float x, y;
    struct memory_slot slot;
    ui_mouse(&x, &y);
    const uint32_t column = (uint32_t)((x - r[0]) / cell), row = (uint32_t)((y - r[1]) / cell);
    const uint32_t index = row * COLUMNS + column;
    if (column < COLUMNS && index < stage_heap_tiles(app->stage) &&
        memory_slot_get(app->stage, &app->facts, heap, index, &slot))
        draw_hover(app, &slot);
}

/* Draws a heap. False if it does not exist. */
static bool draw_heap(struct view_app *app, uint32_t heap, float cell)
{
    float r[4];
    SluiceTile tile;
    if (sluiceGetSlotTile(stage_manager(app->stage), heap, 0, &tile) != SLUICE_SUCCESS)
        return false;
    const uint32_t rows = (stage_heap_tiles(app->stage) + COLUMNS - 1) / COLUMNS;
    const float height = (float)rows * cell + 6 * ui_scale();
    const bool shown = ui_in_sight(height);
    ui_canvas((float)COLUMNS * cell, height, r);
    if (!shown)
        return true;
    const bool hovered = ui_hovered();
    const struct memory_shown *slots =
        memory_map_heap(&app->memory, app->stage, &app->facts, heap,
                        (enum memory_colors)app->settings.memory_colors, app->seconds);
    ui_fill(r[0], r[1], (float)COLUMNS * cell, (float)rows * cell, UI_COLOR(30, 34, 40, 255));
    if (slots)
        draw_slots(app, slots, r, cell);
    if (hovered)
        hover_heap(app, heap, r, cell);
    return true;
}

static void draw_sums(struct view_app *app)
{
    const struct view_facts *f = &app->facts;
    const struct memory_sums sums = memory_sums_of(app->stage);
    char resident[32], standby[32], device[32], tails[32];
    ui_text(UI_WHITE, "%s resident (%.1f %%), %s standby",
            panel_size(f->resident_size, resident, sizeof resident),
            f->all_size ? 100.0 * (double)f->resident_size / (double)f->all_size : 0.0,
            panel_size(f->standby_size, standby, sizeof standby));
    ui_hint("Tiles in memory, as size and as part of all textures with all levels. Standby tiles "
            "are resident and no longer requested; they are evicted first.");
    ui_text(UI_GRAY, "%s of device memory for tiles",
            panel_size(f->memory_size, device, sizeof device));
    if (sums.heaps > 0) {
        ui_text(sums.fragmentation > 0.25 ? UI_ORANGE : UI_GRAY,
                "%u heaps, %u of %u slots used: fragmentation %.0f %%", sums.heaps, sums.used,
                sums.heaps * stage_heap_tiles(app->stage), 100.0 * sums.fragmentation);
        ui_hint("Part of the heaps that would be empty if tiles moved together: %u of %u. Compact "
                "moves them.",
                sums.spare_heaps, sums.heaps);
    }
    ui_text(f->budget && f->tails_size > f->budget ? UI_ORANGE : UI_GRAY,
            "%s of mip tails, never evicted", panel_size(f->tails_size, tails, sizeof tails));
    ui_hint("Each texture keeps the tiles of its coarsest levels (its mip tail) as "
            "long as memory allows. Heaps with such tiles stay, too.");
}

static void draw_swatch(uint32_t color, const char *words)
{
    float r[4];
    ui_canvas(14 * ui_scale(), 14 * ui_scale(), r);
    ui_fill(r[0], r[1] + 2 * ui_scale(), r[2], r[3], color);
    ui_same_line(0);
    ui_text(UI_GRAY, "%s", words);
}

static void draw_states(void)
{
    static const SluiceTileState states[] = {SLUICE_TILE_STATE_MAPPED, SLUICE_TILE_STATE_STANDBY,
                                             SLUICE_TILE_STATE_ALLOCATED,
                                             SLUICE_TILE_STATE_CANCELED};
    for (int i = 0; i < 4; i++) {
        if (i > 0)
            ui_same_line(0);
        draw_swatch(memory_state_color(states[i]), state_name(states[i]));
    }
}

static void draw_levels(void)
{
    static const char *const words[] = {"0", "1", "2", "3", "4", "5", "6", "7 or coarser"};
    for (uint32_t level = 0; level < 8; level++) {
        if (level > 0)
            ui_same_line(0);
        draw_swatch(panel_level_color(level), words[level]);
    }
}

static void draw_ages(void)
{
    static const struct {
        double seconds;
        const char *words;
    } ages[] = {{0, "0.5 s"}, {1, "2 s"}, {5, "10 s"}, {30, "1 min"}, {100, "longer"}};
    for (int i = 0; i < 5; i++) {
        if (i > 0)
            ui_same_line(0);
        draw_swatch(memory_age_color(ages[i].seconds), ages[i].words);
    }
}

void panel_memory_colors(struct view_app *app)
{
    static const char *const names[] = {"State", "Texture", "Level", "Age"};
    for (int i = 0; i < 4; i++) {
        if (i > 0)
            ui_same_line(0);
        if (ui_button(names[i], 0, 0, app->settings.memory_colors == i))
            app->settings.memory_colors = i;
        ui_hint("Colors of the slots. --memory-colors");
    }
    switch (app->settings.memory_colors) {
    case MEMORY_BY_TEXTURE:
        ui_text(UI_GRAY, "as view 6: a color per texture, a hue per set");
        break;
    case MEMORY_BY_LEVEL: draw_levels(); break;
    case MEMORY_BY_AGE: draw_ages(); break;
    default: draw_states(); break;
    }
}

static void draw_buttons(struct view_app *app)
{
    if (ui_button("Compact (Shift+M)", 0, 0, false))
        memory_compact(app);
    ui_hint("Moves at most 64 tiles together, so that heaps become empty and are freed.");
    ui_same_line(0);
    if (ui_button("Trim standby (Ctrl+M)", 0, 0, false))
        memory_trim(app);
    ui_hint("Evicts all tiles that nothing requests.");
}

static void draw_streamer(struct view_app *app)
{
    const float cell = 12 * ui_scale();
    draw_sums(app);
    if (!stage_played(app->stage))
        draw_buttons(app);
    panel_memory_colors(app);
    for (uint32_t heap = 0, drawn = 0; heap < 4096 && drawn < app->facts.now.heapCount; heap++)
        drawn += draw_heap(app, heap, cell);
}

void panel_memory(struct view_app *app)
{
    if (!app->open[PANEL_MEMORY])
        return;
    if (panel_begin(app, PANEL_MEMORY, "Memory (M)", 440, 460)) {
        if (stage_traced(app->stage))
            panel_traced_memory(app);
        else
            draw_streamer(app);
    }
    ui_end_panel();
}
