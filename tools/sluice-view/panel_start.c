#include "panels.h"

#include "actions.h"
#include "panel_played.h"
#include "panel_traced.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define BUTTON_SECONDS 30.0

/* Shortens a text to a width; a cut text ends in dots. */
static const char *fit_text(const char *text, float width, char *fitted, size_t size)
{
    size_t length = strlen(text);
    if (ui_text_width(text) <= width)
        return text;
    length = length < size - 4 ? length : size - 4;
    do {
        while (length > 0 &&
               ((unsigned char)text[--length] & 0xC0) == 0x80) /* within a character */
            continue;
        snprintf(fitted, size, "%.*s ...", (int)length, text);
    } while (length > 0 && ui_text_width(fitted) > width);
    return fitted;
}

static const char *sharp_words(const struct view_facts *f, char *text, size_t size)
{
    if (f->sharp_known)
        snprintf(text, size, "%.0f %% sharp", floor(100.0 * f->sharp));
    else
        snprintf(text, size, "... sharp");
    return text;
}

/* Shows a hint by the mouse position: clicks go through the line to the picture, so ImGui does not
 * report the hover. */
static void hint_line(const struct view_app *app, const float placement[4])
{
    const float left = placement[0] - placement[2] / 2, top = placement[1] - placement[3];
    float x, y;
    ui_mouse(&x, &y);
    if (!app->stage || ui_owns_mouse() || app->dragging || x < left || x >= left + placement[2] ||
        y < top || y >= placement[1])
        return;
    ui_show_hint(
        stage_played(app->stage)
            ? "The shown frame of the recording, and keys that go to other frames."
            : "Size of all textures with all levels; bytes in memory; part of the view that is as "
              "sharp as the camera requests.");
}

/* Draws the line of figures, and a line of hints below. Computes the panel's size from the present
 * texts, since UI_PANEL_FIT follows one frame later. */
static void draw_line(struct view_app *app)
{
    char all[32], now[32], sharp[32], line[160] = "Opening the scene ...";
    char fitted[256];
    const float scale = ui_scale(), pivot[2] = {0.5f, 1.0f}, pad = 12 * scale;
    const char *hints =
        "drag look  ·  WASD walk  ·  right click a surface  ·  1-9 views  ·  F1 all keys";
    if (app->stage)
        snprintf(line, sizeof line, "%s of textures  ·  %s in memory  ·  %s",
                 panel_size(app->facts.all_size, all, sizeof all),
                 panel_size(app->facts.resident_size, now, sizeof now),
                 sharp_words(&app->facts, sharp, sizeof sharp));
    if (app->stage && stage_played(app->stage)) {
        panel_played_line(app, line, sizeof line);
        hints = "N, Shift+N step  ·  space play  ·  click: go there  ·  F failed read  ·  "
                "E eviction  ·  L longest frame  ·  F1 all keys";
    }
    if (app->said_seconds > 0)
        hints = app->said;
    app->line_width = 0;
    if (app->stage && app->width < 620 * scale) /* narrow: the corner has the figures */
        return;
    hints = fit_text(hints, app->width - 6 * pad, fitted, sizeof fitted);
    ui_begin_large();
    const float large = ui_text_width(line), tall = ui_line_height();
    ui_end_large();
    const float small = ui_text_width(hints), wide = large > small ? large : small;
    app->line_width = wide + 2 * pad;
    const float placement[4] = {app->width / 2, app->height - pad, app->line_width,
                                tall + ui_line_height() + 15 * scale};
    if (ui_begin_panel("line", NULL, placement, pivot, UI_PANEL_PLAIN | UI_PANEL_NO_INPUT)) {
        ui_begin_large();
        ui_same_line(pad + (wide - large) / 2);
        ui_text(UI_WHITE, "%s", line);
        ui_end_large();
        ui_space(0);
        ui_same_line(pad + (wide - small) / 2);
        ui_text(app->said_seconds > 0 ? UI_ORANGE : UI_GRAY, "%s", hints);
    }
    ui_end_panel();
    hint_line(app, placement);
}

