/** Which texture follows which. */
#ifndef SLC_CORE_SETS_H
#define SLC_CORE_SETS_H

#include "core/state.h"

/** The texture has no primary any more. */
void slc_unfollow(slc_manager *m, struct slc_managed_texture *t);
/** The texture follows a primary, as its last follower. It had none; the primary has none. */
void slc_follow(slc_manager *m, struct slc_managed_texture *t, struct slc_managed_texture *primary);

#endif /* SLC_CORE_SETS_H */
