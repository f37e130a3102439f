/**
 * Dear ImGui behind a C interface: the widgets that the panels use. ui.cpp has its life,
 * ui_widgets.cpp the widgets, ui_paint.cpp what is drawn. Nothing else is C++.
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

/** A key, or a character. */
enum ui_theme { UI_DARK, UI_LIGHT, UI_CONTRAST };

struct ui_key_event {
    int key; ///< enum view_key; VIEW_KEY_NONE: a character
    bool down;
    char text[5]; ///< a character
};

#define UI_MAX_KEY_EVENTS 256 /* of a slow frame */

/** What happened since the last frame. */
struct ui_input {
    float width, height; ///< of the picture
    float seconds;       ///< since the last frame, above 0
    float mouse_x, mouse_y;
    bool buttons[3]; ///< left, right, middle
    float wheel;
    bool shift, control, alt;
    struct ui_key_event keys[UI_MAX_KEY_EVENTS];
    uint32_t key_count;
    char text[256]; ///< typed; also in `keys`, between the keys
};

/* Life. */

/** `scale`: 1 for 96 dots per inch. False, with a line on stderr, without memory. */
bool ui_create(float scale);
void ui_destroy(void);
/** RGBA texels of the font, valid until ui_destroy. */
const uint8_t *ui_font_pixels(uint32_t *width, uint32_t *height);
/** Functions of the system's clipboard; NULL: one of the program's own. */
void ui_set_clipboard(void (*set)(void *user_data, const char *text),
                      const char *(*get)(void *user_data), void *user_data);
/** Colors of all panels from now on: enum ui_theme. */
void ui_set_theme(int theme);
/** What texts of UI_WHITE, UI_GRAY, UI_ORANGE, UI_RED and UI_BLUE are drawn in; others as given. */
uint32_t ui_theme_color(int theme, uint32_t color);
/** Behind them. */
uint32_t ui_theme_background(int theme);
void ui_begin_frame(const struct ui_input *input);
/** The geometry is valid until the next ui_begin_frame. */
void ui_end_frame(struct ui_geometry *geometry);
void ui_copy_text(const char *text);
/** Whether the mouse or a key of this frame belongs to the user interface. */
bool ui_owns_mouse(void);
bool ui_owns_key(int key);
float ui_scale(void);
/** Height of a line of text, and of a line of widgets. */
float ui_line_height(void);
float ui_text_height(void); ///< of a line without the space below
float ui_text_width(const char *text);

/* Panels. */

enum ui_panel_flags {
    UI_PANEL_PLAIN = 1, ///< no title, cannot be moved
    UI_PANEL_FIT = 2,   ///< as large as its contents
    UI_PANEL_NO_INPUT = 4,
    UI_PANEL_NO_KEYS = 8, ///< the keyboard moves no focus in it
    UI_PANEL_BEHIND = 16  ///< behind all others
};
/** `open` NULL: it has no button to close it. `placement`: x, y, width, height at first; with
 *  UI_PANEL_PLAIN always. `pivot`: which point of the panel is at x, y, 0 to 1. Always end it. */
bool ui_begin_panel(const char *title, bool *open, const float placement[4], const float pivot[2],
                    unsigned flags);
void ui_end_panel(void);
/** Of the panel that was begun last. */
float ui_panel_width(void);
/** A part of a panel that scrolls. */
void ui_begin_part(const char *id, float width, float height);
void ui_end_part(void);
/** A list of `count` lines of text that scrolls: draw lines *first to *last - 1. `follow`: scrolls
 *  to line `selected`. `count` 0: draw all. */
void ui_begin_list(const char *id, float width, float height, uint32_t count, uint32_t selected,
                   bool follow, uint32_t *first, uint32_t *last);
/** Returns how often the line was clicked: 0, 1 or 2. */
int ui_list_line(int id, bool selected, uint32_t color, const char *text);
void ui_end_list(uint32_t count);
/** Scrolls to the widget before. */
void ui_follow(void);
bool ui_begin_group(const char *label, bool open_at_first);

/* Widgets. */

