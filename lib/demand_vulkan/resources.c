/* Resources: pages whose values or bytes a callback of the application delivers. */
#include "base/alloc.h"
#include "base/checked.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "demand_vulkan/loader.h"
#include "demand_vulkan/pages.h"
#include "demand_vulkan/refused_arguments.h"
#include "vulkan/create_checks.h"

#include <sluice/shared/demand.h>

#include <inttypes.h>
#include <string.h>

static SluiceResult get_info(SluiceImageSource *source, SluiceImageInfo *info)
{
    const struct slc_demand_resource *resource = (const struct slc_demand_resource *)source;
    *info = (SluiceImageInfo){.structSize = sizeof(SluiceImageInfo),
                              .width = resource->info.pageCount,
                              .height = 1,
                              .mipLevelCount = 1,
                              .format = SLUICE_FORMAT_R32G32_SFLOAT, /* 64 bits */
                              .pName = "resource"};
    return SLUICE_SUCCESS;
}

static SluiceResult read_region(SluiceImageSource *source, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch)
{
    const SluiceDemandResourceCreateInfo *info =
        &((const struct slc_demand_resource *)source)->info;
    (void)row_pitch;
    return info->pageSize ? info->pfnRead(info->pUserData, region->x, info->pageSize, texels)
                          : info->pfnFill(info->pUserData, region->x, texels);
}

static void destroy_source(SluiceImageSource *source)
{
    (void)source;
}

static const SluiceImageSourceInterface interface = {sizeof interface, get_info, read_region,
                                                     destroy_source};

const SluiceImageSourceInterface *slc_resource_interface(void)
{
    return &interface;
}

SluiceDemandResourceId slc_resource_id(const struct slc_demand_resource *resource)
{
    return (uint64_t)resource->generation << 32 | (resource->index + 1);
}

SluiceResult slc_resource_find(SluiceDemandLoader *loader, SluiceDemandResourceId id,
                               struct slc_demand_resource **resource)
{
    uint32_t index = (uint32_t)id - 1, generation = (uint32_t)(id >> 32);
    if (index >= loader->resource_high || generation == 0 ||
        generation > loader->resources[index]->generation)
        return SLUICE_ERROR_UNKNOWN_TEXTURE;
    *resource = loader->resources[index];
    bool live = (*resource)->state == SLC_RESOURCE_LIVE && (*resource)->generation == generation;
    return live ? SLUICE_SUCCESS : SLUICE_ERROR_STALE_TEXTURE;
}

static SluiceResult add_slot(SluiceDemandLoader *loader, struct slc_demand_resource **resource)
{
    if (loader->resource_high == loader->resource_capacity) {
        uint32_t old = loader->resource_capacity, capacity = old ? 2 * old : 16;
        struct slc_demand_resource **resources = slc_regrow(
            &loader->cb, loader->resources, old, capacity, sizeof(struct slc_demand_resource *));
        if (!resources)
            return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        loader->resources = resources;
        loader->resource_capacity = capacity;
    }
    *resource = slc_calloc(&loader->cb, 1, sizeof **resource);
    if (!*resource)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    (*resource)->index = loader->resource_high;
    (*resource)->next_free = loader->free_resource;
    loader->free_resource = loader->resource_high;
    loader->resources[loader->resource_high++] = *resource;
    return SLUICE_SUCCESS;
}

static SluiceResult take_class(SluiceDemandLoader *loader,
                               const SluiceDemandResourceCreateInfo *info, uint8_t *class_index)
{
    const struct slc_page_memory *memory = info->pageSize ? &loader->byte_interface : NULL;
    uint32_t limit = info->maxResidentPageCount;
    uint32_t at = memory ? SLC_CLASS_BYTES : SLC_CLASS_UNBOUND;
    if (limit && limit < info->pageCount) {
        for (at = SLC_CLASS_BYTES + 1; at < SLC_DEMAND_CLASSES && loader->classes[at];)
            at++;
        if (at == SLC_DEMAND_CLASSES)
            return SLUICE_ERROR_LIMIT_EXCEEDED;
        SluiceResult result = slc_residency_set_class(loader->residency, at, limit, memory);
        if (result != SLUICE_SUCCESS)
            return result;
        loader->classes[at] = true;
        loader->byte_classes[at] = memory != NULL;
        loader->limited_count++;
    }
    *class_index = (uint8_t)at;
    return SLUICE_SUCCESS;
}

static void give_class(SluiceDemandLoader *loader, uint8_t class_index)
{
    if (class_index <= SLC_CLASS_BYTES)
        return;
    loader->classes[class_index] = false;
    loader->limited_count--;
}

