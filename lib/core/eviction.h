/** Why a tile is evicted: requests need its slot. */
#ifndef SLC_CORE_EVICTION_H
#define SLC_CORE_EVICTION_H

#include "core/request_walk.h"

/** Slots of heaps beyond targetHeapCount: tiles leave them, and no others come. */
uint64_t slc_surplus_slots(const slc_manager *m);
/** Free slots that regular tiles must not take: reserved ones for packed tiles, and surplus ones.
 */
uint64_t slc_kept_slots(const slc_manager *m);
/** True if a tile need not share a heap for packed tiles: another heap has a free slot, or heaps
 * for packed tiles are to be filled, because they stay while the number of heaps falls. */
bool slc_has_own_slot(const slc_manager *m);
/** Takes a slot for a tile that needs no heap for packed tiles. False if there is none. */
bool slc_take_own_slot(slc_manager *m, uint32_t node);
/**
 * Evicts tiles on standby, and wanted ones of textures that get no maps, for `unserved` requests.
 * Returns whether such a texture was dropped and requests with it.
 */
bool slc_evict_unwanted_for(slc_manager *m, uint32_t unserved);
/** Evicts wanted tiles for the requests that are left of `walk`, as far as these are worth more. */
void slc_evict_wanted_for(slc_manager *m, struct slc_request_walk walk, uint32_t unserved);

#endif /* SLC_CORE_EVICTION_H */
