#include "vulkan/unmet_budget.h"

#include "base/checked.h"
#include "base/log.h"
#include "vulkan/memory_budget.h"

/* Frames without freed memory until the warning. Emptying a heap takes its tiles / tiles evicted
 * per frame; its memory is freed after the frames in flight. */
#define PATIENCE 64u
#define TILES_PER_FRAME 16u /* assumed evictions per frame; at most tilesPerFrame */

static uint32_t count_packed_tiles(const SluiceVulkanStreamer *s)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->texture_high; i++)
        count += s->textures[i].packed_mapped;
    return count;
}

static void tell(SluiceVulkanStreamer *s)
{
    SluiceVulkanContextStatistics all = {.structSize = sizeof all};
    slc_memory_budget_get(&s->context->budget, &all);
    if (all.tileMemorySize <= all.memoryBudget)
        return;
    slc_log(
        &s->vk.log, SLUICE_LOG_WARNING,
        "the memory budget of %llu bytes cannot be reached: %llu bytes too many stay in use. In "
        "use are %llu bytes of images, %llu of heaps, %llu of pages and %llu of byte pages. This "
        "streamer keeps %u packed tiles, and up to %u tiles as its last heap",
        (unsigned long long)all.memoryBudget,
        (unsigned long long)(all.tileMemorySize - all.memoryBudget),
        (unsigned long long)all.imageMemorySize, (unsigned long long)all.heapMemorySize,
        (unsigned long long)all.pageMemorySize, (unsigned long long)all.byteMemorySize,
        count_packed_tiles(s), s->info.heapTileCapacity);
}

void slc_unmet_budget_step(SluiceVulkanStreamer *s)
{
    struct slc_unmet_budget *unmet = &s->unmet_budget;
    if (s->memory_pressure.beyond == 0) {
        *unmet = (struct slc_unmet_budget){0};
        return;
    }
    uint64_t size = slc_memory_budget_tile_memory(&s->context->budget);
    if (size != unmet->size)
        unmet->frames = 0;
    unmet->size = size;
    uint32_t leaving = slc_min_u32(TILES_PER_FRAME, s->info.tilesPerFrame);
    if (unmet->told || ++unmet->frames < PATIENCE + s->info.heapTileCapacity / leaving)
        return;
    unmet->told = true;
    tell(s);
}
