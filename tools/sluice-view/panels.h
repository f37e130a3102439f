/** The panels. They read facts and change settings. */
#ifndef SLUICE_VIEW_PANELS_H
#define SLUICE_VIEW_PANELS_H

#include "app.h"

/** Draws all open panels. Call between ui_begin_frame and ui_end_frame. */
void panels_draw(struct view_app *app);
/** Draws the picture behind the panels, with the divider of a comparison. */
void panels_draw_picture(const struct view_app *app);

/* Panels. Each function draws its panel if the panel is open. */
void panel_start(struct view_app *app);
/** Draws the frustum of the camera that tiles are loaded for, while requests are frozen (L). */
void panel_ghost(const struct view_app *app);
/** Draws the path that the camera follows, and the bookmarks. */
void panel_path(const struct view_app *app);
void panel_now(struct view_app *app);
void panel_legend(struct view_app *app);
/** Finds the values under the mouse, for the legend and the inspector. */
void panel_probe_find(struct view_app *app);
/** Draws the values under the mouse in the legend of the view. */
void panel_probe(const struct view_app *app);
void panel_controls(struct view_app *app);
void panel_graphs(struct view_app *app);
void panel_latency(struct view_app *app);
void panel_memory(struct view_app *app);
/** Draws the choice and the legend of the slots' colors. */
void panel_memory_colors(struct view_app *app);
void panel_textures(struct view_app *app);
void panel_inspector(struct view_app *app);
void panel_events(struct view_app *app);
void panel_device(struct view_app *app);
void panel_trade(struct view_app *app);
void panel_file(struct view_app *app);
void panel_open(struct view_app *app);
void panel_keys(struct view_app *app);
void panel_menu(struct view_app *app);

/** Returns true if the panel is on the right of the picture. One panel is open on each side. */
bool panel_is_right(enum app_panel panel);
/** Begins a panel with a title, at most a quarter of the picture. Always call ui_end_panel. False
 * if the panel is not visible. */
bool panel_begin(struct view_app *app, enum app_panel panel, const char *title, float width,
                 float height);
/** Shortens a text to `width` pixels: "FlightHel...Normal.jpg". Returns `text` if it fits,
 * otherwise `shortened`. */
const char *panel_shorten(const char *text, float width, char *shortened, size_t size);
/** Writes the number of missing levels at a point, and the reason. Returns `text`. */
const char *panel_missing_words(const struct view_probe *probe, char *text, size_t size);
/** Writes bytes as "1 264 MB", with a blank between thousands. Returns `text`. */
const char *panel_size(uint64_t bytes, char *text, size_t size);
/** Returns the color of a level in views. Color-blind people can tell these colors apart. */
uint32_t panel_level_color(uint32_t level);

#endif /* SLUICE_VIEW_PANELS_H */
