/* Answers of the application for pages, before or after shaders missed them. */
#include "base/log.h"
#include "demand/page_observer.h"
#include "demand_vulkan/loader.h"
#include "demand_vulkan/pages.h"

#include <sluice/shared/demand.h>

#include <string.h>

enum slc_request_answer slc_answer_request(SluiceDemandLoader *loader,
                                           struct slc_demand_resource *resource, uint32_t page,
                                           SluiceResult *result)
{
    if (!slc_missed_pages_reserve(&resource->missed, &loader->cb)) {
        *result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        loader->unasked_count++;
        return SLC_REQUEST_POSTPONED;
    }
    const struct slc_page_request request = slc_resource_page_request(resource, page, false);
    enum slc_request_answer answer = slc_residency_request(loader->residency, &request, result);
    loader->unasked_count += *result != SLUICE_SUCCESS;
    if (answer == SLC_REQUEST_LOAD)
        slc_missed_pages_add(&resource->missed, page);
    return answer;
}

void slc_answers_forget(SluiceDemandLoader *loader, struct slc_demand_resource *resource,
                        uint32_t first, uint32_t count)
{
    uint32_t at = 0, page;
    while (slc_missed_pages_remove_any(&resource->missed, first, count, &at, &page))
        slc_residency_failed(loader->residency, page, false);
}

SluiceResult sluiceGetMissedDemandPages(SluiceDemandLoader *loader,
                                        SluiceDemandResourceId resourceId, uint32_t *pPageCount,
                                        uint32_t *pPages)
{
    struct slc_demand_resource *resource;
    if (!loader || !pPageCount || !pPages)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_resource_find(loader, resourceId, &resource);
    if (result != SLUICE_SUCCESS)
        return result;
    *pPageCount = slc_missed_pages_take(&resource->missed, pPages, *pPageCount);
    for (uint32_t i = 0; i < *pPageCount; i++)
        pPages[i] -= resource->first_page;
    return slc_missed_pages_has_more(&resource->missed) ? SLUICE_INCOMPLETE : SLUICE_SUCCESS;
}

static SluiceResult find(SluiceDemandLoader *loader, SluiceDemandResourceId id, uint32_t page,
                         bool bytes, struct slc_demand_resource **resource)
{
    SluiceResult result = slc_resource_find(loader, id, resource);
    if (result != SLUICE_SUCCESS)
        return result;
    const SluiceDemandResourceCreateInfo *info = &(*resource)->info;
    if (page >= info->pageCount)
        return slc_log_refusal(&loader->vk.log, "page is %u; the resource has %u pages", page,
                               info->pageCount);
    if (bytes == (info->pageSize > 0))
        return SLUICE_SUCCESS;
    return slc_log_refusal(&loader->vk.log, "pageSize is %u: the resource's pages have %s",
                           info->pageSize, bytes ? "values" : "bytes");
}

/* Makes the page loading, without a reader. Pages that were not missed are forgotten first. */
static SluiceResult begin(SluiceDemandLoader *loader, struct slc_demand_resource *resource,
                          uint32_t page, bool pinned)
{
    SluiceResult result;
    const struct slc_page_request request = slc_resource_page_request(resource, page, pinned);
    if (slc_missed_pages_has(&resource->missed, page)) {
        if (pinned)
            slc_residency_request(loader->residency, &request, &result);
        slc_missed_pages_remove(&resource->missed, page);
        return SLUICE_SUCCESS;
    }
    if (slc_residency_is_loading(loader->residency, page))
        return SLUICE_NOT_READY;
    if (resource->stride) /* jobs may be copying bytes to the slot */
        slc_resource_drop_jobs(loader, resource, page, 1);
    slc_residency_forget(loader->residency, page, 1);
    slc_evicted_take(loader);
    enum slc_request_answer answer = slc_residency_request(loader->residency, &request, &result);
    if (result != SLUICE_SUCCESS)
        return result;
    return answer == SLC_REQUEST_LOAD ? SLUICE_SUCCESS : SLUICE_NOT_READY;
}

SluiceResult sluiceSetDemandPageValue(SluiceDemandLoader *loader, SluiceDemandResourceId resourceId,
                                      uint32_t page, uint64_t value, bool pinned)
{
    struct slc_demand_resource *resource;
    if (!loader)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = find(loader, resourceId, page, false, &resource);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!slc_resource_reserve_eviction(loader))
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    uint32_t id = resource->first_page + page;
    result = begin(loader, resource, id, pinned);
    if (result != SLUICE_SUCCESS)
        return result;
    loader->held_count++;
    slc_residency_loaded(loader->residency, id, value);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceSetDemandPageBytes(SluiceDemandLoader *loader, SluiceDemandResourceId resourceId,
                                      uint32_t page, const void *pBytes, bool pinned)
{
    struct slc_demand_resource *resource;
    if (!loader || !pBytes)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = find(loader, resourceId, page, true, &resource);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!slc_job_is_ready(loader, resource->job_kind))
        return SLUICE_NOT_READY;
    uint32_t id = resource->first_page + page;
    result = begin(loader, resource, id, pinned);
    if (result != SLUICE_SUCCESS)
        return result;
    struct slc_demand_job *job = slc_job_take(loader, resource->job_kind);
    job->page = id;
    job->owner = resource->index;
    job->id = resourceId;
    job->place = slc_residency_place(loader->residency, id);
    memcpy(slc_job_memory(loader, job), pBytes, resource->info.pageSize);
    resource->job_count++;
    slc_job_list_append(loader, &loader->arrived, job);
    return SLUICE_SUCCESS;
}
