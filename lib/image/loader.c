#define _GNU_SOURCE /* mutexes that spin before they sleep */

#include <sluice/loader.h>

#include "base/alloc.h"
#include "base/checked.h"
#include "image/read_queue.h"

#include <pthread.h>
#include <time.h>
#include <unistd.h>

/* Of reads, and of sources that are remembered. */
#define MAX_COUNT (1u << 29)

struct SluiceTileLoader {
    SluiceAllocationCallbacks allocator;
    SluiceTileRetryPolicy retry;
    SluiceTileReadFailureCallback failure;
    SluiceTileReadEndCallback end;
    pthread_mutex_t mutex; ///< around everything below
    pthread_cond_t work;   ///< a read may have become startable or delayed, or the loader stops
    pthread_cond_t idle;   ///< nothing is queued, delayed or running
    struct slc_read_queue queue;
    bool stopping;
    uint32_t waiting_count;   ///< threads that wait for `work`
    uint32_t signalled_count; ///< of which so many were told, and have not woken yet
    uint32_t thread_count;
    pthread_t *threads;
};

/* One try at the regions of a read that are left. */
struct attempt {
    SluiceResult result;
    SluiceImageInfo info; ///< zeroed if the source did not tell
    SluiceImageFault fault;
    uint64_t latency; ///< ns
};

static uint64_t nanoseconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * 1000000000u + (uint64_t)now.tv_nsec;
}

static bool is_dropped(const struct slc_read *read)
{
    return atomic_load_explicit(&read->dropped, memory_order_relaxed);
}

static SluiceResult read_regions(struct slc_read *read, SluiceImageInfo *info,
                                 SluiceImageFault *fault)
{
    SluiceImageSource *source = read->source->source;
    SluiceResult result = sluiceGetImageInfo(source, info);
    if (result != SLUICE_SUCCESS) {
        *info = (SluiceImageInfo){0};
        return result;
    }
    for (; read->done_count < read->region_count; read->done_count++) {
        if (is_dropped(read))
            return SLUICE_ERROR_CANCELLED;
        const SluiceImageRegion *region = &read->regions[read->done_count];
        result = sluiceReadImageRegionLocated(
            source, region, read->texels[read->done_count],
            sluiceFormatRegionSize(info->format, region->width, 1), fault);
        if (result != SLUICE_SUCCESS)
            return result;
        read->done_size += sluiceFormatRegionSize(info->format, region->width, region->height);
    }
    return SLUICE_SUCCESS;
}

static struct attempt make_attempt(struct slc_read *read)
{
    struct attempt attempt = {.fault = {"", SLUICE_UNKNOWN_OFFSET}};
    uint64_t start = nanoseconds();
    attempt.result = read_regions(read, &attempt.info, &attempt.fault);
    attempt.latency = nanoseconds() - start;
    read->attempts.count++;
    read->attempts.corrupt_count += attempt.result == SLUICE_ERROR_CORRUPT_DATA;
    return attempt;
}

/* Before the read is over, because the source need not live longer. */
static void report_failure(const struct SluiceTileLoader *loader, const struct slc_read *read,
                           const struct attempt *attempt, bool will_retry, uint64_t delay)
{
    bool is_failure = attempt->result != SLUICE_SUCCESS &&
                      attempt->result != SLUICE_ERROR_CANCELLED &&
                      (attempt->result != SLUICE_NOT_READY || !will_retry);
    if (!is_failure || !loader->failure.pfnFailed)
        return;
    SluiceTileReadFailure failure = {
        .source = read->source->source,
        .pName = attempt->fault.pName,
        .region = read->regions[read->done_count],
        .result = attempt->result,
        .attempt = read->attempts.count,
        .willRetry = will_retry,
        .retryDelay = will_retry ? delay : 0,
        .userValue = read->result.userValue,
        .offset = attempt->fault.offset,
    };
    loader->failure.pfnFailed(loader->failure.pUserData, &failure);
}

static void signal_if_idle(struct SluiceTileLoader *loader)
{
    if (slc_read_queue_is_idle(&loader->queue))
        pthread_cond_broadcast(&loader->idle);
}

static void end_read(struct SluiceTileLoader *loader, struct slc_read *read, SluiceResult result)
{
    slc_read_queue_end(&loader->queue, read, result);
    if (loader->end.pfnEnded)
        loader->end.pfnEnded(loader->end.pUserData, read->result.userValue, result);
}

