/** Blocks of memory that textures take and give back often. */
#ifndef SLC_CORE_SPARES_H
#define SLC_CORE_SPARES_H

#include "core/state.h"

/** Takes a block; not cleared. NULL without memory. Give all back before the manager is destroyed.
 */
void *slc_spares_take(slc_manager *m, size_t size);
/** Gives back a block; `size` as taken. `memory` may be NULL. */
void slc_spares_give(slc_manager *m, void *memory, size_t size);

#endif /* SLC_CORE_SPARES_H */
