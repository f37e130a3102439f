#include "panels.h"

#include "panel_played.h"

#include "panel_compare.h"

#include <stdio.h>
#include <string.h>

const char *panel_size(uint64_t bytes, char *text, size_t size)
{
    const unsigned mega = (unsigned)((bytes + 500000) / 1000000);
    if (mega >= 1000)
        snprintf(text, size, "%u %03u MB", mega / 1000, mega % 1000);
    else if (bytes < 10000000)
        snprintf(text, size, "%.1f MB", (double)bytes / 1e6);
    else
        snprintf(text, size, "%u MB", mega);
    return text;
}

static bool within_character(char byte)
{
    return ((unsigned char)byte & 0xC0) == 0x80;
}

const char *panel_shorten(const char *text, float width, char *shortened, size_t size)
{
    const size_t length = strlen(text), most = size - sizeof "...";
    size_t kept = length < most ? length : most;
    if (ui_text_width(text) <= width && length < size)
        return text;
    do {
        size_t head = kept / 2, tail = length - (kept - head);
        while (head > 0 && within_character(text[head]))
            head--;
        while (within_character(text[tail]))
            tail++;
        snprintf(shortened, size, "%.*s...%s", (int)head, text, text + tail);
    } while (kept-- > 2 && ui_text_width(shortened) > width);
    return shortened;
}

/* Level 0 is red. Dark blue, green and yellow differ in brightness, for color-blind people. */
uint32_t panel_level_color(uint32_t level)
{
    static const uint32_t colors[] = {UI_COLOR(214, 40, 40, 255),   UI_COLOR(247, 127, 0, 255),
                                      UI_COLOR(252, 191, 73, 255),  UI_COLOR(190, 210, 110, 255),
                                      UI_COLOR(102, 194, 165, 255), UI_COLOR(50, 136, 189, 255),
                                      UI_COLOR(70, 80, 170, 255),   UI_COLOR(50, 40, 100, 255)};
    const uint32_t count = sizeof colors / sizeof *colors;
    return colors[level < count ? level : count - 1];
}

bool panel_is_right(enum app_panel panel)
{
    return panel == PANEL_GRAPHS || panel == PANEL_TEXTURES || panel == PANEL_MEMORY ||
           panel == PANEL_DEVICE || panel == PANEL_TRADE || panel == PANEL_FILE;
}

/* Places one panel on each side, below the fixed elements, so that no panel covers another. */
bool panel_begin(struct view_app *app, enum app_panel panel, const char *title, float width,
                 float height)
{
    const float scale = ui_scale(), margin = 12.0f * scale;
    const bool right = panel_is_right(panel);
    const float top = (right ? 128.0f : 84.0f) * scale;
    const float room = app->height - top - 84.0f * scale;
    const float most = app->width * app->height / 4;
    width *= scale;
    height *= scale;
    if (width > (app->width - 3 * margin) / 2)
        width = (app->width - 3 * margin) / 2;
    if (width * height > most)
        height = most / width;
    if (height > room)
        height = room > 8 * margin ? room : 8 * margin;
    const float pivot[2] = {right ? 1.0f : 0.0f, 0};
    const float placement[4] = {right ? app->width - margin : margin, top, width, height};
    return ui_begin_panel(title, &app->open[panel], placement, pivot, 0);
}

static void draw_right_of_divider(const struct view_app *app, uint32_t texture)
{
    const float part = (float)app->settings.divider, x = part * app->width;
    const float half[4] = {x, 0, app->width - x, app->height}, uv[4] = {part, 0, 1, 1};
    ui_picture(texture, UI_MODE_PLAIN, half, uv, UI_COLOR(255, 255, 255, 255));
}

