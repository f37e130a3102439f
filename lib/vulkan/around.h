/**
 * MinMip words that shaders read, one per region: the region's texel in the low half, and the
 * largest texel of the regions around it in the high half. See shaders/include/sluice/quick.glsl.
 */
#ifndef SLC_VULKAN_AROUND_H
#define SLC_VULKAN_AROUND_H

#include <stdbool.h>
#include <stdint.h>

/** The widest map: images of 2^20 texels, tiles of 64. */
#define SLC_MAX_MAP_WIDTH (1u << 14)
#define SLC_MAX_AROUND 2u
/** Texels of scratch that suffice for any row. */
#define SLC_AROUND_SCRATCH (2 * (SLC_MAX_MAP_WIDTH + SLC_MAX_AROUND))

struct slc_around {
    const uint16_t *texels; ///< [height][width]
    uint32_t width, height;
    uint32_t radius;       ///< regions, at most SLC_MAX_AROUND
    bool wraps_x, wraps_y; ///< the image repeats; else no regions are beyond its edges
};

/** Writes the words of a row. `scratch` has room for 2 * (width + radius) texels. */
void slc_around_row(const struct slc_around *around, uint32_t y, uint16_t *scratch,
                    uint32_t *words);

#endif /* SLC_VULKAN_AROUND_H */
