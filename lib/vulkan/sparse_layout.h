/** How a sparse image is cut into tiles and packed pages: pure arithmetic over what a driver says.
 */
#ifndef SLC_VULKAN_SPARSE_LAYOUT_H
#define SLC_VULKAN_SPARSE_LAYOUT_H

#include <sluice/vulkan.h>

#define SLC_TILE_SIZE 65536u
/** In place of a level: a page of the driver's mip tail. */
#define SLC_TAIL_LEVEL UINT32_MAX

struct slc_sparse_layout {
    SluiceStreamedTextureDesc desc;
    /** The driver has a mip tail, bound opaquely. Otherwise each packed tile is a whole level. */
    bool opaque_tail;
    uint64_t tail_offset, tail_size; ///< of the first layer
    uint64_t tail_stride;            ///< from one layer's tail to the next one's
    uint64_t metadata_offset, metadata_size, metadata_stride; ///< size 0: none to bind
    bool uneven; ///< some level's size is not twice the next one's
};

/** The extent of a tile in texels: the granularity, or what a driver means that counts blocks. */
VkExtent3D slc_sparse_tile_extent(const SluiceFormatInfo *format, VkExtent3D granularity);

/** Whether the layers of an array have but one mip tail, which cannot be bound layer by layer. */
bool slc_sparse_layers_share_tail(const SluiceImageInfo *info,
                                  const VkSparseImageMemoryRequirements *color);

/**
 * The same for all layers of an array. `metadata` may be NULL. Errors: UNSUPPORTED if the driver's
 * tiles are not 64 KiB pages, the layers of an array share one tail, or the image is larger than
 * `address_space_size`.
 */
SluiceResult slc_sparse_layout_init(struct slc_sparse_layout *layout, const SluiceImageInfo *info,
                                    const VkMemoryRequirements *memory,
                                    const VkSparseImageMemoryRequirements *color,
                                    const VkSparseImageMemoryRequirements *metadata,
                                    uint64_t address_space_size);

/**
 * Of images that no driver cuts into tiles: the standard shapes, and the levels packed that fit
 * into one tile; they count as the tiles that their texels together fill. Errors: UNSUPPORTED if
 * the format has no standard shape.
 */
SluiceResult slc_standard_layout_init(struct slc_sparse_layout *layout,
                                      const SluiceImageInfo *info);
/** For an image with memory for all levels that is loaded as a whole: all levels are packed. */
SluiceResult slc_whole_layout_init(struct slc_sparse_layout *layout, const SluiceImageInfo *info);
/** Whether level 0 is no larger than a tile of the standard shape. */
bool slc_fits_into_tile(const SluiceImageInfo *info);

/** Where a tile lies: level and tile coordinates, or SLC_TAIL_LEVEL and page number in `x`. */
struct slc_tile_place {
    uint32_t level, x, y;
};
struct slc_tile_place slc_sparse_layout_place(const struct slc_sparse_layout *layout,
                                              const SluiceTile *tile);

#endif /* SLC_VULKAN_SPARSE_LAYOUT_H */