/* With the mutex held, which is given up meanwhile. */
static void run(struct SluiceTileLoader *loader, struct slc_read *read)
{
    uint64_t delay = 0;
    pthread_mutex_unlock(&loader->mutex);
    struct attempt attempt = make_attempt(read);
    bool will_retry = slc_retry_is_due(&loader->retry, &read->attempts, attempt.result, &delay);
    report_failure(loader, read, &attempt, will_retry, delay);
    pthread_mutex_lock(&loader->mutex);
    if (attempt.info.format != SLUICE_FORMAT_UNDEFINED)
        read->source->format = attempt.info.format;
    slc_read_queue_add_attempt(&loader->queue, read, attempt.result, attempt.fault.offset,
                               attempt.latency);
    if (!will_retry) {
        end_read(loader, read, attempt.result);
    } else if (is_dropped(read)) {
        end_read(loader, read, SLUICE_ERROR_CANCELLED);
    } else {
        uint64_t now = nanoseconds();
        slc_read_queue_delay(&loader->queue, read,
                             delay < UINT64_MAX - now ? now + delay : UINT64_MAX - 1);
    }
    signal_if_idle(loader);
}

/* Until something is said, or until the first delayed read is due. */
static void wait_for_work(struct SluiceTileLoader *loader)
{
    uint64_t due = slc_read_queue_next_due(&loader->queue);
    struct timespec until = {(time_t)(due / 1000000000u), (long)(due % 1000000000u)};
    loader->waiting_count++;
    if (due == UINT64_MAX)
        pthread_cond_wait(&loader->work, &loader->mutex);
    else
        pthread_cond_timedwait(&loader->work, &loader->mutex, &until);
    loader->waiting_count--;
    loader->signalled_count -= loader->signalled_count > 0;
}

/*
 * One thread at a time, which will wake the next one if there is more: where reads are quick, few
 * threads that are awake do them sooner than many that wait for each other.
 */
static void signal_work(struct SluiceTileLoader *loader)
{
    if (loader->waiting_count == 0 || loader->signalled_count > 0)
        return;
    loader->signalled_count++;
    pthread_cond_signal(&loader->work);
}

static void *worker_main(void *argument)
{
    struct SluiceTileLoader *loader = argument;
    pthread_mutex_lock(&loader->mutex);
    for (;;) {
        struct slc_read *read = slc_read_queue_start(&loader->queue, nanoseconds());
        if (!read && loader->stopping)
            break;
        if (!read) {
            wait_for_work(loader);
            continue;
        }
        /* This thread may be gone for long: another one looks after what else there is. */
        if (loader->queue.startable.root || loader->queue.delayed.root)
            signal_work(loader);
        run(loader, read);
    }
    pthread_mutex_unlock(&loader->mutex);
    return NULL;
}

/* At least two, or one source that stalls would stop all. */
static uint32_t default_thread_count(void)
{
    long processors = sysconf(_SC_NPROCESSORS_ONLN);
    return processors > 3 ? (uint32_t)processors - 1 : 2;
}

static void free_memory(struct SluiceTileLoader *loader, uint32_t thread_count)
{
    SluiceAllocationCallbacks cb = loader->allocator;
    slc_free(&cb, loader->threads, thread_count, sizeof *loader->threads);
    slc_read_queue_finish(&loader->queue, &cb);
    slc_free(&cb, loader, 1, sizeof *loader);
}

static struct slc_read_queue_limits read_limits(const SluiceTileLoaderCreateInfo *info,
                                                uint32_t thread_count)
{
    uint32_t capacity = info->requestCapacity ? info->requestCapacity : 1024;
    uint32_t per_source = info->maxReadsPerSource ? info->maxReadsPerSource : thread_count - 1;
    return (struct slc_read_queue_limits){
        .capacity = capacity,
        .source_count = slc_max_u32(capacity, info->maxSourceCount),
        .max_running_per_source = slc_max_u32(1, per_source),
        .max_running_size = info->maxBytesInFlight ? info->maxBytesInFlight : (uint64_t)1 << 28,
    };
}

