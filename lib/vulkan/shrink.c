#include "vulkan/shrink.h"

#include "base/checked.h"
#include "core/observer.h"
#include "vulkan/load_deferred.h"
#include "vulkan/page_leaving.h"
#include "vulkan/residencies.h"

#define HEAPS_AT_ONCE 16u
/* Frames in which tiles can be read to the pages for which a heap was released. */
#define FRAMES_FOR_PAGES 8u
/* Frames in which tiles that were given back are requested again. */
#define FRAMES_OF_LACK 4u
/* Few, because a wanted tile that is evicted shows a coarser level until it is read again. */
#define MOVES_PER_FRAME 64u

static uint64_t without(uint64_t amount, uint64_t taken)
{
    return amount > taken ? amount - taken : 0;
}

static uint64_t div_up(uint64_t a, uint64_t b)
{
    return a / b + (a % b > 0);
}

/* Returns the heaps needed for all wanted tiles and for the slots reserved for packed tiles. */
static uint64_t needed_heaps(const SluiceVulkanStreamer *s,
                             const SluiceStreamedTextureStatistics *stats)
{
    uint64_t tiles = (uint64_t)stats->mappedTileCount + stats->allocatedTileCount +
                     stats->requestedTileCount + stats->canceledTileCount +
                     stats->reservedSlotCount;
    return div_up(tiles, s->info.heapTileCapacity);
}

/* Returns the number of heaps to keep; 0: all. Released heaps count as freed already. */
static uint32_t choose_target(const SluiceVulkanStreamer *s,
                              const SluiceStreamedTextureStatistics *stats)
{
    const uint64_t size = (uint64_t)s->info.heapTileCapacity * SLC_TILE_SIZE;
    const struct slc_memory_pressure *pressure = &s->memory_pressure;
    uint64_t live = stats->heapCount, going = s->residency->interface->going_size(s->residency);
    if (s->paged)
        going += slc_page_pool_going_size(s->pages);
    uint64_t beyond = without(pressure->beyond, going);
    uint64_t refused = without(pressure->refused, without(going, pressure->beyond));
    uint64_t target = live;
    if (refused) {
        uint64_t needed = needed_heaps(s, stats);
        target = without(live, div_up(refused, size));
        target = target > needed ? target : slc_min_u64(needed, live);
    }
    if (beyond)
        target = slc_min_u64(target, without(live, div_up(beyond, size)));
    if (!pressure->beyond && target == live && s->frame >= s->shrink.pages_until)
        return 0; /* a target would forbid new heaps until the last released ones are freed */
    return target ? (uint32_t)target : 1;
}

static void note_own_target(SluiceVulkanStreamer *s)
{
    if (slc_manager_config_count(s->manager) != s->shrink.config_count)
        s->shrink.own_target = slc_manager_config(s->manager)->targetHeapCount;
}

SluiceResult slc_shrink_set_config(SluiceVulkanStreamer *s,
                                   const SluiceStreamedTextureManagerConfig *config)
{
    note_own_target(s);
    SluiceResult result = sluiceSetConfig(s->manager, config);
    s->shrink.config_count = slc_manager_config_count(s->manager);
    return slc_streamer_check(s, result, "sluiceSetConfig");
}

/* Sets the smaller one of this target and the application's own target. */
static SluiceResult set_target(SluiceVulkanStreamer *s, uint32_t target)
{
    struct slc_shrink *shrink = &s->shrink;
    SluiceStreamedTextureManagerConfig config = *slc_manager_config(s->manager);
    config.structSize = sizeof config;
    note_own_target(s);
    if (shrink->own_target && (!target || target > shrink->own_target))
        target = shrink->own_target;
    shrink->target = target;
    if (config.targetHeapCount == target)
        return SLUICE_SUCCESS;
    config.targetHeapCount = target;
    return slc_shrink_set_config(s, &config);
}

static uint32_t count_evicted(SluiceVulkanStreamer *s)
{
    uint32_t count = 0;
    sluiceGetTilesToUnmap(s->manager, SLUICE_ALL_TEXTURES, s->frame, &count, NULL);
    return count;
}

