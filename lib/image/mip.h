/** A full mip chain in memory, its levels made by an area-weighted box filter. */
#ifndef SLC_IMAGE_MIP_H
#define SLC_IMAGE_MIP_H

#include <sluice/image.h>

#define SLC_MAX_MIP_LEVELS 32

/** Levels one after the other, finest first, rows tightly packed. */
struct slc_mip_chain {
    SluiceFormat format;
    uint32_t width, height;
    uint32_t level_count;
    size_t offsets[SLC_MAX_MIP_LEVELS]; ///< of each level, in bytes
    size_t size;                        ///< of all levels, in bytes
    char *texels;
};

/** Bytes of all levels of a format that is not compressed; UINT64_MAX beyond 64 bits. */
uint64_t slc_mip_chain_size(SluiceFormat format, uint32_t width, uint32_t height);

/** A rectangle of a level, in memory. */
struct slc_mip_part {
    uint32_t level_width, level_height; ///< texels of the whole level
    uint32_t x, y, width, height;       ///< texels
    char *texels;
    size_t pitch; ///< bytes
};

/** Sets the rectangle of `fine`, in the next finer level, to what `coarse` is made from. */
void slc_mip_part_cover(const struct slc_mip_part *coarse, struct slc_mip_part *fine);

/** Rows of the finer level and of the one that is made, as [width][4]. */
struct slc_mip_rows {
    float *source; ///< owned, like the next two
    double *sum;
    float *result;
    uint32_t width;
};

/** Bytes that rows of a width take, and slc_mip_chain_build meanwhile. */
uint64_t slc_mip_rows_size(uint32_t width);
/** Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_mip_rows_init(struct slc_mip_rows *rows, const SluiceAllocationCallbacks *cb,
                               uint32_t width);
void slc_mip_rows_finish(struct slc_mip_rows *rows, const SluiceAllocationCallbacks *cb);

/**
 * Makes `coarse` from `fine`, which slc_mip_part_cover has given its rectangle: each texel is the
 * mean of the area that it covers, in linear light for sRGB formats; NaN counts as 0. A texel of an
 * integer format is the fine texel at its center; of two, the right or lower one and the left or
 * upper one in turns of levels. `rows` are at least as wide as `fine`. The result does not depend
 * on how a level is cut into parts.
 */
void slc_mip_filter(SluiceFormat format, const struct slc_mip_part *fine,
                    const struct slc_mip_part *coarse, const struct slc_mip_rows *rows);

/** Room for all levels; what it holds is undefined. Errors: OUT_OF_HOST_MEMORY. */
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
