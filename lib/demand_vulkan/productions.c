#include "demand_vulkan/productions.h"

#include "base/alloc.h"
#include "base/log.h"
#include "demand_vulkan/tiles.h"
#include "vulkan/producer_calls.h"

#include <assert.h>
#include <stdlib.h>

#define TAIL_TARGET 0xFFFFu /* in place of a chunk: a mip tail is a batch of its own */

static_assert(SLC_TILE_MAX_PARTS <= SLC_PRODUCER_BATCH, "a tail is one batch");

SluiceResult slc_productions_init(SluiceDemandLoader *loader)
{
    loader->unproduced = loader->produced = (struct slc_job_list){SLC_NONE, SLC_NONE};
    loader->productions =
        slc_alloc(&loader->cb, loader->info.maxTilesInFlight, sizeof *loader->productions);
    if (!loader->productions)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    return slc_remakes_init(&loader->remakes, &loader->cb, loader->info.maxTilesInFlight);
}

void slc_productions_finish(SluiceDemandLoader *loader)
{
    slc_remakes_finish(&loader->remakes);
    slc_free(&loader->cb, loader->productions, loader->info.maxTilesInFlight,
             sizeof *loader->productions);
    loader->productions = NULL;
}

static struct slc_demand_job *begin(SluiceDemandLoader *loader, struct slc_demand_image *image,
                                    uint32_t owner, uint32_t page)
{
    struct slc_demand_job *job =
        slc_job_take(loader, image ? SLC_JOB_PRODUCE : SLC_JOB_PRODUCE_BYTES);
    job->page = page;
    job->owner = owner;
    job->image = image;
    job->place = slc_residency_place(loader->residency, page);
    job->answer = SLUICE_SUCCESS;
    job->asked = 0;
    slc_job_list_append(loader, &loader->unproduced, job);
    return job;
}

void slc_tile_production_begin(SluiceDemandLoader *loader, struct slc_demand_image *image,
                               uint32_t page)
{
    begin(loader, image, image->slot, page);
    image->job_count++;
}

void slc_byte_production_begin(SluiceDemandLoader *loader, struct slc_demand_resource *resource,
                               uint32_t page)
{
    begin(loader, NULL, resource->index, page);
    resource->job_count++;
}

void slc_remake_begin(SluiceDemandLoader *loader, struct slc_demand_image *image,
                      struct slc_demand_resource *resource, uint32_t page)
{
    begin(loader, image, image ? image->slot : resource->index, page)->remakes = true;
    if (image)
        image->job_count++;
    else
        resource->job_count++;
}

static void end(SluiceDemandLoader *loader, struct slc_demand_job *job)
{
    struct slc_demand_image *image = job->image;
    uint32_t owner = job->owner;
    slc_job_free(loader, job);
    if (image)
        slc_image_release(loader, image);
    else
        slc_resource_release(loader, owner);
}

/* Fails a remake: the page keeps its content. Logs once per texture or resource until one succeeds.
 */
static void fail_remake(SluiceDemandLoader *loader, struct slc_demand_job *job)
{
    struct slc_demand_resource *resource = job->image ? NULL : loader->resources[job->owner];
    bool *told = resource ? &resource->told_remake : &job->image->told_remake;
    slc_remakes_end(&loader->remakes, job->page);
    loader->counts.failedCount++;
    if (!*told)
        slc_log(&loader->vk.log, SLUICE_LOG_WARNING,
                "%s: page %u cannot be made again: %s. Its old content stays.",
                resource ? "resource" : slc_image_name(job->image), job->page,
                sluiceGetResultName(job->answer));
    *told = true;
    end(loader, job);
}

/* Ends a job whose page must not be shown. `failed`: its producer failed. */
static void fail(SluiceDemandLoader *loader, struct slc_demand_job *job, bool failed)
{
    if (job->remakes) {
        (failed ? fail_remake : end)(loader, job);
        return;
    }
    loader->counts.failedCount += failed;
    if (job->image) {
        slc_tile_fail(loader, job, job->answer, failed);
        return;
    }
    struct slc_demand_resource *resource = loader->resources[job->owner];
    slc_resource_fail(loader, resource, job, job->answer, failed);
    slc_job_free(loader, job);
    slc_resource_release(loader, resource->index);
}

static void show(SluiceDemandLoader *loader, struct slc_demand_job *job)
{
    struct slc_demand_image *image = job->image;
    loader->counts.producedCount++;
    if (job->remakes) {
        *(image ? &image->told_remake : &loader->resources[job->owner]->told_remake) = false;
        loader->counts.remadeCount++;
        end(loader, job);
        return;
    }
    slc_residency_loaded(loader->residency, job->page, job->place);
    if (image)
        slc_tile_note_success(loader, image, job->page);
    else
        slc_resource_note_success(loader, loader->resources[job->owner], job->page);
    end(loader, job);
}

