/**
 * Container layout: offsets and sizes of a texture's images in a file, from the header of a DDS or
 * KTX2 file. After slc_layout_check, all images lie in the file and sums do not overflow.
 */
#ifndef SLC_CONTAINER_CONTAINER_LAYOUT_H
#define SLC_CONTAINER_CONTAINER_LAYOUT_H

#include "image/input_file.h"
#include "image/mip.h"

/** Largest width and height, equal to the limit of textures. */
#define SLC_CONTAINER_MAX_SIZE (1u << 20)
#define SLC_CONTAINER_MAX_LAYERS (1u << 16)

/** Changes to texels of four bytes, for file formats without a SluiceFormat. */
enum slc_texel_change {
    SLC_SWAP_RED_BLUE = 1, ///< from B, G, R, A
    SLC_MAKE_OPAQUE = 2    ///< the fourth byte is undefined; it becomes 255
};

struct slc_level_layout {
    uint64_t offset;       ///< bytes from the start of the file to the first layer
    uint64_t layer_stride; ///< bytes from one layer to the next, decompressed
    uint64_t stored_size;  ///< bytes in the file, for levels compressed as a whole
    uint64_t size;         ///< decompressed bytes of all layers, for contiguous layers
};

struct slc_container_layout {
    uint32_t width, height;
    uint32_t level_count; ///< in the file; the full chain once it is checked
    uint32_t layer_count;
    bool cube; ///< layers are faces
    SluiceFormat format;
    unsigned changes;           ///< flags of enum slc_texel_change
    bool levels_are_compressed; ///< each level as a whole, with Zstandard
    struct slc_level_layout levels[SLC_MAX_MIP_LEVELS];
};

/**
 * Checks that size, layers and number of levels are supported. Errors, logged: CORRUPT_DATA,
 * UNSUPPORTED.
 */
SluiceResult slc_layout_check(const struct slc_container_layout *layout,
                              const struct slc_input_file *file);

/** Returns the bytes of one layer of a level. At most 2^44 after the check. */
uint64_t slc_layout_image_size(const struct slc_container_layout *layout, uint32_t level);

/** Changes the format to another with the same bytes. UNDEFINED keeps the format. Errors, logged:
 * UNSUPPORTED for a format with different bytes. */
SluiceResult slc_layout_rename(struct slc_container_layout *layout,
                               const struct slc_input_file *file, SluiceFormat format);

/** Reads a little-endian number of a header. */
static inline uint32_t slc_u32_at(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 |
           (uint32_t)bytes[3] << 24;
}

static inline uint64_t slc_u64_at(const uint8_t *bytes)
{
    return slc_u32_at(bytes) | (uint64_t)slc_u32_at(bytes + 4) << 32;
}

#endif /* SLC_CONTAINER_CONTAINER_LAYOUT_H */
