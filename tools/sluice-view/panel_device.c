#include "panels.h"

#include "device_words.h"
#include "panel_played.h"
#include "panel_traced.h"

#include <sluice/version.h>

static const char *mode_name(SluiceResidencyMode mode)
{
    switch (mode) {
    case SLUICE_RESIDENCY_MODE_SPARSE: return "Sparse: images whose tiles are bound to memory";
    case SLUICE_RESIDENCY_MODE_PAGED: return "Paged: a page table in shaders";
    case SLUICE_RESIDENCY_MODE_DENSE: return "Dense: memory for everything";
    default: return "Auto";
    }
}

static void draw_mode(const struct view_app *app)
{
    static const SluiceResidencyMode asked[] = {[VIEW_AUTO] = SLUICE_RESIDENCY_MODE_AUTO,
                                                [VIEW_SPARSE] = SLUICE_RESIDENCY_MODE_SPARSE,
                                                [VIEW_PAGED] = SLUICE_RESIDENCY_MODE_PAGED,
                                                [VIEW_DENSE] = SLUICE_RESIDENCY_MODE_DENSE};
    const SluiceVulkanDeviceCapabilities *c = &app->gpu->capabilities;
    SluiceResidencyMode mode = SLUICE_RESIDENCY_MODE_AUTO;
    char words[DEVICE_WORDS], quirks[DEVICE_QUIRKS][DEVICE_WORDS];
    sluiceGetVulkanResidencyMode(stage_streamer(app->stage), &mode);
    ui_paragraph(UI_WHITE, mode_name(mode));
    ui_paragraph(UI_GRAY, device_mode_reason(c, asked[app->settings.residency], mode,
                                             app->facts.texture_count, words));
    const uint32_t count = device_quirks(c, mode, quirks);
    ui_text(UI_WHITE, count > 0 ? "Quirks in force" : "No quirks in force");
    for (uint32_t i = 0; i < count; i++)
        ui_paragraph(UI_GRAY, quirks[i]);
}

static void draw_size(const char *name, uint64_t size, const char *hint)
{
    char text[32];
    if (size == 0)
        return;
    ui_text(UI_GRAY, "%s: %s", name, panel_size(size, text, sizeof text));
    ui_hint("%s", hint);
}

static void draw_memory(const struct view_app *app)
{
    const SluiceVulkanContextStatistics *s = &app->facts.context;
    const VkPhysicalDeviceMemoryProperties *memory = &app->gpu->memory;
    char size[32];
    ui_text(UI_WHITE, "Memory");
    for (uint32_t i = 0; i < memory->memoryHeapCount; i++)
        ui_text(UI_GRAY, "memory heap %u: %s%s", i,
                panel_size(memory->memoryHeaps[i].size, size, sizeof size),
                memory->memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT ? ", of the device"
                                                                               : "");
    if (s->deviceMemoryBudget != UINT64_MAX && !app->deterministic) /* others take of it */
        draw_size("the device can spare", s->deviceMemoryBudget,
                  "Bytes for tiles, by VK_EXT_memory_budget.");
    if (s->memoryBudget != UINT64_MAX && !app->deterministic)
        draw_size("budget in use", s->memoryBudget, "Most bytes for tiles.");
    draw_size("heaps of tiles", s->heapMemorySize, "Memory that sparse images are bound to.");
    draw_size("pages", s->pageMemorySize, "Array images that hold tiles in paged mode.");
    draw_size("images", s->imageMemorySize, "Images that are resident as a whole.");
    draw_size("tables", s->tableMemorySize, "MinMip maps, page tables and feedback maps.");
    draw_size("staging", s->stagingMemorySize, "Host memory for uploads.");
    draw_size("readback", s->readbackMemorySize, "Host memory for feedback.");
    if (s->refusedBlockCount > 0)
        ui_text(UI_ORANGE, "%llu blocks did not fit into the budget",
                (unsigned long long)s->refusedBlockCount);
}

void panel_device(struct view_app *app)
{
    if (!app->open[PANEL_DEVICE])
        return;
    if (panel_begin(app, PANEL_DEVICE, "Device (J)", 440, 480)) {
        const VkPhysicalDeviceProperties *p = &app->gpu->properties;
        const SluiceVulkanDeviceCapabilities *c = &app->gpu->capabilities;
        ui_paragraph(UI_BLUE, p->deviceName);
        ui_text(UI_GRAY, "Vulkan %u.%u.%u", VK_API_VERSION_MAJOR(p->apiVersion),
                VK_API_VERSION_MINOR(p->apiVersion), VK_API_VERSION_PATCH(p->apiVersion));
        ui_text(UI_GRAY, "%s %s", c->driverName, c->driverInfo);
        if (stage_traced(app->stage))
            panel_traced_device(app);
        else if (stage_played(app->stage))
            panel_played_device(app);
        else
            draw_mode(app);
        if (app->present_mode)
            ui_text(UI_GRAY, "the window presents by %s", app->present_mode);
        if (!stage_played(app->stage))
            draw_memory(app);
        const unsigned messages = (unsigned)atomic_load(&app->gpu->validation_messages);
        ui_text(messages > 0 ? UI_RED : UI_GRAY, "validation messages: %u", messages);
        ui_text(UI_GRAY, "Sluice %u.%u.%u", SLUICE_VERSION_MAJOR, SLUICE_VERSION_MINOR,
                SLUICE_VERSION_PATCH);
    }
    ui_end_panel();
}
