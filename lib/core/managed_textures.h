/** Textures are added and removed. */
#ifndef SLC_CORE_MANAGED_TEXTURES_H
#define SLC_CORE_MANAGED_TEXTURES_H

#include "core/state.h"

/** Frees all textures. */
void slc_textures_finish(slc_manager *m);

#endif /* SLC_CORE_MANAGED_TEXTURES_H */
