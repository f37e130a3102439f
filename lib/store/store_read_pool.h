/** Pool of benches: buffers and decompressor, one bench per read in progress, kept between reads.
 */
#ifndef SLC_STORE_STORE_READ_POOL_H
#define SLC_STORE_STORE_READ_POOL_H

#include "store/codec.h"
#include "store/grid.h"

struct slc_store_read_bench {
    struct slc_store_read_bench *next;
    struct slc_store_decompressor *decompressor; ///< NULL until needed
    unsigned char stored[SLC_STORE_MAX_CHUNK_SIZE];
    unsigned char texels[SLC_STORE_MAX_CHUNK_SIZE]; ///< for reads of parts of a chunk
};

/** Takes a bench, to be given back. NULL without memory. Any thread. */
struct slc_store_read_bench *slc_store_read_pool_take(SluiceStoreReadPool *pool);
/** Returns the bench's decompressor; creates it if necessary. NULL without memory. */
struct slc_store_decompressor *slc_store_read_decompressor(SluiceStoreReadPool *pool,
                                                           struct slc_store_read_bench *bench);
void slc_store_read_pool_give(SluiceStoreReadPool *pool, struct slc_store_read_bench *bench);

#endif /* SLC_STORE_STORE_READ_POOL_H */
