/** The read pool that several contexts and tile loaders use: SluiceReadPool. */
#ifndef SLC_IMAGE_SHARED_POOL_H
#define SLC_IMAGE_SHARED_POOL_H

#include "image/read_pool.h"
#include "image/shared_reads.h"

struct SluiceReadPool {
    SluiceAllocationCallbacks allocator;
    SluiceLogCallback log;
    struct slc_read_pool *threads;
    struct slc_shared_reads shares; ///< the mutex of `threads` is around it
};

/** A context or tile loader uses the pool from here to slc_read_pool_remove_member. */
void slc_read_pool_add_member(SluiceReadPool *pool);
void slc_read_pool_remove_member(SluiceReadPool *pool);

#endif /* SLC_IMAGE_SHARED_POOL_H */
