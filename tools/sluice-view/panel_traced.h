/** Panels for pbrt scenes, which a demand loader streams. */
#ifndef SLUICE_VIEW_PANEL_TRACED_H
#define SLUICE_VIEW_PANEL_TRACED_H

#include "panels.h"

/** Returns why an action does not apply to traced scenes; NULL: it does. `chord`: chord in the
 * table of actions. */
const char *panel_traced_refuses(const char *chord);
/** Draws the values of the pixel under the mouse, in the legend. */
void panel_traced_probe(const struct view_app *app);
/** Returns true if the control of this name applies to traced scenes. */
bool panel_traced_takes(const char *control);

/* Contents of panels. Call between panel_begin and ui_end_panel. */
void panel_traced_memory(struct view_app *app);
void panel_traced_latency(const struct view_app *app);
void panel_traced_events(struct view_app *app);
/** Draws the lines after name and size of the selected picture, or of the picked surface. */
void panel_traced_inspector(const struct view_app *app);
void panel_traced_device(const struct view_app *app);

#endif /* SLUICE_VIEW_PANEL_TRACED_H */
