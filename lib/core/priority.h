/** Priorities of textures: the order of tiles of one level while memory or time is short. */
#ifndef SLC_CORE_PRIORITY_H
#define SLC_CORE_PRIORITY_H

#include "core/state.h"

/** Returns the priority of a texture: its own, or its primary's if it follows one. */
static inline int32_t slc_priority_of(const slc_manager *m, const struct slc_managed_texture *t)
{
    return t->primary == SLC_NONE ? t->priority : slc_texture_at(m, t->primary)->priority;
}

/** True if some texture has had a priority other than 0. */
static inline bool slc_has_priorities(const slc_manager *m)
{
    return m->residency.user.weight;
}

/** Reorders waiting requests of a texture whose priority was `before`. They come behind waiting
 * requests of equal order. */
void slc_priority_changed(slc_manager *m, const struct slc_managed_texture *t, int32_t before);

/** Weights requests by the priority of their texture from now on. */
void slc_use_priorities(slc_manager *m);

#endif /* SLC_CORE_PRIORITY_H */
