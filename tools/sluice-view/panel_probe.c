#include "panels.h"

#include "panel_traced.h"
#include "sets.h"

#include <stdio.h>
#include <string.h>

/* A ray is tested against all triangles. Large scenes have no time for it while the camera moves.
 */
#define MOST_TRIANGLES 300000u

static bool camera_moves(struct view_app *app)
{
    const struct view_camera *now = &app->camera;
    const bool moves = memcmp(now, &app->probed_camera, sizeof *now) != 0;
    app->probed_camera = *now;
    return moves;
}

static bool shows_values(const struct view_app *app)
{
    const uint32_t view = app->settings.view;
    return view > VIEW_PICTURE && view <= VIEW_CHECKS && view != VIEW_TRUTH &&
           !stage_traced(app->stage) && !app_shows_difference(app);
}

void panel_probe_find(struct view_app *app)
{
    const bool moves = camera_moves(app);
    app->probe.known = false;
    const bool inspects = app->open[PANEL_INSPECTOR] && !stage_traced(app->stage);
    if (!(shows_values(app) || inspects) || ui_owns_mouse() || app->mouse_x < 0 ||
        app->mouse_y < 0 || app->mouse_x >= app->width || app->mouse_y >= app->height ||
        (moves && stage_triangle_count(app->stage) > MOST_TRIANGLES))
        return;
    const struct stage_pixel pixel = {.camera = app->camera,
                                      .width = (uint32_t)(app->width * app->picture_scale) + 1,
                                      .height = (uint32_t)(app->height * app->picture_scale) + 1,
                                      .x = app->mouse_x / app->width,
                                      .y = app->mouse_y / app->height};
    const struct stage_pick pick =
        stage_pick(app->stage, &app->camera, app->width / app->height, pixel.x, pixel.y);
    float texels[4];
    /* The inspector describes A. */
    const bool of_b = app->other && !inspects && app_shows_b(app, app->mouse_x);
    const struct view_settings settings =
        of_b ? sets_of_second(&app->settings, &app->b) : app->settings;
    probe_point(of_b ? app->other : app->stage, of_b ? &app->facts_b : &app->facts, &pick,
                &app->probe);
    app->probe.of_b = of_b;
    if (app->probe.known && stage_pick_pixel(app->stage, &pick, &pixel, texels))
        probe_pixel(texels, &settings, &app->probe);
}

static const char *reason_words(SluiceCoarseReason reason)
{
    switch (reason) {
    case SLUICE_COARSE_FINEST: return "the file has no finer level";
    case SLUICE_COARSE_ENOUGH: return "feedback asks for no finer level";
    case SLUICE_COARSE_NOT_SEEN: return "feedback has not asked so far";
    case SLUICE_COARSE_HIDDEN: return "the texture is hidden";
    case SLUICE_COARSE_LIMIT: return "a limit of the texture";
    case SLUICE_COARSE_MIP_BIAS: return "a mip bias of the texture";
    case SLUICE_COARSE_QUEUED: return "waits in the queue";
    case SLUICE_COARSE_BANDWIDTH: return "all loads in flight are taken";
    case SLUICE_COARSE_READING: return "is being read";
    case SLUICE_COARSE_UPLOADING: return "is being uploaded";
    case SLUICE_COARSE_FADING: return "is resident and fades in";
    case SLUICE_COARSE_BUDGET: return "memory is short";
    case SLUICE_COARSE_FAILED: return "reading failed";
    default: return "";
    }
}

/* Writes a level; "none" if nothing is resident. */
static const char *level_words(uint32_t level, char *text, size_t size)
{
    if (level == SLUICE_MIP_UNTOUCHED)
        snprintf(text, size, "none");
    else
        snprintf(text, size, "level %u", level);
    return text;
}

