#include "image/pooled_reads.h"

#include "image/region.h"
#include "platform/time_now.h"

#include <assert.h>
#include <string.h>

bool slc_reads_are_pooled(const SluiceTileLoader *loader, const SluiceImageSource *source)
{
    return loader->pool->shares && source->pInterface != loader->direct[0] &&
           source->pInterface != loader->direct[1];
}

static size_t region_size(SluiceFormat format, const SluiceImageRegion *at)
{
    return sluiceGetFormatRegionSize(format, at->width, at->height);
}

enum slc_delivery slc_pooled_region_claim(SluiceTileLoader *loader, struct slc_read *read,
                                          const SluiceImageInfo *info, uint32_t region,
                                          struct slc_shared_region **shared)
{
    struct slc_shared_reads *shares = loader->pool->shares;
    SluiceImageSource *source = read->source->source;
    const SluiceImageRegion *at = &read->regions[region];
    size_t size = region_size(info->format, at);
    *shared = NULL;
    if (read->held) {
        struct slc_shared_region *held = read->held;
        read->held = NULL;
        if (held->size == size && slc_shared_region_is_at(held, at)) {
            *shared = held;
            shares->statistics.joinedCount++;
            return SLC_DELIVER_COPY;
        }
        slc_shared_reads_release(shares, held); /* another format: the source has changed */
    }
    if (!slc_reads_are_pooled(loader, source) || !slc_shared_reads_are_on(shares) ||
        !slc_region_is_valid(at, info) || size > loader->pool->load.max_running_size)
        return read->is_copy ? SLC_DELIVER_WAIT : SLC_DELIVER_ALONE;
    return slc_shared_reads_claim(shares, read, at, size, shared);
}

/* Resumes waiting reads. They hold the texels, or get the failure if `held` is NULL. */
static void resume_waiting(SluiceTileLoader *loader, struct slc_read *waiting,
                           struct slc_shared_region *held, const struct slc_joined_failure *failed)
{
    struct slc_read *next;
    bool any = waiting;
    for (; waiting; waiting = next) {
        next = waiting->next_waiting;
        waiting->next_waiting = NULL;
        waiting->awaited = NULL;
        assert(!waiting->held);
        waiting->held = held;
        waiting->failed = *failed;
        slc_read_queue_resume(slc_read_queue_of(waiting), waiting);
    }
    if (any)
        slc_read_pool_signal(loader->pool);
}

void slc_pooled_region_count(SluiceTileLoader *loader, const struct slc_read *read,
                             SluiceFormat format, uint32_t region)
{
    if (!slc_reads_are_pooled(loader, read->source->source))
        return;
    loader->pool->shares->statistics.readCount++;
    loader->pool->shares->statistics.readSize += region_size(format, &read->regions[region]);
}

void slc_pooled_region_end(SluiceTileLoader *loader, struct slc_read *read, uint32_t region,
                           struct slc_shared_region *shared, enum slc_delivery delivery,
                           SluiceResult result, const SluiceImageFault *fault)
{
    struct slc_read_pool *pool = loader->pool;
    bool is_read = result == SLUICE_SUCCESS;
    if (delivery == SLC_DELIVER_READ) {
        pool->shares->statistics.readCount += is_read;
        pool->shares->statistics.readSize += is_read ? shared->size : 0;
        struct slc_joined_failure failed = {SLUICE_SUCCESS, {"", SLUICE_UNKNOWN_OFFSET}};
        if (!is_read && result != SLUICE_ERROR_CANCELED) /* a cancel concerns only the reader */
            failed = (struct slc_joined_failure){result, *fault};
        resume_waiting(loader, slc_shared_reads_end(pool->shares, shared, is_read),
                       is_read ? shared : NULL, &failed);
    }
    if (is_read) {
        slc_read_pool_unlock(pool);
        memcpy(read->texels[region], shared->texels, shared->size);
        slc_mutex_lock(&pool->mutex);
    }
    slc_shared_reads_release(pool->shares, shared);
}

SluiceResult slc_read_shared_region(const struct slc_shared_region *shared,
                                    const SluiceImageInfo *info, SluiceImageFault *fault)
{
    const SluiceImageRegion *at = &shared->region;
    return sluiceReadImageRegionLocated(shared->source, at, shared->texels,
                                        sluiceGetFormatRegionSize(info->format, at->width, 1),
                                        fault);
}

