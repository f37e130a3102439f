/** Copy of a source's levels into a store, unchanged: blocks and integers. */
#ifndef SLC_BAKE_COPY_H
#define SLC_BAKE_COPY_H

#include <sluice/store.h>

#include "bake/work_pool.h"

struct slc_copy {
    SluiceAllocationCallbacks allocator;
    struct slc_bake_jobs *jobs;
    SluiceImageSource *source;
    SluiceStoreWriter *writer;
    uint64_t *next_turn; ///< next turn of the writer, for all sources of a store
    SluiceStoreLayout layout;
    uint32_t first_layer;      ///< layer of the store for the source's first layer
    uint32_t layer_count;      ///< layers of the source
    uint32_t all_layer_count;  ///< layers of the store, for the progress
    uint64_t found_tile_count; ///< tiles that an earlier run has written
    void *user;
    bool (*progress)(void *user, uint64_t done, uint64_t total); ///< in tiles; NULL: none
};

/** Returns the bytes that slc_copy_run allocates. */
uint64_t slc_copy_memory(const SluiceStoreLayout *layout, uint32_t thread_count);

/** Copies all levels. Errors: those of reading and writing; CANCELED; OUT_OF_HOST_MEMORY. */
SluiceResult slc_copy_run(struct slc_copy *copy);

#endif /* SLC_BAKE_COPY_H */