static void draw_divider(const struct view_app *app, const char *left, const char *right)
{
    const float x = (float)app->settings.divider * app->width;
    const float y = app->height * 0.8f, pad = 6 * ui_scale();
    ui_fill_behind(x - ui_scale(), 0, 2 * ui_scale(), app->height, UI_COLOR(255, 255, 255, 255));
    ui_label_behind(x - ui_text_width(left) - 2 * pad, y, pad, left);
    ui_label_behind(x + 2 * pad, y, pad, right);
}

/* FLIP is black until the first map is there. */
static void draw_difference(const struct view_app *app)
{
    const struct view_settings *s = &app->settings;
    const bool known = app->flip && app->flip->known;
    const float all[4] = {0, 0, app->width, app->height}, uv[4] = {0, 0, 1, 1};
    const uint32_t gain = (uint32_t)(s->gain / 16.0 * 255.0);
    if (s->difference == VIEW_FLIP && known)
        ui_picture(UI_TEXTURE_FLIP, UI_MODE_PLAIN, all, uv, UI_COLOR(255, 255, 255, 255));
    else if (s->difference == VIEW_FLIP)
        ui_fill_behind(0, 0, app->width, app->height, UI_COLOR(0, 0, 0, 255));
    else
        ui_picture(UI_TEXTURE_PICTURE, UI_MODE_DIFFERENCE, all, uv, UI_COLOR(255, 255, 255, gain));
    if (s->difference != VIEW_BOTH_DIFFERENCES)
        return;
    const float x = (float)s->divider * app->width;
    if (known)
        draw_right_of_divider(app, UI_TEXTURE_FLIP);
    else
        ui_fill_behind(x, 0, app->width - x, app->height, UI_COLOR(0, 0, 0, 255));
    draw_divider(app, "pixels", "FLIP");
}

void panels_draw_picture(const struct view_app *app)
{
    char name[160];
    const struct view_settings *s = &app->settings;
    const float all[4] = {0, 0, app->width, app->height}, uv[4] = {0, 0, 1, 1};
    if (!app->stage) {
        ui_fill_behind(0, 0, app->width, app->height, UI_COLOR(38, 44, 52, 255));
        return;
    }
    if (stage_played(app->stage))
        return;                               /* panels_draw draws it */
    if (app_has_second(app) && !app->other) { /* B is being prepared */
        ui_picture(UI_TEXTURE_PICTURE, UI_MODE_PLAIN, all, uv, UI_COLOR(255, 255, 255, 255));
        return;
    }
    if (app_shows_difference(app)) {
        draw_difference(app);
        return;
    }
    ui_picture(s->compare == VIEW_FLICKER && app_shows_b(app, 0) ? UI_TEXTURE_OTHER
                                                                 : UI_TEXTURE_PICTURE,
               UI_MODE_PLAIN, all, uv, UI_COLOR(255, 255, 255, 255));
    if (s->compare != VIEW_DIVIDER)
        return;
    draw_right_of_divider(app, UI_TEXTURE_OTHER);
    draw_divider(app, "A", panel_compare_name(app, name, sizeof name));
}

void panels_draw(struct view_app *app)
{
    ui_set_theme(app->settings.theme);
    panels_draw_picture(app);
    if (app->stage && stage_played(app->stage)) {
        panel_played_picture(app);
    } else {
        panel_ghost(app);
        panel_path(app);
    }
    if (app->settings.panels != 0)
        return;
    if (app->open[PANEL_KEYS] && app->stage) {
        panel_keys(app);
        return;
    }
    if (app->open[PANEL_OPEN] && app->stage) {
        panel_open(app);
        return;
    }
    panel_start(app);
    if (!app->stage)
        return;
    panel_now(app);
    app->probe.known = false;
    if (!stage_played(app->stage)) {
        panel_probe_find(app);
        panel_legend(app);
    }
    panel_controls(app);
    panel_graphs(app);
    panel_latency(app);
    panel_memory(app);
    panel_textures(app);
    panel_inspector(app);
    panel_events(app);
    panel_device(app);
    panel_trade(app);
    panel_file(app);
    panel_menu(app);
}
