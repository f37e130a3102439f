/* Empty heaps, which the application may release. */
#include "base/checked.h"
#include "core/eviction.h"
#include "core/observer.h"
#include "core/refusal.h"
#include "core/state.h"
#include "residency/defragment.h"

SluiceResult sluiceGetEmptyHeaps(const SluiceStreamedTextureManager *manager, uint32_t *pHeapCount,
                                 uint32_t *pHeapIds)
{
    if (!manager || !pHeapCount)
        return SLUICE_ERROR_NULL_POINTER;
    const struct slc_tile_heaps *h = &manager->residency.heaps;
    uint32_t room = *pHeapCount, found = 0;
    uint64_t rest = h->free_total,
             keep = h->capacity / 2 + slc_tile_heaps_reserved(&manager->residency.heaps);
    if (rest == (uint64_t)h->live_count * h->capacity)
        keep = 0; /* no tile is left */
    uint64_t surplus = slc_surplus_slots(manager);
    for (uint32_t i = 0; i < h->end; i++) {
        if (h->heaps[i].free_count != h->capacity || (rest - h->capacity < keep && !surplus))
            continue;
        rest -= h->capacity;
        surplus -= surplus ? h->capacity : 0;
        if (pHeapIds && found < room)
            pHeapIds[found] = h->heaps[i].id;
        found++;
    }
    *pHeapCount = pHeapIds ? slc_min_u32(found, room) : found;
    return pHeapIds && found > room ? SLUICE_INCOMPLETE : SLUICE_SUCCESS;
}

SluiceResult sluiceEvacuateHeaps(SluiceStreamedTextureManager *manager, uint32_t maxTileCount)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    if (slc_is_locked(manager))
        return slc_refuse_locked(manager, __func__);
    struct slc_call call = {.kind = SLC_CALL_EVACUATE_HEAPS,
                            .keep_count = maxTileCount,
                            .result = slc_evacuate(&manager->residency, maxTileCount)};
    slc_notify(manager, &call);
    return call.result;
}

static SluiceResult release_heap(slc_manager *m, uint32_t heap_id)
{
    uint32_t heap = slc_tile_heaps_find(&m->residency.heaps, heap_id);
    if (heap == UINT32_MAX)
        return SLUICE_ERROR_UNKNOWN_HEAP;
    if (m->residency.heaps.heaps[heap].free_count != m->residency.heaps.capacity)
        return SLUICE_ERROR_HEAP_IN_USE;
    slc_tile_heaps_release(&m->residency.heaps, heap);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceReleaseHeap(SluiceStreamedTextureManager *manager, uint32_t heapId)
{
    if (!manager)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_call call = {
        .kind = SLC_CALL_RELEASE_HEAP, .heap_id = heapId, .result = release_heap(manager, heapId)};
    slc_notify(manager, &call);
    return call.result;
}
