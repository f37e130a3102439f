#include "panel_open.h"

#include "panels.h"

#include <stdio.h>
#include <string.h>

#define WIDTH 780.0f
#define HEIGHT 470.0f
#define PAGE 10 /* lines */

void panel_open_toggle(struct view_app *app)
{
    app->open[PANEL_OPEN] = !app->open[PANEL_OPEN];
    if (!app->open[PANEL_OPEN])
        return;
    app->settings.panels = 0; /* shown, since it takes the keys */
    browser_begin(&app->browser);
}

/* Removes the last character of the filter. */
static void shorten_filter(struct browser *b)
{
    char filter[sizeof b->filter];
    memcpy(filter, b->filter, sizeof filter);
    size_t length = strlen(filter);
    while (length > 0 && ((unsigned char)filter[--length] & 0xC0) == 0x80)
        continue;
    filter[length] = '\0';
    browser_set_filter(b, filter);
}

static void activate(struct view_app *app)
{
    browser_activate(&app->browser);
    app->open[PANEL_OPEN] = !app->browser.is_chosen;
}

static void choose_folder(struct view_app *app)
{
    browser_choose_folder(&app->browser);
    app->open[PANEL_OPEN] = false;
}

static void go_up(struct browser *b)
{
    if (b->filter[0])
        shorten_filter(b);
    else
        browser_up(b);
}

static void change_side(struct browser *b)
{
    b->side = b->side == BROWSER_FILES ? BROWSER_PLACES : BROWSER_FILES;
    b->moved = true;
}

bool panel_open_key(struct view_app *app, int key, unsigned modifiers)
{
    struct browser *b = &app->browser;
    if ((key >= VIEW_KEY_F1 && key <= VIEW_KEY_F12) ||
        (modifiers & VIEW_CONTROL && key != VIEW_KEY_ENTER))
        return false;
    switch (key) {
    case VIEW_KEY_ESCAPE: app->open[PANEL_OPEN] = false; break;
    case VIEW_KEY_ENTER: (modifiers & VIEW_CONTROL ? choose_folder : activate)(app); break;
    case VIEW_KEY_BACKSPACE: go_up(b); break;
    case VIEW_KEY_TAB: change_side(b); break;
    case VIEW_KEY_UP: browser_move(b, -1); break;
    case VIEW_KEY_DOWN: browser_move(b, 1); break;
    case VIEW_KEY_PAGE_UP: browser_move(b, -PAGE); break;
    case VIEW_KEY_PAGE_DOWN: browser_move(b, PAGE); break;
    case VIEW_KEY_HOME: browser_move(b, INT32_MIN); break;
    case VIEW_KEY_END: browser_move(b, INT32_MAX); break;
    default: break;
    }
    return true;
}

void panel_open_type(struct view_app *app, const char *text)
{
    struct browser *b = &app->browser;
    char filter[sizeof b->filter + 64];
    if (!text[0])
        return;
    snprintf(filter, sizeof filter, "%s%s", b->filter, text);
    if (strlen(filter) < sizeof b->filter)
        browser_set_filter(b, filter);
}

/* Handles clicks on a line of a list: one selects, two open. */
static void take_click(struct view_app *app, enum browser_side side, uint32_t line, int clicks)
{
    struct browser *b = &app->browser;
    if (clicks > 0) {
        b->side = side;
        b->selected[side] = line;
    }
    if (clicks > 1)
        activate(app);
}

static const char *size_words(uint64_t bytes, char *text, size_t size)
{
    if (bytes >= 1000000)
        return panel_size(bytes, text, size);
    snprintf(text, size, "%.1f kB", (double)bytes / 1e3);
    return text;
}

static void draw_files(struct view_app *app, float width, float height)
{
    struct browser *b = &app->browser;
    char name[300], shown[300], size[32];
    uint32_t first, last, clicked = 0;
    int clicks = 0;
    const bool follow = b->moved && b->side == BROWSER_FILES;
    ui_begin_list("files", width, height, b->shown_count, b->selected[BROWSER_FILES], follow,
                  &first, &last);
    for (uint32_t i = first; i < last; i++) {
        const struct browser_entry *entry = &b->entries[b->shown[i]];
        const bool selected = b->side == BROWSER_FILES && i == b->selected[BROWSER_FILES];
        snprintf(name, sizeof name, "%s%s", entry->name, entry->is_folder ? "/" : "");
        const int hit =
            ui_list_line((int)i, selected, entry->is_folder ? UI_BLUE : UI_WHITE,
                         panel_shorten(name, width - 110 * ui_scale(), shown, sizeof shown));
        ui_hint("%s", entry->name);
        if (!entry->is_folder) {
            ui_same_line(width - 90 * ui_scale());
            ui_text(UI_GRAY, "%s", size_words(entry->size, size, sizeof size));
        }
        if (hit > 0) {
            clicks = hit;
            clicked = i;
        }
    }
    ui_end_list(b->shown_count);
    take_click(app, BROWSER_FILES, clicked, clicks); /* may change the list */
}

