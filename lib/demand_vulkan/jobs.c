/*
 * Jobs: all work on other threads is a read of the tile loader, of a tile, of the texel that opens
 * an image, or of the value of a page. This file begins and ends all reads.
 */
#include "demand_vulkan/loader.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "demand_vulkan/productions.h"
#include "demand_vulkan/refused_arguments.h"
#include "image/read_pool.h"
#include "platform/time_now.h"
#include "vulkan/shared_parts.h"
#include "vulkan/sparse_layout.h"

#include <assert.h>

#define BATCH 256u
#define LEAST_LARGE 4u /* least jobs for large byte pages */

void slc_job_list_append(SluiceDemandLoader *loader, struct slc_job_list *list,
                         struct slc_demand_job *job)
{
    uint32_t index = slc_job_index(loader, job);
    job->next = SLC_NONE;
    if (list->first == SLC_NONE)
        list->first = index;
    else
        loader->jobs[list->last].next = index;
    list->last = index;
}

struct slc_demand_job *slc_job_list_pop(SluiceDemandLoader *loader, struct slc_job_list *list)
{
    if (list->first == SLC_NONE)
        return NULL;
    struct slc_demand_job *job = &loader->jobs[list->first];
    list->first = job->next;
    return job;
}

/* Called with the tile loader's lock held. So no code may take that lock while holding this one. */
static void on_end(void *user, uint64_t index, SluiceResult result)
{
    SluiceDemandLoader *loader = user;
    struct slc_tickets *tickets = &loader->tickets;
    struct slc_demand_job *job = &loader->jobs[index];
    uint64_t us = (slc_monotonic_time() - job->start) / 1000;
    uint32_t bucket = us >> 31 ? 31 : us ? slc_log2_u32((uint32_t)us) + 1 : 0;
    slc_mutex_lock(&tickets->mutex);
    if (result != SLUICE_ERROR_CANCELED)
        tickets->latency[slc_min_u32(bucket, 23)]++;
    job->running = false;
    slc_ticket_task_ends(tickets, job->ticket, result != SLUICE_SUCCESS);
    if (tickets->job_waiters)
        slc_condition_broadcast(&tickets->changed);
    slc_mutex_unlock(&tickets->mutex);
}

/* Translates the reader's source and value, which are internal, to those of the application. */
static void on_failure(void *user, const SluiceTileReadFailure *failure)
{
    const SluiceDemandLoader *loader = user;
    const struct slc_demand_job *job = &loader->jobs[failure->userValue];
    SluiceTileReadFailure told = *failure;
    told.userValue = job->id;
    if (job->kind == SLC_JOB_OPEN)
        told.source = job->image->source;
    else if (job->kind != SLC_JOB_TILE)
        told.source = NULL;
    loader->info.failure.pfnFailed(loader->info.failure.pUserData, &told);
}

static SluiceResult create_reader(SluiceDemandLoader *loader)
{
    SluiceTileLoaderCreateInfo create = {.structSize = sizeof create,
                                         .requestCapacity = loader->first_produce,
                                         .end = {loader, on_end}};
    if (loader->info.failure.pfnFailed)
        create.failure = (SluiceTileReadFailureCallback){loader, on_failure};
    SluiceResult result =
        slc_create_shared_loader(&loader->context->shared, &create, &loader->reader);
    if (result == SLUICE_SUCCESS) { /* done before the first read */
        loader->reader->direct[0] = loader->opener.pInterface;
        loader->reader->direct[1] = slc_resource_interface();
        if (slc_shares_jobs(&loader->context->shared))
            loader->tickets.reader = loader->reader;
    }
    return result;
}

/* Returns the list of free jobs of a kind. */
static struct slc_job_list *free_list(SluiceDemandLoader *loader, enum slc_job_kind kind,
                                      uint32_t **count)
{
    switch (kind) {
    case SLC_JOB_TILE:
    case SLC_JOB_BYTES: *count = &loader->free_tile_count; return &loader->free_tiles;
    case SLC_JOB_LARGE: *count = &loader->free_large_count; return &loader->free_large;
    case SLC_JOB_PRODUCE:
    case SLC_JOB_PRODUCE_BYTES: *count = &loader->free_produce_count; return &loader->free_produce;
    default: *count = &loader->free_other_count; return &loader->free_others;
    }
}

/* Returns the staging memory of a job; NULL: none. */
static struct slc_staging *staging_of(SluiceDemandLoader *loader, uint32_t index)
{
    if (index >= loader->first_produce)
        return NULL;
    if (index >= loader->first_large)
        return &loader->large;
    return index < loader->info.maxTilesInFlight ? &loader->staging : NULL;
}

