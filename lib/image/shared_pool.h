/** SluiceReadPool: the read pool of several contexts and tile loaders. */
#ifndef SLC_IMAGE_SHARED_POOL_H
#define SLC_IMAGE_SHARED_POOL_H

#include "image/read_pool.h"
#include "image/shared_reads.h"

struct SluiceReadPool {
    SluiceAllocationCallbacks allocator;
    SluiceLogCallback log;
    struct slc_read_pool *threads;
    struct slc_shared_reads shares; ///< guarded by the mutex of `threads`
};

/** Adds a context or tile loader to the pool's users, until slc_read_pool_remove_member. */
void slc_read_pool_add_member(SluiceReadPool *pool);
void slc_read_pool_remove_member(SluiceReadPool *pool);

#endif /* SLC_IMAGE_SHARED_POOL_H */