static SluiceResult create(SluiceDemandLoader *loader, const SluiceDemandResourceCreateInfo *info,
                           struct slc_demand_resource **resource)
{
    SluiceResult result = SLUICE_SUCCESS;
    if (loader->free_resource == SLC_NONE)
        result = add_slot(loader, resource);
    if (result != SLUICE_SUCCESS)
        return result;
    struct slc_demand_resource *new = *resource = loader->resources[loader->free_resource];
    result = take_class(loader, info, &new->class_index);
    if (result != SLUICE_SUCCESS)
        return result;
    result = slc_pages_take(loader, info->rank, info->pageCount, SLC_OWNER_RESOURCE, new->index,
                            &new->first_page);
    if (result != SLUICE_SUCCESS) {
        give_class(loader, new->class_index);
        return result;
    }
    loader->free_resource = new->next_free;
    new->base.pInterface = &interface;
    new->state = SLC_RESOURCE_LIVE;
    new->generation++;
    new->info = *info;
    new->told = new->told_remake = false;
    slc_byte_pages_describe(loader, new);
    if (new->stride)
        slc_byte_pages_add_resource(loader);
    return SLUICE_SUCCESS;
}

static SluiceResult check(const SluiceDemandLoader *loader,
                          const SluiceDemandResourceCreateInfo *info)
{
    const struct slc_limit limits[] = {{"pageCount", info->pageCount, 1, UINT32_MAX},
                                       {"rank", info->rank, 0, SLUICE_DEMAND_RANKS - 1}};
    SluiceResult result =
        slc_check_limits(&loader->vk.log, limits, sizeof limits / sizeof limits[0]);
    if (result != SLUICE_SUCCESS)
        return result;
    bool bytes = info->pfnRead || info->pfnRecordPages;
    if (info->pageSize ? info->pfnFill || info->pfnEvict : bytes)
        return slc_log_refusal(
            &loader->vk.log,
            "pageSize is %u: pfnFill and pfnEvict are for pages of 0 bytes, pfnRead and "
            "pfnRecordPages are for larger ones",
            info->pageSize);
    if (info->pfnRead && info->pfnRecordPages)
        return slc_log_refusal(&loader->vk.log,
                               "pfnRead and pfnRecordPages are both set: one of them can fill the "
                               "pages of a resource");
    return info->pageCount > loader->info.pageCapacity ? SLUICE_ERROR_LIMIT_EXCEEDED
                                                       : SLUICE_SUCCESS;
}

SluiceResult sluiceAddDemandResource(SluiceDemandLoader *loader,
                                     const SluiceDemandResourceCreateInfo *pCreateInfo,
                                     SluiceDemandResourceId *pResourceId, uint32_t *pFirstPage)
{
    struct slc_demand_resource *resource;
    if (!loader || !pCreateInfo || !pResourceId || !pFirstPage)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceDemandResourceCreateInfo info = {.structSize = sizeof info};
    SluiceResult result = slc_struct_read(SLC_STRUCT(SluiceDemandResourceCreateInfo), &info,
                                          pCreateInfo, &loader->vk.log);
    if (result != SLUICE_SUCCESS)
        return result;
    result = check(loader, &info);
    if (result == SLUICE_SUCCESS && info.pageSize)
        result = slc_byte_pages_prepare(loader, info.pageSize);
    if (result != SLUICE_SUCCESS)
        return result;
    result = create(loader, &info, &resource);
    if (result != SLUICE_SUCCESS)
        return result;
    *pResourceId = slc_resource_id(resource);
    *pFirstPage = resource->first_page;
    return SLUICE_SUCCESS;
}

struct slc_page_request slc_resource_page_request(const struct slc_demand_resource *resource,
                                                  uint32_t page, bool pinned)
{
    return (struct slc_page_request){.page = page,
                                     .class_index = resource->class_index,
                                     .rank = (uint8_t)resource->info.rank,
                                     .pinned = pinned,
                                     .kind = resource->byte_kind};
}