/* Returns the first slot of a job in its staging memory. */
static uint32_t slot_of(const SluiceDemandLoader *loader, uint32_t index)
{
    return index < loader->first_large ? index : (index - loader->first_large) * SLC_LARGE_SLOTS;
}

SluiceResult slc_jobs_init(SluiceDemandLoader *loader)
{
    uint32_t tiles = loader->info.maxTilesInFlight;
    const struct slc_job_list empty = {SLC_NONE, SLC_NONE};
    loader->free_tiles = loader->free_others = loader->free_large = loader->free_produce = empty;
    loader->arrived = loader->admitted = loader->copied = empty;
    loader->first_large = 2 * tiles; /* the second `tiles` jobs open images and compute values */
    loader->free_large_count = slc_max_u32(LEAST_LARGE, tiles / SLC_LARGE_SLOTS);
    loader->first_produce = loader->first_large + loader->free_large_count;
    loader->job_count = loader->first_produce + tiles;
    loader->jobs = slc_calloc(&loader->cb, loader->job_count, sizeof *loader->jobs);
    if (!loader->jobs)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint32_t i = 0; i < loader->job_count; i++)
        slc_job_list_append(loader,
                            i < tiles                   ? &loader->free_tiles
                            : i < loader->first_large   ? &loader->free_others
                            : i < loader->first_produce ? &loader->free_large
                                                        : &loader->free_produce,
                            &loader->jobs[i]);
    loader->free_tile_count = loader->free_other_count = loader->free_produce_count = tiles;
    SluiceResult result = slc_productions_init(loader);
    if (result == SLUICE_SUCCESS)
        result = slc_staging_init(&loader->staging, &loader->context->shared.staging, &loader->vk,
                                  &loader->caps, &loader->cb, tiles);
    return result == SLUICE_SUCCESS ? create_reader(loader) : result;
}

void slc_jobs_finish(SluiceDemandLoader *loader)
{
    slc_staging_finish(&loader->large);
    slc_staging_finish(&loader->staging);
    slc_productions_finish(loader);
    slc_free(&loader->cb, loader->jobs, loader->job_count, sizeof *loader->jobs);
    loader->jobs = NULL;
}

static void push_front(SluiceDemandLoader *loader, struct slc_job_list *list,
                       struct slc_demand_job *job)
{
    job->next = list->first;
    if (list->first == SLC_NONE)
        list->last = slc_job_index(loader, job);
    list->first = slc_job_index(loader, job);
}

/* Moves a free job with staging memory to the front. False: there is none. */
static bool find_staged(SluiceDemandLoader *loader, struct slc_job_list *list)
{
    for (uint32_t before = list->first; before != SLC_NONE; before = loader->jobs[before].next) {
        uint32_t index = loader->jobs[before].next;
        if (index == SLC_NONE ||
            !slc_staging_is_there(staging_of(loader, index), slot_of(loader, index)))
            continue;
        loader->jobs[before].next = loader->jobs[index].next;
        if (list->last == index)
            list->last = before;
        push_front(loader, list, &loader->jobs[index]);
        return true;
    }
    return false;
}

bool slc_job_is_ready(SluiceDemandLoader *loader, enum slc_job_kind kind)
{
    uint32_t *count;
    struct slc_job_list *list = free_list(loader, kind, &count);
    if (*count == 0)
        return false;
    struct slc_staging *staging = staging_of(loader, list->first);
    if (!staging || slc_staging_ensure(staging, slot_of(loader, list->first)))
        return true;
    return find_staged(loader, list); /* jobs without staging returned above */
}

struct slc_demand_job *slc_job_take(SluiceDemandLoader *loader, enum slc_job_kind kind)
{
    uint32_t *count;
    struct slc_demand_job *job = slc_job_list_pop(loader, free_list(loader, kind, &count));
    if (!job)
        return NULL;
    assert(job->kind == SLC_JOB_FREE);
    job->kind = kind; /* fields that the lock guards are not touched: the job is not running */
    job->stale = job->counted = job->remakes = false;
    job->image = NULL;
    uint32_t index = slc_job_index(loader, job);
    struct slc_staging *staging = staging_of(loader, index);
    if (staging)
        slc_staging_take(staging, slot_of(loader, index));
    *count -= 1;
    return job;
}

void slc_job_free(SluiceDemandLoader *loader, struct slc_demand_job *job)
{
    uint32_t *count, index = slc_job_index(loader, job);
    struct slc_job_list *list = free_list(loader, job->kind, &count);
    struct slc_staging *staging = staging_of(loader, index);
    job->kind = SLC_JOB_FREE;
    if (staging)
        slc_staging_give(staging, slot_of(loader, index));
    push_front(loader, list, job);
    *count += 1;
}

uint8_t *slc_job_memory(SluiceDemandLoader *loader, const struct slc_demand_job *job)
{
    uint32_t index = slc_job_index(loader, job);
    return slc_staging_memory(staging_of(loader, index), slot_of(loader, index));
}