static void draw_buttons(struct view_app *app)
{
    const float scale = ui_scale(), height = 40 * scale, width = 190 * scale;
    const bool centered = app->width >= 1160 * scale;
    const float pivot[2] = {centered ? 0.5f : 0, 0};
    const float placement[4] = {centered ? app->width / 2 : 12 * scale, 12 * scale, 0, 0};
    if (app->width < 900 * scale) /* narrow: no room beside the figures; keys do the same */
        return;
    if (ui_begin_panel("buttons", NULL, placement, pivot, UI_PANEL_PLAIN | UI_PANEL_FIT)) {
        const uint32_t view = app->settings.view;
        if (ui_button("What is in memory? (2)", width, height, view == VIEW_RESIDENT))
            app_set_view(app, view == VIEW_RESIDENT ? VIEW_PICTURE : VIEW_RESIDENT);
        ui_hint("Colors the picture by the level of detail in memory. Key 2; key 1 returns to the "
                "picture.");
        ui_same_line(0);
        if (ui_button("Why is this blurry? (3)", width, height, view == VIEW_MISSING))
            app_set_view(app, view == VIEW_MISSING ? VIEW_PICTURE : VIEW_MISSING);
        ui_hint(
            "Colors surfaces that are coarser than the camera requests. Right click one for the "
            "reason. Key 3; key 1 returns to the picture.");
        ui_same_line(0);
        if (ui_button("With 16 MB (B)", width, height, app->demonstrating))
            actions_press(app, 'B', 0);
        ui_hint("Lowers the budget to 16 MB for some seconds, and restores it. Key B.");
    }
    ui_end_panel();
}

void panel_start(struct view_app *app)
{
    draw_line(app);
    if (app->stage && !stage_played(app->stage) &&
        (!app->touched || app->seconds < BUTTON_SECONDS || app->demonstrating))
        draw_buttons(app);
}

/* Draws the bar: resident and standby (hatched) tiles, relative to the budget or to everything. */
static void draw_bar(const struct view_app *app, float width, float height)
{
    const struct view_facts *f = &app->facts;
    const double whole = f->budget ? (double)f->budget : (double)f->all_size;
    float r[4];
    ui_canvas(width, height, r);
    if (whole <= 0)
        return;
    const double resident = fmin(1.0, (double)f->resident_size / whole);
    const double standby = fmin(resident, (double)f->standby_size / whole);
    ui_fill(r[0], r[1], r[2], r[3], UI_COLOR(50, 56, 66, 255));
    ui_fill(r[0], r[1], r[2] * (float)resident, r[3], UI_COLOR(70, 150, 220, 255));
    const float left = r[0] + r[2] * (float)(resident - standby);
    for (float x = left; x < r[0] + r[2] * (float)resident; x += 4 * ui_scale())
        ui_fill(x, r[1], 2 * ui_scale(), r[3], UI_COLOR(40, 80, 120, 255));
    const double wanted = (double)f->wanted_size / whole;
    if (wanted < 1.0)
        ui_fill(r[0] + r[2] * (float)wanted, r[1], 2 * ui_scale(), r[3], UI_WHITE);
    ui_hint("Blue: resident. Hatched: resident and not wanted (standby). White mark: wanted now. "
            "The bar is %s.",
            f->budget ? "the budget" : "all textures");
}

/* Draws messages of the scene: missing images, unsupported extensions. */
static void draw_messages(const struct view_app *app)
{
    char text[900] = "";
    const uint32_t count = stage_message_count(app->stage);
    size_t length = 0;
    if (count == 0)
        return;
    for (uint32_t i = 0; i < count && length < sizeof text; i++)
        length += (size_t)snprintf(text + length, sizeof text - length, "%s%s", i > 0 ? "\n" : "",
                                   stage_message(app->stage, i));
    ui_text(UI_ORANGE, "%u part%s of the scene cannot be shown (Shift+I)", count,
            count == 1 ? "" : "s");
    ui_hint("%s", text);
}

