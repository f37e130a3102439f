/** Everything that a key does: one table for keys, the menu and the page of keys. */
#ifndef SLUICE_VIEW_ACTIONS_H
#define SLUICE_VIEW_ACTIONS_H

#include "app.h"

struct action {
    const char *group;
    const char *chord; ///< as view_chord_read takes it; NULL: `shown` is not a key of this table
    const char *shown; ///< NULL: the chord
    const char *words;
    void (*act)(struct view_app *app, int argument);
    int argument;
};

const struct action *actions_get(uint32_t *count);
/** Whether the action is listed: those of scenes are not while a recording is shown, and the other
 *  way round. */
bool actions_lists(const struct view_app *app, const struct action *action);
/** Acts, or says why the action does not apply to what is shown. */
void actions_run(struct view_app *app, const struct action *action);
/** Acts if the chord is in the table. */
bool actions_press(struct view_app *app, int key, unsigned modifiers);

#endif /* SLUICE_VIEW_ACTIONS_H */
