/** Queries for the streamer before it forgets textures. */
#ifndef SLC_CORE_FORGET_TEXTURE_H
#define SLC_CORE_FORGET_TEXTURE_H

#include <sluice/manager.h>

/** Returns whether some map of the texture counts, so that tiles of it are wanted. */
bool slc_manager_wants_texture(const SluiceStreamedTextureManager *manager, SluiceTextureId id);

#endif /* SLC_CORE_FORGET_TEXTURE_H */