static SluiceResult release_empty_heaps(SluiceVulkanStreamer *s)
{
    uint32_t heaps[HEAPS_AT_ONCE], count = HEAPS_AT_ONCE;
    SluiceResult result = sluiceGetEmptyHeaps(s->manager, &count, heaps);
    for (uint32_t i = 0; i < count && result >= 0; i++)
        result = sluiceReleaseHeap(s->manager, heaps[i]);
    return slc_streamer_check(s, result, "sluiceReleaseHeap");
}

/* Out of memory is no error: the next frame tries again. */
static SluiceResult evacuate(SluiceVulkanStreamer *s, uint32_t count)
{
    SluiceResult result = sluiceEvacuateHeaps(s->manager, count);
    return result == SLUICE_ERROR_OUT_OF_HOST_MEMORY
               ? SLUICE_SUCCESS
               : slc_streamer_check(s, result, "sluiceEvacuateHeaps");
}

/* Moves tiles together in the manager's heaps. In paged mode heaps have no memory, so nothing is
 * copied. */
static SluiceResult count_together(SluiceVulkanStreamer *s)
{
    SluiceTileMove moves[MOVES_PER_FRAME];
    SluiceResult result = SLUICE_SUCCESS;
    uint32_t count = MOVES_PER_FRAME;
    for (uint32_t i = 0; i < HEAPS_AT_ONCE && count == MOVES_PER_FRAME && result >= 0; i++)
        result = sluiceDefragmentTiles(s->manager, 0, &count, moves);
    return result == SLUICE_ERROR_OUT_OF_HOST_MEMORY
               ? SLUICE_SUCCESS
               : slc_streamer_check(s, result, "sluiceDefragmentTiles");
}

/* Gives `count` pages back: standby tiles first. If they do not suffice and `must` is set, lowers
 * `*target`, so that wanted tiles are evicted. */
static SluiceResult give_back(SluiceVulkanStreamer *s, const SluiceStreamedTextureStatistics *stats,
                              uint32_t count, bool must, uint32_t *target)
{
    uint64_t standby = stats->standbyTileCount, capacity = s->info.heapTileCapacity;
    if (!must && count > standby)
        return SLUICE_SUCCESS;
    SluiceResult result = sluiceTrimStandbyTiles(s->manager, (uint32_t)without(standby, count));
    if (count > standby) {
        uint64_t used = stats->heapCount * capacity - stats->freeSlotCount;
        *target = slc_max_u32(1, (uint32_t)(without(used, count) / capacity));
    }
    return slc_streamer_check(s, result, "sluiceTrimStandbyTiles");
}

static SluiceResult shrink_pages(SluiceVulkanStreamer *s,
                                 const SluiceStreamedTextureStatistics *stats)
{
    const struct slc_memory_pressure *pressure = &s->memory_pressure;
    bool must = pressure->beyond > 0, compacting = s->shrink.compacting;
    uint32_t target = must ? s->shrink.target : 0, lacking = SLC_NONE;
    uint64_t size = pressure->beyond + pressure->refused;
    if (size || !compacting)
        lacking = s->residency->interface->gather(s->residency, size);
    s->shrink.compacting = false; /* the moves were for this frame only */
    SluiceResult result = SLUICE_SUCCESS;
    if (lacking != SLC_NONE && lacking > stats->standbyTileCount && !must)
        s->residency->interface->gather(s->residency, 0); /* ends: wanted tiles would be evicted */
    else if (lacking != SLC_NONE && lacking > 0)
        result = give_back(s, stats, lacking, must, &target);
    if (result >= 0)
        result = set_target(s, target);
    if (result < 0 || !s->shrink.target || stats->heapCount <= s->shrink.target)
        return result;
    result = count_together(s);
    return result >= 0 ? release_empty_heaps(s) : result;
}

/* Frees heaps that were made ahead, before any tile is evicted. */
static void free_spare_heaps(SluiceVulkanStreamer *s)
{
    struct slc_memory_pressure *pressure = &s->memory_pressure;
    uint64_t size = pressure->beyond + pressure->refused;
    if (size == 0)
        return;
    uint64_t freed = s->residency->interface->free_spare(s->residency, size);
    pressure->refused = without(pressure->refused, without(freed, pressure->beyond));
    pressure->beyond = without(pressure->beyond, freed);
}

/* Gives deferred tiles back, because they hold slots in all heaps. Wanted ones are requested again.
 */