const char *panel_missing_words(const struct view_probe *p, char *text, size_t size)
{
    const char *reason = reason_words(p->why.reason);
    if (p->resident == 0)
        snprintf(text, size, "level 0 is resident: nothing is missing");
    else if (p->resident == SLUICE_MIP_UNTOUCHED)
        snprintf(text, size, "nothing is resident%s%s", *reason ? ": " : "", reason);
    else if (p->density > 0 && p->camera_level < p->resident)
        snprintf(text, size, "%.0f missing: %s",
                 p->resident - (p->camera_level > 0 ? p->camera_level : 0.0), reason);
    else
        snprintf(text, size, "as sharp as wanted");
    return text;
}

static void draw_missing(const struct view_probe *p)
{
    char resident[24], requested[24], words[96];
    ui_text(UI_WHITE, "resident %s, requested %s",
            level_words(p->resident, resident, sizeof resident),
            level_words(p->requested, requested, sizeof requested));
    ui_text(UI_WHITE, "%s", panel_missing_words(p, words, sizeof words));
}

static void draw_wanted(const struct view_probe *p)
{
    char requested[24];
    if (p->density > 0)
        ui_text(UI_WHITE, "level of detail %.1f: level %.0f", p->lod,
                p->camera_level > 0 ? p->camera_level : 0.0);
    ui_text(UI_WHITE, "feedback requests %s",
            level_words(p->requested, requested, sizeof requested));
}

static void draw_age(const struct view_probe *p)
{
    if (p->age < 0)
        ui_text(UI_WHITE, "level %u is there since the scene was opened", p->resident);
    else
        ui_text(UI_WHITE, "level %u: loaded %.1f s ago, %u load%s", p->resident, p->age, p->loads,
                p->loads == 1 ? "" : "s");
}

static void draw_identity(const struct view_app *app, const struct stage_texture *texture)
{
    ui_text(UI_WHITE, "%u x %u, %u levels, %s", texture->width, texture->height,
            texture->level_count, texture->format);
    const uint32_t set = texture->primary;
    if (set != STAGE_NO_TEXTURE)
        ui_text(UI_GRAY, "follows %s", stage_texture(app->stage, set)->name);
}

static void draw_written(const struct view_app *app, const struct view_probe *p)
{
    const struct view_facts *facts = p->of_b ? &app->facts_b : &app->facts;
    const struct stage *stage = p->of_b ? app->other : app->stage;
    const SluiceTextureStatistics *s = &facts->textures[p->texture].statistics;
    if (s->seenTime == 0)
        ui_text(UI_WHITE, "no feedback of it so far");
    else
        ui_text(UI_WHITE, "feedback read back %.2f s ago",
                (double)(stage_now(stage) - s->seenTime) / STAGE_TICKS_PER_SECOND);
}

void panel_probe(const struct view_app *app)
{
    const struct view_probe *p = &app->probe;
    char level[24];
    if (stage_traced(app->stage)) {
        panel_traced_probe(app);
        return;
    }
    if (!p->known || !shows_values(app))
        return;
    ui_line();
    ui_text(UI_BLUE, "%s%.40s", p->of_b ? "B: " : "", stage_texture(app->stage, p->texture)->name);
    switch (app->settings.view) {
    case VIEW_RESIDENT:
        ui_text(UI_WHITE, "%s is resident", level_words(p->resident, level, sizeof level));
        break;
    case VIEW_MISSING: draw_missing(p); break;
    case VIEW_WANTED: draw_wanted(p); break;
    case VIEW_AGE: draw_age(p); break;
    case VIEW_IDENTITY: draw_identity(app, stage_texture(app->stage, p->texture)); break;
    case VIEW_WRITTEN: draw_written(app, p); break;
    case VIEW_CHECKS:
        if (p->density > 0)
            ui_text(UI_WHITE, "%.2f texels of level 0 per pixel", p->density);
        ui_text(UI_WHITE, "%s is resident", level_words(p->resident, level, sizeof level));
        break;
    default: break;
    }
}
