/** Contents of panels for recordings, and what stands in the place of the picture. */
#ifndef SLUICE_VIEW_PANEL_PLAYED_H
#define SLUICE_VIEW_PANEL_PLAYED_H

#include "panels.h"
#include "played.h"

/** Curves of figures over frames. */
struct played_curve {
    enum played_figure figure;
    double factor; ///< of its values
    uint32_t color;
    const char *name;
};

#define PLAYED_CURVES 4u

struct played_graph {
    const char *title, *unit, *hint;
    struct played_curve curves[PLAYED_CURVES];
    uint32_t curve_count;
    double least_top; ///< the axis ends there or higher
    bool heaps;       ///< factors are multiplied by the size of a heap, or else of a tile, in MB,
    bool bytes;       ///< if these are bytes
};

const struct played_graph *played_graphs_get(uint32_t *count);
/** Draws frames `first` to `last` into a rectangle of the panel that was begun last: curves,
 * cursor, and values under the mouse. Returns the frame under the mouse; UINT32_MAX: none. */
uint32_t played_graph_draw(const struct view_app *app, const struct played_graph *graph,
                           const float r[4], uint32_t first, uint32_t last, bool over);

/** All of the recording, with its cursor, and buttons. */
void panel_played_picture(struct view_app *app);
/** The corner. */
void panel_played_now(struct view_app *app);
/** Goes to a frame that was clicked. */
void panel_played_jump(struct view_app *app, uint32_t frame);
/** The line at the bottom. Returns `text`. */
const char *panel_played_line(const struct view_app *app, char *text, size_t size);

/* Between panel_begin and ui_end_panel. */
void panel_played_graphs(struct view_app *app);
void panel_played_latency(const struct view_app *app);
/** Failures, above the events. */
void panel_played_failures(struct view_app *app);
void panel_played_device(const struct view_app *app);
/** Why the selected texture is not sharper. */
void panel_played_reason(const struct view_app *app);

#endif /* SLUICE_VIEW_PANEL_PLAYED_H */
