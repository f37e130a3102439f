#include "image/shared_pool.h"

#include "base/alloc.h"
#include "base/limits.h"
#include "base/log.h"
#include "base/struct_size.h"

#define MAX_THREADS 1024u

static SluiceResult check(const SluiceReadPoolCreateInfo *info)
{
    const struct slc_limit limits[] = {{"threadCount", info->threadCount, 0, MAX_THREADS}};
    if (info->pJobSystem && !info->pJobSystem->pfnSubmitJob) {
        slc_log(&info->log, SLUICE_LOG_ERROR, "the function of pJobSystem is NULL");
        return SLUICE_ERROR_NULL_POINTER;
    }
    return slc_check_limits(&info->log, limits, sizeof limits / sizeof limits[0]);
}

SluiceResult sluiceCreateReadPool(const SluiceReadPoolCreateInfo *pCreateInfo,
                                  SluiceReadPool **pPool)
{
    if (!pCreateInfo || !pPool || !slc_allocator_is_valid(pCreateInfo->pAllocator))
        return SLUICE_ERROR_NULL_POINTER;
    *pPool = NULL;
    SluiceReadPoolCreateInfo info = {.structSize = sizeof info};
    SluiceResult result = slc_struct_read(SLC_STRUCT(SluiceReadPoolCreateInfo), &info, pCreateInfo,
                                          &pCreateInfo->log);
    if (result == SLUICE_SUCCESS)
        result = check(&info);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceAllocationCallbacks cb = slc_allocator(info.pAllocator);
    SluiceReadPool *pool = slc_calloc(&cb, 1, sizeof *pool);
    if (!pool)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    pool->allocator = cb;
    pool->log = info.log;
    slc_shared_reads_init(&pool->shares, &cb,
                          info.cacheSize ? info.cacheSize : SLUICE_READ_POOL_DEFAULT_CACHE_SIZE);
    const SluiceTileLoaderCreateInfo create = {.structSize = sizeof create,
                                               .threadCount = info.threadCount,
                                               .pAllocator = &cb,
                                               .maxReadsPerSource = info.maxReadsPerSource,
                                               .maxBytesInFlight = info.maxBytesInFlight,
                                               .pJobSystem = info.pJobSystem};
    result = slc_read_pool_create(&create, &pool->threads);
    if (result != SLUICE_SUCCESS) {
        slc_free(&cb, pool, 1, sizeof *pool);
        return result;
    }
    pool->threads->shares = &pool->shares; /* before there is a loader */
    *pPool = pool;
    return SLUICE_SUCCESS;
}

static uint32_t member_count(SluiceReadPool *pool)
{
    slc_mutex_lock(&pool->threads->mutex);
    uint32_t count = pool->shares.member_count;
    slc_mutex_unlock(&pool->threads->mutex);
    return count;
}

void sluiceDestroyReadPool(SluiceReadPool *pool)
{
    if (!pool)
        return;
    uint32_t members = member_count(pool);
    if (members > 0) {
        slc_log(&pool->log, SLUICE_LOG_ERROR,
                "read pool is not destroyed: %u of its contexts and tile loaders still exist",
                members);
        return;
    }
    SluiceAllocationCallbacks cb = pool->allocator;
    slc_read_pool_destroy(pool->threads);
    slc_shared_reads_finish(&pool->shares);
    slc_free(&cb, pool, 1, sizeof *pool);
}

SluiceResult sluiceGetReadPoolStatistics(SluiceReadPool *pool,
                                         SluiceReadPoolStatistics *pStatistics)
{
    if (!pool || !pStatistics)
        return SLUICE_ERROR_NULL_POINTER;
    const struct slc_struct *type = SLC_STRUCT(SluiceReadPoolStatistics);
    SluiceResult result = slc_struct_check(type, pStatistics, &pool->log);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceReadPoolStatistics statistics;
    slc_mutex_lock(&pool->threads->mutex);
    slc_shared_reads_write_statistics(&pool->shares, &statistics);
    slc_mutex_unlock(&pool->threads->mutex);
    slc_struct_write(type, pStatistics, &statistics);
    return SLUICE_SUCCESS;
}

void slc_read_pool_add_member(SluiceReadPool *pool)
{
    slc_mutex_lock(&pool->threads->mutex);
    slc_shared_reads_add_member(&pool->shares);
    slc_mutex_unlock(&pool->threads->mutex);
}

void slc_read_pool_remove_member(SluiceReadPool *pool)
{
    const SluiceAllocationCallbacks cb = pool->allocator;
    struct slc_shared_region *dropped = NULL;
    slc_mutex_lock(&pool->threads->mutex);
    slc_shared_reads_remove_member(&pool->shares, &dropped);
    slc_mutex_unlock(&pool->threads->mutex); /* the pool may be destroyed from here on */
    slc_shared_regions_free(&cb, dropped);
}