void slc_productions_collect(SluiceDemandLoader *loader)
{
    while (loader->produced.first != SLC_NONE &&
           loader->jobs[loader->produced.first].launch <= loader->processed) {
        struct slc_demand_job *job = slc_job_list_pop(loader, &loader->produced);
        if (job->stale || job->answer != SLUICE_SUCCESS)
            fail(loader, job, !job->stale);
        else
            show(loader, job);
    }
}

bool slc_productions_are_due(const SluiceDemandLoader *loader)
{
    return loader->unproduced.first != SLC_NONE || loader->remakes.count > 0;
}

static bool is_tail(const struct slc_demand_job *job)
{
    return job->image && job->page == job->image->tail_page;
}

/* Returns the batch key: pages of one texture or resource in one image or buffer have equal keys.
 */
static uint64_t key_of(const SluiceDemandLoader *loader, const struct slc_demand_job *job)
{
    uint32_t target = TAIL_TARGET;
    uint64_t offset;
    if (!job->image)
        slc_byte_place(job->place, loader->resources[job->owner]->stride, &target, &offset);
    else if (!is_tail(job))
        target = (job->place & SLUICE_DEMAND_PLACE_MASK) >> 16;
    return (uint64_t)!job->image << 63 | (uint64_t)job->owner << 16 | target;
}

static int compare(const void *a, const void *b)
{
    const struct slc_production *x = a, *y = b;
    if (x->key != y->key)
        return x->key < y->key ? -1 : 1;
    return (x->page > y->page) - (x->page < y->page);
}

/* True if a job may wait. Half of the jobs are kept for pages that can be made at once. */
static bool can_wait(const SluiceDemandLoader *loader)
{
    return 2 * loader->free_produce_count >= loader->info.maxTilesInFlight;
}

/* Applies the answer to a job. A mip tail that failed keeps its place until the launch is complete,
 * because some of its levels may be recorded. True: the page is written. */
static bool answered(SluiceDemandLoader *loader, struct slc_demand_job *job, SluiceResult answer,
                     uint32_t timeout)
{
    job->answer = job->stale ? SLUICE_SUCCESS : answer;
    job->launch = loader->launch;
    switch (
        slc_producer_effect(job->answer, &job->asked, loader->launch, timeout, can_wait(loader))) {
    case SLC_PRODUCER_WROTE:
        if (job->remakes)
            slc_remakes_end(&loader->remakes, job->page);
        slc_job_list_append(loader, &loader->produced, job);
        return !job->stale;
    case SLC_PRODUCER_WAITS: slc_job_list_append(loader, &loader->unproduced, job); return false;
    case SLC_PRODUCER_FAILED: break;
    }
    if (is_tail(job) && !job->remakes)
        slc_job_list_append(loader, &loader->produced, job);
    else
        fail(loader, job, true);
    return false;
}

static struct slc_demand_job *job_of(SluiceDemandLoader *loader, uint32_t at)
{
    return &loader->jobs[loader->productions[at].job];
}

/* Joins the answers of a page's parts: the first one that is not SLUICE_SUCCESS. */
static SluiceResult join(const SluiceResult *answers, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        if (answers[i] != SLUICE_SUCCESS)
            return answers[i];
    return SLUICE_SUCCESS;
}

static uint32_t ask_for_tiles(SluiceDemandLoader *loader, struct slc_producer_calls *calls,
                              uint32_t first, uint32_t count)
{
    struct slc_demand_image *image = job_of(loader, first)->image;
    const struct slc_tile_producer producer = image->made->producer;
    const uint32_t place = job_of(loader, first)->place & SLUICE_DEMAND_PLACE_MASK;
    SluiceTileTarget targets[SLC_PRODUCER_BATCH];
    SluiceResult answers[SLC_PRODUCER_BATCH];
    SluiceTileBatch batch = {.structSize = sizeof batch,
                             .textureId = slc_texture_id(loader, image->texture),
                             .commandBuffer = calls->commands,
                             .frameIndex = loader->launch,
                             .image = slc_page_image(loader->pages, place),
                             .imageView = slc_page_storage_view(loader->pages, place),
                             .pTiles = targets,
                             .levelWidth = image->tile_width,
                             .levelHeight = image->tile_height};
    uint32_t parts = 1, written = 0;
    for (uint32_t i = 0; i < count; i++) {
        struct slc_tile_part list[SLC_TILE_MAX_PARTS];
        const struct slc_demand_job *job = job_of(loader, first + i);
        parts = slc_tile_parts(image, job->page, job->place, list);
        for (uint32_t k = 0; k < parts; k++)
            targets[batch.tileCount++] =
                (SluiceTileTarget){list[k].region, list[k].x, list[k].y,
                                   job->place & SLUICE_DEMAND_PLACE_MASK & 0xFFFFu};
    }
    slc_image_touch(loader, image, loader->launch);
    slc_producer_answers_init(answers, batch.tileCount);
    slc_producer_calls_order(calls, image->slot, (uint64_t)batch.image, 0);
    SluiceResult returned = producer.pfn(producer.user, &batch, answers);
    slc_producer_answers_end(answers, batch.tileCount, returned);
    for (uint32_t i = 0; i < count; i++)
        written += answered(loader, job_of(loader, first + i), join(answers + i * parts, parts),
                            producer.timeout_frames);
    return written;
}

