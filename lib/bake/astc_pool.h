/** Contexts of astcenc, kept for reuse: they are slow to make and serve one thread at a time. */
#ifndef SLC_BAKE_ASTC_POOL_H
#define SLC_BAKE_ASTC_POOL_H

#include <sluice/bake.h>

#include "platform/thread.h"

struct slc_astc_context;

/** Initialize before use. Finish it when no thread encodes. */
struct slc_astc_pool {
    SluiceAllocationCallbacks allocator;
    struct slc_mutex mutex;
    bool is_ready;
    struct slc_astc_context *idle;
};

void slc_astc_pool_init(struct slc_astc_pool *pool, const SluiceAllocationCallbacks *cb);
/** Destroys all contexts. A zeroed pool is allowed. */
void slc_astc_pool_finish(struct slc_astc_pool *pool);

/**
 * Encodes rows of RGBA bytes, `pitch` bytes apart, to blocks of `extent` x `extent` texels.
 * Errors: OUT_OF_HOST_MEMORY. Thread safety: any thread.
 */
SluiceResult slc_astc_pool_encode(struct slc_astc_pool *pool, uint32_t extent, bool srgb,
                                  SluiceBakeQuality quality, const void *texels, size_t pitch,
                                  uint32_t width, uint32_t height, void *blocks);

#endif /* SLC_BAKE_ASTC_POOL_H */
