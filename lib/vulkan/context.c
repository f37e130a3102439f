#include "vulkan/context.h"

#include "base/alloc.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "vulkan/create_checks.h"

#include <assert.h>

#define MIN_BUDGET (UINT64_C(4) << 20)
#define MAX_THREADS 1024u
#define DEFAULT_BINDS_PER_CALL 512u

static SluiceResult check_budget(const SluiceLogCallback *log, uint64_t bytes)
{
    const struct slc_limit limit = {"memoryBudget", bytes ? bytes : MIN_BUDGET, MIN_BUDGET,
                                    UINT64_MAX};
    return slc_check_limits(log, &limit, 1);
}

static SluiceResult check_shared_limits(const SluiceVulkanContextCreateInfo *info)
{
    const struct slc_limit limits[] = {
        {"loaderThreadCount", info->loaderThreadCount, 0, MAX_THREADS},
        {"maxPageChunkCount", info->maxPageChunkCount, 0, SLC_MAX_PAGE_CHUNKS},
        {"samplingQueueFamilyCount", info->samplingQueueFamilyCount, 0, SLC_MAX_QUEUE_FAMILIES - 2},
    };
    return slc_check_limits(&info->log, limits, sizeof limits / sizeof limits[0]);
}

static SluiceResult check_read_pool(const SluiceVulkanContextCreateInfo *info)
{
    if (!info->readPool ||
        (!info->loaderThreadCount && !info->maxReadsPerSource && !info->pJobSystem))
        return SLUICE_SUCCESS;
    return slc_log_refusal(&info->log, "loaderThreadCount, maxReadsPerSource and pJobSystem are "
                                       "those of readPool: set them to 0");
}

static SluiceResult check_fields(const SluiceVulkanContextCreateInfo *info)
{
    const SluiceDeviceMemoryCallbacks *memory = info->pDeviceMemory;
    const SluiceVulkanQueueLockCallbacks *lock = info->pQueueLock;
    const struct slc_required fields[] = {
        {"instance", info->instance},
        {"physicalDevice", info->physicalDevice},
        {"device", info->device},
        {"pfnGetInstanceProcAddr", info->pfnGetInstanceProcAddr},
        {"a function of pAllocator", slc_allocator_is_valid(info->pAllocator)},
        {"a function of pDeviceMemory", memory == NULL || (memory->pfnAllocate && memory->pfnFree)},
        {"pSamplingQueueFamilies",
         info->samplingQueueFamilyCount == 0 || info->pSamplingQueueFamilies},
        {"a function of pQueueLock", lock == NULL || (lock->pfnLock && lock->pfnUnlock)},
        {"the function of pJobSystem", info->pJobSystem == NULL || info->pJobSystem->pfnSubmitJob}};
    SluiceResult result = slc_check_required(&info->log, fields, sizeof fields / sizeof fields[0]);
    if (result == SLUICE_SUCCESS)
        result = check_shared_limits(info);
    if (result == SLUICE_SUCCESS)
        result = check_read_pool(info);
    return result == SLUICE_SUCCESS ? check_budget(&info->log, info->memoryBudget) : result;
}

static void add_family(struct slc_vk *vk, uint32_t family)
{
    for (uint32_t i = 0; i < vk->family_count; i++)
        if (vk->families[i] == family)
            return;
    vk->families[vk->family_count++] = family;
}

/* Collects the distinct families of all queues that sample or copy, and checks that they exist. */
static SluiceResult share_families(SluiceVulkanContext *context,
                                   const SluiceVulkanContextCreateInfo *info)
{
    struct slc_vk *vk = &context->vk;
    const VkQueueFlags copies =
        VK_QUEUE_TRANSFER_BIT | VK_QUEUE_COMPUTE_BIT | VK_QUEUE_GRAPHICS_BIT;
    SluiceResult result = SLUICE_SUCCESS;
    add_family(vk, info->queueFamilyIndex);
    for (uint32_t i = 0; i < info->samplingQueueFamilyCount && result == SLUICE_SUCCESS; i++) {
        result = slc_check_queue_family(vk, "an element of pSamplingQueueFamilies",
                                        info->pSamplingQueueFamilies[i],
                                        VK_QUEUE_COMPUTE_BIT | VK_QUEUE_GRAPHICS_BIT,
                                        "have VK_QUEUE_COMPUTE_BIT or VK_QUEUE_GRAPHICS_BIT");
        if (result == SLUICE_SUCCESS)
            add_family(vk, info->pSamplingQueueFamilies[i]);
    }
    if (result != SLUICE_SUCCESS || !info->uploadQueue)
        return result;
    result = slc_check_queue_family(vk, "uploadQueueFamilyIndex", info->uploadQueueFamilyIndex,
                                    copies, "have VK_QUEUE_TRANSFER_BIT");
    if (result != SLUICE_SUCCESS)
        return result;
    add_family(vk, info->uploadQueueFamilyIndex);
    context->upload_queue = info->uploadQueue;
    context->upload_family = info->uploadQueueFamilyIndex;
    context->upload_granularity = slc_transfer_granularity(vk, info->uploadQueueFamilyIndex);
    return SLUICE_SUCCESS;
}

