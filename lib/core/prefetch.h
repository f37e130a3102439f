/** Coarse tiles are loaded while nothing is requested. */
#ifndef SLC_CORE_PREFETCH_H
#define SLC_CORE_PREFETCH_H

#include "core/state.h"

/**
 * Hands out coarse tiles of what may come into view. INCOMPLETE if the list is full or host memory
 * runs out; OUT_OF_HOST_MEMORY if nothing was handed out for want of it.
 */
SluiceResult slc_prefetch(slc_manager *m, uint32_t room, uint32_t *written, SluiceTile *tiles);

#endif /* SLC_CORE_PREFETCH_H */
