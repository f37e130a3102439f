#include "texture_actions.h"

#include "../common/text.h"

#include <string.h>

static SluiceVulkanStreamer *streamer_of(const struct view_app *app)
{
    return stage_streamer(app->stage);
}

static bool evict(struct view_app *app, uint32_t texture)
{
    return sluiceEvictVulkanTexture(streamer_of(app), stage_texture(app->stage, texture)->id, 0) ==
           SLUICE_SUCCESS;
}

static bool is_pinned(const struct view_app *app, uint32_t texture)
{
    return app->facts.textures[texture].pin != 0;
}

static bool pin(struct view_app *app, uint32_t texture)
{
    SluiceTextureRequestId *id = &app->facts.textures[texture].pin;
    const SluiceVulkanTextureRequest all = {.structSize = sizeof all, .until = UINT64_MAX};
    if (*id == 0)
        return sluiceRequestVulkanTexture(streamer_of(app), stage_texture(app->stage, texture)->id,
                                          &all, id) == SLUICE_SUCCESS;
    const bool withdrawn = sluiceWithdrawVulkanRequest(streamer_of(app), *id) == SLUICE_SUCCESS;
    *id = 0;
    return withdrawn;
}

static bool get_control(const struct view_app *app, uint32_t texture,
                        SluiceVulkanTextureControl *control)
{
    *control = (SluiceVulkanTextureControl){.structSize = sizeof *control};
    return sluiceGetVulkanTextureControl(streamer_of(app), stage_texture(app->stage, texture)->id,
                                         control) == SLUICE_SUCCESS;
}

static bool is_hidden(const struct view_app *app, uint32_t texture)
{
    SluiceVulkanTextureControl control;
    return get_control(app, texture, &control) && control.hidden;
}

static bool hide(struct view_app *app, uint32_t texture)
{
    SluiceVulkanTextureControl control;
    if (!get_control(app, texture, &control))
        return false;
    control.hidden = !control.hidden;
    return sluiceSetVulkanTextureControl(streamer_of(app), stage_texture(app->stage, texture)->id,
                                         &control) == SLUICE_SUCCESS;
}

static bool retry(struct view_app *app, uint32_t texture)
{
    return sluiceRetryVulkanSource(streamer_of(app), stage_source(app->stage, texture)) ==
           SLUICE_SUCCESS;
}

static bool look_at_file(struct view_app *app, uint32_t texture)
{
    const char *path = stage_texture(app->stage, texture)->path;
    if (!path[0])
        return false;
    file_facts_look(&app->file, path);
    app_show_panel(app, PANEL_FILE);
    return true;
}

static const struct texture_action table[] = {
    {"evict", "Evict", NULL, "Evicts its tiles. What is still seen comes again.", evict, NULL},
    {"pin", "Pin", "Unpin",
     "Pinned: all its tiles are requested until it is unpinned, as far as memory allows.", pin,
     is_pinned},
    {"hide", "Hide", "Show",
     "Hidden: its feedback is not read, its tiles leave when others need the memory.", hide,
     is_hidden},
    {"retry", "Retry", NULL, "Reads again at once what failed to load.", retry, NULL},
    {"file", "Its file", NULL, "Shows what sluice-info says of its file.", look_at_file, NULL},
};

#define COUNT (sizeof table / sizeof *table)

const struct texture_action *texture_actions_get(uint32_t *count)
{
    *count = (uint32_t)COUNT;
    return table;
}

bool texture_actions_do(struct view_app *app, const char *name)
{
    if (!app->stage || app->selected >= app->facts.texture_count) {
        text_say("sluice-view: %s: no texture is selected", name);
        return false;
    }
    if (stage_played(app->stage)) {
        text_say("sluice-view: %s: not for recordings, which are played as they were", name);
        return false;
    }
    if (stage_traced(app->stage) && strcmp(name, "file") != 0) {
        text_say("sluice-view: %s: not for textures of pbrt scenes, which rays ask for", name);
        return false;
    }
    const struct stage_texture *texture = stage_texture(app->stage, app->selected);
    const uint32_t primary =
        texture->primary == STAGE_NO_TEXTURE ? app->selected : texture->primary;
    for (size_t i = 0; i < COUNT; i++) {
        if (strcmp(table[i].name, name) != 0)
            continue;
        if (table[i].act(app, table[i].act == retry || table[i].act == look_at_file ? app->selected
                                                                                    : primary))
            return true;
        text_say("sluice-view: %s: %s was refused", texture->name, name);
        return false;
    }
    text_say("sluice-view: there is no action %s", name);
    return false;
}
