/**
 * The tail of a texture: its levels that fit into half a tile, in one tile. The first of them is at
 * the left, those after it below one another at the right, none over another:
 *
 *     +-------+---+---+
 *     |       | 1 |   |     0: the first level of the tail
 *     |   0   +-+-+   |
 *     |       |2|     |
 *     |       +-+     |
 *     +-------+-------+
 *     |       | *     |     *: levels lower than a block, where texels come in blocks
 *     +-------+-------+
 *
 * All functions: for the shapes of sluiceGetStandardTileShape. GLSL twin: sluiceDemandTailPlace in
 * shaders/include/sluice/demand_texels.glsl.
 */
#ifndef SLC_DEMAND_TAIL_PLACE_H
#define SLC_DEMAND_TAIL_PLACE_H

#include "base/checked.h"

/** How many levels have tiles of their own: those wider or higher than half a tile. So it is the
 *  first level of the tail, too, which always has one: the last level is 1x1. */
static inline uint32_t slc_demand_regular_count(uint32_t width, uint32_t height,
                                                uint32_t tile_width, uint32_t tile_height)
{
    uint32_t count = 0;
    while (slc_mip_size(width, count) > tile_width / 2 ||
           slc_mip_size(height, count) > tile_height / 2)
        count++;
    return count;
}

struct slc_demand_place {
    uint32_t x, y; ///< texels from the tile's corner; in block-compressed formats multiples of 4
};

/** Where level `k` of the tail begins: 0 is its first. `blocks`: texels come in blocks of 4x4. */
static inline struct slc_demand_place
slc_demand_tail_place(uint32_t tile_width, uint32_t tile_height, bool blocks, uint32_t k)
{
    if (k == 0)
        return (struct slc_demand_place){0, 0};
    uint32_t half = tile_height / 2;
    uint32_t y = half - (half >> (k - 1));
    if (blocks && half >> k < 4)
        y = half + 4 * (k - (slc_log2_u32(half) - 1)); /* 4 rows for each level below 4 */
    return (struct slc_demand_place){tile_width / 2, y};
}

#endif /* SLC_DEMAND_TAIL_PLACE_H */
