#include "vulkan/touched_tiles.h"

#include "base/alloc.h"
#include "base/checked.h"

#include <assert.h>

SluiceResult slc_touched_tiles_init(struct slc_touched_tiles *tiles,
                                    const SluiceAllocationCallbacks *cb,
                                    struct slc_touch_budget *budget, uint32_t tile_count,
                                    uint32_t first_packed)
{
    *tiles = (struct slc_touched_tiles){.tile_count = tile_count};
    if (budget->limit == 0)
        return SLUICE_SUCCESS;
    if (tile_count - first_packed > budget->limit - budget->count)
        return SLUICE_ERROR_LIMIT_EXCEEDED;
    tiles->bits = slc_calloc(cb, slc_div_up_u32(tile_count, 32), sizeof *tiles->bits);
    if (!tiles->bits)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint32_t tile = first_packed; tile < tile_count; tile++)
        slc_touched_tiles_touch(tiles, budget, tile);
    return SLUICE_SUCCESS;
}

void slc_touched_tiles_finish(struct slc_touched_tiles *tiles, const SluiceAllocationCallbacks *cb,
                              struct slc_touch_budget *budget)
{
    assert(tiles->count <= budget->count);
    budget->count -= tiles->count;
    slc_free(cb, tiles->bits, slc_div_up_u32(tiles->tile_count, 32), sizeof *tiles->bits);
    *tiles = (struct slc_touched_tiles){0};
}

static bool is_touched(const struct slc_touched_tiles *tiles, uint32_t tile)
{
    assert(tile < tiles->tile_count);
    return !tiles->bits || tiles->bits[tile / 32] >> tile % 32 & 1;
}

bool slc_touched_tiles_may_touch(const struct slc_touched_tiles *tiles,
                                 const struct slc_touch_budget *budget, uint32_t tile)
{
    return is_touched(tiles, tile) || budget->count < budget->limit;
}

bool slc_touched_tiles_touch(struct slc_touched_tiles *tiles, struct slc_touch_budget *budget,
                             uint32_t tile)
{
    if (is_touched(tiles, tile))
        return true;
    if (!slc_touched_tiles_may_touch(tiles, budget, tile))
        return false;
    tiles->bits[tile / 32] |= 1u << tile % 32;
    tiles->count++;
    budget->count++;
    return true;
}
