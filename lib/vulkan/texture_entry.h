/** The parts of a texture table's entry that follow from others. */
#ifndef SLC_VULKAN_TEXTURE_ENTRY_H
#define SLC_VULKAN_TEXTURE_ENTRY_H

#include <sluice/shared/texture_table.h>

/**
 * Fills in sizeX, sizeY, shape, regionLastX and regionLastY, by width, height, mipLevelCount,
 * regionWidth, regionHeight, regionCountX, regionCountY, the address modes and flags. Where there
 * is more than one region their sizes are powers of two.
 */
void slc_texture_entry_complete(struct SluiceTextureEntry *entry);

#endif /* SLC_VULKAN_TEXTURE_ENTRY_H */
