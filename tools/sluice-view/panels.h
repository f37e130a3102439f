/** The panels: they read the facts and change the settings. */
#ifndef SLUICE_VIEW_PANELS_H
#define SLUICE_VIEW_PANELS_H

#include "app.h"

/** All panels that are open, between ui_begin_frame and ui_end_frame. */
void panels_draw(struct view_app *app);
/** The picture behind them, with the divider of a comparison. */
void panels_draw_picture(const struct view_app *app);

/* Each is drawn if it is open. */
void panel_start(struct view_app *app);
/** Lines of the frustum of the camera that tiles are loaded for, while wants are frozen. */
void panel_ghost(const struct view_app *app);
/** The path that the camera follows, and the bookmarks. */
void panel_path(const struct view_app *app);
void panel_now(struct view_app *app);
void panel_legend(struct view_app *app);
/** Finds what is under the mouse, for the legend and the inspector. */
void panel_probe_find(struct view_app *app);
/** Values under the mouse, in the legend of the view. */
void panel_probe(const struct view_app *app);
void panel_controls(struct view_app *app);
void panel_graphs(struct view_app *app);
void panel_latency(struct view_app *app);
void panel_memory(struct view_app *app);
/** Chooses the colors of slots, and explains them. */
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

/** Whether a panel is on the right of the picture. One panel is open on each side. */
bool panel_is_right(enum app_panel panel);
/** Begins a panel with a title, at most a quarter of the picture. False if it is not shown; end it
 *  in any case. */
bool panel_begin(struct view_app *app, enum app_panel panel, const char *title, float width,
                 float height);
/** A text that is no wider than `width` pixels: "FlightHel...Normal.jpg". Returns `text` if that
 *  is, else `shortened`. */
const char *panel_shorten(const char *text, float width, char *shortened, size_t size);
/** How many levels a point lacks, and why. Returns `text`. */
const char *panel_missing_words(const struct view_probe *probe, char *text, size_t size);
/** "1 264 MB" of bytes, with a blank between thousands. Returns `text`. */
const char *panel_size(uint64_t bytes, char *text, size_t size);
/** Colors of views by level, for people who see colors differently, too. */
uint32_t panel_level_color(uint32_t level);

#endif /* SLUICE_VIEW_PANELS_H */
