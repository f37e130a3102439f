/** Arrays that grow by half of their size. */
#ifndef SLC_PBRT_GROWTH_H
#define SLC_PBRT_GROWTH_H

#include "base/alloc.h"

#include <string.h>

/** Room for `needed` elements in the array whose pointer is at `memory_address`. False: out of
 * memory, and nothing has changed. */
static inline bool slc_pbrt_grow(const SluiceAllocationCallbacks *cb, void *memory_address,
                                 size_t *capacity, size_t needed, size_t size)
{
    void *memory;
    if (needed <= *capacity)
        return true;
    size_t more = *capacity + *capacity / 2 + 16;
    if (more < needed)
        more = needed;
    memcpy(&memory, memory_address, sizeof memory);
    void *moved = slc_regrow(cb, memory, *capacity, more, size);
    if (!moved)
        return false;
    memcpy(memory_address, &moved, sizeof moved);
    *capacity = more;
    return true;
}

#endif /* SLC_PBRT_GROWTH_H */
