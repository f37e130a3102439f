/* A loader: what its owner submits, cancels and collects. Threads are the pool's. */
#include "image/read_pool.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "image/pooled_reads.h"
#include "image/shared_pool.h"
#include "image/started_reads.h"
#include "platform/time_now.h"

/* Limit for the number of reads, and of remembered sources. */
#define MAX_COUNT (1u << 29)

static struct slc_read_queue_limits read_limits(const SluiceTileLoaderCreateInfo *info)
{
    uint32_t capacity = info->requestCapacity ? info->requestCapacity : 1024;
    return (struct slc_read_queue_limits){
        .capacity = capacity,
        .source_count = slc_max_u32(capacity, info->maxSourceCount),
    };
}

static SluiceTileLoader *allocate(const SluiceTileLoaderCreateInfo *info)
{
    SluiceAllocationCallbacks cb = slc_allocator(info->pAllocator);
    SluiceTileLoader *loader = slc_calloc(&cb, 1, sizeof *loader);
    if (!loader)
        return NULL;
    loader->allocator = cb;
    loader->retry = slc_retry_policy(&info->retry);
    loader->failure = info->failure;
    loader->end = info->end;
    struct slc_read_queue_limits limits = read_limits(info);
    if (slc_read_queue_init(&loader->queue, &cb, &limits) == SLUICE_SUCCESS)
        return loader;
    slc_free(&cb, loader, 1, sizeof *loader);
    return NULL;
}

static void join(SluiceTileLoader *loader, struct slc_read_pool *pool)
{
    SluiceTileLoader **last = &pool->loaders;
    loader->pool = pool;
    slc_mutex_lock(&pool->mutex);
    slc_read_queue_share(&loader->queue, &pool->load, pool->loaders ? &pool->loaders->queue : NULL);
    loader->queue.shares = pool->shares;
    while (*last)
        last = &(*last)->next;
    *last = loader;
    slc_mutex_unlock(&pool->mutex);
}

SluiceResult slc_create_pool_loader(struct slc_read_pool *pool,
                                    const SluiceTileLoaderCreateInfo *info, SluiceTileLoader **out)
{
    if (info->requestCapacity > MAX_COUNT || info->maxSourceCount > MAX_COUNT)
        return SLUICE_ERROR_INVALID_ARGUMENT;
    SluiceTileLoader *loader = allocate(info);
    if (!loader)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    join(loader, pool);
    *out = loader;
    return SLUICE_SUCCESS;
}

static SluiceResult create_member(const SluiceTileLoaderCreateInfo *info, SluiceTileLoader **out)
{
    SluiceReadPool *pool = info->readPool;
    if (info->threadCount || info->maxReadsPerSource || info->maxBytesInFlight || info->pJobSystem)
        return slc_log_refusal(&pool->log, "threadCount, maxReadsPerSource, maxBytesInFlight and "
                                           "pJobSystem are those of readPool: set them to 0");
    SluiceTileLoader *loader;
    SluiceResult result = slc_create_pool_loader(pool->threads, info, &loader);
    if (result != SLUICE_SUCCESS)
        return result;
    loader->member_of = pool;
    slc_read_pool_add_member(pool);
    *out = loader;
    return SLUICE_SUCCESS;
}

SluiceResult sluiceCreateTileLoader(const SluiceTileLoaderCreateInfo *pCreateInfo,
                                    SluiceTileLoader **pLoader)
{
    if (!pCreateInfo || !pLoader || !slc_allocator_is_valid(pCreateInfo->pAllocator))
        return SLUICE_ERROR_NULL_POINTER;
    SluiceTileLoaderCreateInfo info = {.structSize = sizeof info};
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceTileLoaderCreateInfo), &info, pCreateInfo, NULL);
    if (result != SLUICE_SUCCESS)
        return result;
    if (info.pJobSystem && !info.pJobSystem->pfnSubmitJob)
        return SLUICE_ERROR_NULL_POINTER;
    if (info.requestCapacity > MAX_COUNT || info.maxSourceCount > MAX_COUNT)
        return SLUICE_ERROR_INVALID_ARGUMENT;
    if (info.readPool)
        return create_member(&info, pLoader);
    struct slc_read_pool *pool;
    SluiceTileLoader *loader;
    result = slc_read_pool_create(&info, &pool);
    if (result != SLUICE_SUCCESS)
        return result;
    result = slc_create_pool_loader(pool, &info, &loader);
    if (result != SLUICE_SUCCESS) {
        slc_read_pool_destroy(pool);
        return result;
    }
    loader->owns_pool = true;
    *pLoader = loader;
    return SLUICE_SUCCESS;
}

