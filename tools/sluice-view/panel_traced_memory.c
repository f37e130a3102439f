/* Memory of a scene that is traced: figures, and a map of the slots of its demand loader. */
#include "panel_traced.h"

#include "memory_map.h"
#include "traced.h"

#include <stdio.h>

#define COLUMNS 32u

static SluiceTileState state_of(const SluiceDemandSlot *slot)
{
    switch (slot->state) {
    case SLUICE_DEMAND_SLOT_RESIDENT: return SLUICE_TILE_STATE_MAPPED;
    case SLUICE_DEMAND_SLOT_STANDBY: return SLUICE_TILE_STATE_STANDBY;
    default: return SLUICE_TILE_STATE_ALLOCATED;
    }
}

static double age_of(const struct traced *t, const SluiceDemandSlot *slot)
{
    const struct traced_tile *tile = traced_tiles_find(&t->tiles, slot->page);
    return tile && tile->loads > 0 ? (double)(t->time - tile->loaded[0]) / STAGE_TICKS_PER_SECOND
                                   : -1.0;
}

static uint32_t color_of(const struct view_app *app, const struct traced *t,
                         const SluiceDemandSlot *slot)
{
    const uint32_t picture = traced_picture_of(t, (uint32_t)slot->textureId);
    switch (app->settings.memory_colors) {
    case MEMORY_BY_TEXTURE:
        return picture < t->picture_count ? memory_texture_color(app->stage, picture) : UI_GRAY;
    case MEMORY_BY_LEVEL: return panel_level_color(slot->level);
    case MEMORY_BY_AGE: return memory_age_color(age_of(t, slot));
    default: return memory_state_color(state_of(slot));
    }
}

static void draw_hover(struct view_app *app, const struct traced *t, const SluiceDemandSlot *slot)
{
    static const char *const states[] = {"loading", "resident", "standby"};
    const struct traced_tile *tile = traced_tiles_find(&t->tiles, slot->page);
    const uint32_t picture = traced_picture_of(t, (uint32_t)slot->textureId);
    char text[320], place[48] = "mip tail", age[64] = "";
    if (!slot->isTail)
        snprintf(place, sizeof place, "tile %u, %u", slot->x, slot->y);
    if (tile && tile->loads > 0)
        snprintf(age, sizeof age, "\nloaded %.1f s ago, %u load%s", age_of(t, slot), tile->loads,
                 tile->loads == 1 ? "" : "s");
    snprintf(text, sizeof text, "%.120s: level %u, %s\nimage %u, layer %u: %s%s\nClick: inspect",
             picture < t->picture_count ? t->pictures[picture].texture.name : "a texture",
             slot->level, place, slot->image, slot->layer, states[slot->state], age);
    ui_show_hint(text);
    if (ui_mouse_clicked(0) && picture < t->picture_count)
        app->selected = picture;
}

static void draw_image(struct view_app *app, const struct traced *t, uint32_t image, float cell)
{
    const uint32_t slots = t->tiles.images[image].slotCount;
    const uint32_t rows = (slots + COLUMNS - 1) / COLUMNS;
    float r[4], x, y;
    ui_canvas((float)COLUMNS * cell, (float)rows * cell + 6 * ui_scale(), r);
    const bool hovered = ui_hovered();
    if (r[1] > app->height || r[1] + r[3] < 0) /* scrolled away */
        return;
    ui_mouse(&x, &y);
    for (uint32_t i = 0; i < slots; i++) {
        const float left = r[0] + (float)(i % COLUMNS) * cell;
        const float top = r[1] + (float)(i / COLUMNS) * cell;
        const SluiceDemandSlot *slot = traced_tiles_at(&t->tiles, image, i);
        if (top > app->height || top + cell < 0)
            continue;
        ui_fill(left, top, cell - 1, cell - 1,
                slot ? color_of(app, t, slot) : UI_COLOR(30, 34, 40, 255));
        if (!slot)
            continue;
        if (app->selected < t->picture_count &&
            traced_picture_of(t, (uint32_t)slot->textureId) == app->selected)
            ui_frame(left, top, cell - 1, cell - 1, UI_WHITE);
        if (hovered && x >= left && x < left + cell && y >= top && y < top + cell)
            draw_hover(app, t, slot);
    }
}

static void draw_map(struct view_app *app, const struct traced *t)
{
    const float cell = 12 * ui_scale();
    if (t->tiles.is_cut)
        ui_text(UI_GRAY, "the first %u tiles are shown", TRACED_TILE_MOST);
    for (uint32_t i = 0; i < t->tiles.image_count; i++)
        draw_image(app, t, i, cell);
}

static void draw_size(const char *name, uint64_t bytes)
{
    char size[32];
    ui_text(UI_GRAY, "%s", name);
    ui_same_line(220 * ui_scale());
    ui_text(UI_WHITE, "%s", panel_size(bytes, size, sizeof size));
}

void panel_traced_memory(struct view_app *app)
{
    const struct traced *t = stage_traced(app->stage);
    const SluiceDemandStatistics *d = &t->now;
    const struct traced_tile_sums sums = traced_tiles_sums(&t->tiles);
    ui_text(UI_WHITE, "%llu tile%s and mip tails are resident, in %u image%s",
            (unsigned long long)d->residentTileCount, d->residentTileCount == 1 ? "" : "s",
            d->pageChunkCount, d->pageChunkCount == 1 ? "" : "s");
    if (d->lodBias > 0)
        ui_text(UI_RED, "memory is short: +%.1f level", (double)d->lodBias);
    draw_size("tiles, on the device", d->tileMemorySize);
    draw_size("loader in all, on the device", d->deviceMemorySize);
    draw_size("loader, mapped memory", d->hostVisibleMemorySize);
    draw_size("meshes, trees, materials", traced_geometry_size(t));
    ui_text(UI_GRAY, "%llu of %llu shapes are built, %u boxes stand for others",
            (unsigned long long)t->world.entered_count,
            (unsigned long long)t->pbrt->scene.place_count, proxies_box_count(&t->proxies));
    ui_hint("A shape is built when a ray enters its box.");
    ui_text(UI_GRAY, "%llu tiles were evicted, %llu came back without a read",
            (unsigned long long)d->evictedCount, (unsigned long long)d->restoredCount);
    if (sums.slots > 0) {
        ui_text(sums.fragmentation > 0.25 ? UI_ORANGE : UI_GRAY,
                "%u image%s, %u of %u slots used, %u stand by: fragmentation %.0f %%",
                t->tiles.image_count, t->tiles.image_count == 1 ? "" : "s", sums.used, sums.slots,
                sums.standby, 100.0 * sums.fragmentation);
        ui_hint("Part of the slots in images that would be empty if tiles moved together. Demand "
                "loaders move no tiles: short of memory, they evict the tiles of an image.");
    }
    panel_memory_colors(app);
    draw_map(app, t);
}
