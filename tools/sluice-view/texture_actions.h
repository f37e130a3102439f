/** What the buttons of the inspector and the event `do` of scripts do to the selected texture. */
#ifndef SLUICE_VIEW_TEXTURE_ACTIONS_H
#define SLUICE_VIEW_TEXTURE_ACTIONS_H

#include "app.h"

struct texture_action {
    const char *name, *label, *label_again; ///< `label_again`: to undo it; NULL: nothing to undo
    const char *hint;
    bool (*act)(struct view_app *app, uint32_t texture);           ///< false if it was refused
    bool (*is_done)(const struct view_app *app, uint32_t texture); ///< NULL: never
};

const struct texture_action *texture_actions_get(uint32_t *count);
/** Acts on the selected texture, for a follower on its primary. False, with a line on stderr, if
 *  there is no such action, no texture is selected, or it was refused. */
bool texture_actions_do(struct view_app *app, const char *name);

#endif /* SLUICE_VIEW_TEXTURE_ACTIONS_H */