static SluiceResult check_queues(const struct slc_vk *vk, const SluiceVulkanContextCreateInfo *info)
{
    SluiceResult result = slc_check_queue_family(vk, "queueFamilyIndex", info->queueFamilyIndex,
                                                 VK_QUEUE_COMPUTE_BIT, "have VK_QUEUE_COMPUTE_BIT");
    if (result != SLUICE_SUCCESS || !info->sparseQueue)
        return result;
    return slc_check_queue_family(vk, "sparseQueueFamilyIndex", info->sparseQueueFamilyIndex,
                                  VK_QUEUE_SPARSE_BINDING_BIT, "have VK_QUEUE_SPARSE_BINDING_BIT");
}

static SluiceResult create_pipeline_cache(SluiceVulkanContext *context,
                                          const SluiceVulkanContextCreateInfo *info)
{
    struct slc_vk *vk = &context->vk;
    vk->pipeline_cache = info->pipelineCache;
    if (info->pipelineCache)
        return SLUICE_SUCCESS;
    const VkPipelineCacheCreateInfo create = {.sType =
                                                  VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    SluiceResult result = slc_vk_result(
        vk, vk->CreatePipelineCache(vk->device, &create, NULL, &context->pipeline_cache),
        "vkCreatePipelineCache");
    if (result != SLUICE_SUCCESS)
        return result;
    vk->pipeline_cache = context->pipeline_cache;
    slc_vk_name(vk, VK_OBJECT_TYPE_PIPELINE_CACHE, (uint64_t)vk->pipeline_cache, "pipelines");
    return SLUICE_SUCCESS;
}

static SluiceResult init(SluiceVulkanContext *context, const SluiceVulkanContextCreateInfo *info)
{
    SluiceResult result = slc_vk_init_instance(&context->vk, info->instance, info->physicalDevice,
                                               info->pfnGetInstanceProcAddr, &info->log);
    if (result == SLUICE_SUCCESS)
        result = slc_vk_init_device(&context->vk, info->device);
    if (result == SLUICE_SUCCESS)
        result = check_queues(&context->vk, info);
    if (result == SLUICE_SUCCESS)
        result = share_families(context, info);
    if (result != SLUICE_SUCCESS)
        return result;
    /* Functions of instance extensions are found only through the instance, and only if enabled. */
    context->vk.SetDebugUtilsObjectNameEXT =
        (PFN_vkSetDebugUtilsObjectNameEXT)info->pfnGetInstanceProcAddr(
            info->instance, "vkSetDebugUtilsObjectNameEXT");
    result = create_pipeline_cache(context, info);
    if (result != SLUICE_SUCCESS)
        return result;
    slc_caps_init(&context->caps, &context->vk);
    context->sparse_queue = info->sparseQueue;
    context->max_binds_per_call =
        info->maxBindsPerCall ? info->maxBindsPerCall : DEFAULT_BINDS_PER_CALL;
    if (info->pQueueLock) {
        context->queue_lock = *info->pQueueLock;
        context->vk.queue_lock = &context->queue_lock;
    }
    slc_shared_parts_init(&context->shared, &context->vk, &context->caps, &context->cb, info);
    atomic_init(&context->child_count, 0);
    if (info->pDeviceMemory) {
        context->memory_callbacks = *info->pDeviceMemory;
        context->vk.memory_callbacks = &context->memory_callbacks;
    }
    result = slc_memory_budget_init(&context->budget);
    if (result != SLUICE_SUCCESS) {
        context->vk.DestroyPipelineCache(context->vk.device, context->pipeline_cache, NULL);
        return result;
    }
    if (info->memoryBudget)
        slc_memory_budget_set_limit(&context->budget, info->memoryBudget);
    if (!info->noDeviceBudget)
        result =
            slc_device_budget_init(&context->device_budget, &context->vk, &context->caps,
                                   &context->cb, info->pfnGetInstanceProcAddr, &context->budget);
    if (result != SLUICE_SUCCESS) {
        slc_memory_budget_finish(&context->budget);
        context->vk.DestroyPipelineCache(context->vk.device, context->pipeline_cache, NULL);
        return result;
    }
    slc_memory_client_init(&context->memory, &context->budget);
    context->vk.memory_client = &context->memory;
    return SLUICE_SUCCESS;
}

SluiceResult sluiceCreateVulkanContext(const SluiceVulkanContextCreateInfo *pCreateInfo,
                                       SluiceVulkanContext **pContext)
{
    if (!pContext)
        return SLUICE_ERROR_NULL_POINTER;
    *pContext = NULL;
    if (!pCreateInfo)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceVulkanContextCreateInfo info = {.structSize = sizeof info};
    SluiceResult result = slc_struct_read(SLC_STRUCT(SluiceVulkanContextCreateInfo), &info,
                                          pCreateInfo, &pCreateInfo->log);
    if (result == SLUICE_SUCCESS)
        result = check_fields(&info);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceAllocationCallbacks cb = slc_allocator(info.pAllocator);
    SluiceVulkanContext *context = slc_calloc(&cb, 1, sizeof *context);
    if (!context)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    context->cb = cb;
    result = init(context, &info);
    if (result != SLUICE_SUCCESS) {
        slc_free(&cb, context, 1, sizeof *context);
        return result;
    }
    slc_shared_parts_join(&context->shared);
    *pContext = context;
    return SLUICE_SUCCESS;
}

void sluiceDestroyVulkanContext(SluiceVulkanContext *context)
{
    if (!context)
        return;
    unsigned children = atomic_load(&context->child_count);
    if (children > 0) {
        slc_log(&context->vk.log, SLUICE_LOG_ERROR,
                "context is not destroyed: %u of its streamers and demand loaders still exist",
                children);
        return;
    }
    SluiceAllocationCallbacks cb = context->cb;
    slc_shared_parts_leave(&context->shared);
    slc_memory_client_finish(&context->memory);
    slc_device_budget_finish(&context->device_budget);
    slc_memory_budget_finish(&context->budget);
    context->vk.DestroyPipelineCache(context->vk.device, context->pipeline_cache, NULL);
    slc_shared_parts_finish(&context->shared);
    slc_free(&cb, context, 1, sizeof *context);
}

SluiceResult sluiceSetVulkanMemoryBudget(SluiceVulkanContext *context, uint64_t memoryBudget)
{
    if (!context)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = check_budget(&context->vk.log, memoryBudget);
    if (result == SLUICE_SUCCESS)
        slc_memory_budget_set_limit(&context->budget,
                                    memoryBudget ? memoryBudget : SLC_NO_MEMORY_LIMIT);
    return result;
}

SluiceResult sluiceGetVulkanContextStatistics(SluiceVulkanContext *context,
                                              SluiceVulkanContextStatistics *pStatistics)
{
    if (!context || !pStatistics)
        return SLUICE_ERROR_NULL_POINTER;
    const struct slc_struct *type = SLC_STRUCT(SluiceVulkanContextStatistics);
    SluiceResult result = slc_struct_check(type, pStatistics, &context->vk.log);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceVulkanContextStatistics statistics = {.structSize = sizeof statistics};
    slc_memory_budget_get(&context->budget, &statistics);
    slc_struct_write(type, pStatistics, &statistics);
    return SLUICE_SUCCESS;
}

void slc_context_add_child(SluiceVulkanContext *context)
{
    atomic_fetch_add(&context->child_count, 1);
}

void slc_context_remove_child(SluiceVulkanContext *context)
{
    unsigned before = atomic_fetch_sub(&context->child_count, 1);
    assert(before > 0);
    (void)before;
}
