/** What reads need for their time, kept between them: one bench per read that is under way. */
#ifndef SLC_STORE_STORE_READ_POOL_H
#define SLC_STORE_STORE_READ_POOL_H

#include "store/codec.h"
#include "store/grid.h"

struct slc_store_read_bench {
    struct slc_store_read_bench *next;
    struct slc_store_decompressor *decompressor; ///< NULL until one is asked for
    unsigned char stored[SLC_STORE_MAX_CHUNK_SIZE];
    unsigned char texels[SLC_STORE_MAX_CHUNK_SIZE]; ///< where the caller's memory cannot take them
};

/** NULL: out of memory. Give it back. Any thread. */
struct slc_store_read_bench *slc_store_read_pool_take(SluiceStoreReadPool *pool);
/** Makes one if need be; NULL: out of memory. */
struct slc_store_decompressor *slc_store_read_decompressor(SluiceStoreReadPool *pool,
                                                           struct slc_store_read_bench *bench);
void slc_store_read_pool_give(SluiceStoreReadPool *pool, struct slc_store_read_bench *bench);

#endif /* SLC_STORE_STORE_READ_POOL_H */
