#include "image/read_pool.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "image/pooled_reads.h"
#include "image/start_read.h"
#include "image/started_reads.h"
#include "platform/time_now.h"

#include <string.h>

#define TILE_SIZE 65536u

bool slc_read_is_dropped(const struct slc_read *read)
{
    return atomic_load_explicit(&read->dropped, memory_order_relaxed);
}

/* Sources may read what they have written: to decompress, or to check a sum. */
static SluiceResult read_to_cache(SluiceImageSource *source, const SluiceImageRegion *region,
                                  void *texels, size_t size, size_t row_pitch,
                                  SluiceImageFault *fault)
{
    unsigned char cached[TILE_SIZE];
    SluiceResult result = sluiceReadImageRegionLocated(source, region, cached, row_pitch, fault);
    if (result == SLUICE_SUCCESS)
        memcpy(texels, cached, size);
    return result;
}

static bool goes_through_cache(const SluiceTileLoader *loader, const SluiceImageSource *source,
                               size_t size)
{
    return loader->uncached && size <= TILE_SIZE && source->pInterface != loader->direct[0] &&
           source->pInterface != loader->direct[1];
}

SluiceResult slc_loader_read_region(const SluiceTileLoader *loader, const struct slc_read *read,
                                    const SluiceImageInfo *info, uint32_t region,
                                    SluiceImageFault *fault)
{
    SluiceImageSource *source = read->source->source;
    const SluiceImageRegion *at = &read->regions[region];
    size_t row_pitch = sluiceGetFormatRegionSize(info->format, at->width, 1);
    size_t size = sluiceGetFormatRegionSize(info->format, at->width, at->height);
    void *texels = read->texels[region];
    return goes_through_cache(loader, source, size)
               ? read_to_cache(source, at, texels, size, row_pitch, fault)
               : sluiceReadImageRegionLocated(source, at, texels, row_pitch, fault);
}

void slc_read_region_done(struct slc_read *read, SluiceFormat format, uint32_t region)
{
    const SluiceImageRegion *at = &read->regions[region];
    read->done |= 1u << region;
    read->done_size += sluiceGetFormatRegionSize(format, at->width, at->height);
}

static void read_regions(const SluiceTileLoader *loader, struct slc_read *read,
                         const SluiceImageInfo *info, struct slc_read_outcome *outcome)
{
    for (uint32_t i = 0; i < read->region_count; i++) {
        if (read->done >> i & 1)
            continue;
        outcome->region = i;
        outcome->result = slc_read_is_dropped(read)
                              ? SLUICE_ERROR_CANCELED
                              : slc_loader_read_region(loader, read, info, i, &outcome->fault);
        if (outcome->result != SLUICE_SUCCESS)
            return;
        slc_read_region_done(read, info->format, i);
    }
}

/* Reports a failure. The mutex is held, and released in between. Called before the read ends,
 * because the source need not live longer. */
static void report_failure(const SluiceTileLoader *loader, const struct slc_read *read,
                           const struct slc_read_outcome *outcome, bool will_retry, uint64_t delay)
{
    struct slc_mutex *mutex = &loader->pool->mutex;
    bool is_failure = outcome->result != SLUICE_SUCCESS &&
                      outcome->result != SLUICE_ERROR_CANCELED &&
                      (outcome->result != SLUICE_NOT_READY || !will_retry);
    if (!is_failure || !loader->failure.pfnFailed)
        return;
    SluiceTileReadFailure failure = {
        .structSize = sizeof failure,
        .source = read->source->source,
        .pName = outcome->fault.pName,
        .region = read->regions[outcome->region],
        .result = outcome->result,
        .attempt = read->attempts.count,
        .willRetry = will_retry,
        .retryDelayNs = will_retry ? delay : 0,
        .userValue = read->result.userValue,
        .offset = outcome->fault.offset,
    };
    slc_mutex_unlock(mutex);
    loader->failure.pfnFailed(loader->failure.pUserData, &failure);
    slc_mutex_lock(mutex);
}

void slc_loader_signal_if_idle(SluiceTileLoader *loader)
{
    if (slc_read_queue_is_idle(&loader->queue) ||
        (loader->awaited && loader->queue.finished_count > 0))
        slc_condition_broadcast(&loader->pool->idle);
}

void slc_loader_end_read(SluiceTileLoader *loader, struct slc_read *read, SluiceResult result)
{
    slc_read_queue_end(&loader->queue, read, result);
    slc_pooled_read_ends(loader, read);
    if (loader->end.pfnEnded)
        loader->end.pfnEnded(loader->end.pUserData, read->result.userValue, result);
}

