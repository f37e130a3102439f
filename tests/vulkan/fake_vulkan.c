#include "vulkan/fake_vulkan.h"

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

SluiceVulkanContextCreateInfo fake_vulkan_context_info(struct fake_vulkan *fake)
{
    return (SluiceVulkanContextCreateInfo){
        .structSize = sizeof(SluiceVulkanContextCreateInfo),
        .instance = (VkInstance)(void *)fake,
        .physicalDevice = (VkPhysicalDevice)(void *)fake,
        .device = (VkDevice)(void *)fake,
        .pfnGetInstanceProcAddr = get_instance_function,
        .sparseQueue = (VkQueue)(void *)fake,
        .pAllocator = fake->pAllocator,
        .log = fake->log,
        .loaderThreadCount = fake->loaderThreadCount ? fake->loaderThreadCount : 1,
        .readRetry = fake->readRetry,
        .maxPageChunkCount = fake->maxPageChunkCount,
        .minStagingSize = fake->minStagingSize,
        .minTileMemorySize = fake->minTileMemorySize};
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
