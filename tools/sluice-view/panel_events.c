#include "panels.h"

#include "panel_traced.h"

#include <sluice/version.h>

static const char *const state_names[] = {"free",    "requested", "loading", "resident",
                                          "standby", "canceled",  "failed",  "given up"};
static const char *const reason_names[] = {"feedback", "added",   "taken up", "prefetched",
                                           "answered", "retried", "evicted",  "unmapped",
                                           "called",   "removed"};

static const struct stage_texture *texture_of(const struct view_app *app, SluiceTextureId id,
                                              uint32_t *index)
{
    for (*index = 0; *index < app->facts.texture_count; ++*index)
        if (stage_texture(app->stage, *index)->id == id)
            return stage_texture(app->stage, *index);
    return NULL;
}

static void draw_failures(struct view_app *app)
{
    const struct view_facts *f = &app->facts;
    for (uint32_t i = 0; i < f->texture_count; i++)
        if (f->textures[i].statistics.failedTotal > 0)
            ui_text(UI_RED, "%s: %u loads failed", stage_texture(app->stage, i)->name,
                    f->textures[i].statistics.failedTotal);
    if (f->now.failedTileCount + f->now.givenUpTileCount > 0 && ui_button("Retry", 0, 0, false))
        sluiceRetryVulkanSource(stage_streamer(app->stage), NULL);
}

static void draw_event(struct view_app *app, const SluiceTileEvent *event, const char *name,
                       int row)
{
    SluiceTile tile = {0};
    SluiceStreamedTextureManager *manager = NULL;
    sluiceGetVulkanStreamerManager(stage_streamer(app->stage), &manager);
    sluiceGetTileState(manager, event->textureId, event->tileIndex, NULL, &tile);
    ui_table_row(row, false);
    ui_table_cell(UI_WHITE, "%llu", (unsigned long long)event->mark);
    ui_table_cell(UI_WHITE, "%s", name);
    ui_table_cell(UI_WHITE, "%u", tile.mipLevel);
    ui_table_cell(UI_WHITE, "%u, %u", tile.x, tile.y);
    ui_table_cell(UI_GRAY, "%s", state_names[event->from]);
    ui_table_cell(event->to >= SLUICE_TILE_STATE_FAILED ? UI_RED : UI_WHITE, "%s",
                  state_names[event->to]);
    ui_table_cell(UI_GRAY, "%s", reason_names[event->reason]);
}

static void draw_streamer(struct view_app *app)
{
    const struct view_facts *f = &app->facts;
    int shown = 0;
    draw_failures(app);
    ui_text(UI_GRAY, app->selected < f->texture_count
                         ? "The selected texture; newest first."
                         : "All textures; newest first. Click a surface for its own.");
    if (!ui_begin_table("events", "Frame|Texture|Level|Tile|From|To|Reason", 0, false))
        return;
    for (uint32_t age = 0; age < f->event_count && shown < 200; age++) {
        const SluiceTileEvent *event =
            &f->events[(f->event_next + FACTS_EVENTS - 1 - age) % FACTS_EVENTS];
        uint32_t index;
        const struct stage_texture *texture = texture_of(app, event->textureId, &index);
        if (texture && (app->selected >= f->texture_count || app->selected == index))
            draw_event(app, event, texture->name, shown++);
    }
    ui_end_table();
}

void panel_events(struct view_app *app)
{
    if (!app->open[PANEL_EVENTS])
        return;
    if (panel_begin(app, PANEL_EVENTS, "Events (K)", 520, 400)) {
        if (stage_traced(app->stage))
            panel_traced_events(app);
        else
            draw_streamer(app);
    }
    ui_end_panel();
}

static const char *mode_name(SluiceResidencyMode mode)
{
    switch (mode) {
    case SLUICE_RESIDENCY_MODE_SPARSE: return "sparse: images whose tiles are bound to memory";
    case SLUICE_RESIDENCY_MODE_PAGED: return "paged: a page table in shaders";
    case SLUICE_RESIDENCY_MODE_DENSE: return "dense: memory for everything";
    default: return "auto";
    }
}

static void draw_mode(const struct view_app *app, SluiceResidencyMode mode)
{
    ui_paragraph(UI_WHITE, mode_name(mode));
    ui_text(UI_GRAY, "asked for: %s",
            app->settings.residency == VIEW_AUTO ? "auto, the best that it has"
                                                 : "this mode (--residency)");
}

void panel_device(struct view_app *app)
{
    if (!app->open[PANEL_DEVICE])
        return;
    if (panel_begin(app, PANEL_DEVICE, "Device (J)", 420, 300)) {
        const VkPhysicalDeviceProperties *p = &app->gpu->properties;
        SluiceResidencyMode mode = SLUICE_RESIDENCY_MODE_AUTO;
        char size[32];
        sluiceGetVulkanResidencyMode(stage_streamer(app->stage), &mode);
        ui_paragraph(UI_BLUE, p->deviceName);
        ui_text(UI_GRAY, "Vulkan %u.%u.%u, driver %u.%u.%u", VK_API_VERSION_MAJOR(p->apiVersion),
                VK_API_VERSION_MINOR(p->apiVersion), VK_API_VERSION_PATCH(p->apiVersion),
                VK_API_VERSION_MAJOR(p->driverVersion), VK_API_VERSION_MINOR(p->driverVersion),
                VK_API_VERSION_PATCH(p->driverVersion));
        if (stage_traced(app->stage))
            panel_traced_device(app);
        else
            draw_mode(app, mode);
        ui_text(UI_GRAY, "sparse residency: %s", app->gpu->capabilities.sparse ? "yes" : "no");
        for (uint32_t i = 0; i < app->gpu->memory.memoryHeapCount; i++)
            ui_text(UI_GRAY, "memory heap %u: %s%s", i,
                    panel_size(app->gpu->memory.memoryHeaps[i].size, size, sizeof size),
                    app->gpu->memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT
                        ? ", of the device"
                        : "");
        ui_text(UI_GRAY, "validation messages: %u",
                (unsigned)atomic_load(&app->gpu->validation_messages));
        ui_text(UI_GRAY, "Sluice %u.%u.%u", SLUICE_VERSION_MAJOR, SLUICE_VERSION_MINOR,
                SLUICE_VERSION_PATCH);
    }
    ui_end_panel();
}
