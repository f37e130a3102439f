#include "image/started_reads.h"

#include "image/pooled_reads.h"
#include "image/start_read.h"
#include "platform/time_now.h"

static SluiceImageReadToken token_of(SluiceTileLoader *loader, const struct slc_read *read,
                                     uint32_t region)
{
    return (SluiceImageReadToken){loader, read->result.ticket, region, read->attempts.count};
}

static bool is_pending(const struct slc_read *read, uint32_t region)
{
    return read->started.pending >> region & 1;
}

/* Completes a region. The mutex is held, and released while texels of the pool are copied. `fault`
 * NULL: the source's name, and no offset. */
static void complete_region(SluiceTileLoader *loader, struct slc_read *read, uint32_t region,
                            SluiceResult result, const SluiceImageFault *fault)
{
    struct slc_started *started = &read->started;
    struct slc_shared_region *shared = started->shared[region];
    if (!is_pending(read, region))
        return;
    started->pending &= ~(1u << region);
    started->shared[region] = NULL;
    const SluiceImageFault unknown = {started->fault.pName, SLUICE_UNKNOWN_OFFSET};
    if (!fault)
        fault = &unknown;
    if (shared) {
        started->calls++;
        slc_pooled_region_end(loader, read, region, shared, SLC_DELIVER_READ, result, fault);
        started->calls--;
    } else if (result == SLUICE_SUCCESS) {
        slc_pooled_region_count(loader, read, started->format, region);
    }
    if (result == SLUICE_SUCCESS) {
        slc_read_region_done(read, started->format, region);
    } else if (started->result == SLUICE_SUCCESS) {
        started->result = result;
        started->failed_region = region;
        started->fault = *fault;
    }
}

/* Exactly one caller finds the last region completed and the last call returned. */
static void settle_if_over(SluiceTileLoader *loader, struct slc_read *read)
{
    const struct slc_started *started = &read->started;
    if (started->pending || started->calls)
        return;
    struct slc_read_outcome outcome = {.result = started->result,
                                       .fault = started->fault,
                                       .region = started->failed_region,
                                       .latency = slc_monotonic_time() - started->start_time};
    if (!slc_pooled_read_waits(loader, read, &outcome))
        slc_loader_settle_read(loader, read, &outcome);
    if (slc_read_pool_has_work(loader->pool))
        slc_read_pool_signal(loader->pool);
}

/* Starts a region. The mutex is held, and released in between. */
static void start_region(SluiceTileLoader *loader, struct slc_read *read,
                         const SluiceImageInfo *info, uint32_t region)
{
    struct slc_mutex *mutex = &loader->pool->mutex;
    const SluiceImageReadToken token = token_of(loader, read, region);
    const SluiceImageRegion *at = &read->regions[region];
    SluiceImageFault fault = {"", SLUICE_UNKNOWN_OFFSET};
    struct slc_shared_region *shared;
    enum slc_delivery delivery = slc_pooled_region_claim(loader, read, info, region, &shared);
    if (delivery == SLC_DELIVER_WAIT)
        return;
    if (delivery == SLC_DELIVER_COPY) {
        slc_pooled_region_end(loader, read, region, shared, delivery, SLUICE_SUCCESS, NULL);
        slc_read_region_done(read, info->format, region);
        return;
    }
    read->started.shared[region] = shared;
    read->started.pending |= 1u << region;
    slc_mutex_unlock(mutex);
    SluiceResult result = slc_start_read(
        read->source->source, info, at, shared ? shared->texels : read->texels[region],
        sluiceGetFormatRegionSize(info->format, at->width, 1), &token);
    bool is_started = result == SLUICE_SUCCESS;
    bool is_read = result == SLUICE_ERROR_UNSUPPORTED;
    if (is_read)
        result = shared ? slc_read_shared_region(shared, info, &fault)
                        : slc_loader_read_region(loader, read, info, region, &fault);
    slc_mutex_lock(mutex);
    if (!is_started)
        complete_region(loader, read, region, result, is_read ? &fault : NULL);
}

