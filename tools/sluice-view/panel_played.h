/** Panels for recordings, and the curves that replace the picture. */
#ifndef SLUICE_VIEW_PANEL_PLAYED_H
#define SLUICE_VIEW_PANEL_PLAYED_H

#include "panels.h"
#include "played.h"

/** A curve of a figure over frames. */
struct played_curve {
    enum played_figure figure;
    double factor; ///< multiplies the values
    uint32_t color;
    const char *name;
};

#define PLAYED_CURVES 4u

struct played_graph {
    const char *title, *unit, *hint;
    struct played_curve curves[PLAYED_CURVES];
    uint32_t curve_count;
    double least_top; ///< smallest end of the axis
    bool heaps;       ///< with `bytes`: values count heaps; otherwise they count tiles
    bool bytes;       ///< values are shown in MB
};

const struct played_graph *played_graphs_get(uint32_t *count);
/** Draws frames `first` to `last` into a rectangle of the panel that was begun last: curves,
 * cursor, and values under the mouse. Returns the frame under the mouse; UINT32_MAX: none. */
uint32_t played_graph_draw(const struct view_app *app, const struct played_graph *graph,
                           const float r[4], uint32_t first, uint32_t last, bool over);

/** Draws curves of the whole recording, its cursor, and buttons. */
void panel_played_picture(struct view_app *app);
/** Draws the figures in the corner. */
void panel_played_now(struct view_app *app);
/** Goes to a clicked frame. */
void panel_played_jump(struct view_app *app, uint32_t frame);
/** Writes the line at the bottom. Returns `text`. */
const char *panel_played_line(const struct view_app *app, char *text, size_t size);

/* Contents of panels. Call between panel_begin and ui_end_panel. */
void panel_played_graphs(struct view_app *app);
void panel_played_latency(const struct view_app *app);
/** Draws the failures above the events. */
void panel_played_failures(struct view_app *app);
void panel_played_device(const struct view_app *app);
/** Draws the reason why the selected texture is not sharper. */
void panel_played_reason(const struct view_app *app);

#endif /* SLUICE_VIEW_PANEL_PLAYED_H */
