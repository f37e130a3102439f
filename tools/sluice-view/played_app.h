/** What keys, clicks and scripts do to a recording. */
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
    PLAYED_LAST_FAILURE, ///< the one before
    PLAYED_NEXT_LOSS,
    PLAYED_LAST_LOSS,
    PLAYED_SHOW_LONGEST,
    PLAYED_FORWARD, ///< by 100 frames
    PLAYED_REWIND
};

/** Goes to a frame, and says so if that failed. */
void played_app_go(struct view_app *app, uint32_t frame);
/** `action`: enum played_action. Says so if no recording is shown. */
void played_app_act(struct view_app *app, int action);
/** Acts if the chord means something to a recording that is shown. */
bool played_app_press(struct view_app *app, int key, unsigned modifiers);
/** Why an action does not apply to recordings; NULL: it does. */
const char *played_app_refuses(const struct action *action);
/** Whether a control does something for recordings, by its name. */
bool played_app_takes(const char *control);
/** Once per frame of the viewer: goes on if the recording plays, and follows the mouse. */
void played_app_move(struct view_app *app);

#endif /* SLUICE_VIEW_PLAYED_APP_H */
