#define _POSIX_C_SOURCE 200809L

#include <sluice/loader.h>

#include "base/alloc.h"
#include "base/checked.h"
#include "image/read_queue.h"

#include <pthread.h>
#include <stdatomic.h>
#include <unistd.h>

struct SluiceTileLoader {
    SluiceAllocationCallbacks allocator;
    pthread_mutex_t mutex; ///< around everything below
    pthread_cond_t work;   ///< a read is queued, or the loader stops
    pthread_cond_t idle;   ///< nothing is queued or running
    struct slc_read_queue queue;
    uint32_t running_count;
    bool stopping;
    atomic_bool *dropped; ///< per slot: a running read that nobody wants any more
    uint32_t thread_count;
    pthread_t *threads;
};

static SluiceResult read_regions(struct SluiceTileLoader *loader, const struct slc_read *read,
                                 uint64_t *size)
{
    SluiceImageInfo info;
    SluiceResult result = sluiceGetImageInfo(read->source, &info);
    if (result != SLUICE_SUCCESS)
        return result;
    const atomic_bool *dropped = &loader->dropped[read - loader->queue.reads];
    for (uint32_t i = 0; i < read->region_count; i++) {
        if (atomic_load_explicit(dropped, memory_order_relaxed))
            return SLUICE_ERROR_CANCELLED;
        const SluiceImageRegion *region = &read->regions[i];
        result = sluiceReadImageRegion(read->source, region, read->texels[i],
                                       sluiceFormatRegionSize(info.format, region->width, 1));
        if (result != SLUICE_SUCCESS)
            return result;
        *size += sluiceFormatRegionSize(info.format, region->width, region->height);
    }
    return SLUICE_SUCCESS;
}

static void signal_if_idle(struct SluiceTileLoader *loader)
{
    if (loader->running_count == 0 && loader->queue.heap_count == 0)
        pthread_cond_broadcast(&loader->idle);
}

static void *worker_main(void *argument)
{
    struct SluiceTileLoader *loader = argument;
    pthread_mutex_lock(&loader->mutex);
    for (;;) {
        struct slc_read *read = slc_read_queue_start(&loader->queue);
        if (!read) {
            if (loader->stopping)
                break;
            pthread_cond_wait(&loader->work, &loader->mutex);
            continue;
        }
        loader->running_count++;
        atomic_store(&loader->dropped[read - loader->queue.reads], false);
        pthread_mutex_unlock(&loader->mutex);
        uint64_t size = 0;
        SluiceResult result = read_regions(loader, read, &size);
        pthread_mutex_lock(&loader->mutex);
        slc_read_queue_end(&loader->queue, read, result, result == SLUICE_SUCCESS ? size : 0);
        loader->running_count--;
        signal_if_idle(loader);
    }
    pthread_mutex_unlock(&loader->mutex);
    return NULL;
}

static uint32_t default_thread_count(void)
{
    long processors = sysconf(_SC_NPROCESSORS_ONLN);
    return processors > 2 ? (uint32_t)processors - 1 : 1;
}

static void free_memory(struct SluiceTileLoader *loader, uint32_t thread_count)
{
    SluiceAllocationCallbacks cb = loader->allocator;
    slc_free(&cb, loader->threads, thread_count, sizeof *loader->threads);
    slc_free(&cb, loader->dropped, loader->queue.capacity, sizeof *loader->dropped);
    slc_read_queue_finish(&loader->queue, &cb);
    slc_free(&cb, loader, 1, sizeof *loader);
}

static struct SluiceTileLoader *allocate(const SluiceAllocationCallbacks *cb, uint32_t capacity,
                                         uint32_t thread_count)
{
    struct SluiceTileLoader *loader = slc_calloc(cb, 1, sizeof *loader);
    if (!loader)
        return NULL;
    loader->allocator = *cb;
    if (slc_read_queue_init(&loader->queue, cb, capacity) != SLUICE_SUCCESS) {
        slc_free(cb, loader, 1, sizeof *loader);
        return NULL;
    }
    loader->dropped = slc_calloc(cb, capacity, sizeof *loader->dropped);
    loader->threads = slc_calloc(cb, thread_count, sizeof *loader->threads);
    if (!loader->dropped || !loader->threads) {
        free_memory(loader, thread_count);
        return NULL;
    }
    return loader;
}

static void stop_threads(struct SluiceTileLoader *loader)
{
    pthread_mutex_lock(&loader->mutex);
    loader->stopping = true;
    pthread_cond_broadcast(&loader->work);
    pthread_mutex_unlock(&loader->mutex);
    for (uint32_t i = 0; i < loader->thread_count; i++)
        pthread_join(loader->threads[i], NULL);
}

static void finish_synchronisation(struct SluiceTileLoader *loader)
{
    pthread_mutex_destroy(&loader->mutex);
    pthread_cond_destroy(&loader->work);
    pthread_cond_destroy(&loader->idle);
}

