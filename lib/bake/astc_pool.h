/** Contexts of astcenc, which cost milliseconds to make and serve one thread at a time. */
#ifndef SLC_BAKE_ASTC_POOL_H
#define SLC_BAKE_ASTC_POOL_H

#include <sluice/bake.h>

#include <pthread.h>

struct slc_astc_context;

/** Zeroed and then initialized; finished when no thread is in it. */
struct slc_astc_pool {
    SluiceAllocationCallbacks allocator;
    pthread_mutex_t mutex;
    bool is_ready;
    struct slc_astc_context *idle;
};

void slc_astc_pool_init(struct slc_astc_pool *pool, const SluiceAllocationCallbacks *cb);
/** A zeroed pool is allowed. */
void slc_astc_pool_finish(struct slc_astc_pool *pool);

/**
 * Rows of RGBA bytes, `pitch` bytes apart, to blocks of `extent` x `extent` texels.
 * Errors: OUT_OF_HOST_MEMORY. Thread safety: any thread.
 */
SluiceResult slc_astc_pool_encode(struct slc_astc_pool *pool, uint32_t extent, bool srgb,
                                  SluiceBakeQuality quality, const void *texels, size_t pitch,
                                  uint32_t width, uint32_t height, void *blocks);

#endif /* SLC_BAKE_ASTC_POOL_H */
