/** Actions on the selected texture: buttons of the inspector, and the event `do` of scripts. */
#ifndef SLUICE_VIEW_TEXTURE_ACTIONS_H
#define SLUICE_VIEW_TEXTURE_ACTIONS_H

#include "app.h"

struct texture_action {
    const char *name, *label, *label_again; ///< `label_again`: undoes the action; NULL: no undo
    const char *hint;
    bool (*act)(struct view_app *app, uint32_t texture);           ///< false if it was refused
    bool (*is_done)(const struct view_app *app, uint32_t texture); ///< NULL: never
};

const struct texture_action *texture_actions_get(uint32_t *count);
/** Acts on the selected texture, or on its primary if it follows one. False, with a line on stderr,
 *  if the action is unknown or refused, or no texture is selected. */
bool texture_actions_do(struct view_app *app, const char *name);

#endif /* SLUICE_VIEW_TEXTURE_ACTIONS_H */
