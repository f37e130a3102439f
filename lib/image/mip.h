/** Full mip chain in memory. Levels are made by an area-weighted box filter. */
#ifndef SLC_IMAGE_MIP_H
#define SLC_IMAGE_MIP_H

#include <sluice/image.h>

#define SLC_MAX_MIP_LEVELS 32

/** Mip chain: levels in sequence, finest first, with tightly packed rows. */
struct slc_mip_chain {
    SluiceFormat format;
    uint32_t width, height;
    uint32_t level_count;
    size_t offsets[SLC_MAX_MIP_LEVELS]; ///< byte offset of each level
    size_t size;                        ///< bytes of all levels
    char *texels;
};

/** Returns the bytes of all levels, for uncompressed formats; UINT64_MAX beyond 64 bits. */
uint64_t slc_mip_chain_size(SluiceFormat format, uint32_t width, uint32_t height);

/** Rectangle of a level in memory. */
struct slc_mip_part {
    uint32_t level_width, level_height; ///< texels of the whole level
    uint32_t x, y, width, height;       ///< texels
    char *texels;
    size_t pitch; ///< bytes
};

/** Sets the rectangle of `fine` to the texels of the next finer level under `coarse`. */
void slc_mip_part_cover(const struct slc_mip_part *coarse, struct slc_mip_part *fine);

/** Scratch rows of both levels, [width][4]. */
struct slc_mip_rows {
    float *source; ///< owned, like the next two
    double *sum;
    float *result;
    uint32_t width;
};

/** Returns the bytes of rows of a width, which slc_mip_chain_build also takes. */
uint64_t slc_mip_rows_size(uint32_t width);
/** Allocates rows. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_mip_rows_init(struct slc_mip_rows *rows, const SluiceAllocationCallbacks *cb,
                               uint32_t width);
void slc_mip_rows_finish(struct slc_mip_rows *rows, const SluiceAllocationCallbacks *cb);

/**
 * Makes `coarse` from `fine`, whose rectangle slc_mip_part_cover has set. Each texel is the mean of
 * the area that it covers, in linear light for sRGB formats; NaN counts as 0. A texel of an integer
 * format is the fine texel at its center. If two are there, levels take the right or lower one and
 * the left or upper one in turns. `rows` must be at least as wide as `fine`. The result does not
 * depend on how a level is cut into parts.
 */
void slc_mip_filter(SluiceFormat format, const struct slc_mip_part *fine,
                    const struct slc_mip_part *coarse, const struct slc_mip_rows *rows);

/** Allocates all levels, with undefined texels. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_mip_chain_init(struct slc_mip_chain *chain, const SluiceAllocationCallbacks *cb,
                                SluiceFormat format, uint32_t width, uint32_t height);

void slc_mip_chain_finish(struct slc_mip_chain *chain, const SluiceAllocationCallbacks *cb);

static inline char *slc_mip_chain_level(const struct slc_mip_chain *chain, uint32_t level)
{
    return chain->texels + chain->offsets[level];
}

/**
 * Makes every level from the stored one above it with slc_mip_filter. Only levels below the first
 * can hold fewer infinities than the file: half formats saturate. Errors: OUT_OF_HOST_MEMORY.
 */
SluiceResult slc_mip_chain_build(struct slc_mip_chain *chain, const SluiceAllocationCallbacks *cb);

/** Copies a region that lies inside its level. */
void slc_mip_chain_read(const struct slc_mip_chain *chain, const SluiceImageRegion *region,
                        void *texels, size_t row_pitch);

#endif /* SLC_IMAGE_MIP_H */
