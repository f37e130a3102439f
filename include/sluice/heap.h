/** Memory for tiles, supplied by the application: heaps of equal tile slots. */
#ifndef SLUICE_HEAP_H
#define SLUICE_HEAP_H

#include <sluice/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Allocates and releases heaps. A heap is an array of `heapTileCapacity` slots of `tileSize` bytes.
 *
 * Called on the thread that calls the manager. The callbacks must not call the manager.
 * Never grows.
 */
typedef struct SluiceHeapAllocator {
    void *pUserData;
    /**
     * Allocates a heap of `size` bytes and writes its id to `*pHeapId`. You choose the id; no
     * existing heap may have the same one.
     *
     * Any result but SLUICE_SUCCESS means that the budget is reached for now: requests wait, and
     * the manager asks again later. It accepts one such refusal per call of sluiceGetTilesToMap.
     */
    SluiceResult (*pfnAllocateHeap)(void *pUserData, uint64_t size, uint32_t *pHeapId);
    /** Releases a heap. It holds no tile, and no retire value is pending on it. */
    void (*pfnReleaseHeap)(void *pUserData, uint32_t heapId);
} SluiceHeapAllocator;

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_HEAP_H */