/* Delivers a region to a read. The mutex is held, and released in between. */
static SluiceResult deliver(SluiceTileLoader *loader, struct slc_read *read,
                            const SluiceImageInfo *info, uint32_t region, SluiceImageFault *fault)
{
    struct slc_read_pool *pool = loader->pool;
    struct slc_shared_region *shared;
    SluiceResult result = SLUICE_SUCCESS;
    enum slc_delivery delivery = slc_pooled_region_claim(loader, read, info, region, &shared);
    if (delivery == SLC_DELIVER_WAIT)
        return SLUICE_SUCCESS;
    if (delivery != SLC_DELIVER_COPY) {
        slc_mutex_unlock(&pool->mutex);
        result = shared ? slc_read_shared_region(shared, info, fault)
                        : slc_loader_read_region(loader, read, info, region, fault);
        slc_mutex_lock(&pool->mutex);
    }
    if (shared)
        slc_pooled_region_end(loader, read, region, shared, delivery, result, fault);
    else if (result == SLUICE_SUCCESS)
        slc_pooled_region_count(loader, read, info->format, region);
    if (result == SLUICE_SUCCESS)
        slc_read_region_done(read, info->format, region);
    return result;
}

void slc_read_pooled_regions(SluiceTileLoader *loader, struct slc_read *read,
                             const SluiceImageInfo *info, struct slc_read_outcome *outcome)
{
    for (uint32_t i = 0; i < read->region_count && outcome->result == SLUICE_SUCCESS; i++) {
        if (read->done >> i & 1)
            continue;
        outcome->region = i;
        outcome->result = slc_read_is_dropped(read)
                              ? SLUICE_ERROR_CANCELED
                              : deliver(loader, read, info, i, &outcome->fault);
    }
}

bool slc_pooled_read_waits(SluiceTileLoader *loader, struct slc_read *read,
                           struct slc_read_outcome *outcome)
{
    uint32_t left = ~read->done & (read->region_count < 32 ? (1u << read->region_count) - 1 : ~0u);
    if (outcome->result != SLUICE_SUCCESS || left == 0)
        return false;
    if (slc_read_is_dropped(read)) {
        outcome->result = SLUICE_ERROR_CANCELED;
        return false;
    }
    uint32_t first = 0;
    while (!(left >> first & 1))
        first++;
    struct slc_shared_region *region = slc_shared_reads_find_reading(
        loader->pool->shares, read->source->source, &read->regions[first]);
    if (region) {
        read->awaited = region;
        read->awaited_region = first;
        read->wait_time = slc_monotonic_time();
        slc_shared_region_await(region, read);
        slc_read_queue_wait(&loader->queue, read);
    } else { /* the region's reader has ended meanwhile, or a copy cannot be made */
        slc_read_queue_resume(&loader->queue, read);
    }
    return true;
}

bool slc_pooled_read_has_failed(struct slc_read *read, struct slc_read_outcome *outcome)
{
    const struct slc_joined_failure failed = read->failed;
    if (failed.result == SLUICE_SUCCESS)
        return false;
    read->failed.result = SLUICE_SUCCESS;
    *outcome = (struct slc_read_outcome){.result = failed.result,
                                         .fault = failed.fault,
                                         .region = read->awaited_region,
                                         .latency = slc_monotonic_time() - read->wait_time};
    return true;
}

void slc_pooled_read_ends(SluiceTileLoader *loader, struct slc_read *read)
{
    if (read->awaited)
        slc_shared_region_leave(read->awaited, read);
    if (read->held)
        slc_shared_reads_release(loader->pool->shares, read->held);
    read->awaited = read->held = NULL;
}

void slc_loader_drop_texels(SluiceTileLoader *loader, const SluiceImageSource *source)
{
    struct slc_read_pool *pool = loader->pool;
    struct slc_shared_region *dropped = NULL;
    if (!pool->shares || !source)
        return;
    slc_mutex_lock(&pool->mutex);
    slc_shared_reads_drop(pool->shares, source, &dropped);
    slc_mutex_unlock(&pool->mutex);
    slc_shared_regions_free(&pool->shares->cb, dropped);
}
