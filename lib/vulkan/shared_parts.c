#include "vulkan/shared_parts.h"

#include "base/alloc.h"
#include "image/shared_pool.h"

#include <assert.h>

#define DEFAULT_PAGE_CHUNKS 64u

void slc_shared_parts_init(struct slc_shared_parts *shared, const struct slc_vk *vk,
                           const struct slc_caps *caps, const SluiceAllocationCallbacks *cb,
                           const SluiceVulkanContextCreateInfo *info)
{
    shared->vk = vk;
    shared->caps = caps;
    shared->cb = cb;
    shared->thread_count = info->loaderThreadCount;
    shared->max_reads_per_source = info->maxReadsPerSource;
    if (info->pJobSystem)
        shared->job_system = *info->pJobSystem;
    shared->read_pool = info->readPool;
    if (info->readPool)
        shared->job_system = info->readPool->threads->jobs.system;
    shared->max_page_chunks =
        info->maxPageChunkCount ? info->maxPageChunkCount : DEFAULT_PAGE_CHUNKS;
    shared->min_tile_memory = info->minTileMemorySize;
    shared->retry = info->readRetry;
    slc_mutex_init(&shared->mutex);
    slc_staging_group_init(&shared->staging, info->minStagingSize);
}

void slc_shared_parts_join(struct slc_shared_parts *shared)
{
    if (shared->read_pool)
        slc_read_pool_add_member(shared->read_pool);
}

void slc_shared_parts_leave(struct slc_shared_parts *shared)
{
    if (shared->read_pool)
        slc_read_pool_remove_member(shared->read_pool);
}

void slc_shared_parts_finish(struct slc_shared_parts *shared)
{
    assert(!shared->pages && !shared->threads);
    slc_staging_group_finish(&shared->staging);
    slc_mutex_finish(&shared->mutex);
}

bool slc_shares_jobs(const struct slc_shared_parts *shared)
{
    return shared->job_system.pfnSubmitJob;
}

static SluiceResult create_pages(struct slc_shared_parts *shared)
{
    struct slc_page_pool *pool = slc_calloc(shared->cb, 1, sizeof *pool);
    if (!pool)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    SluiceResult result =
        slc_page_pool_init(pool, shared->vk, shared->caps, shared->cb, shared->max_page_chunks);
    if (result == SLUICE_SUCCESS) {
        slc_page_pool_keep(pool, shared->min_tile_memory);
        shared->pages = pool;
        return SLUICE_SUCCESS;
    }
    slc_page_pool_finish(pool);
    slc_free(shared->cb, pool, 1, sizeof *pool);
    return result;
}

SluiceResult slc_use_pages(struct slc_shared_parts *shared, struct slc_page_pool **pool)
{
    SluiceResult result = SLUICE_SUCCESS;
    slc_mutex_lock(&shared->mutex);
    if (!shared->pages)
        result = create_pages(shared);
    if (result == SLUICE_SUCCESS) {
        shared->page_users++;
        *pool = shared->pages;
    }
    slc_mutex_unlock(&shared->mutex);
    return result;
}

void slc_drop_pages(struct slc_shared_parts *shared, struct slc_page_pool *pool)
{
    if (!pool)
        return;
    slc_mutex_lock(&shared->mutex);
    assert(pool == shared->pages && shared->page_users > 0);
    if (--shared->page_users == 0) {
        slc_page_pool_finish(pool);
        slc_free(shared->cb, pool, 1, sizeof *pool);
        shared->pages = NULL;
    }
    slc_mutex_unlock(&shared->mutex);
}

/* Makes the threads for the first loader. The caller holds the lock. */
static SluiceResult use_threads(struct slc_shared_parts *shared,
                                const SluiceTileLoaderCreateInfo *create)
{
    if (shared->threads)
        return SLUICE_SUCCESS;
    if (!shared->read_pool)
        return slc_read_pool_create(create, &shared->threads);
    shared->threads = shared->read_pool->threads;
    return SLUICE_SUCCESS;
}

static void drop_threads(struct slc_shared_parts *shared)
{
    if (shared->loader_count > 0)
        return;
    if (shared->read_pool) {
        shared->threads = NULL;
        return;
    }
    slc_read_pool_destroy(shared->threads);
    shared->threads = NULL;
}

SluiceResult slc_create_shared_loader(struct slc_shared_parts *shared,
                                      const SluiceTileLoaderCreateInfo *info,
                                      SluiceTileLoader **loader)
{
    SluiceTileLoaderCreateInfo create = *info;
    create.pAllocator = shared->cb;
    create.threadCount = shared->thread_count;
    create.maxReadsPerSource = shared->max_reads_per_source;
    create.retry = shared->retry;
    if (slc_shares_jobs(shared))
        create.pJobSystem = &shared->job_system;
    slc_mutex_lock(&shared->mutex);
    SluiceResult result = use_threads(shared, &create);
    if (result == SLUICE_SUCCESS)
        result = slc_create_pool_loader(shared->threads, &create, loader);
    if (result == SLUICE_SUCCESS) {
        (*loader)->uncached = slc_staging_is_uncached(shared->caps);
        shared->loader_count++;
    } else {
        drop_threads(shared);
    }
    slc_mutex_unlock(&shared->mutex);
    return result;
}

void slc_destroy_shared_loader(struct slc_shared_parts *shared, SluiceTileLoader *loader)
{
    if (!loader)
        return;
    sluiceDestroyTileLoader(loader);
    slc_mutex_lock(&shared->mutex);
    shared->loader_count--;
    drop_threads(shared);
    slc_mutex_unlock(&shared->mutex);
}
