#include "panels.h"

#include "inspector_parts.h"
#include "panel_played.h"
#include "panel_traced.h"
#include "texture_actions.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Returns the inspected texel as a rectangle of level 0. */
static SluiceTextureRect rect_of(const struct view_app *app, const struct stage_texture *texture)
{
    SluiceTextureRect rect = {(uint32_t)(app->inspect.u * (float)texture->width),
                              (uint32_t)(app->inspect.v * (float)texture->height), 1, 1};
    if (rect.x >= texture->width)
        rect.x = texture->width - 1;
    if (rect.y >= texture->height)
        rect.y = texture->height - 1;
    return rect;
}

/* Returns a sentence without the path at its begin. The panel shows the name above it. */
static const char *without_path(const char *sentence, const struct stage_texture *texture)
{
    const char *end = strstr(sentence, ": ");
    const bool begins = end && strncmp(sentence, texture->path, (size_t)(end - sentence)) == 0;
    return begins ? end + 2 : sentence;
}

static void draw_reason(const struct view_app *app, const struct stage_texture *texture)
{
    SluiceVulkanExplanation why = {.structSize = sizeof why};
    const SluiceTextureRect rect = rect_of(app, texture);
    const bool at_point = app->inspect.hit && app->inspect.texture == app->selected;
    if (sluiceExplainVulkanTexture(stage_streamer(app->stage), texture->id, at_point ? &rect : NULL,
                                   &why) != SLUICE_SUCCESS)
        return;
    ui_text(UI_GRAY,
            at_point ? "Here: why no finer level?" : "Its coarsest part: why no finer level?");
    const bool good = why.reason == SLUICE_COARSE_FINEST || why.reason == SLUICE_COARSE_ENOUGH;
    ui_paragraph(why.reason == SLUICE_COARSE_FAILED ? UI_RED
                 : good                             ? UI_WHITE
                                                    : UI_ORANGE,
                 without_path(why.sentence, texture));
}

/* Draws the last failed read of the file, if there is one. */
static void draw_failure(const struct view_app *app, const struct stage_texture *texture)
{
    const SluiceTileLoaderStatistics *reads = &app->facts.textures[app->selected].reads;
    char where[48] = "";
    if (reads->failedCount == 0)
        return;
    if (reads->lastFailureOffset != SLUICE_UNKNOWN_OFFSET)
        snprintf(where, sizeof where, " at offset 0x%llx",
                 (unsigned long long)reads->lastFailureOffset);
    ui_text(UI_RED, "%llu reads failed: %s%s", (unsigned long long)reads->failedCount,
            sluiceGetResultName(reads->lastFailure), where);
    ui_hint("The last failure. %s", texture->path[0] ? texture->path : texture->name);
}

static void draw_buttons(struct view_app *app)
{
    uint32_t count;
    const struct texture_action *actions = texture_actions_get(&count);
    const uint32_t primary = stage_texture(app->stage, app->selected)->primary;
    const uint32_t texture = primary == STAGE_NO_TEXTURE ? app->selected : primary;
    for (uint32_t i = 0; i < count; i++) {
        const bool done = actions[i].is_done && actions[i].is_done(app, texture);
        if (i > 0)
            ui_same_line(0);
        if (ui_button(done ? actions[i].label_again : actions[i].label, 0, 0, done))
            texture_actions_do(app, actions[i].name);
        ui_hint("%s In scripts: do %s", actions[i].hint, actions[i].name);
    }
}

static void draw_streamer(struct view_app *app, const struct stage_texture *texture)
{
    const SluiceTextureStatistics *s = &app->facts.textures[app->selected].statistics;
    char resident[32], all[32];
    const bool played = stage_played(app->stage);
    if (played)
        panel_played_reason(app);
    else
        draw_reason(app, texture);
    ui_line();
    ui_text(UI_WHITE, "%s of %s resident, %u tiles wanted",
            panel_size(s->residentSize, resident, sizeof resident),
            panel_size(texture->size, all, sizeof all), s->wantedTileCount);
    ui_text(UI_GRAY, "%u loads, %u evictions, %u failures", s->mappedTotal, s->unmappedTotal,
            s->failedTotal);
    if (!played) {
        draw_failure(app, texture);
        inspector_draw_tile(app, app->selected);
        draw_buttons(app);
    }
    inspector_draw_levels(app, app->selected);
    inspector_draw_maps(app, app->selected);
    if (texture->path[0])
        ui_paragraph(UI_GRAY, texture->path);
}

static void draw_texture(struct view_app *app)
{
    const struct stage_texture *texture = stage_texture(app->stage, app->selected);
    ui_text(UI_BLUE, "%s", texture->name);
    ui_text(UI_GRAY, "%u x %u, %u levels%s%s", texture->width, texture->height,
            texture->level_count, texture->format[0] ? ", " : "", texture->format);
    if (stage_traced(app->stage)) {
        panel_traced_inspector(app);
        if (ui_button("Its file", 0, 0, false))
            texture_actions_do(app, "file");
    } else {
        draw_streamer(app, texture);
    }
}

void panel_inspector(struct view_app *app)
{
    if (!app->open[PANEL_INSPECTOR])
        return;
    if (panel_begin(app, PANEL_INSPECTOR, "Inspector (I)", 380, 430)) {
        if (app->selected < app->facts.texture_count) {
            draw_texture(app);
        } else if (stage_traced(app->stage) && app->inspect.hit) {
            ui_text(UI_BLUE, "A surface without a texture");
            panel_traced_inspector(app);
        } else {
            ui_paragraph(UI_GRAY, "Right click a surface, or click a row of the textures (T).");
        }
    }
    ui_end_panel();
}
