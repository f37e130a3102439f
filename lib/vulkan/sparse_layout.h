/** Layout of a sparse image: tiles and packed pages. Pure arithmetic on the values of a driver. */
#ifndef SLC_VULKAN_SPARSE_LAYOUT_H
#define SLC_VULKAN_SPARSE_LAYOUT_H

#include <sluice/vulkan.h>

#define SLC_TILE_SIZE 65536u
/** Level of a place in the driver's mip tail. */
#define SLC_TAIL_LEVEL UINT32_MAX

struct slc_sparse_layout {
    SluiceStreamedTextureDesc desc;
    /** The driver has a mip tail, bound opaquely. Otherwise each packed tile is a whole level. */
    bool opaque_tail;
    uint64_t tail_offset, tail_size; ///< bytes, of the first layer
    uint64_t tail_stride;            ///< bytes between the tails of consecutive layers
    uint64_t metadata_offset, metadata_size, metadata_stride; ///< bytes; size 0: none to bind
    bool uneven; ///< some level's size is not twice the next one's
};

/** Returns the extent of a tile in texels, from a granularity that may count blocks. */
VkExtent3D slc_sparse_tile_extent(const SluiceFormatInfo *format, VkExtent3D granularity);

/** True if all layers of an array share one mip tail, which cannot be bound layer by layer. */
bool slc_sparse_layers_share_tail(const SluiceImageInfo *info,
                                  const VkSparseImageMemoryRequirements *color);

/**
 * Computes the layout, which is equal for all layers of an array. `metadata` may be NULL. Errors:
 * UNSUPPORTED if the driver's tiles are not 64 KiB pages, the layers of an array share one tail, or
 * the image is larger than `address_space_size`.
 */
SluiceResult slc_sparse_layout_init(struct slc_sparse_layout *layout, const SluiceImageInfo *info,
                                    const VkMemoryRequirements *memory,
                                    const VkSparseImageMemoryRequirements *color,
                                    const VkSparseImageMemoryRequirements *metadata,
                                    uint64_t address_space_size);

/**
 * Computes a layout without a driver: tiles have the standard shape, and levels that fit into one
 * tile are packed. The packed levels count as the tiles that their texels fill. Errors: UNSUPPORTED
 * if the format has no standard shape.
 */
SluiceResult slc_standard_layout_init(struct slc_sparse_layout *layout,
                                      const SluiceImageInfo *info);
/** Makes the layout of an image that is loaded as a whole: all levels are packed. */
SluiceResult slc_whole_layout_init(struct slc_sparse_layout *layout, const SluiceImageInfo *info);
/** True if level 0 is no larger than a tile of the standard shape. */
bool slc_fits_into_tile(const SluiceImageInfo *info);

/** Position of a tile: level and tile coordinates, or SLC_TAIL_LEVEL and page number in `x`. */
struct slc_tile_place {
    uint32_t level, x, y;
};
struct slc_tile_place slc_sparse_layout_place(const struct slc_sparse_layout *layout,
                                              const SluiceTile *tile);

#endif /* SLC_VULKAN_SPARSE_LAYOUT_H */