SluiceResult sluiceCreateTileLoader(const SluiceTileLoaderCreateInfo *pCreateInfo,
                                    SluiceTileLoader **pLoader)
{
    if (!pCreateInfo || !pLoader || !slc_allocator_is_valid(pCreateInfo->pAllocator))
        return SLUICE_ERROR_NULL_POINTER;
    SluiceAllocationCallbacks cb = slc_allocator(pCreateInfo->pAllocator);
    uint32_t capacity = pCreateInfo->requestCapacity ? pCreateInfo->requestCapacity : 1024;
    uint32_t wanted = pCreateInfo->threadCount ? pCreateInfo->threadCount : default_thread_count();
    struct SluiceTileLoader *loader = allocate(&cb, capacity, wanted);
    if (!loader)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    pthread_mutex_init(&loader->mutex, NULL);
    pthread_cond_init(&loader->work, NULL);
    pthread_cond_init(&loader->idle, NULL);
    while (loader->thread_count < wanted &&
           pthread_create(&loader->threads[loader->thread_count], NULL, worker_main, loader) == 0)
        loader->thread_count++;
    if (loader->thread_count < wanted) {
        stop_threads(loader);
        finish_synchronisation(loader);
        free_memory(loader, wanted);
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    *pLoader = loader;
    return SLUICE_SUCCESS;
}

static void drop_read(struct SluiceTileLoader *loader, struct slc_read *read)
{
    if (read->state == SLC_READ_QUEUED)
        slc_read_queue_end(&loader->queue, read, SLUICE_ERROR_CANCELLED, 0);
    else if (read->state == SLC_READ_RUNNING)
        atomic_store(&loader->dropped[read - loader->queue.reads], true);
}

void sluiceDestroyTileLoader(SluiceTileLoader *loader)
{
    if (!loader)
        return;
    pthread_mutex_lock(&loader->mutex);
    for (uint32_t i = 0; i < loader->queue.capacity; i++)
        drop_read(loader, &loader->queue.reads[i]);
    pthread_mutex_unlock(&loader->mutex);
    stop_threads(loader);
    finish_synchronisation(loader);
    free_memory(loader, loader->thread_count);
}

SluiceResult sluiceSubmitTileRead(SluiceTileLoader *loader, const SluiceTileRead *pRead,
                                  uint64_t *pTicket)
{
    if (!loader || !pRead || !pTicket || !pRead->source || !pRead->pRegions || !pRead->ppTexels)
        return SLUICE_ERROR_NULL_POINTER;
    if (pRead->regionCount == 0 || pRead->regionCount > SLUICE_MAX_READ_REGIONS)
        return SLUICE_ERROR_INVALID_ARGUMENT;
    for (uint32_t i = 0; i < pRead->regionCount; i++)
        if (!pRead->ppTexels[i])
            return SLUICE_ERROR_NULL_POINTER;
    pthread_mutex_lock(&loader->mutex);
    bool queued = slc_read_queue_submit(&loader->queue, pRead, pTicket);
    if (queued)
        pthread_cond_signal(&loader->work);
    pthread_mutex_unlock(&loader->mutex);
    return queued ? SLUICE_SUCCESS : SLUICE_NOT_READY;
}

void sluiceCancelTileRead(SluiceTileLoader *loader, uint64_t ticket)
{
    if (!loader)
        return;
    pthread_mutex_lock(&loader->mutex);
    struct slc_read *read = slc_read_queue_find(&loader->queue, ticket);
    if (read)
        drop_read(loader, read);
    signal_if_idle(loader);
    pthread_mutex_unlock(&loader->mutex);
}

SluiceResult sluiceCollectTileReads(SluiceTileLoader *loader, uint32_t *pResultCount,
                                    SluiceTileReadResult *pResults)
{
    if (!loader || !pResultCount || (*pResultCount > 0 && !pResults))
        return SLUICE_ERROR_NULL_POINTER;
    uint32_t room = *pResultCount, count = 0;
    pthread_mutex_lock(&loader->mutex);
    while (count < room && slc_read_queue_collect(&loader->queue, &pResults[count]))
        count++;
    bool more = loader->queue.finished_count > 0;
    pthread_mutex_unlock(&loader->mutex);
    *pResultCount = count;
    return more ? SLUICE_INCOMPLETE : SLUICE_SUCCESS;
}

void sluiceWaitTileLoaderIdle(SluiceTileLoader *loader)
{
    if (!loader)
        return;
    pthread_mutex_lock(&loader->mutex);
    while (loader->running_count > 0 || loader->queue.heap_count > 0)
        pthread_cond_wait(&loader->idle, &loader->mutex);
    pthread_mutex_unlock(&loader->mutex);
}
