/** Adding, removing and restoring textures. */
#ifndef SLC_CORE_MANAGED_TEXTURES_H
#define SLC_CORE_MANAGED_TEXTURES_H

#include "core/state.h"

/** Frees all textures. */
void slc_textures_finish(slc_manager *m);

/**
 * Adds the texture with the next index from a snapshot, without tiles. `desc` NULL: the index is
 * free. Errors: OUT_OF_HOST_MEMORY; errors of sluiceAddStreamedTexture for `desc`.
 */
SluiceResult slc_texture_restore(slc_manager *m, uint32_t generation,
                                 const SluiceStreamedTextureDesc *desc);
/** Ends the restoration of textures: collects the free indices. */
void slc_textures_restored(slc_manager *m);

#endif /* SLC_CORE_MANAGED_TEXTURES_H */