/* Drops a read. The mutex is held, but unlocked while a source is told. */
static void drop_read(SluiceTileLoader *loader, struct slc_read *read)
{
    const struct slc_shared_region *awaited = read->awaited;
    if (read->state == SLC_READ_QUEUED || read->state == SLC_READ_DELAYED ||
        read->state == SLC_READ_WAITING) {
        slc_loader_end_read(loader, read, SLUICE_ERROR_CANCELED);
        if (awaited)
            slc_cancel_unwanted_region(awaited);
    } else if (read->state == SLC_READ_RUNNING) {
        atomic_store_explicit(&read->dropped, true, memory_order_relaxed);
        slc_cancel_regions(loader, read);
    }
}

/* Drops shared texels of the loader's sources, which may now be destroyed. The mutex is held. */
static void drop_its_texels(SluiceTileLoader *loader, struct slc_shared_region **dropped)
{
    const struct slc_read_sources *sources = &loader->queue.sources;
    struct slc_shared_reads *shares = loader->pool->shares;
    if (shares && sources->has_recycled)
        slc_shared_reads_drop_all(shares, dropped);
    for (uint32_t i = 0; shares && i < sources->count; i++)
        if (sources->records[i].source)
            slc_shared_reads_drop(shares, sources->records[i].source, dropped);
}

/* Removes a loader from the pool. Reads behind its reads may then start. The mutex is held. */
static void leave(SluiceTileLoader *loader, struct slc_shared_region **dropped)
{
    struct slc_read_pool *pool = loader->pool;
    SluiceTileLoader **link = &pool->loaders;
    while (*link != loader)
        link = &(*link)->next;
    *link = loader->next;
    if (pool->turn == loader)
        pool->turn = loader->next;
    drop_its_texels(loader, dropped);
    slc_read_queue_finish(&loader->queue, &loader->allocator);
    slc_read_pool_signal(pool);
}

void sluiceDestroyTileLoader(SluiceTileLoader *loader)
{
    if (!loader)
        return;
    struct slc_read_pool *pool = loader->pool;
    slc_mutex_lock(&pool->mutex);
    loader->ending = true;
    for (uint32_t i = 0; i < loader->queue.capacity; i++)
        drop_read(loader, &loader->queue.reads[i]);
    while (!slc_read_queue_is_idle(&loader->queue))
        slc_condition_wait(&pool->idle, &pool->mutex);
    struct slc_shared_region *dropped = NULL;
    leave(loader, &dropped);
    slc_read_pool_unlock(pool);
    if (dropped)
        slc_shared_regions_free(&pool->shares->cb, dropped);
    if (loader->owns_pool)
        slc_read_pool_destroy(pool);
    if (loader->member_of)
        slc_read_pool_remove_member(loader->member_of);
    SluiceAllocationCallbacks cb = loader->allocator;
    slc_free(&cb, loader, 1, sizeof *loader);
}

static SluiceResult check_read(const SluiceTileRead *read)
{
    if (!read->source || !read->pRegions || !read->ppTexels)
        return SLUICE_ERROR_NULL_POINTER;
    if (read->regionCount == 0 || read->regionCount > SLUICE_MAX_READ_REGIONS)
        return SLUICE_ERROR_INVALID_ARGUMENT;
    for (uint32_t i = 0; i < read->regionCount; i++)
        if (!read->ppTexels[i])
            return SLUICE_ERROR_NULL_POINTER;
    return SLUICE_SUCCESS;
}

SluiceResult sluiceSubmitTileReads(SluiceTileLoader *loader, uint32_t count,
                                   const SluiceTileRead *pReads, uint64_t *pTickets)
{
    if (!loader || (count > 0 && (!pReads || !pTickets)))
        return SLUICE_ERROR_NULL_POINTER;
    for (uint32_t i = 0; i < count; i++) {
        SluiceResult result = check_read(&pReads[i]);
        if (result != SLUICE_SUCCESS)
            return result;
    }
    if (count == 0)
        return SLUICE_SUCCESS;
    slc_mutex_lock(&loader->pool->mutex);
    bool room = loader->queue.free_count >= count;
    for (uint32_t i = 0; room && i < count; i++)
        slc_read_queue_submit(&loader->queue, &pReads[i], &pTickets[i]);
    if (room)
        slc_read_pool_signal(loader->pool);
    slc_read_pool_unlock(loader->pool);
    return room ? SLUICE_SUCCESS : SLUICE_NOT_READY;
}

