/** Keyboard input of the file browser, while it is open. */
#ifndef SLUICE_VIEW_PANEL_OPEN_H
#define SLUICE_VIEW_PANEL_OPEN_H

#include "app.h"

/** Opens the browser, or closes it. */
void panel_open_toggle(struct view_app *app);
/** Handles a key press. False for keys that the browser leaves alone: F1 to F12, and Ctrl chords.
 */
bool panel_open_key(struct view_app *app, int key, unsigned modifiers);
/** Adds letters to the filter. */
void panel_open_type(struct view_app *app, const char *text);

#endif /* SLUICE_VIEW_PANEL_OPEN_H */