static uint32_t ask_for_bytes(SluiceDemandLoader *loader, struct slc_producer_calls *calls,
                              uint32_t first, uint32_t count)
{
    struct slc_demand_resource *resource = loader->resources[job_of(loader, first)->owner];
    const SluiceDemandResourceCreateInfo info = resource->info;
    SluiceBytePageTarget targets[SLC_PRODUCER_BATCH];
    SluiceResult answers[SLC_PRODUCER_BATCH];
    SluiceBytePageBatch batch = {.structSize = sizeof batch,
                                 .resourceId = slc_resource_id(resource),
                                 .commandBuffer = calls->commands,
                                 .launchIndex = loader->launch,
                                 .pageSize = info.pageSize,
                                 .pageCount = count,
                                 .pPages = targets};
    uint32_t chunk = 0, written = 0;
    for (uint32_t i = 0; i < count; i++) {
        const struct slc_demand_job *job = job_of(loader, first + i);
        targets[i] = (SluiceBytePageTarget){.page = job->page - resource->first_page};
        slc_byte_place(job->place, resource->stride, &chunk, &targets[i].offset);
        if (loader->bytes.chunks[chunk].address)
            targets[i].address = loader->bytes.chunks[chunk].address + targets[i].offset;
    }
    batch.buffer = loader->bytes.chunks[chunk].buffer;
    slc_producer_answers_init(answers, count);
    slc_producer_calls_order(calls, SLC_NONE - resource->index, (uint64_t)batch.buffer, 0);
    SluiceResult returned = info.pfnRecordPages(info.pUserData, &batch, answers);
    slc_producer_answers_end(answers, count, returned);
    for (uint32_t i = 0; i < count; i++)
        written += answered(loader, job_of(loader, first + i), answers[i],
                            info.timeoutLaunches ? info.timeoutLaunches : SLC_PRODUCER_TIMEOUT);
    return written;
}

/* True if a page to be made again is still resident. If it was evicted, its old content must not be
 * restored. If it is being made anew, no remake is necessary. */
static bool is_there(SluiceDemandLoader *loader, struct slc_demand_job *job)
{
    if (!job->remakes || slc_residency_is_resident(loader->residency, job->page, &job->place))
        return true;
    if (slc_residency_is_absent(loader->residency, job->page))
        slc_residency_forget(loader->residency, job->page, 1);
    return false;
}

/* Ends a job without calling the producer, because its owner is gone. */
static void drop(SluiceDemandLoader *loader, struct slc_demand_job *job)
{
    if (job->remakes)
        slc_remakes_end(&loader->remakes, job->page);
    fail(loader, job, false);
}

/* Takes all jobs that wait into `productions`, sorted. Ends those whose owner is gone. */
static uint32_t take(SluiceDemandLoader *loader)
{
    uint32_t count = 0;
    for (struct slc_demand_job *job; (job = slc_job_list_pop(loader, &loader->unproduced));) {
        if (job->stale || !is_there(loader, job))
            drop(loader, job);
        else
            loader->productions[count++] =
                (struct slc_production){key_of(loader, job), job->page, slc_job_index(loader, job)};
    }
    if (count)
        qsort(loader->productions, count, sizeof *loader->productions, compare);
    return count;
}

uint32_t slc_productions_ask(SluiceDemandLoader *loader, VkCommandBuffer commands)
{
    struct slc_producer_calls calls = {.vk = &loader->vk, .commands = commands};
    const struct slc_production *list = loader->productions;
    slc_remakes_start(loader);
    uint32_t count = take(loader), written = 0;
    for (uint32_t i = 0, next; i < count; i = next) {
        next = i + 1;
        if (job_of(loader, i)->stale) { /* set by a callback of this launch */
            drop(loader, job_of(loader, i));
            continue;
        }
        while (next < count && next - i < SLC_PRODUCER_BATCH && list[next].key == list[i].key)
            next++;
        written +=
            (job_of(loader, i)->image ? ask_for_tiles : ask_for_bytes)(loader, &calls, i, next - i);
    }
    slc_producer_calls_end(&calls);
    return written;
}

void slc_productions_ask_again(SluiceDemandLoader *loader, uint64_t launch)
{
    struct slc_job_list kept = {SLC_NONE, SLC_NONE}, again = kept;
    for (struct slc_demand_job *job; (job = slc_job_list_pop(loader, &loader->produced));) {
        bool stays = job->launch < launch;
        if (!stays && job->remakes &&
            (job->stale || !slc_remakes_retake(&loader->remakes, job->page)))
            end(loader, job); /* the page is gone, or will be made again anyway */
        else
            slc_job_list_append(loader, stays ? &kept : &again, job);
    }
    for (struct slc_demand_job *job; (job = slc_job_list_pop(loader, &loader->unproduced));)
        slc_job_list_append(loader, &again, job);
    loader->produced = kept;
    loader->unproduced = again;
}
