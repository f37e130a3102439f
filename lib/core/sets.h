/** Sets of textures: a primary and its followers. */
#ifndef SLC_CORE_SETS_H
#define SLC_CORE_SETS_H

#include "core/state.h"

/** Detaches a texture from its primary, if it has one. */
void slc_unfollow(slc_manager *m, struct slc_managed_texture *t);
/** Makes a texture the last follower of `primary`. Neither may have a primary before. */
void slc_follow(slc_manager *m, struct slc_managed_texture *t, struct slc_managed_texture *primary);

#endif /* SLC_CORE_SETS_H */
