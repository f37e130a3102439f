/** Textures by their ids. */
#ifndef SLC_CORE_LOOKUP_H
#define SLC_CORE_LOOKUP_H

#include "core/state.h"

SluiceResult slc_find_texture(const slc_manager *m, SluiceTextureId id,
                              struct slc_managed_texture **out);
/** SLUICE_ALL_TEXTURES gives NULL. SLUICE_NO_TEXTURE is refused, in the name of `function`. */
SluiceResult slc_find_scope(const slc_manager *m, const char *function, SluiceTextureId id,
                            struct slc_managed_texture **out);

#endif /* SLC_CORE_LOOKUP_H */
