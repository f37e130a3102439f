/** Textures by their ids. */
#ifndef SLC_CORE_LOOKUP_H
#define SLC_CORE_LOOKUP_H

#include "core/state.h"

SluiceResult slc_find_texture(const slc_manager *m, SluiceTextureId id,
                              struct slc_managed_texture **out);
/** Finds one texture, or NULL for SLUICE_ALL_TEXTURES. Refuses SLUICE_NO_TEXTURE and logs why. */
SluiceResult slc_find_scope(const slc_manager *m, const char *function, SluiceTextureId id,
                            struct slc_managed_texture **out);

#endif /* SLC_CORE_LOOKUP_H */
