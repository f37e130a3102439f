/** Textures by the time of their last map. */
#ifndef SLC_CORE_VISITS_H
#define SLC_CORE_VISITS_H

#include "core/state.h"

/** Puts the texture at the end of the list of those that hold something, or takes it out. */
void slc_visit(slc_manager *m, struct slc_managed_texture *t, bool holds);

#endif /* SLC_CORE_VISITS_H */
