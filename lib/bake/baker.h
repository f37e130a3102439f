/** Threads and memory that bakes share. */
#ifndef SLC_BAKE_BAKER_H
#define SLC_BAKE_BAKER_H

#include <sluice/bake.h>

#include "bake/astc_pool.h"
#include "bake/work_pool.h"

struct SluiceBaker {
    SluiceAllocationCallbacks allocator;
    SluiceLogCallback log;
    uint64_t max_memory;
    uint64_t used_memory; ///< guarded by the pool's mutex
    struct slc_bake_jobs jobs;
    struct slc_astc_pool astc;
    float *decoded16; ///< 65536 values of sRGB codes
};

/** Reserves memory. Waits until other bakes have given back enough, and calls the bake's progress
 *  callback meanwhile. Errors: LIMIT_EXCEEDED if `size` exceeds the limit of the baker; CANCELED.
 */
SluiceResult slc_baker_reserve(SluiceBaker *baker, uint64_t size, const SluiceBakeInfo *info);
void slc_baker_give_back(SluiceBaker *baker, uint64_t size);

#endif /* SLC_BAKE_BAKER_H */
