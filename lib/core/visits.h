/** Textures by the time of their last map. */
#ifndef SLC_CORE_VISITS_H
#define SLC_CORE_VISITS_H

#include "core/state.h"

/** Moves the texture to the end of the list of textures with requests, or removes it. */
void slc_visit(slc_manager *m, struct slc_managed_texture *t, bool holds);

#endif /* SLC_CORE_VISITS_H */