static const char *place_name(const struct browser_place *place)
{
    const char *slash = strrchr(place->path, '/');
    if (!place->path[0])
        return "the room of computed pictures";
    return slash && slash[1] ? slash + 1 : place->path;
}

static void draw_places(struct view_app *app, float width, float height)
{
    static const char *const headings[] = {"Recent files", "Scenes of the viewer",
                                           "Scenes beside this one"};
    struct browser *b = &app->browser;
    char shown[300];
    uint32_t clicked = 0;
    int clicks = 0;
    ui_begin_list("places", width, height, 0, 0, false, NULL, NULL);
    for (uint32_t i = 0; i < b->place_count; i++) {
        const struct browser_place *place = &b->places[i];
        const bool selected = b->side == BROWSER_PLACES && i == b->selected[BROWSER_PLACES];
        if (i == 0 || place->kind != b->places[i - 1].kind)
            ui_text(UI_GRAY, "%s", headings[place->kind]);
        const int hit = ui_list_line(
            (int)i, selected, place->is_missing ? UI_GRAY : UI_WHITE,
            panel_shorten(place_name(place), width - 30 * ui_scale(), shown, sizeof shown));
        ui_hint("%s%s", place->path[0] ? place->path : "Needs no file.",
                place->is_missing ? "\nIt is not there now." : "");
        if (selected && b->moved)
            ui_follow();
        if (hit > 0) {
            clicks = hit;
            clicked = i;
        }
    }
    ui_end_list(0);
    take_click(app, BROWSER_PLACES, clicked, clicks);
}

static void draw_buttons(struct view_app *app)
{
    struct browser *b = &app->browser;
    if (ui_button("Folder above (Backspace)", 0, 0, false))
        browser_up(b);
    ui_same_line(0);
    if (ui_button("Hang its pictures (Ctrl+Enter)", 0, 0, false))
        choose_folder(app);
    ui_hint("Hangs all pictures of this folder and those below it in the room.");
    ui_same_line(0);
    if (ui_button("Open (Enter)", 0, 0, false))
        activate(app);
    ui_same_line(0);
    if (ui_button("Cancel (Esc)", 0, 0, false))
        app->open[PANEL_OPEN] = false;
}

static void draw_head(const struct browser *b, float width)
{
    char shown[512], selected[2 * BROWSER_PATH];
    ui_text(UI_BLUE, "%s", panel_shorten(b->folder, width, shown, sizeof shown));
    if (b->filter[0])
        ui_text(UI_WHITE, "%s %s_", strchr(b->filter, '/') ? "Path:" : "Filter:", b->filter);
    else
        ui_text(UI_GRAY, "Type words of a name, or a path with '/'.  Arrows: choose.  Tab: the "
                         "other list.");
    if (b->problem[0])
        ui_paragraph(UI_RED, b->problem);
    else if (b->side == BROWSER_PLACES)
        ui_text(UI_GRAY, "%s",
                panel_shorten(browser_selected(b, selected, sizeof selected), width, shown,
                              sizeof shown));
    else
        ui_text(UI_GRAY, "%u of %zu folders and files that the viewer reads", b->shown_count,
                b->entry_count);
}

void panel_open(struct view_app *app)
{
    const float scale = ui_scale(), pivot[2] = {0.5f, 0.5f}, margin = 40 * scale;
    float width = WIDTH * scale, height = HEIGHT * scale;
    width = width < app->width - margin ? width : app->width - margin;
    height = height < app->height - margin ? height : app->height - margin;
    const float placement[4] = {app->width / 2, app->height / 2, width, height};
    if (ui_begin_panel("Open (Ctrl+O)", &app->open[PANEL_OPEN], placement, pivot,
                       UI_PANEL_NO_KEYS)) {
        const float inner = width - 32 * scale, files = 0.6f * inner;
        draw_head(&app->browser, inner);
        const float list = height - 7.2f * ui_line_height() - 20 * scale;
        draw_files(app, files, list);
        ui_same_line(0);
        draw_places(app, inner - files, list);
        draw_buttons(app);
        app->browser.moved = false;
    }
    ui_end_panel();
}