void slc_loader_settle_read(SluiceTileLoader *loader, struct slc_read *read,
                            const struct slc_read_outcome *outcome)
{
    uint64_t delay = 0;
    read->attempts.count++;
    read->attempts.corrupt_count += outcome->result == SLUICE_ERROR_CORRUPT_DATA;
    bool will_retry = slc_retry_is_due(&loader->retry, &read->attempts, outcome->result, &delay);
    report_failure(loader, read, outcome, will_retry, delay);
    slc_read_queue_add_attempt(&loader->queue, read, outcome->result, outcome->fault.offset,
                               outcome->latency);
    if (!will_retry) {
        slc_loader_end_read(loader, read, outcome->result);
    } else if (slc_read_is_dropped(read)) {
        slc_loader_end_read(loader, read, SLUICE_ERROR_CANCELED);
    } else {
        uint64_t now = slc_monotonic_time();
        slc_read_queue_delay(&loader->queue, read,
                             delay < UINT64_MAX - now ? now + delay : UINT64_MAX - 1);
    }
    slc_loader_signal_if_idle(loader);
}

/* Runs a read. The mutex is held, and released in between. */
static void run(SluiceTileLoader *loader, struct slc_read *read)
{
    struct slc_mutex *mutex = &loader->pool->mutex;
    SluiceImageSource *source = read->source->source;
    SluiceImageInfo info = {.structSize = sizeof info};
    struct slc_read_outcome outcome = {.fault = {"", SLUICE_UNKNOWN_OFFSET}};
    if (slc_pooled_read_has_failed(read, &outcome)) {
        slc_loader_settle_read(loader, read, &outcome);
        return;
    }
    slc_read_pool_unlock(loader->pool); /* submits the next job, which reads meanwhile */
    uint64_t start = slc_monotonic_time();
    outcome.result = sluiceGetImageInfo(source, &info);
    bool is_known = outcome.result == SLUICE_SUCCESS;
    if (is_known && slc_starts_reads(source)) {
        slc_mutex_lock(mutex);
        slc_start_regions(loader, read, &info, start);
        return;
    }
    bool is_pooled = slc_reads_are_pooled(loader, source);
    if (is_known && !is_pooled)
        read_regions(loader, read, &info, &outcome);
    outcome.latency = slc_monotonic_time() - start;
    slc_mutex_lock(mutex);
    if (is_known && is_pooled) {
        slc_read_pooled_regions(loader, read, &info, &outcome);
        outcome.latency = slc_monotonic_time() - start;
    }
    if (is_known && info.format != SLUICE_FORMAT_UNDEFINED)
        read->source->format = info.format;
    if (!slc_pooled_read_waits(loader, read, &outcome))
        slc_loader_settle_read(loader, read, &outcome);
}

uint64_t slc_read_pool_next_due(const struct slc_read_pool *pool)
{
    uint64_t due = UINT64_MAX;
    for (const SluiceTileLoader *loader = pool->loaders; loader; loader = loader->next) {
        uint64_t own = slc_read_queue_next_due(&loader->queue);
        due = own < due ? own : due;
    }
    return due;
}

/* Waits for a signal, or until the first delayed read is due. */
static void wait_for_work(struct slc_read_pool *pool)
{
    uint64_t due = slc_read_pool_next_due(pool);
    pool->waiting_count++;
    if (due == UINT64_MAX)
        slc_condition_wait(&pool->work, &pool->mutex);
    else
        slc_condition_wait_until(&pool->work, &pool->mutex, due);
    pool->waiting_count--;
    pool->signaled_count -= pool->signaled_count > 0;
}

void slc_read_pool_wait(struct slc_read_pool *pool, uint64_t until)
{
    if (slc_uses_jobs(pool))
        slc_read_jobs_wait(pool, until);
    else if (until == UINT64_MAX)
        slc_condition_wait(&pool->idle, &pool->mutex);
    else
        slc_condition_wait_until(&pool->idle, &pool->mutex, until);
}

/*
 * Wakes one thread at a time, which wakes the next one if there is more work: few running threads
 * finish quick reads sooner than many that wait for each other.
 */
void slc_read_pool_signal(struct slc_read_pool *pool)
{
    if (slc_uses_jobs(pool)) {
        slc_read_jobs_want(pool);
        return;
    }
    if (pool->waiting_count == 0 || pool->signaled_count > 0)
        return;
    pool->signaled_count++;
    slc_condition_signal(&pool->work);
}

void slc_read_pool_unlock(struct slc_read_pool *pool)
{
    slc_read_jobs_submit(pool);
    slc_mutex_unlock(&pool->mutex);
}

bool slc_read_pool_has_startable(const struct slc_read_pool *pool)
{
    for (const SluiceTileLoader *loader = pool->loaders; loader; loader = loader->next)
        if (loader->queue.copies.root || loader->queue.startable.root)
            return true;
    return false;
}

bool slc_read_pool_has_work(const struct slc_read_pool *pool)
{
    for (const SluiceTileLoader *loader = pool->loaders; loader; loader = loader->next)
        if (loader->queue.copies.root || loader->queue.startable.root || loader->queue.delayed.root)
            return true;
    return false;
}

