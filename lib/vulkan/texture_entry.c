#include "vulkan/texture_entry.h"

#include "base/checked.h"

#include <stdbool.h>

/* A short mip chain may halve evenly although the size is no power of two. */
static bool is_power_of_two(uint32_t size)
{
    return (size & (size - 1)) == 0;
}

/* True if footprints clamp. Border texels need no tiles, and footprints treat them as edge texels.
 */
static bool clamps_to_edge(uint32_t mode)
{
    return mode == SLUICE_ADDRESS_MODE_CLAMP_TO_EDGE || mode == SLUICE_ADDRESS_MODE_CLAMP_TO_BORDER;
}

void slc_texture_entry_complete(struct SluiceTextureEntry *entry)
{
    entry->sizeX = (float)entry->width;
    entry->sizeY = (float)entry->height;
    entry->regionLastX = entry->regionCountX - 1;
    entry->regionLastY = entry->regionCountY - 1;
    entry->shape = slc_log2_u32(entry->regionWidth) |
                   slc_log2_u32(entry->regionHeight) << SLUICE_SHAPE_HEIGHT_SHIFT |
                   entry->addressModeU << SLUICE_SHAPE_MODE_U_SHIFT |
                   entry->addressModeV << SLUICE_SHAPE_MODE_V_SHIFT |
                   (entry->mipLevelCount - 1) << SLUICE_SHAPE_LAST_LEVEL_SHIFT;
    bool even = !(entry->flags & SLUICE_TEXTURE_FLAG_UNEVEN);
    bool powers = is_power_of_two(entry->width) && is_power_of_two(entry->height);
    bool repeats = entry->addressModeU == SLUICE_ADDRESS_MODE_REPEAT &&
                   entry->addressModeV == SLUICE_ADDRESS_MODE_REPEAT;
    bool clamps = clamps_to_edge(entry->addressModeU) && clamps_to_edge(entry->addressModeV);
    entry->shape |= (entry->flags & SLUICE_TEXTURE_FLAG_SPLINE ? SLUICE_SHAPE_SPLINE : 0) |
                    (entry->flags & SLUICE_TEXTURE_FLAG_SMART ? SLUICE_SHAPE_SMART : 0);
    entry->shape |= entry->flags & SLUICE_TEXTURE_FLAG_PAGED ? SLUICE_SHAPE_PAGED : 0;
    entry->shape |= (even ? 0 : SLUICE_SHAPE_UNEVEN) | (repeats ? SLUICE_SHAPE_REPEATS : 0) |
                    (even && powers && (repeats || clamps) ? SLUICE_SHAPE_QUICK : 0);
}