enum slc_request_answer slc_resource_request(SluiceDemandLoader *loader, uint32_t index,
                                             uint32_t page, SluiceDemandTicket ticket,
                                             SluiceResult *result)
{
    struct slc_demand_resource *resource = loader->resources[index];
    const SluiceImageRegion region = {.x = page - resource->first_page, .width = 1, .height = 1};
    *result = SLUICE_SUCCESS;
    if (resource->state != SLC_RESOURCE_LIVE || region.x >= resource->info.pageCount)
        return SLC_REQUEST_RESIDENT;
    if (!resource->info.pfnFill && !resource->info.pfnRead && !resource->produced)
        return slc_answer_request(loader, resource, page, result);
    if (!slc_job_is_ready(loader,
                          resource->produced ? SLC_JOB_PRODUCE_BYTES : resource->job_kind)) {
        loader->unasked_count++;
        return SLC_REQUEST_POSTPONED;
    }
    const struct slc_page_request request = slc_resource_page_request(resource, page, false);
    enum slc_request_answer answer = slc_residency_request(loader->residency, &request, result);
    loader->unasked_count += *result != SLUICE_SUCCESS;
    if (answer == SLC_REQUEST_LOAD && resource->produced)
        slc_byte_production_begin(loader, resource, page);
    if (answer != SLC_REQUEST_LOAD || resource->produced)
        return answer;
    struct slc_demand_job *job = slc_job_take(loader, resource->job_kind);
    void *texels = resource->stride ? (void *)slc_job_memory(loader, job) : (void *)&job->value;
    job->place = resource->stride ? slc_residency_place(loader->residency, page) : SLC_NO_PLACE;
    job->page = page;
    job->owner = index;
    job->id = slc_resource_id(resource);
    SluiceTileRead read = {.source = &resource->base,
                           .regionCount = 1,
                           .pRegions = &region,
                           .ppTexels = &texels,
                           .priority = SLUICE_DEMAND_RANKS - resource->info.rank};
    *result = slc_job_submit(loader, job, &read, ticket);
    if (*result == SLUICE_SUCCESS) {
        resource->job_count++;
        loader->reading_count += resource->stride != 0;
        return SLC_REQUEST_LOAD;
    }
    slc_residency_failed(loader->residency, page, false);
    slc_job_free(loader, job);
    return SLC_REQUEST_POSTPONED;
}

static void tell_evicted(const struct slc_demand_resource *resource, uint32_t page, uint64_t value)
{
    if (resource->info.pfnEvict)
        resource->info.pfnEvict(resource->info.pUserData, page, value);
}

/* Frees a destroyed resource step by step: its pages when no fill is in progress, its slot when all
 * values are evicted, too. */
static void check_gone(SluiceDemandLoader *loader, struct slc_demand_resource *resource)
{
    if (resource->state != SLC_RESOURCE_DESTROYED || resource->job_count ||
        resource->eviction_count)
        return;
    slc_missed_pages_finish(&resource->missed, &loader->cb);
    sluiceDropTileLoaderStatistics(loader->reader, &resource->base);
    slc_pages_give(loader, resource->first_page, resource->info.pageCount);
    give_class(loader, resource->class_index);
    if (resource->stride)
        slc_byte_pages_remove_resource(loader);
    resource->state = SLC_RESOURCE_FREE;
    if (resource->generation == UINT32_MAX)
        return; /* all generations of the index are used up */
    resource->next_free = loader->free_resource;
    loader->free_resource = resource->index;
}

bool slc_resource_reserve_eviction(SluiceDemandLoader *loader)
{
    uint32_t old = loader->eviction_capacity;
    if (loader->eviction_count + loader->held_count < old)
        return true;
    uint32_t capacity = old ? 2 * old : 64;
    struct slc_eviction *evictions = slc_alloc(&loader->cb, capacity, sizeof *evictions);
    if (!evictions)
        return false;
    for (uint32_t i = 0; i < loader->eviction_count; i++)
        evictions[i] = loader->evictions[(loader->eviction_first + i) % old];
    slc_free(&loader->cb, loader->evictions, old, sizeof *evictions);
    loader->evictions = evictions;
    loader->eviction_capacity = capacity;
    loader->eviction_first = 0;
    return true;
}

void slc_resource_note_success(SluiceDemandLoader *loader, struct slc_demand_resource *resource,
                               uint32_t page)
{
    slc_retries_success(loader, &resource->retry_group, page);
    resource->told = resource->told && resource->retry_group != 0;
}

void slc_resource_fail(SluiceDemandLoader *loader, struct slc_demand_resource *resource,
                       const struct slc_demand_job *job, SluiceResult result, bool failed)
{
    bool refuse = failed;
    char retrying[48];
    if (refuse && !resource->told)
        slc_log(&loader->vk.log, SLUICE_LOG_WARNING, "page %u of a resource has no %s: %s; %s.",
                job->page - resource->first_page, resource->stride ? "bytes" : "value",
                sluiceGetResultName(result), slc_retries_words(loader, retrying, sizeof retrying));
    resource->told |= refuse;
    refuse = refuse && slc_retries_add(loader, &resource->retry_group, job->page);
    slc_residency_failed(loader->residency, job->page, refuse);
}

void slc_resource_release(SluiceDemandLoader *loader, uint32_t index)
{
    struct slc_demand_resource *resource = loader->resources[index];
    resource->job_count--;
    check_gone(loader, resource);
}

void slc_resource_job_back(SluiceDemandLoader *loader, struct slc_demand_job *job,
                           SluiceResult result)
{
    struct slc_demand_resource *resource = loader->resources[job->owner];
    bool filled = result == SLUICE_SUCCESS;
    if (filled && !job->stale && slc_resource_reserve_eviction(loader)) {
        loader->held_count++;
        slc_residency_loaded(loader->residency, job->page, job->value);
        slc_resource_note_success(loader, resource, job->page);
    } else {
        if (filled) /* no launch has seen the value */
            tell_evicted(resource, job->page - resource->first_page, job->value);
        slc_resource_fail(loader, resource, job, result,
                          result != SLUICE_SUCCESS && !job->stale && !slc_result_may_pass(result));
    }
    slc_resource_release(loader, resource->index);
}

