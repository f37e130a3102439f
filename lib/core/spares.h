/** Memory that textures have for a while. */
#ifndef SLC_CORE_SPARES_H
#define SLC_CORE_SPARES_H

#include "core/state.h"

/** Bytes for a while; not cleared. NULL: there are none. All are given back before the end. */
void *slc_spares_take(slc_manager *m, size_t size);
/** Of the size that was taken. NULL is allowed. */
void slc_spares_give(slc_manager *m, void *memory, size_t size);

#endif /* SLC_CORE_SPARES_H */
