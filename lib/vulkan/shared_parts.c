#include "vulkan/shared_parts.h"

#include "base/alloc.h"
#include "image/read_pool.h"

#include <assert.h>

static SluiceResult create_pages(SluiceVulkanContext *context, uint32_t chunk_count)
{
    struct slc_page_pool *pool = slc_calloc(&context->cb, 1, sizeof *pool);
    if (!pool)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    SluiceResult result =
        slc_page_pool_init(pool, &context->vk, &context->caps, &context->cb, chunk_count);
    if (result == SLUICE_SUCCESS) {
        context->shared.pages = pool;
        return SLUICE_SUCCESS;
    }
    slc_page_pool_finish(pool);
    slc_free(&context->cb, pool, 1, sizeof *pool);
    return result;
}

SluiceResult slc_use_pages(SluiceVulkanContext *context, uint32_t chunk_count,
                           struct slc_page_pool **pool)
{
    struct slc_shared_parts *shared = &context->shared;
    SluiceResult result = SLUICE_SUCCESS;
    pthread_mutex_lock(&shared->mutex);
    if (!shared->pages)
        result = create_pages(context, chunk_count);
    if (result == SLUICE_SUCCESS) {
        shared->page_users++;
        *pool = shared->pages;
    }
    pthread_mutex_unlock(&shared->mutex);
    return result;
}

void slc_drop_pages(SluiceVulkanContext *context, struct slc_page_pool *pool)
{
    struct slc_shared_parts *shared = &context->shared;
    if (!pool)
        return;
    pthread_mutex_lock(&shared->mutex);
    assert(pool == shared->pages && shared->page_users > 0);
    if (--shared->page_users == 0) {
        slc_page_pool_finish(pool);
        slc_free(&context->cb, pool, 1, sizeof *pool);
        shared->pages = NULL;
    }
    pthread_mutex_unlock(&shared->mutex);
}

/* With the lock held. */
static void drop_threads(struct slc_shared_parts *shared)
{
    if (shared->loader_count > 0)
        return;
    slc_read_pool_destroy(shared->threads);
    shared->threads = NULL;
}

SluiceResult slc_create_shared_loader(SluiceVulkanContext *context,
                                      const SluiceTileLoaderCreateInfo *info,
                                      SluiceTileLoader **loader)
{
    struct slc_shared_parts *shared = &context->shared;
    SluiceResult result = SLUICE_SUCCESS;
    pthread_mutex_lock(&shared->mutex);
    if (!shared->threads)
        result = slc_read_pool_create(info, &shared->threads);
    if (result == SLUICE_SUCCESS)
        result = slc_create_pool_loader(shared->threads, info, loader);
    if (result == SLUICE_SUCCESS)
        shared->loader_count++;
    else
        drop_threads(shared);
    pthread_mutex_unlock(&shared->mutex);
    return result;
}

void slc_destroy_shared_loader(SluiceVulkanContext *context, SluiceTileLoader *loader)
{
    struct slc_shared_parts *shared = &context->shared;
    if (!loader)
        return;
    sluiceDestroyTileLoader(loader);
    pthread_mutex_lock(&shared->mutex);
    shared->loader_count--;
    drop_threads(shared);
    pthread_mutex_unlock(&shared->mutex);
}