void slc_resource_evicted(SluiceDemandLoader *loader, uint32_t index, uint32_t page, uint64_t value)
{
    struct slc_demand_resource *resource = loader->resources[index];
    uint32_t at = (loader->eviction_first + loader->eviction_count++) % loader->eviction_capacity;
    loader->held_count--;
    loader->counts.evictedCount++;
    resource->eviction_count++;
    loader->evictions[at] =
        (struct slc_eviction){index, page - resource->first_page, value, loader->launch};
}

static void tell_next(SluiceDemandLoader *loader)
{
    const struct slc_eviction *next = &loader->evictions[loader->eviction_first];
    struct slc_demand_resource *resource = loader->resources[next->resource];
    tell_evicted(resource, next->page, next->value);
    resource->eviction_count--;
    loader->eviction_first = (loader->eviction_first + 1) % loader->eviction_capacity;
    loader->eviction_count--;
    check_gone(loader, resource);
}

void slc_resources_end_retired(SluiceDemandLoader *loader)
{
    while (loader->eviction_count &&
           loader->evictions[loader->eviction_first].launch <= loader->processed)
        tell_next(loader);
}

void slc_resource_drop_jobs(SluiceDemandLoader *loader, const struct slc_demand_resource *resource,
                            uint32_t first, uint32_t count)
{
    slc_jobs_drop(loader, resource->job_kind, resource->index, first, count);
    if (resource->produced)
        slc_jobs_drop(loader, SLC_JOB_PRODUCE_BYTES, resource->index, first, count);
    slc_remakes_forget(loader, first, count);
}

/* Forgets pages, and the results of their jobs. */
static void forget(SluiceDemandLoader *loader, struct slc_demand_resource *resource, uint32_t first,
                   uint32_t count)
{
    slc_retries_all(loader, &resource->retry_group);
    if (resource->job_count || resource->stride) /* jobs may be copying bytes to the slots */
        slc_resource_drop_jobs(loader, resource, first, count);
    slc_residency_forget(loader->residency, first, count);
    slc_answers_forget(loader, resource, first, count);
    slc_evicted_take(loader);
}

SluiceResult sluiceInvalidateDemandPages(SluiceDemandLoader *loader,
                                         SluiceDemandResourceId resourceId, uint32_t firstPage,
                                         uint32_t count)
{
    struct slc_demand_resource *resource;
    if (!loader)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_resource_find(loader, resourceId, &resource);
    if (result != SLUICE_SUCCESS)
        return result;
    uint32_t page_count = resource->info.pageCount;
    if (firstPage > page_count || count > page_count - firstPage)
        return slc_demand_refuse(loader, __func__,
                                 "%" PRIu32 " pages from page %" PRIu32
                                 " on: the resource has %" PRIu32,
                                 count, firstPage, page_count);
    if (count)
        forget(loader, resource, resource->first_page + firstPage, count);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceRemoveDemandResource(SluiceDemandLoader *loader,
                                        SluiceDemandResourceId resourceId)
{
    struct slc_demand_resource *resource;
    if (!loader)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_resource_find(loader, resourceId, &resource);
    if (result != SLUICE_SUCCESS)
        return result;
    forget(loader, resource, resource->first_page, resource->info.pageCount);
    if (resource->job_count)
        slc_jobs_wait(loader, resource->job_kind, resource->index);
    slc_pages_forget_requests(loader, resource->first_page, resource->info.pageCount);
    resource->state = SLC_RESOURCE_DESTROYED;
    check_gone(loader, resource);
    return SLUICE_SUCCESS;
}

void slc_resources_finish(SluiceDemandLoader *loader)
{
    for (uint32_t i = 0; i < loader->resource_high && loader->residency; i++)
        if (loader->resources[i]->state == SLC_RESOURCE_LIVE)
            forget(loader, loader->resources[i], loader->resources[i]->first_page,
                   loader->resources[i]->info.pageCount);
    while (loader->eviction_count)
        tell_next(loader);
    for (uint32_t i = 0; i < loader->resource_high; i++) {
        slc_missed_pages_finish(&loader->resources[i]->missed, &loader->cb);
        slc_free(&loader->cb, loader->resources[i], 1, sizeof *loader->resources[i]);
    }
    slc_free(&loader->cb, loader->resources, loader->resource_capacity,
             sizeof(struct slc_demand_resource *));
    slc_free(&loader->cb, loader->evictions, loader->eviction_capacity, sizeof *loader->evictions);
    loader->resources = NULL;
}
