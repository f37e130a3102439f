/** Physical storage for tiles, supplied by the application: heaps of equal tile slots. */
#ifndef SLUICE_HEAP_H
#define SLUICE_HEAP_H

#include <sluice/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Makes and releases heaps. A heap is an array of `heapTileCapacity` slots of `tileSize` bytes.
 *
 * Called on the thread that called the manager; must not call the manager back.
 */
typedef struct SluiceHeapAllocator {
    void *pUserData;
    /**
     * On success writes an id that the application will recognise and that no living heap has.
     * `size` is in bytes. Any failure means that the budget is reached for now: requests wait and
     * the manager asks again later, at most once per call of sluiceGetTilesToMap.
     */
    SluiceResult (*pfnAllocateHeap)(void *pUserData, uint64_t size, uint32_t *pHeapId);
    /** No tile lives in the heap any more and no retire value is pending on it. */
    void (*pfnReleaseHeap)(void *pUserData, uint32_t heapId);
} SluiceHeapAllocator;

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_HEAP_H */