/* Starts a copy of any loader. Copies are short, and wait for nothing. */
static struct slc_read *start_copy(struct slc_read_pool *pool, uint64_t now,
                                   SluiceTileLoader **loader)
{
    struct slc_read *read = NULL;
    for (SluiceTileLoader *at = pool->loaders; at && !read; at = at->next) {
        read = slc_read_queue_start_copy(&at->queue, now);
        *loader = at;
    }
    return read;
}

/* Starts a read. Loaders take turns. A read that waits until fewer bytes are being read keeps its
 * turn: otherwise small reads of other loaders could delay it forever. */
static struct slc_read *start(struct slc_read_pool *pool, SluiceTileLoader **loader)
{
    SluiceTileLoader *first = pool->turn ? pool->turn : pool->loaders, *at = first;
    uint64_t now = first ? slc_monotonic_time() : 0;
    struct slc_read *copy = start_copy(pool, now, loader);
    if (copy)
        return copy;
    while (at) {
        SluiceTileLoader *next = at->next ? at->next : pool->loaders;
        struct slc_read *read = slc_read_queue_start(&at->queue, now);
        pool->turn = read ? next : at;
        *loader = at;
        if (read || at->queue.startable.root || next == first)
            return read;
        at = next;
    }
    return NULL;
}

bool slc_read_pool_read(struct slc_read_pool *pool)
{
    SluiceTileLoader *loader = NULL;
    struct slc_read *read = start(pool, &loader);
    if (!read)
        return false;
    /* This thread may be busy for long: another one takes the remaining work. */
    if (slc_read_pool_has_work(pool))
        slc_read_pool_signal(pool);
    run(loader, read);
    return true;
}

static void *worker_main(void *argument)
{
    struct slc_read_pool *pool = argument;
    slc_mutex_lock(&pool->mutex);
    for (;;) {
        if (slc_read_pool_read(pool))
            continue;
        if (pool->stopping)
            break;
        wait_for_work(pool);
    }
    slc_mutex_unlock(&pool->mutex);
    return NULL;
}

/* Returns the default number of threads. At least two, so that one stalling source does not stop
 * all. */
static uint32_t default_thread_count(void)
{
    uint32_t processors = slc_get_processor_count();
    return processors > 3 ? processors - 1 : 2;
}

/* Stops the pool. `wanted`: number of threads that were allocated. */
static void stop(struct slc_read_pool *pool, uint32_t wanted)
{
    slc_mutex_lock(&pool->mutex);
    pool->stopping = true;
    slc_condition_broadcast(&pool->work);
    slc_read_jobs_finish(pool);
    slc_mutex_unlock(&pool->mutex);
    for (uint32_t i = 0; i < pool->thread_count; i++)
        slc_thread_join(&pool->threads[i]);
    slc_mutex_finish(&pool->mutex);
    slc_condition_finish(&pool->work);
    slc_condition_finish(&pool->idle);
    SluiceAllocationCallbacks cb = pool->allocator;
    slc_free(&cb, pool->threads, wanted, sizeof *pool->threads);
    slc_free(&cb, pool, 1, sizeof *pool);
}

static bool start_threads(struct slc_read_pool *pool, uint32_t wanted)
{
    pool->threads = slc_calloc(&pool->allocator, wanted, sizeof *pool->threads);
    while (pool->threads && pool->thread_count < wanted &&
           slc_thread_start(&pool->threads[pool->thread_count], worker_main, pool))
        pool->thread_count++;
    return pool->thread_count == wanted;
}

SluiceResult slc_read_pool_create(const SluiceTileLoaderCreateInfo *info,
                                  struct slc_read_pool **out)
{
    uint32_t wanted = info->threadCount ? info->threadCount : default_thread_count();
    uint32_t per_source = info->maxReadsPerSource ? info->maxReadsPerSource : wanted - 1;
    SluiceAllocationCallbacks cb = slc_allocator(info->pAllocator);
    struct slc_read_pool *pool = slc_calloc(&cb, 1, sizeof *pool);
    if (!pool)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    pool->allocator = cb;
    pool->load = (struct slc_read_load){
        .max_running_per_source = slc_max_u32(1, per_source),
        .max_running_size = info->maxBytesInFlight ? info->maxBytesInFlight : (uint64_t)1 << 28,
    };
    slc_mutex_init_spinning(&pool->mutex);
    slc_condition_init(&pool->work);
    slc_condition_init(&pool->idle);
    if (info->pJobSystem) {
        pool->jobs.system = *info->pJobSystem;
        pool->jobs.max_count = wanted;
    } else if (!start_threads(pool, wanted)) {
        stop(pool, wanted);
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    *out = pool;
    return SLUICE_SUCCESS;
}

void slc_read_pool_destroy(struct slc_read_pool *pool)
{
    if (pool)
        stop(pool, pool->thread_count);
}
