/** Actions: one table for keys, the menu (F10) and the page of keys (F1). */
#ifndef SLUICE_VIEW_ACTIONS_H
#define SLUICE_VIEW_ACTIONS_H

#include "app.h"

struct action {
    const char *group;
    const char *chord; ///< key chord in the syntax of view_chord_read; NULL: `shown` is not handled
                       ///< by this table
    const char *shown; ///< key as shown to the user; NULL: same as `chord`
    const char *words;
    void (*act)(struct view_app *app, int argument);
    int argument;
};

const struct action *actions_get(uint32_t *count);
/** Returns true if the action applies to the scene or recording that is shown. */
bool actions_lists(const struct view_app *app, const struct action *action);
/** Runs the action, or shows why it does not apply. */
void actions_run(struct view_app *app, const struct action *action);
/** Runs the action of a chord. False if the chord is not in the table. */
bool actions_press(struct view_app *app, int key, unsigned modifiers);

#endif /* SLUICE_VIEW_ACTIONS_H */
