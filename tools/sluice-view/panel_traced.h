/** Contents of panels for scenes of pbrt, whose tiles a demand loader has. */
#ifndef SLUICE_VIEW_PANEL_TRACED_H
#define SLUICE_VIEW_PANEL_TRACED_H

#include "panels.h"

/** Why an action does not apply to a traced scene; NULL: it does. `chord`: of the table of actions.
 */
const char *panel_traced_refuses(const char *chord);
/** What the pixel under the mouse has, for the legend. */
void panel_traced_probe(const struct view_app *app);
/** Whether a control does something for traced scenes, by its name. */
bool panel_traced_takes(const char *control);

/* Between panel_begin and ui_end_panel. */
void panel_traced_memory(struct view_app *app);
void panel_traced_latency(const struct view_app *app);
void panel_traced_events(struct view_app *app);
/** The lines behind name and size of the selected picture, or of what was picked. */
void panel_traced_inspector(const struct view_app *app);
void panel_traced_device(const struct view_app *app);

#endif /* SLUICE_VIEW_PANEL_TRACED_H */
