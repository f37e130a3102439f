/** Opening of images on worker threads, and grids of their tiles. */
#ifndef SLC_DEMAND_VULKAN_OPENING_H
#define SLC_DEMAND_VULKAN_OPENING_H

#include "base/checked.h"
#include "demand_vulkan/loader.h"

/** Returns why an image cannot be a texture, or NULL. Reads no source. Any thread. */
const char *slc_image_trouble(const SluiceDemandLoader *loader, const SluiceImageInfo *info,
                              uint32_t array_layer);

/**
 * Gets the first texel of the last level of a texture, in linear light. `texel`: a block of
 * compressed formats. BC6H: mid gray, because it takes a decoder; the color is visible only if the
 * texture covers less than a pixel.
 */
void slc_base_color(SluiceFormat format, const void *texel, float rgba[4]);
/** Gets the first texel of a BC7 block as stored, without sRGB decoding. */
void slc_bc7_texel(const uint8_t block[16], float rgba[4]);

/** Width and height of a regular level in tiles. */
static inline uint32_t slc_image_level_width(const struct slc_demand_image *image, uint32_t level)
{
    return slc_div_up_u32(slc_mip_size(image->info.width, level), image->tile_width);
}
static inline uint32_t slc_image_level_height(const struct slc_demand_image *image, uint32_t level)
{
    return slc_div_up_u32(slc_mip_size(image->info.height, level), image->tile_height);
}
/** Returns a level's rank, low for coarse levels: 1 + ceil(log4(tiles)), below SLUICE_DEMAND_RANKS.
 */
uint32_t slc_image_level_rank(const struct slc_demand_image *image, uint32_t level);

#endif /* SLC_DEMAND_VULKAN_OPENING_H */
