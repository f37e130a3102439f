#include "store/store_read_pool.h"

#include "base/alloc.h"
#include "platform/thread.h"

struct SluiceStoreReadPool {
    SluiceAllocationCallbacks allocator;
    struct slc_mutex mutex; ///< guards the fields below
    struct slc_store_read_bench *idle;
};

SluiceResult sluiceCreateStoreReadPool(const SluiceAllocationCallbacks *pAllocator,
                                       SluiceStoreReadPool **pPool)
{
    if (!pPool || !slc_allocator_is_valid(pAllocator))
        return SLUICE_ERROR_NULL_POINTER;
    SluiceAllocationCallbacks cb = slc_allocator(pAllocator);
    SluiceStoreReadPool *pool = slc_calloc(&cb, 1, sizeof *pool);
    if (!pool)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    pool->allocator = cb;
    if (!slc_mutex_init(&pool->mutex)) {
        slc_free(&cb, pool, 1, sizeof *pool);
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    *pPool = pool;
    return SLUICE_SUCCESS;
}

static void free_bench(const SluiceAllocationCallbacks *cb, struct slc_store_read_bench *bench)
{
    slc_store_decompressor_destroy(bench->decompressor);
    slc_free(cb, bench, 1, sizeof *bench);
}

void sluiceDestroyStoreReadPool(SluiceStoreReadPool *pool)
{
    if (!pool)
        return;
    SluiceAllocationCallbacks cb = pool->allocator;
    while (pool->idle) {
        struct slc_store_read_bench *bench = pool->idle;
        pool->idle = bench->next;
        free_bench(&cb, bench);
    }
    slc_mutex_finish(&pool->mutex);
    slc_free(&cb, pool, 1, sizeof *pool);
}

struct slc_store_read_bench *slc_store_read_pool_take(SluiceStoreReadPool *pool)
{
    slc_mutex_lock(&pool->mutex);
    struct slc_store_read_bench *bench = pool->idle;
    if (bench)
        pool->idle = bench->next;
    slc_mutex_unlock(&pool->mutex);
    if (bench)
        return bench;
    bench = slc_alloc(&pool->allocator, 1, sizeof *bench);
    if (bench)
        bench->decompressor = NULL;
    return bench;
}

struct slc_store_decompressor *slc_store_read_decompressor(SluiceStoreReadPool *pool,
                                                           struct slc_store_read_bench *bench)
{
    if (!bench->decompressor)
        bench->decompressor = slc_store_decompressor_create(&pool->allocator);
    return bench->decompressor;
}

void slc_store_read_pool_give(SluiceStoreReadPool *pool, struct slc_store_read_bench *bench)
{
    slc_mutex_lock(&pool->mutex);
    bench->next = pool->idle;
    pool->idle = bench;
    slc_mutex_unlock(&pool->mutex);
}
