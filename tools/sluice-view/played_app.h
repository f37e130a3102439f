/** Actions of keys, clicks and scripts on a recording. */
#ifndef SLUICE_VIEW_PLAYED_APP_H
#define SLUICE_VIEW_PLAYED_APP_H

#include "actions.h"
#include "played.h"

enum played_action {
    PLAYED_NEXT,
    PLAYED_BACK,
    PLAYED_FIRST,
    PLAYED_LAST,
    PLAYED_PLAY,
    PLAYED_NEXT_FAILURE,
    PLAYED_LAST_FAILURE, ///< the previous failure
    PLAYED_NEXT_LOSS,
    PLAYED_LAST_LOSS,
    PLAYED_SHOW_LONGEST,
    PLAYED_FORWARD, ///< by 100 frames
    PLAYED_REWIND
};

/** Goes to a frame. Shows a message on failure. */
void played_app_go(struct view_app *app, uint32_t frame);
/** Runs an enum played_action. Shows a message if no recording is shown. */
void played_app_act(struct view_app *app, int action);
/** Runs the action of a chord on the shown recording. False if there is none. */
bool played_app_press(struct view_app *app, int key, unsigned modifiers);
/** Returns why an action does not apply to recordings; NULL: it does. */
const char *played_app_refuses(const struct action *action);
/** Returns true if the control of this name applies to recordings. */
bool played_app_takes(const char *control);
/** Advances a recording that plays, and follows the mouse. Call once per frame of the viewer. */
void played_app_move(struct view_app *app);

#endif /* SLUICE_VIEW_PLAYED_APP_H */
