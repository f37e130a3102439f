/** Eviction of tiles whose slots are required for requests. */
#ifndef SLC_CORE_EVICTION_H
#define SLC_CORE_EVICTION_H

#include "core/request_walk.h"

/** Returns the number of slots in heaps beyond targetHeapCount, which are being emptied. */
uint64_t slc_surplus_slots(const slc_manager *m);
/** Returns the number of free slots that regular tiles must not take: slots reserved for packed
 * tiles, and surplus slots. */
uint64_t slc_kept_slots(const slc_manager *m);
/** True if a regular tile has a slot of its kind: in a heap for regular tiles, or, while the number
 * of heaps shrinks, in a heap for packed tiles, because these heaps stay. */
bool slc_has_own_slot(const slc_manager *m);
/** Takes a slot as in slc_has_own_slot. Returns false if there is none. */
bool slc_take_own_slot(slc_manager *m, uint32_t node);
/**
 * Evicts STANDBY tiles, and wanted tiles of textures that get no maps, for `unserved` requests.
 * Returns whether such a texture was dropped, which ends its requests.
 */
bool slc_evict_unwanted_for(slc_manager *m, uint32_t unserved);
/** Evicts wanted tiles for the remaining requests of `walk` that are worth more than the tiles. */
void slc_evict_wanted_for(slc_manager *m, struct slc_request_walk walk, uint32_t unserved);

#endif /* SLC_CORE_EVICTION_H */