void panel_now(struct view_app *app)
{
    const struct view_facts *f = &app->facts;
    char resident[32], whole[32], sharp[32];
    const float scale = ui_scale(), pivot[2] = {1, 0};
    const float placement[4] = {app->width - 12 * scale, 12 * scale, 0, 0};
    if (stage_played(app->stage)) {
        panel_played_now(app);
        return;
    }
    if (ui_begin_panel("now", NULL, placement, pivot, UI_PANEL_PLAIN | UI_PANEL_FIT)) {
        if (app->deterministic)
            ui_text(UI_WHITE, "frame %llu", (unsigned long long)f->frame);
        else if (app->headless)
            ui_text(UI_WHITE, "frame %llu   host %.1f ms   GPU %.1f ms",
                    (unsigned long long)f->frame, 1e3 * f->host_seconds, 1e3 * f->gpu_seconds);
        else
            ui_text(UI_WHITE, "%.0f fps   host %.1f ms   GPU %.1f ms",
                    f->frame_seconds > 0 ? 1.0 / f->frame_seconds : 0.0, 1e3 * f->host_seconds,
                    1e3 * f->gpu_seconds);
        ui_hint("Frames per second; time of the viewer and the library on the host; time of the "
                "frame on the GPU.");
        ui_text(UI_WHITE, "%s of %s", panel_size(f->resident_size, resident, sizeof resident),
                panel_size(f->budget ? f->budget : f->all_size, whole, sizeof whole));
        ui_hint("Tiles that are in memory, of %s.",
                f->budget ? "the budget (--budget)" : "all textures with all levels");
        draw_bar(app, 230 * scale, 10 * scale);
        ui_text(UI_GRAY, "%s   %u load%s in flight", sharp_words(f, sharp, sizeof sharp),
                f->now.loadsInFlight, f->now.loadsInFlight == 1 ? "" : "s");
        ui_hint(
            "How much of what is in view is as sharp as the camera asks for, and tiles that are "
            "being read.");
        const uint32_t baking = stage_baking_count(app->stage);
        if (baking > 0) {
            ui_text(UI_ORANGE, "baking %u picture%s into tiles", baking, baking == 1 ? "" : "s");
            ui_hint(
                "Pictures are baked into tile stores when they are first opened, and kept in the "
                "cache (--cache). Coarse levels are shown until then.");
        }
        if (f->budget && f->resident_size > f->budget && f->tails_size > 0) {
            ui_text(UI_ORANGE, "%s are mip tails, which stay",
                    panel_size(f->tails_size, whole, sizeof whole));
            ui_hint("Each texture keeps the tiles of its coarsest levels, whatever the budget. "
                    "Panel M shows them.");
        }
        if (!stage_traced(app->stage) && f->budget && f->now.heapCount == 0 &&
            f->now.requestedTileCount > 0) {
            ui_text(UI_ORANGE, "no memory for tiles: heaps of %s do not fit",
                    panel_size((uint64_t)stage_heap_tiles(app->stage) * SLUICE_DEFAULT_TILE_SIZE,
                               whole, sizeof whole));
            ui_hint("Heaps are made for the budget that the scene was opened with. Raise the "
                    "budget (U), or open the scene again with this one.");
        }
        if (f->now.globalMipBias > 0)
            ui_text(UI_RED, "memory is short: +%.1f level", f->now.globalMipBias / 16.0);
        if (f->now.failedTileCount + f->now.givenUpTileCount > 0 && baking == 0)
            ui_text(UI_RED, "%u tile%s failed to load (K)",
                    f->now.failedTileCount + f->now.givenUpTileCount,
                    f->now.failedTileCount + f->now.givenUpTileCount == 1 ? "" : "s");
        draw_messages(app);
        if (app->tracing)
            ui_text(UI_RED, "recording for sluice-replay (Ctrl+R)");
        if (app->settings.pause)
            ui_text(UI_ORANGE, "streaming is paused (P): %u tiles wait", f->now.requestedTileCount);
        if (app->settings.freeze_wants)
            ui_text(UI_ORANGE, "wants are frozen: orange lines (L)");
    }
    ui_end_panel();
}
