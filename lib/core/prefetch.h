/** Prefetch of coarse tiles while nothing is requested. */
#ifndef SLC_CORE_PREFETCH_H
#define SLC_CORE_PREFETCH_H

#include "core/state.h"

/**
 * Hands out coarse tiles that nothing requests yet. INCOMPLETE if the list is full, or if host
 * memory runs out after some tiles; OUT_OF_HOST_MEMORY if it runs out before the first tile.
 */
SluiceResult slc_prefetch(slc_manager *m, uint32_t room, uint32_t *written, SluiceTile *tiles);

#endif /* SLC_CORE_PREFETCH_H */
