/**
 * Dear ImGui behind a C interface: the widgets that the panels use. ui.cpp creates and destroys the
 * context, ui_widgets.cpp has the widgets, ui_paint.cpp draws shapes. Only these files and
 * ui_theme.cpp are C++.
 *
 * There is one user interface per process, as ImGui has one context. All sizes are in pixels,
 * colors are 0xAABBGGRR. Texts are UTF-8; labels may hide an id behind "##".
 */
#ifndef SLUICE_VIEW_UI_H
#define SLUICE_VIEW_UI_H

#include "ui_geometry.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define UI_PRINTF(text, first) __attribute__((format(printf, text, first)))
#else
#define UI_PRINTF(text, first)
#endif

#define UI_COLOR(r, g, b, a)                                                                       \
    ((uint32_t)(a) << 24 | (uint32_t)(b) << 16 | (uint32_t)(g) << 8 | (uint32_t)(r))
#define UI_WHITE UI_COLOR(235, 238, 242, 255)
#define UI_GRAY UI_COLOR(160, 168, 178, 255)
#define UI_ORANGE UI_COLOR(255, 178, 60, 255)
#define UI_RED UI_COLOR(255, 110, 90, 255)
#define UI_BLUE UI_COLOR(105, 175, 255, 255)

enum ui_theme { UI_DARK, UI_LIGHT, UI_CONTRAST };

/** A key or a character. */
struct ui_key_event {
    int key; ///< enum view_key; VIEW_KEY_NONE: a character
    bool down;
    char text[5]; ///< a character
};

#define UI_MAX_KEY_EVENTS 256 /* per frame, enough for a slow one */

/** Input since the last frame. */
struct ui_input {
    float width, height; ///< pixels of the picture
    float seconds;       ///< time since the last frame, above 0
    float mouse_x, mouse_y;
    bool buttons[3]; ///< left, right, middle
    float wheel;
    bool shift, control, alt;
    struct ui_key_event keys[UI_MAX_KEY_EVENTS];
    uint32_t key_count;
    char text[256]; ///< typed; also in `keys`, between the keys
};

/* Life. */

/** Creates the user interface. `scale`: 1 for 96 dots per inch. False, with a line on stderr,
 * without memory. */
bool ui_create(float scale);
void ui_destroy(void);
/** Returns RGBA texels of the font, valid until ui_destroy. */
const uint8_t *ui_font_pixels(uint32_t *width, uint32_t *height);
/** Sets functions of the system's clipboard. NULL: the program keeps a clipboard of its own. */
void ui_set_clipboard(void (*set)(void *user_data, const char *text),
                      const char *(*get)(void *user_data), void *user_data);
/** Sets the colors of all panels. `theme`: enum ui_theme. */
void ui_set_theme(int theme);
/** Returns a theme's text color for UI_WHITE, UI_GRAY, UI_ORANGE, UI_RED or UI_BLUE. Returns other
 *  colors unchanged. */
uint32_t ui_theme_color(int theme, uint32_t color);
/** Returns the background color of a theme. */
uint32_t ui_theme_background(int theme);
void ui_begin_frame(const struct ui_input *input);
/** Ends the frame. The geometry is valid until the next ui_begin_frame. */
void ui_end_frame(struct ui_geometry *geometry);
void ui_copy_text(const char *text);
/** Returns true if the mouse belongs to the user interface in this frame. */
bool ui_owns_mouse(void);
/** Returns true if the key belongs to the user interface in this frame. */
bool ui_owns_key(int key);
float ui_scale(void);
/** Height of a line of text, with the space below. */
float ui_line_height(void);
float ui_text_height(void); ///< height of a line of text, without the space below
float ui_text_width(const char *text);

/* Panels. */

enum ui_panel_flags {
    UI_PANEL_PLAIN = 1, ///< no title, cannot be moved
    UI_PANEL_FIT = 2,   ///< size of the panel follows its contents
    UI_PANEL_NO_INPUT = 4,
    UI_PANEL_NO_KEYS = 8, ///< keys do not move the focus in the panel
    UI_PANEL_BEHIND = 16  ///< panel is behind all others
};
/** Begins a panel. Always call ui_end_panel. `open` NULL: the panel has no close button.
 *  `placement`: first x, y, width, height; fixed with UI_PANEL_PLAIN. `pivot`: point of the panel
 *  that lies at x, y; 0 to 1. */
bool ui_begin_panel(const char *title, bool *open, const float placement[4], const float pivot[2],
                    unsigned flags);
void ui_end_panel(void);
/** Width of the panel that was begun last, in pixels. */
float ui_panel_width(void);
/** Begins a part of a panel that scrolls. */
void ui_begin_part(const char *id, float width, float height);
void ui_end_part(void);
/** Begins a list of `count` lines of text that scrolls. Draw lines *first to *last - 1. `follow`:
 *  scrolls to line `selected`. `count` 0: draw all lines. */
