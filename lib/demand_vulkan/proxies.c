/* Proxies: pages that shaders miss and that are never answered. */
#include "base/log.h"
#include "base/struct_size.h"
#include "demand_vulkan/loader.h"
#include "demand_vulkan/pages.h"
#include "proxy/proxy_set.h"

#include <sluice/vulkan_proxy.h>

#include <inttypes.h>

#define BATCH 256u

static SluiceResult get_set_info(const SluiceProxySet *set, SluiceProxySetInfo *info)
{
    *info = (SluiceProxySetInfo){.structSize = sizeof *info};
    return sluiceGetProxySetInfo(set, info);
}

SluiceResult sluiceAddDemandProxies(SluiceDemandLoader *loader, const SluiceProxySet *set,
                                    uint32_t rank, SluiceDemandResourceId *pResourceId,
                                    uint32_t *pFirstPage)
{
    SluiceProxySetInfo info;
    if (!loader || !set || !pResourceId || !pFirstPage)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = get_set_info(set, &info);
    if (result != SLUICE_SUCCESS)
        return result;
    const SluiceDemandResourceCreateInfo resource = {
        .structSize = sizeof resource, .pageCount = info.maxProxyCount, .rank = rank};
    return sluiceAddDemandResource(loader, &resource, pResourceId, pFirstPage);
}

static SluiceResult check(const SluiceDemandLoader *loader,
                          const SluiceDemandResourceCreateInfo *resource, const SluiceProxySet *set)
{
    SluiceProxySetInfo info;
    SluiceResult result = get_set_info(set, &info);
    if (result != SLUICE_SUCCESS)
        return result;
    if (resource->pfnFill || resource->pageSize)
        return slc_log_refusal(&loader->vk.log,
                               "the resource is none of proxies: it has pfnFill, or pageSize %u",
                               resource->pageSize);
    if (resource->pageCount != info.maxProxyCount)
        return slc_log_refusal(&loader->vk.log, "pageCount is %u; the set's maxProxyCount is %u",
                               resource->pageCount, info.maxProxyCount);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceProcessDemandProxies(SluiceDemandLoader *loader,
                                        SluiceDemandResourceId resourceId, SluiceProxySet *set)
{
    struct slc_demand_resource *resource;
    uint32_t indices[BATCH];
    if (!loader || !set)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_resource_find(loader, resourceId, &resource);
    if (result == SLUICE_SUCCESS)
        result = check(loader, &resource->info, set);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceProxyRequests requests = {.structSize = sizeof requests,
                                    .begunLaunch = loader->launch,
                                    .processedLaunch = loader->listed_launch,
                                    .pIndices = indices};
    do {
        requests.indexCount = slc_missed_pages_take(&resource->missed, indices, BATCH);
        for (uint32_t i = 0; i < requests.indexCount; i++)
            indices[i] -= resource->first_page;
        result = sluiceAddProxyRequests(set, &requests);
    } while (requests.indexCount == BATCH && result == SLUICE_SUCCESS);
    /* The set has the requests. No answer is due, and later launches list missed pages again. */
    slc_answers_forget(loader, resource, resource->first_page, resource->info.pageCount);
    return result;
}

SluiceResult sluiceGetProxyGeometry(const SluiceProxySet *set, VkDeviceAddress address,
                                    SluiceProxyGeometry *pGeometry)
{
    SluiceProxySetInfo info;
    if (!set || !pGeometry)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_struct_check(SLC_STRUCT(SluiceProxyGeometry), pGeometry, &set->log);
    if (result == SLUICE_SUCCESS)
        result = get_set_info(set, &info);
    if (result != SLUICE_SUCCESS)
        return result;
    if (info.kind != SLUICE_PROXY_KIND_GEOMETRY)
        return slc_log_refusal(&set->log, "%s: proxies of materials have no boxes", __func__);
    if (address % 8)
        return slc_log_refusal(&set->log, "address is 0x%" PRIx64 ": it must be a multiple of 8",
                               address);
    if (info.indexCount && !address)
        return SLUICE_ERROR_NULL_POINTER;
    const SluiceProxyGeometry geometry = {
        .structSize = sizeof geometry,
        .geometry = {.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR,
                     .geometryType = VK_GEOMETRY_TYPE_AABBS_KHR,
                     .geometry.aabbs =
                         {.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_AABBS_DATA_KHR,
                          .data.deviceAddress = address,
                          .stride = sizeof(SluiceProxyBox)},
                     .flags = VK_GEOMETRY_NO_DUPLICATE_ANY_HIT_INVOCATION_BIT_KHR},
        .range = {.primitiveCount = info.indexCount}};
    slc_struct_write(SLC_STRUCT(SluiceProxyGeometry), pGeometry, &geometry);
    return SLUICE_SUCCESS;
}
