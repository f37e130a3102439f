#include "vulkan/fake_vulkan.h"

#include "support/test.h"
#include "vulkan/fake_functions.h"
#include "vulkan/fake_objects.h"
#include "vulkan/streamer.h"

#include <string.h>

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device_function(VkDevice device,
                                                                    const char *name);

static const struct fake_function entry_functions[] = {
    FAKE_FUNCTION(GetDeviceProcAddr, get_device_function),
    {NULL, NULL},
};

static const struct fake_function *const lists[] = {
    entry_functions,           fake_property_functions, fake_object_functions,
    fake_image_functions,      fake_buffer_functions,   fake_queue_functions,
    fake_descriptor_functions, fake_command_functions,  fake_pass_functions,
};

static PFN_vkVoidFunction find(const char *name)
{
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++)
        for (const struct fake_function *f = lists[i]; f->name; f++)
            if (strcmp(f->name, name) == 0)
                return f->function;
    return NULL;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device_function(VkDevice device,
                                                                    const char *name)
{
    const char *missing = fake_of(device)->missing;
    return missing && strcmp(missing, name) == 0 ? NULL : find(name);
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_instance_function(VkInstance instance,
                                                                      const char *name)
{
    const char *missing = fake_of(instance)->missing;
    return missing && strcmp(missing, name) == 0 ? NULL : find(name);
}

void fake_vulkan_fill(SluiceVulkanStreamerCreateInfo *info)
{
    info->structSize = sizeof *info;
    if (info->ticksPerSecond)
        return;
    info->ticksPerSecond = 60;
    info->newestFeedbackMapOnly = info->feedbackTimeoutTicks == 0;
    info->noStandbyTiles = info->numExtraStandbyTiles == 0;
    if (info->retryDelayTicks == 0)
        info->retryDelayTicks = 1;
}

static void lock_queue(void *user, VkQueue queue)
{
    struct fake_vulkan *fake = user;
    assert_int_equal(fake->lock_depth, 0);
    fake->lock_depth++;
    fake->lock_count++;
    fake->locked_queue = queue;
}

static void unlock_queue(void *user, VkQueue queue)
{
    struct fake_vulkan *fake = user;
    assert_int_equal(fake->lock_depth, 1);
    assert_ptr_equal(fake->locked_queue, queue);
    fake->lock_depth--;
}

SluiceVulkanContextCreateInfo fake_vulkan_context_info(struct fake_vulkan *fake)
{
    fake->queue_lock = (SluiceVulkanQueueLockCallbacks){fake, lock_queue, unlock_queue};
    return (SluiceVulkanContextCreateInfo){
        .structSize = sizeof(SluiceVulkanContextCreateInfo),
        .instance = (VkInstance)(void *)fake,
        .physicalDevice = (VkPhysicalDevice)(void *)fake,
        .device = (VkDevice)(void *)fake,
        .pfnGetInstanceProcAddr = get_instance_function,
        .sparseQueue = (VkQueue)(void *)fake,
        .uploadQueue = fake->has_upload_queue ? (VkQueue)(void *)fake : VK_NULL_HANDLE,
        .uploadQueueFamilyIndex = FAKE_TRANSFER_FAMILY,
        .pAllocator = fake->pAllocator,
        .log = fake->log,
        .loaderThreadCount = fake->readPool            ? 0
                             : fake->loaderThreadCount ? fake->loaderThreadCount
                                                       : 1,
        .readRetry = fake->readRetry,
        .maxPageChunkCount = fake->maxPageChunkCount,
        .minStagingSize = fake->minStagingSize,
        .minTileMemorySize = fake->minTileMemorySize,
        .pQueueLock = fake->no_queue_lock ? NULL : &fake->queue_lock,
        .maxBindsPerCall = fake->maxBindsPerCall,
        .pJobSystem = fake->pJobSystem,
        .readPool = fake->readPool};
}

SluiceResult fake_vulkan_create(struct fake_vulkan *fake, SluiceVulkanStreamerCreateInfo *info,
                                SluiceVulkanStreamer **streamer)
{
    const SluiceVulkanContextCreateInfo context = fake_vulkan_context_info(fake);
    *streamer = NULL;
    SluiceResult result = sluiceCreateVulkanContext(&context, &info->context);
    if (result != SLUICE_SUCCESS)
        return result;
    result = sluiceCreateVulkanStreamer(info, streamer);
    if (result != SLUICE_SUCCESS)
        sluiceDestroyVulkanContext(info->context);
    return result;
}

void fake_vulkan_destroy(SluiceVulkanStreamer *streamer)
{
    if (!streamer)
        return;
    SluiceVulkanContext *context = streamer->context;
    sluiceDestroyVulkanStreamer(streamer);
    sluiceDestroyVulkanContext(context);
}

VkCommandBuffer fake_vulkan_commands(struct fake_vulkan *fake)
{
    return (VkCommandBuffer)(void *)fake;
}
