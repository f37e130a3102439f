/** Keys and letters of the file browser, while it is open. */
#ifndef SLUICE_VIEW_PANEL_OPEN_H
#define SLUICE_VIEW_PANEL_OPEN_H

#include "app.h"

/** Opens the browser, or closes it. */
void panel_open_toggle(struct view_app *app);
/** A key that goes down. False if it is not the browser's: F1 to F12, and chords of Ctrl. */
bool panel_open_key(struct view_app *app, int key, unsigned modifiers);
/** Letters go into the filter. */
void panel_open_type(struct view_app *app, const char *text);

#endif /* SLUICE_VIEW_PANEL_OPEN_H */