static SluiceResult give_deferred_back(SluiceVulkanStreamer *s)
{
    SluiceResult result = SLUICE_SUCCESS;
    while (s->deferred.count > 0 && result >= 0) {
        const struct slc_deferred_tile last = s->deferred.tiles[s->deferred.count - 1];
        slc_deferred_tiles_remove_at(&s->deferred, s->deferred.count - 1);
        result = slc_load_give_back(s, last.texture, &last.tile);
    }
    return result;
}

/* Releases a heap for pages, if tiles of paged textures have slots but heaps took the memory of
 * their pages. One heap at a time. The following eviction treats all textures equally. */
static SluiceResult make_room_for_pages(SluiceVulkanStreamer *s)
{
    uint64_t *before = &s->shrink.size_before, size = slc_memory_client_tiles(&s->memory);
    if (s->lacking_pages)
        s->shrink.lacking_until = s->frame + FRAMES_OF_LACK;
    if (!s->paged || s->frame >= s->shrink.lacking_until || !slc_page_pool_was_refused(s->pages)) {
        *before = 0;
    } else if (*before > size) {
        slc_page_pool_ask_again(s->pages);
        s->shrink.pages_until = s->frame + FRAMES_FOR_PAGES;
        *before = 0;
    } else if (s->frame >= s->shrink.pages_until) {
        *before = size;
        s->memory_pressure.beyond += (uint64_t)s->info.heapTileCapacity * SLC_TILE_SIZE;
        return give_deferred_back(s);
    }
    return SLUICE_SUCCESS;
}

/* Moves pages together beside heaps. The eviction that empties heaps also gives pages back. */
static void gather_pages(SluiceVulkanStreamer *s)
{
    uint64_t size = s->memory_pressure.beyond + s->memory_pressure.refused;
    if (!s->paged || (size == 0 && s->shrink.compacting))
        return;
    uint32_t lacking = s->paged->interface->gather(s->paged, size);
    if (lacking != SLC_NONE && lacking > 0)
        s->paged->interface->gather(s->paged, 0);
}

static SluiceResult shrink_heaps(SluiceVulkanStreamer *s,
                                 const SluiceStreamedTextureStatistics *stats)
{
    struct slc_shrink *shrink = &s->shrink;
    gather_pages(s);
    SluiceResult result = make_room_for_pages(s);
    free_spare_heaps(s);
    if (result >= 0)
        result = set_target(s, choose_target(s, stats));
    bool too_many = shrink->target && stats->heapCount > shrink->target;
    if (result >= 0 && (too_many || shrink->compacting))
        result = release_empty_heaps(s);
    if (result >= 0 && too_many)
        result = evacuate(s, slc_min_u32(MOVES_PER_FRAME, s->info.tilesPerFrame));
    if (stats->retiringSlotCount == 0 && count_evicted(s) == 0)
        shrink->compacting = false;
    return result;
}

SluiceResult slc_shrink_step(SluiceVulkanStreamer *s)
{
    const struct slc_residency_interface *interface = s->residency->interface;
    if (!interface->going_size && !interface->gather)
        return SLUICE_SUCCESS;
    SluiceStreamedTextureStatistics stats = slc_manager_slot_statistics(s->manager);
    return interface->gather ? shrink_pages(s, &stats) : shrink_heaps(s, &stats);
}

static SluiceResult compact_heaps(SluiceVulkanStreamer *s, uint32_t most, uint32_t *count)
{
    s->manager_locked = false;
    uint32_t before = count_evicted(s);
    SluiceResult result = sluiceEvacuateHeaps(s->manager, most);
    *count = count_evicted(s) - before;
    s->manager_locked = true;
    s->shrink.compacting |= result == SLUICE_SUCCESS;
    return result;
}

SluiceResult sluiceCompactVulkanStreamer(SluiceVulkanStreamer *streamer, uint32_t maxTileCount,
                                         uint32_t *pTileCount)
{
    SluiceVulkanStreamer *s = streamer;
    if (!s || !pTileCount)
        return SLUICE_ERROR_NULL_POINTER;
    *pTileCount = 0;
    struct slc_residency *pages = slc_residency_of_pages(s);
    if (pages) {
        *pTileCount = pages->interface->compact(pages, maxTileCount);
        s->shrink.compacting = true;
    }
    if (!s->residency->interface->going_size)
        return SLUICE_SUCCESS;
    uint32_t count;
    SluiceResult result = compact_heaps(s, maxTileCount - *pTileCount, &count);
    *pTileCount += count;
    return result;
}
