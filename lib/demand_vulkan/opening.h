/** What workers do to open an image, and where its tiles lie. */
#ifndef SLC_DEMAND_VULKAN_OPENING_H
#define SLC_DEMAND_VULKAN_OPENING_H

#include "base/checked.h"
#include "demand_vulkan/loader.h"

/** Why an image cannot be a texture, or NULL. Reads no source. Any thread. */
const char *slc_image_trouble(const SluiceDemandLoader *loader, const SluiceImageInfo *info,
                              uint32_t array_layer);

/**
 * Gets the first texel of the last level of a texture, in linear light. `texel`: a block of
 * compressed formats. BC6H: mid gray, because it takes a decoder; the color is visible only if the
 * texture covers less than a pixel.
 */
void slc_base_color(SluiceFormat format, const void *texel, float rgba[4]);
/** The first texel of a BC7 block, as the format stores it: sRGB ones are not decoded. */
void slc_bc7_texel(const uint8_t block[16], float rgba[4]);

/** Tiles of a regular level. */
static inline uint32_t slc_image_level_width(const struct slc_demand_image *image, uint32_t level)
{
    return slc_div_up_u32(slc_mip_size(image->info.width, level), image->tile_width);
}
static inline uint32_t slc_image_level_height(const struct slc_demand_image *image, uint32_t level)
{
    return slc_div_up_u32(slc_mip_size(image->info.height, level), image->tile_height);
}
/** Coarse levels first: 1 + ceil(log4(tiles)), below SLUICE_DEMAND_RANKS. */
uint32_t slc_image_level_rank(const struct slc_demand_image *image, uint32_t level);

#endif /* SLC_DEMAND_VULKAN_OPENING_H */
