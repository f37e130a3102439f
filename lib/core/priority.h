/** Which textures come first where memory or time is short for some of a level. */
#ifndef SLC_CORE_PRIORITY_H
#define SLC_CORE_PRIORITY_H

#include "core/state.h"

/** Priority of a texture: its own, or that of the primary that it follows. */
static inline int32_t slc_priority_of(const slc_manager *m, const struct slc_managed_texture *t)
{
    return t->primary == SLC_NONE ? t->priority : slc_texture_at(m, t->primary)->priority;
}

/** Some texture has had a priority other than 0. */
static inline bool slc_has_priorities(const slc_manager *m)
{
    return m->residency.user.weight;
}

/** The priority of a texture was `before`: its requests that wait get their new places, behind
 * those that are there. */
void slc_priority_changed(slc_manager *m, const struct slc_managed_texture *t, int32_t before);

/** From now on requests are weighted by the priority of their texture. */
void slc_use_priorities(slc_manager *m);

#endif /* SLC_CORE_PRIORITY_H */