void slc_start_regions(SluiceTileLoader *loader, struct slc_read *read, const SluiceImageInfo *info,
                       uint64_t start_time)
{
    struct slc_started *started = &read->started;
    *started =
        (struct slc_started){.calls = 1,
                             .starting = true,
                             .format = info->format,
                             .fault = {info->pName ? info->pName : "", SLUICE_UNKNOWN_OFFSET},
                             .start_time = start_time};
    read->source->format = info->format;
    for (uint32_t i = 0; i < read->region_count && started->result == SLUICE_SUCCESS; i++) {
        if (read->done >> i & 1)
            continue;
        if (atomic_load_explicit(&read->dropped, memory_order_relaxed)) {
            started->result = SLUICE_ERROR_CANCELED;
            started->failed_region = i;
        } else {
            start_region(loader, read, info, i);
        }
    }
    started->starting = false;
    started->calls--;
    if (started->pending)
        slc_read_queue_release_thread(&loader->queue, read);
    if (started->pending && atomic_load_explicit(&read->dropped, memory_order_relaxed))
        slc_cancel_regions(loader, read);
    else
        settle_if_over(loader, read);
}

/* True if the source must be told of the cancel. */
static bool is_unwanted(const SluiceTileLoader *loader, const struct slc_read *read,
                        uint32_t region)
{
    const struct slc_started *started = &read->started;
    const struct slc_shared_region *shared = started->shared[region];
    return is_pending(read, region) && !(started->told >> region & 1) &&
           (!shared || !shared->waiting || loader->ending);
}

void slc_cancel_regions(SluiceTileLoader *loader, struct slc_read *read)
{
    struct slc_started *started = &read->started;
    if (!started->pending || started->starting)
        return;
    started->calls++;
    for (uint32_t i = 0; i < read->region_count; i++) {
        if (!is_unwanted(loader, read, i))
            continue;
        started->told |= 1u << i;
        if (started->shared[i])
            slc_shared_reads_hide(loader->pool->shares, started->shared[i]);
        const SluiceImageReadToken token = token_of(loader, read, i);
        slc_mutex_unlock(&loader->pool->mutex);
        slc_cancel_read(read->source->source, &read->regions[i], &token);
        slc_mutex_lock(&loader->pool->mutex);
    }
    started->calls--;
    settle_if_over(loader, read);
}

void slc_cancel_unwanted_region(const struct slc_shared_region *region)
{
    struct slc_read *reader = region->reader;
    if (!reader || region->waiting || !slc_read_is_dropped(reader))
        return;
    struct slc_read_queue *queue = slc_read_queue_of(reader);
    slc_cancel_regions(SLC_CONTAINER_OF(queue, SluiceTileLoader, queue), reader);
}

static bool is_awaited(const struct slc_read *read, const SluiceImageReadToken *token)
{
    return read && read->state == SLC_READ_RUNNING && token->region < read->region_count &&
           is_pending(read, token->region) && read->attempts.count == token->attempt;
}

SluiceResult sluiceCompleteImageRead(const SluiceImageReadToken *pToken, SluiceResult result)
{
    if (!pToken || !pToken->pReader)
        return SLUICE_ERROR_NULL_POINTER;
    const SluiceImageReadToken token = *pToken; /* copied, because it may be freed with the read */
    SluiceTileLoader *loader = token.pReader;
    struct slc_read_pool *pool = loader->pool;
    slc_mutex_lock(&pool->mutex);
    struct slc_read *read = slc_read_queue_find(&loader->queue, token.ticket);
    bool awaited = is_awaited(read, &token);
    if (awaited) {
        complete_region(loader, read, token.region, result, NULL);
        settle_if_over(loader, read);
    }
    slc_read_pool_unlock(pool); /* loader and pool may be destroyed from here on */
    return awaited ? SLUICE_SUCCESS : SLUICE_ERROR_INVALID_ARGUMENT;
}