void ui_text(uint32_t color, const char *format, ...) UI_PRINTF(2, 3);
/** Texts between are half as large again. */
void ui_begin_large(void);
void ui_end_large(void);
/** Lines between stand closer, if `tight`. */
void ui_begin_tight(bool tight);
void ui_end_tight(void);
void ui_paragraph(uint32_t color, const char *text);
void ui_same_line(float x); ///< x: from the left of the panel; 0: behind the last widget
void ui_space(float height);
/** Whether a widget of this height would be seen here, or is scrolled away. */
bool ui_in_sight(float height);
void ui_line(void);
bool ui_button(const char *label, float width, float height, bool pressed);
/** Widgets between are gray and cannot be used if `disabled`. */
void ui_begin_disabled(bool disabled);
void ui_end_disabled(void);
bool ui_check(const char *label, bool *value);
bool ui_slider_real(const char *label, double *value, double minimum, double maximum,
                    bool logarithmic, const char *format);
bool ui_slider_whole(const char *label, uint32_t *value, uint32_t minimum, uint32_t maximum,
                     bool logarithmic);
/** `words`: separated by '|'. */
bool ui_choice(const char *label, const char *words, int *value);
/** Two numbers to type; they count when the keyboard leaves them, or Enter is pressed. */
bool ui_type_extent(const char *label, uint32_t value[2], uint32_t minimum, uint32_t maximum);
bool ui_type_text(const char *label, const char *hint, char *text, size_t size);
void ui_item_width(float width);
/** About the widget before. */
bool ui_hovered(void);
bool ui_double_clicked(void);
bool ui_deleted(void);    ///< it has the keyboard, and Delete was pressed
bool ui_active(void);     ///< being dragged, or typed into
bool ui_any_active(void); ///< any widget
bool ui_released(void);   ///< released in this frame, after its value changed
void ui_hint(const char *format, ...) UI_PRINTF(1, 2); ///< shown while the widget is hovered
void ui_show_hint(const char *text);                   ///< shown at the mouse now

/* Tables. */

/** `columns`: titles separated by '|', each with "=" and its widest text, if that changes:
 *  "Name|Loads=9999". Widths are those of the first rows, and can be dragged. */
bool ui_begin_table(const char *id, const char *columns, float height, bool sortable);
/** The column to sort by. False if the order is that of the frame before. */
bool ui_table_sort(uint32_t *column, bool *descending);
/** Draws those of `count` rows that are in sight, each begun by ui_table_row. */
void ui_table_rows(uint32_t count, void (*draw)(void *user_data, uint32_t row), void *user_data);
/** Begins a row; returns whether it was clicked. */
bool ui_table_row(int id, bool selected);
/** A square in the cell of the next ui_table_cell, before its text. */
void ui_table_image(uint32_t texture, float size, const float uv[4]);
void ui_table_cell(uint32_t color, const char *format, ...) UI_PRINTF(2, 3);
void ui_end_table(void);

/* Drawing, in pixels of the picture. */

/** Reserves a rectangle in the panel: x, y, width, height. Width 0: all there is. */
void ui_canvas(float width, float height, float rectangle[4]);
void ui_fill(float x, float y, float width, float height, uint32_t color);
/** Behind all panels; a text on a dark rectangle that is larger by `pad`. */
void ui_label_behind(float x, float y, float pad, const char *text);
void ui_fill_behind(float x, float y, float width, float height, uint32_t color);
void ui_stroke_behind(float x0, float y0, float x1, float y1, uint32_t color, float thickness);
void ui_frame(float x, float y, float width, float height, uint32_t color);
void ui_stroke(float x0, float y0, float x1, float y1, uint32_t color, float thickness);
void ui_polyline(const float *xy, uint32_t count, uint32_t color, float thickness);
void ui_label(float x, float y, uint32_t color, const char *text);
/** Behind all panels. `uv`: left, top, right, bottom. */
void ui_picture(uint32_t texture, uint32_t mode, const float rectangle[4], const float uv[4],
                uint32_t color);
/** In the panel. */
void ui_image(uint32_t texture, float width, float height, const float uv[4]);
void ui_mouse(float *x, float *y);
bool ui_mouse_clicked(int button);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_VIEW_UI_H */