static struct SluiceTileLoader *allocate(const SluiceTileLoaderCreateInfo *info,
                                         uint32_t thread_count)
{
    SluiceAllocationCallbacks cb = slc_allocator(info->pAllocator);
    struct SluiceTileLoader *loader = slc_calloc(&cb, 1, sizeof *loader);
    if (!loader)
        return NULL;
    loader->allocator = cb;
    loader->retry = slc_retry_policy(&info->retry);
    loader->failure = info->failure;
    loader->end = info->end;
    struct slc_read_queue_limits limits = read_limits(info, thread_count);
    if (slc_read_queue_init(&loader->queue, &cb, &limits) != SLUICE_SUCCESS) {
        slc_free(&cb, loader, 1, sizeof *loader);
        return NULL;
    }
    loader->threads = slc_calloc(&cb, thread_count, sizeof *loader->threads);
    if (!loader->threads) {
        free_memory(loader, thread_count);
        return NULL;
    }
    return loader;
}

static void init_synchronisation(struct SluiceTileLoader *loader)
{
    pthread_condattr_t attributes;
    pthread_condattr_init(&attributes);
    pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
    pthread_mutexattr_t mutex;
    pthread_mutexattr_init(&mutex);
#ifdef PTHREAD_ADAPTIVE_MUTEX_INITIALIZER_NP
    pthread_mutexattr_settype(&mutex, PTHREAD_MUTEX_ADAPTIVE_NP);
#endif
    pthread_mutex_init(&loader->mutex, &mutex);
    pthread_mutexattr_destroy(&mutex);
    pthread_cond_init(&loader->work, &attributes);
    pthread_cond_init(&loader->idle, NULL);
    pthread_condattr_destroy(&attributes);
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
    if (pCreateInfo->requestCapacity > MAX_COUNT || pCreateInfo->maxSourceCount > MAX_COUNT)
        return SLUICE_ERROR_INVALID_ARGUMENT;
    uint32_t wanted = pCreateInfo->threadCount ? pCreateInfo->threadCount : default_thread_count();
    struct SluiceTileLoader *loader = allocate(pCreateInfo, wanted);
    if (!loader)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    init_synchronisation(loader);
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
    if (read->state == SLC_READ_QUEUED || read->state == SLC_READ_DELAYED)
        end_read(loader, read, SLUICE_ERROR_CANCELLED);
    else if (read->state == SLC_READ_RUNNING)
        atomic_store_explicit(&read->dropped, true, memory_order_relaxed);
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
    pthread_mutex_lock(&loader->mutex);
    bool room = loader->queue.free_count >= count;
    for (uint32_t i = 0; room && i < count; i++)
        slc_read_queue_submit(&loader->queue, &pReads[i], &pTickets[i]);
    if (room)
        signal_work(loader);
    pthread_mutex_unlock(&loader->mutex);
    return room ? SLUICE_SUCCESS : SLUICE_NOT_READY;
}

SluiceResult sluiceSubmitTileRead(SluiceTileLoader *loader, const SluiceTileRead *pRead,
                                  uint64_t *pTicket)
{
    return sluiceSubmitTileReads(loader, 1, pRead, pTicket);
}

void sluiceCancelTileRead(SluiceTileLoader *loader, uint64_t ticket)
{
    if (!loader)
        return;
    pthread_mutex_lock(&loader->mutex);
    struct slc_read *read = slc_read_queue_find(&loader->queue, ticket);
    if (read)
        drop_read(loader, read);
    /* what stood behind it may fit into the bytes that are left */
    if (loader->queue.startable.root)
        signal_work(loader);
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
    while (!slc_read_queue_is_idle(&loader->queue))
        pthread_cond_wait(&loader->idle, &loader->mutex);
    pthread_mutex_unlock(&loader->mutex);
}

SluiceResult sluiceGetTileLoaderStatistics(SluiceTileLoader *loader,
                                           const SluiceImageSource *source,
                                           SluiceTileLoaderStatistics *pStatistics)
{
    if (!loader || !pStatistics)
        return SLUICE_ERROR_NULL_POINTER;
    pthread_mutex_lock(&loader->mutex);
    slc_read_queue_write_statistics(&loader->queue, source, pStatistics);
    pthread_mutex_unlock(&loader->mutex);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceForgetTileLoaderSource(SluiceTileLoader *loader, const SluiceImageSource *source)
{
    if (!loader || !source)
        return SLUICE_ERROR_NULL_POINTER;
    pthread_mutex_lock(&loader->mutex);
    SluiceResult result = slc_read_queue_forget(&loader->queue, source);
    pthread_mutex_unlock(&loader->mutex);
    return result;
}