SluiceResult sluiceSubmitTileRead(SluiceTileLoader *loader, const SluiceTileRead *pRead,
                                  uint64_t *pTicket)
{
    return sluiceSubmitTileReads(loader, 1, pRead, pTicket);
}

SluiceResult sluiceCancelTileRead(SluiceTileLoader *loader, uint64_t ticket)
{
    if (!loader)
        return SLUICE_ERROR_NULL_POINTER;
    slc_mutex_lock(&loader->pool->mutex);
    struct slc_read *read = slc_read_queue_find(&loader->queue, ticket);
    if (read)
        drop_read(loader, read);
    /* reads behind the canceled read may fit into the freed bytes */
    if (slc_read_pool_has_startable(loader->pool))
        slc_read_pool_signal(loader->pool);
    slc_loader_signal_if_idle(loader);
    slc_read_pool_unlock(loader->pool);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceCollectTileReads(SluiceTileLoader *loader, uint32_t *pResultCount,
                                    SluiceTileReadResult *pResults)
{
    if (!loader || !pResultCount || (*pResultCount > 0 && !pResults))
        return SLUICE_ERROR_NULL_POINTER;
    uint32_t room = *pResultCount, count = 0;
    slc_mutex_lock(&loader->pool->mutex);
    while (count < room && slc_read_queue_collect(&loader->queue, &pResults[count]))
        count++;
    bool more = loader->queue.finished_count > 0;
    if (slc_uses_jobs(loader->pool)) /* a retry may be due, or a job was refused */
        slc_read_pool_signal(loader->pool);
    slc_read_pool_unlock(loader->pool);
    *pResultCount = count;
    return more ? SLUICE_INCOMPLETE : SLUICE_SUCCESS;
}

SluiceResult sluiceWaitTileLoaderIdle(SluiceTileLoader *loader)
{
    if (!loader)
        return SLUICE_ERROR_NULL_POINTER;
    slc_mutex_lock(&loader->pool->mutex);
    while (!slc_read_queue_is_idle(&loader->queue))
        slc_read_pool_wait(loader->pool, UINT64_MAX);
    slc_mutex_unlock(&loader->pool->mutex);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceGetTileLoaderStatistics(SluiceTileLoader *loader,
                                           const SluiceImageSource *source,
                                           SluiceTileLoaderStatistics *pStatistics)
{
    if (!loader || !pStatistics)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result =
        slc_struct_check(SLC_STRUCT(SluiceTileLoaderStatistics), pStatistics, NULL);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceTileLoaderStatistics statistics = {.structSize = sizeof statistics};
    slc_mutex_lock(&loader->pool->mutex);
    slc_read_queue_write_statistics(&loader->queue, source, &statistics);
    slc_mutex_unlock(&loader->pool->mutex);
    slc_struct_write(SLC_STRUCT(SluiceTileLoaderStatistics), pStatistics, &statistics);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceDropTileLoaderStatistics(SluiceTileLoader *loader,
                                            const SluiceImageSource *source)
{
    if (!loader || !source)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_read_pool *pool = loader->pool;
    struct slc_shared_region *dropped = NULL;
    slc_mutex_lock(&pool->mutex);
    if (pool->shares)
        slc_shared_reads_drop(pool->shares, source, &dropped);
    SluiceResult result = slc_read_queue_forget(&loader->queue, source);
    slc_mutex_unlock(&pool->mutex);
    if (dropped)
        slc_shared_regions_free(&pool->shares->cb, dropped);
    return result;
}

bool slc_loader_wait_for_read(SluiceTileLoader *loader, uint64_t until)
{
    bool in_time = true;
    slc_mutex_lock(&loader->pool->mutex);
    loader->awaited = true;
    /* The time comes first: with a job system, waiting may read here. */
    while (loader->queue.finished_count == 0 && !slc_read_queue_is_idle(&loader->queue) &&
           (in_time = slc_monotonic_time() < until))
        slc_read_pool_wait(loader->pool, until);
    loader->awaited = false;
    slc_mutex_unlock(&loader->pool->mutex);
    return in_time;
}

bool slc_loader_help(SluiceTileLoader *loader)
{
    struct slc_read_pool *pool = loader->pool;
    slc_mutex_lock(&pool->mutex);
    bool has_read = slc_uses_jobs(pool) && slc_read_jobs_help(pool);
    slc_mutex_unlock(&pool->mutex);
    return has_read;
}