VkBuffer slc_job_buffer(SluiceDemandLoader *loader, const struct slc_demand_job *job,
                        uint64_t *offset)
{
    uint32_t index = slc_job_index(loader, job);
    *offset = slc_staging_offset(slot_of(loader, index));
    return slc_staging_buffer(staging_of(loader, index), slot_of(loader, index));
}

/* Begins a task of a ticket. The caller holds the lock. */
static void begin_task(SluiceDemandLoader *loader, struct slc_demand_job *job,
                       SluiceDemandTicket ticket)
{
    job->running = true;
    job->ticket = ticket;
    job->read = 0;
    slc_ticket_task_begins(&loader->tickets, ticket);
}

/* Notes the number of a submitted read, with the lock held. True if the ticket was canceled
 * meanwhile. */
static bool note_read(SluiceDemandLoader *loader, struct slc_demand_job *job,
                      SluiceDemandTicket ticket, uint64_t number)
{
    bool known;
    const struct slc_ticket *found = slc_ticket_find(&loader->tickets, ticket, &known);
    job->read = number;
    return loader->tickets.aborted || (found && found->canceled);
}

static SluiceResult submit_alone(SluiceDemandLoader *loader, struct slc_demand_job *job,
                                 const SluiceTileRead *read, SluiceDemandTicket ticket)
{
    struct slc_tickets *tickets = &loader->tickets;
    uint64_t number = 0;
    bool canceled = false;
    slc_mutex_lock(&tickets->mutex);
    begin_task(loader, job, ticket);
    slc_mutex_unlock(&tickets->mutex);
    SluiceResult result = sluiceSubmitTileRead(loader->reader, read, &number);
    slc_mutex_lock(&tickets->mutex);
    if (result == SLUICE_SUCCESS) {
        canceled = note_read(loader, job, ticket, number);
    } else {
        job->running = false;
        slc_ticket_task_withdraw(tickets, ticket);
    }
    slc_mutex_unlock(&tickets->mutex);
    if (canceled)
        sluiceCancelTileRead(loader->reader, number);
    return result;
}

static void submit_batch(SluiceDemandLoader *loader)
{
    struct slc_job_batch *batch = &loader->batch;
    struct slc_tickets *tickets = &loader->tickets;
    uint64_t numbers[SLC_BATCH_JOBS];
    uint32_t canceled = 0;
    if (batch->count == 0)
        return;
    slc_mutex_lock(&tickets->mutex);
    for (uint32_t i = 0; i < batch->count; i++)
        begin_task(loader, batch->jobs[i], batch->tickets[i]);
    slc_mutex_unlock(&tickets->mutex);
    SluiceResult result =
        sluiceSubmitTileReads(loader->reader, batch->count, batch->reads, numbers);
    assert(result == SLUICE_SUCCESS); /* the reader has room for all jobs */
    (void)result;
    slc_mutex_lock(&tickets->mutex);
    for (uint32_t i = 0; i < batch->count; i++)
        if (note_read(loader, batch->jobs[i], batch->tickets[i], numbers[i]))
            numbers[canceled++] = numbers[i];
    slc_mutex_unlock(&tickets->mutex);
    for (uint32_t i = 0; i < canceled; i++)
        sluiceCancelTileRead(loader->reader, numbers[i]);
    batch->count = 0;
}

static void add_to_batch(SluiceDemandLoader *loader, struct slc_demand_job *job,
                         const SluiceTileRead *read, SluiceDemandTicket ticket)
{
    struct slc_job_batch *batch = &loader->batch;
    uint32_t i = batch->count++;
    batch->jobs[i] = job;
    batch->tickets[i] = ticket;
    batch->regions[i] = read->pRegions[0];
    batch->texels[i] = read->ppTexels[0];
    batch->reads[i] = *read;
    batch->reads[i].pRegions = &batch->regions[i];
    batch->reads[i].ppTexels = &batch->texels[i];
    if (batch->count == SLC_BATCH_JOBS)
        submit_batch(loader);
}

SluiceResult slc_job_submit(SluiceDemandLoader *loader, struct slc_demand_job *job,
                            SluiceTileRead *read, SluiceDemandTicket ticket)
{
    job->start = slc_monotonic_time();
    read->userValue = slc_job_index(loader, job);
    if (!loader->batch.open || read->regionCount > 1)
        return submit_alone(loader, job, read, ticket);
    add_to_batch(loader, job, read, ticket);
    return SLUICE_SUCCESS;
}

void slc_jobs_begin_batch(SluiceDemandLoader *loader)
{
    assert(!loader->batch.open && loader->batch.count == 0);
    loader->batch.open = true;
}

