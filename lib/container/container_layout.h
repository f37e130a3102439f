/**
 * Where in a file the images of a texture lie: what headers of DDS and KTX2 come to, checked
 * against the file, so that nothing that is computed from it overflows or lies outside.
 */
#ifndef SLC_CONTAINER_CONTAINER_LAYOUT_H
#define SLC_CONTAINER_CONTAINER_LAYOUT_H

#include "image/input_file.h"
#include "image/mip.h"

/** Largest width and height; a texture cannot be larger either. */
#define SLC_CONTAINER_MAX_SIZE (1u << 20)
#define SLC_CONTAINER_MAX_LAYERS (1u << 16)

/** What happens to the texels of four bytes of a file whose format has no name here. */
enum slc_texel_change {
    SLC_SWAP_RED_BLUE = 1, ///< of B, G, R, A
    SLC_MAKE_OPAQUE = 2    ///< the fourth byte means nothing
};

struct slc_level_layout {
    uint64_t offset;       ///< of the first layer, from the start of the file
    uint64_t layer_stride; ///< bytes from one layer to the next, decompressed
    uint64_t stored_size;  ///< bytes in the file, of levels that are compressed as a whole
    uint64_t size;         ///< bytes of all layers, if they follow each other: when decompressed
};

struct slc_container_layout {
    uint32_t width, height;
    uint32_t level_count; ///< in the file; the full chain once it is checked
    uint32_t layer_count;
    bool cube; ///< layers are faces
    SluiceFormat format;
    unsigned changes;           ///< of enum slc_texel_change
    bool levels_are_compressed; ///< with Zstandard, each as a whole
    struct slc_level_layout levels[SLC_MAX_MIP_LEVELS];
};

/**
 * Whether the size, the layers and the number of levels are such as can be delivered. Errors:
 * CORRUPT_DATA, UNSUPPORTED; logged.
 */
SluiceResult slc_layout_check(const struct slc_container_layout *layout,
                              const struct slc_input_file *file);

/** Bytes of one layer of a level. At most 2^44 after the check. */
uint64_t slc_layout_image_size(const struct slc_container_layout *layout, uint32_t level);

/** Gives the texels another format. Errors: UNSUPPORTED, logged, if it does not mean the same
 *  bytes. UNDEFINED leaves them as they are. */
SluiceResult slc_layout_rename(struct slc_container_layout *layout,
                               const struct slc_input_file *file, SluiceFormat format);

/** A little-endian number of a header. */
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
