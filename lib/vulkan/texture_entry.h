/** Derived fields of entries of the texture table. */
#ifndef SLC_VULKAN_TEXTURE_ENTRY_H
#define SLC_VULKAN_TEXTURE_ENTRY_H

#include <sluice/shared/texture_table.h>

/**
 * Fills in sizeX, sizeY, shape, regionLastX and regionLastY, from width, height, mipLevelCount,
 * regionWidth, regionHeight, regionCountX, regionCountY, the address modes and flags. Region sizes
 * must be powers of two along axes with more than one region.
 */
void slc_texture_entry_complete(struct SluiceTextureEntry *entry);

#endif /* SLC_VULKAN_TEXTURE_ENTRY_H */