void slc_jobs_end_batch(SluiceDemandLoader *loader)
{
    submit_batch(loader);
    loader->batch.open = false;
}

static void job_back(SluiceDemandLoader *loader, const SluiceTileReadResult *read)
{
    struct slc_demand_job *job = &loader->jobs[read->userValue];
    if (read->result == SLUICE_ERROR_CANCELED)
        loader->counts.canceledCount++;
    else if (read->result != SLUICE_SUCCESS)
        loader->counts.failedCount++;
    if (job->kind == SLC_JOB_TILE) {
        slc_tile_job_back(loader, job, read->result, read->size);
    } else if (job->kind == SLC_JOB_RESOURCE) {
        slc_resource_job_back(loader, job, read->result);
        slc_job_free(loader, job);
    } else if (job->kind == SLC_JOB_BYTES || job->kind == SLC_JOB_LARGE) {
        slc_byte_job_back(loader, job, read->result);
    } else {
        slc_image_job_back(loader, job->image, job, read->result);
        slc_job_free(loader, job);
    }
}

void slc_jobs_collect(SluiceDemandLoader *loader)
{
    SluiceTileReadResult reads[BATCH];
    SluiceResult result = SLUICE_INCOMPLETE;
    while (result == SLUICE_INCOMPLETE) {
        uint32_t count = BATCH;
        result = sluiceCollectTileReads(loader->reader, &count, reads);
        for (uint32_t i = 0; i < count; i++)
            job_back(loader, &reads[i]);
    }
}

void slc_jobs_drop(SluiceDemandLoader *loader, enum slc_job_kind kind, uint32_t owner,
                   uint32_t first, uint64_t count)
{
    for (uint32_t i = 0; i < loader->job_count; i++) {
        struct slc_demand_job *job = &loader->jobs[i];
        if (job->kind != kind || job->owner != owner || job->page < first ||
            job->page - first >= count)
            continue;
        job->stale = true;
        if (i < loader->first_produce)
            sluiceCancelTileRead(loader->reader, job->read); /* ignored if the read has ended */
    }
}

static bool is_running(const SluiceDemandLoader *loader, enum slc_job_kind kind, uint32_t owner)
{
    for (uint32_t i = 0; i < loader->job_count; i++)
        if (loader->jobs[i].kind == kind && loader->jobs[i].owner == owner &&
            loader->jobs[i].running)
            return true;
    return false;
}

void slc_jobs_wait(SluiceDemandLoader *loader, enum slc_job_kind kind, uint32_t owner)
{
    struct slc_tickets *tickets = &loader->tickets;
    slc_mutex_lock(&tickets->mutex);
    tickets->job_waiters++;
    while (is_running(loader, kind, owner))
        slc_tickets_wait(tickets, UINT64_MAX);
    tickets->job_waiters--;
    slc_mutex_unlock(&tickets->mutex);
}

/* Cancels the jobs of a ticket; 0: all jobs. */
static void cancel_jobs(SluiceDemandLoader *loader, SluiceDemandTicket ticket)
{
    for (uint32_t next = 0; next < loader->job_count;) {
        uint64_t reads[BATCH];
        uint32_t count = 0;
        slc_mutex_lock(&loader->tickets.mutex);
        for (; next < loader->job_count && count < BATCH; next++) {
            const struct slc_demand_job *job = &loader->jobs[next];
            if (job->running && job->read && (ticket == 0 || job->ticket == ticket))
                reads[count++] = job->read;
        }
        slc_mutex_unlock(&loader->tickets.mutex);
        for (uint32_t i = 0; i < count; i++)
            sluiceCancelTileRead(loader->reader, reads[i]);
    }
}

SluiceResult sluiceCancelDemandTicket(SluiceDemandLoader *loader, SluiceDemandTicket ticket)
{
    if (!loader)
        return SLUICE_ERROR_NULL_POINTER;
    bool known;
    slc_mutex_lock(&loader->tickets.mutex);
    struct slc_ticket *found = slc_ticket_find(&loader->tickets, ticket, &known);
    if (found)
        found->canceled = true;
    slc_mutex_unlock(&loader->tickets.mutex);
    if (found)
        cancel_jobs(loader, ticket);
    return known ? SLUICE_SUCCESS : slc_demand_refuse_ticket(loader, __func__, ticket);
}

SluiceResult sluiceAbortDemandLoader(SluiceDemandLoader *loader)
{
    if (!loader)
        return SLUICE_ERROR_NULL_POINTER;
    slc_mutex_lock(&loader->tickets.mutex);
    loader->tickets.aborted = true;
    slc_condition_broadcast(&loader->tickets.changed);
    slc_mutex_unlock(&loader->tickets.mutex);
    cancel_jobs(loader, 0);
    return SLUICE_SUCCESS;
}
