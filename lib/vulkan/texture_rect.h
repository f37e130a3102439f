/** Rectangles that the application gives: checks them, and converts them to tiles of level 0. */
#ifndef SLC_VULKAN_TEXTURE_RECT_H
#define SLC_VULKAN_TEXTURE_RECT_H

#include "vulkan/streamer.h"

#include <sluice/vulkan_control.h>

/** Rectangle [x0, x1) x [y0, y1). */
struct slc_tile_rect {
    uint32_t x0, y0, x1, y1;
};

/** Finds a live texture. Errors: UNKNOWN_TEXTURE; STALE_TEXTURE. */
SluiceResult slc_streamer_find(const SluiceVulkanStreamer *s, SluiceTextureId id,
                               struct slc_texture **texture);

/** Finds a texture that follows no other one. Errors: as slc_streamer_find; INVALID_ARGUMENT,
 * logged.
 */
SluiceResult slc_streamer_find_primary(const SluiceVulkanStreamer *s, SluiceTextureId id,
                                       struct slc_texture **texture);

/** Grid of `columns` x `rows` cells of `cell_width` x `cell_height` texels. */
struct slc_cells {
    uint32_t cell_width, cell_height, columns, rows;
};

/** Returns the cells that are texels of MinMip maps. */
static inline struct slc_cells slc_min_mip_cells(const SluiceStreamedTextureLayout *layout)
{
    return (struct slc_cells){layout->desc.tileWidth, layout->desc.tileHeight, layout->minMipWidth,
                              layout->minMipHeight};
}

/** Gets the cells that `rect` touches. Errors, logged: INVALID_ARGUMENT if it leaves the texture.
 */
SluiceResult slc_texture_rect_cells(const SluiceVulkanStreamer *s,
                                    const struct slc_texture *texture,
                                    const SluiceTextureRect *rect, const struct slc_cells *cells,
                                    struct slc_tile_rect *out);

#endif /* SLC_VULKAN_TEXTURE_RECT_H */
