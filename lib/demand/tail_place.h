/**
 * Places of mip tails in pages. The mip tail of a texture is its levels that fit into half a tile.
 * Tails share pages. A page is cut into equal cells, and a cell into slots, one for each tail. The
 * first levels of three tails are quarters of the cell. The fourth quarter is cut in the same way
 * for their next levels, and so on:
 *
 *     +-------+-------+
 *     |       |       |
 *     |  A0   |  B0   |     three tails A, B and C of 64x64 RGBA8 texels
 *     |       |       |     take a page of 128x128 texels, except one texel
 *     +-------+---+---+
 *     |       |A1 |B1 |
 *     |  C0   +---+-+-+
 *     |       |C1 +-+-+
 *     +-------+---+-+-+
 *
 * The quarters end at one texel, or one block. Tails with levels beyond that leave slot C empty,
 * and have those levels at the beginning of C0.
 *
 * All functions: for the shapes of sluiceGetStandardTileShape, which are squares or twice as wide
 * as high. GLSL twin: sluiceDemandTailPlace in shaders/include/sluice/demand_texels.glsl.
 */
#ifndef SLC_DEMAND_TAIL_PLACE_H
#define SLC_DEMAND_TAIL_PLACE_H

#include "base/checked.h"

#include <sluice/shared/demand.h>

#include <stdbool.h>

/** Returns the number of levels with tiles of their own: those wider or higher than half a tile. It
 *  is the first level of the tail, too. The mip chain must reach that level. */
static inline uint32_t slc_demand_regular_count(uint32_t width, uint32_t height,
                                                uint32_t tile_width, uint32_t tile_height)
{
    uint32_t count = 0;
    while (slc_mip_size(width, count) > tile_width / 2 ||
           slc_mip_size(height, count) > tile_height / 2)
        count++;
    return count;
}

/** Partition of a page for tails of one size. */
struct slc_tail_cut {
    uint32_t cell;                    ///< 0: the page is one cell; 1 to 3: SLUICE_DEMAND_CELL_SIDE
    uint32_t slots;                   ///< slots per cell: 2 or 3
    uint32_t columns, rows;           ///< cells per page
    uint32_t cell_width, cell_height; ///< texels
};

/** Returns the number of levels that are in quarters of a cell. */
static inline uint32_t slc_tail_quarters(uint32_t cell_height, bool blocks)
{
    return slc_log2_u32(cell_height / (blocks ? 4 : 1));
}

/** Returns the partition with the smallest cells for a tail whose first level has these texels. */
static inline struct slc_tail_cut slc_tail_cut(uint32_t tile_width, uint32_t tile_height,
                                               bool blocks, uint32_t width, uint32_t height,
                                               uint32_t levels)
{
    struct slc_tail_cut cut = {.cell_width = tile_width, .cell_height = tile_height};
    while (cut.cell < 3 && slc_max_u32(width, height) <= tile_height >> (cut.cell + 1)) {
        cut.cell++;
        cut.cell_width = cut.cell_height = SLUICE_DEMAND_CELL_SIDE(tile_height, cut.cell);
    }
    cut.columns = tile_width / cut.cell_width;
    cut.rows = tile_height / cut.cell_height;
    cut.slots = levels > slc_tail_quarters(cut.cell_height, blocks) ? 2 : 3;
    return cut;
}

static inline uint32_t slc_tail_slot_count(const struct slc_tail_cut *cut)
{
    return cut->columns * cut->rows * cut->slots;
}

/** Returns the bits of a page's word that name the slot, not 0. Other bits name chunk and layer. */
static inline uint32_t slc_tail_slot_bits(const struct slc_tail_cut *cut, uint32_t slot)
{
    uint32_t cell = slot / cut->slots;
    return (1 + slot % cut->slots) << SLUICE_DEMAND_SLOT_SHIFT |
           cut->cell << SLUICE_DEMAND_CELL_SHIFT |
           cell % cut->columns << SLUICE_DEMAND_CELL_X_SHIFT |
           cell / cut->columns << SLUICE_DEMAND_CELL_Y_SHIFT;
}

static inline uint32_t slc_tail_slot_of(const struct slc_tail_cut *cut, uint32_t word)
{
    uint32_t x = word >> SLUICE_DEMAND_CELL_X_SHIFT & 7, y = word >> SLUICE_DEMAND_CELL_Y_SHIFT & 3;
    return (y * cut->columns + x) * cut->slots + (word >> SLUICE_DEMAND_SLOT_SHIFT & 3) - 1;
}

static inline bool slc_is_tail_word(uint32_t word)
{
    return (word >> SLUICE_DEMAND_SLOT_SHIFT & 3) != 0;
}

struct slc_demand_place {
    uint32_t x, y; ///< texels from the page's corner; in block-compressed formats multiples of 4
};

/** Returns the position of level `k` of the tail, counted from 0. `word` has the slot bits.
 * `blocks`: the format has blocks of 4x4 texels. */
static inline struct slc_demand_place slc_demand_tail_place(uint32_t tile_width,
                                                            uint32_t tile_height, bool blocks,
                                                            uint32_t word, uint32_t k)
{
    uint32_t n = word >> SLUICE_DEMAND_CELL_SHIFT & 3, block = blocks ? 4 : 1;
    uint32_t height = n ? SLUICE_DEMAND_CELL_SIDE(tile_height, n) : tile_height;
    uint32_t width = n ? height : tile_width;
    uint32_t slot = (word >> SLUICE_DEMAND_SLOT_SHIFT & 3) - 1;
    uint32_t x = (word >> SLUICE_DEMAND_CELL_X_SHIFT & 7) * width;
    uint32_t y = (word >> SLUICE_DEMAND_CELL_Y_SHIFT & 3) * height;
    if (height >> (k + 1) >= block)
        return (struct slc_demand_place){x + width - (width >> k) + (slot & 1) * (width >> (k + 1)),
                                         y + height - (height >> k) +
                                             (slot >> 1) * (height >> (k + 1))};
    return (struct slc_demand_place){x + (4 * slot + k - slc_tail_quarters(height, blocks)) * block,
                                     y + height / 2};
}

#endif /* SLC_DEMAND_TAIL_PLACE_H */
