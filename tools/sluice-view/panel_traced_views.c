/* The legend's values under the mouse, in scenes that are traced. */
#include "panel_traced.h"

#include "traced.h"

static void draw_level(const char *what, uint32_t level, uint32_t count)
{
    if (level == TRACED_NO_LEVEL)
        ui_text(UI_WHITE, "%s none", what);
    else
        ui_text(UI_WHITE, "%s level %u of 0 to %u", what, level, count > 0 ? count - 1 : 0);
}

static void draw_missing(const struct traced *t, const struct TracedView *v)
{
    draw_level("resident", v->resident, v->levelCount);
    if (v->resident <= v->wanted)
        ui_text(UI_WHITE, "as sharp as wanted");
    else if (t->now.lodBias > 0)
        ui_text(UI_WHITE, "%u missing: memory is short, +%.1f level", v->resident - v->wanted,
                (double)t->now.lodBias);
    else
        ui_text(UI_WHITE, "%u missing", v->resident - v->wanted);
}

static void draw_age(const struct traced *t, const struct TracedView *v)
{
    const struct traced_tile *tile = traced_tiles_find(&t->tiles, v->page);
    if (!tile || tile->loads == 0)
        ui_text(UI_WHITE, "no tile: the color of the last level serves");
    else
        ui_text(UI_WHITE, "level %u: loaded %.1f s ago, %u load%s", v->resident,
                (double)(t->time - tile->loaded[0]) / STAGE_TICKS_PER_SECOND, tile->loads,
                tile->loads == 1 ? "" : "s");
}

static void draw_open(const struct view_app *app, const struct TracedView *v)
{
    const struct traced *t = stage_traced(app->stage);
    switch (app->settings.view) {
    case VIEW_RESIDENT: draw_level("resident", v->resident, v->levelCount); break;
    case VIEW_MISSING: draw_missing(t, v); break;
    case VIEW_WANTED:
        ui_text(UI_WHITE, "level of detail %.1f: level %u", (double)v->lod, v->wanted);
        break;
    case VIEW_AGE: draw_age(t, v); break;
    case VIEW_CHECKS:
        ui_text(UI_WHITE, "%.2f texels of level 0 per pixel", (double)v->density);
        draw_level("resident", v->resident, v->levelCount);
        break;
    default: break;
    }
}

void panel_traced_probe(const struct view_app *app)
{
    const struct traced *t = stage_traced(app->stage);
    if (ui_owns_mouse() || app_shows_difference(app))
        return;
    const struct TracedView *v =
        traced_view_at(t, app->mouse_x / app->width, app->mouse_y / app->height);
    const uint32_t picture = v ? traced_picture_of(t, v->texture) : UINT32_MAX;
    if (picture >= t->picture_count)
        return;
    const struct stage_texture *texture = &t->pictures[picture].texture;
    ui_line();
    ui_text(UI_BLUE, "%.40s", texture->name);
    if (v->state != TRACED_OPEN) {
        ui_text(UI_ORANGE, "%s",
                v->state == TRACED_FAILED ? "it cannot be opened" : "it is not open yet");
        return;
    }
    if (app->settings.view == VIEW_IDENTITY)
        ui_text(UI_WHITE, "%u x %u, %u levels, %s", texture->width, texture->height,
                texture->level_count, texture->format);
    draw_open(app, v);
}