void ui_begin_list(const char *id, float width, float height, uint32_t count, uint32_t selected,
                   bool follow, uint32_t *first, uint32_t *last);
/** Draws a line of a list. Returns the number of clicks on it: 0, 1 or 2. */
int ui_list_line(int id, bool selected, uint32_t color, const char *text);
void ui_end_list(uint32_t count);
/** Scrolls to the last widget. */
void ui_follow(void);
bool ui_begin_group(const char *label, bool open_at_first);

/* Widgets. */

void ui_text(uint32_t color, const char *format, ...) UI_PRINTF(2, 3);
/** Texts until ui_end_large are 1.5 times as large. */
void ui_begin_large(void);
void ui_end_large(void);
/** Lines until ui_end_tight stand closer, if `tight`. */
void ui_begin_tight(bool tight);
void ui_end_tight(void);
void ui_paragraph(uint32_t color, const char *text);
void ui_same_line(float x); ///< x: distance from the left of the panel; 0: after the last widget
void ui_space(float height);
/** Returns true if a widget of this height is visible at the present position. False: the position
 * is scrolled away. */
bool ui_in_sight(float height);
void ui_line(void);
bool ui_button(const char *label, float width, float height, bool pressed);
/** Widgets until ui_end_disabled are gray and take no input, if `disabled`. */
void ui_begin_disabled(bool disabled);
void ui_end_disabled(void);
bool ui_check(const char *label, bool *value);
bool ui_slider_real(const char *label, double *value, double minimum, double maximum,
                    bool logarithmic, const char *format);
bool ui_slider_whole(const char *label, uint32_t *value, uint32_t minimum, uint32_t maximum,
                     bool logarithmic);
/** Draws a list of choices. `words`: choices separated by '|'. */
bool ui_choice(const char *label, const char *words, int *value);
/** Draws two number fields. `value` changes when Enter is pressed or the keyboard leaves a field.
 */
bool ui_type_extent(const char *label, uint32_t value[2], uint32_t minimum, uint32_t maximum);
bool ui_type_text(const char *label, const char *hint, char *text, size_t size);
void ui_item_width(float width);
/* Queries about the last widget, except ui_any_active. */
bool ui_hovered(void);
bool ui_double_clicked(void);
bool ui_deleted(void);    ///< the widget has the keyboard, and Delete was pressed
bool ui_active(void);     ///< the widget is dragged or typed into
bool ui_any_active(void); ///< any widget is dragged or typed into
bool ui_released(void);   ///< the widget was released in this frame, after its value changed
void ui_hint(const char *format, ...) UI_PRINTF(1, 2); ///< hint shown while the widget is hovered
void ui_show_hint(const char *text);                   ///< hint shown at the mouse now

/* Tables. */

/** Begins a table. `columns`: titles separated by '|': "Name|Loads=9999". A title of changing cells
 *  has "=" and the widest text. Other columns fit the first rows. The user can drag widths. */
bool ui_begin_table(const char *id, const char *columns, float height, bool sortable);
/** Writes the column to sort by. False if the order has not changed since the previous frame. */
bool ui_table_sort(uint32_t *column, bool *descending);
/** Calls `draw` for each visible row of `count`. `draw` begins a row by ui_table_row. */
void ui_table_rows(uint32_t count, void (*draw)(void *user_data, uint32_t row), void *user_data);
/** Begins a row. Returns true if it was clicked. */
bool ui_table_row(int id, bool selected);
/** Draws a square image before the text of the next ui_table_cell. */
void ui_table_image(uint32_t texture, float size, const float uv[4]);
void ui_table_cell(uint32_t color, const char *format, ...) UI_PRINTF(2, 3);
void ui_end_table(void);

/* Drawing, in pixels of the picture. */

/** Reserves a rectangle in the panel: x, y, width, height. Width 0: all that is free. */
void ui_canvas(float width, float height, float rectangle[4]);
void ui_fill(float x, float y, float width, float height, uint32_t color);
/** Draws a text behind all panels, on a dark rectangle that is larger by `pad`. */
void ui_label_behind(float x, float y, float pad, const char *text);
void ui_fill_behind(float x, float y, float width, float height, uint32_t color);
void ui_stroke_behind(float x0, float y0, float x1, float y1, uint32_t color, float thickness);
void ui_frame(float x, float y, float width, float height, uint32_t color);
void ui_stroke(float x0, float y0, float x1, float y1, uint32_t color, float thickness);
void ui_polyline(const float *xy, uint32_t count, uint32_t color, float thickness);
void ui_label(float x, float y, uint32_t color, const char *text);
/** Draws a picture behind all panels. `uv`: left, top, right, bottom. */
void ui_picture(uint32_t texture, uint32_t mode, const float rectangle[4], const float uv[4],
                uint32_t color);
/** Draws an image in the panel. */
void ui_image(uint32_t texture, float width, float height, const float uv[4]);
void ui_mouse(float *x, float *y);
bool ui_mouse_clicked(int button);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_VIEW_UI_H */
