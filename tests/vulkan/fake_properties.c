#include "vulkan/fake_functions.h"
#include "vulkan/fake_objects.h"

static VKAPI_ATTR void VKAPI_CALL get_features(VkPhysicalDevice device,
                                               VkPhysicalDeviceFeatures2 *features)
{
    const bool has_addresses = fake_of(device)->has_addresses;
    features->features =
        (VkPhysicalDeviceFeatures){.sparseBinding = VK_TRUE,
                                   .sparseResidencyImage2D = VK_TRUE,
                                   .shaderSampledImageArrayDynamicIndexing = VK_TRUE,
                                   .fragmentStoresAndAtomics = VK_TRUE};
    for (VkBaseOutStructure *next = features->pNext; next; next = next->pNext) {
        if (next->sType != VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES)
            continue;
        ((VkPhysicalDeviceVulkan12Features *)next)->timelineSemaphore = VK_TRUE;
        ((VkPhysicalDeviceVulkan12Features *)next)->bufferDeviceAddress = has_addresses;
    }
}

static VKAPI_ATTR void VKAPI_CALL get_properties(VkPhysicalDevice device,
                                                 VkPhysicalDeviceProperties2 *properties)
{
    const struct fake_vulkan *fake = fake_of(device);
    const uint32_t samplers = fake->max_samplers ? fake->max_samplers : 1000000;
    properties->properties =
        (VkPhysicalDeviceProperties){.apiVersion = VK_API_VERSION_1_2,
                                     .deviceName = "fake",
                                     .limits = {.sparseAddressSpaceSize = 1ull << 40,
                                                .maxStorageBufferRange = 1u << 27,
                                                .maxImageArrayLayers = 256,
                                                .maxPerStageDescriptorSamplers = samplers,
                                                .maxDescriptorSetSamplers = 1000000,
                                                .maxPerStageDescriptorSampledImages = 1000000,
                                                .maxDescriptorSetSampledImages = 1000000}};
}

static VKAPI_ATTR void VKAPI_CALL get_memory(VkPhysicalDevice device,
                                             VkPhysicalDeviceMemoryProperties *memory)
{
    const struct fake_vulkan *fake = fake_of(device);
    *memory = (VkPhysicalDeviceMemoryProperties){
        .memoryTypeCount = 1,
        .memoryTypes = {{VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                             VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
                         0}},
        .memoryHeapCount = 1,
        .memoryHeaps = {{fake->heap_size ? fake->heap_size : 1ull << 40, 0}}};
}

static VKAPI_ATTR VkResult VKAPI_CALL list_extensions(VkPhysicalDevice device, const char *layer,
                                                      uint32_t *count, VkExtensionProperties *list)
{
    struct fake_vulkan *fake = fake_of(device);
    (void)layer;
    fake->extension_calls++;
    if (list && fake->has_memory_budget && *count > 1)
        list[1] = (VkExtensionProperties){VK_EXT_MEMORY_BUDGET_EXTENSION_NAME, 1};
    if (list)
        list[0] = (VkExtensionProperties){"VK_EXT_other", 1};
    *count = fake->has_memory_budget ? 2 : 1;
    return VK_SUCCESS;
}

/* Others may use more than there is: the budget of this program is smaller then. */
static VKAPI_ATTR void VKAPI_CALL get_memory2(VkPhysicalDevice device,
                                              VkPhysicalDeviceMemoryProperties2 *memory)
{
    struct fake_vulkan *fake = fake_of(device);
    fake->budget_calls++;
    get_memory(device, &memory->memoryProperties);
    VkPhysicalDeviceMemoryBudgetPropertiesEXT *budget = memory->pNext;
    uint64_t all = memory->memoryProperties.memoryHeaps[0].size;
    budget->heapBudget[0] = all > fake->used_by_others ? all - fake->used_by_others : 0;
    budget->heapUsage[0] = fake->live_memory;
}

static VKAPI_ATTR void VKAPI_CALL get_families(VkPhysicalDevice device, uint32_t *count,
                                               VkQueueFamilyProperties *families)
{
    const struct fake_vulkan *fake = fake_of(device);
    static const VkQueueFlags all[FAKE_FAMILIES] = {
        [0] = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT | VK_QUEUE_SPARSE_BINDING_BIT,
        [FAKE_TRANSFER_FAMILY] = VK_QUEUE_TRANSFER_BIT,
        [FAKE_SPARSE_FAMILY] = VK_QUEUE_TRANSFER_BIT | VK_QUEUE_SPARSE_BINDING_BIT,
        [FAKE_COMPUTE_FAMILY] = VK_QUEUE_COMPUTE_BIT};
    uint32_t room = families ? *count : 0;
    *count = FAKE_FAMILIES;
    for (uint32_t i = 0; i < room && i < FAKE_FAMILIES; i++)
        families[i] = (VkQueueFamilyProperties){
            .queueFlags = all[i], .queueCount = 1, .minImageTransferGranularity = {1, 1, 1}};
    if (room > FAKE_TRANSFER_FAMILY && (fake->granularity.width || fake->whole_levels))
        families[FAKE_TRANSFER_FAMILY].minImageTransferGranularity = fake->granularity;
}

static VKAPI_ATTR void VKAPI_CALL get_format_features(VkPhysicalDevice device, VkFormat format,
                                                      VkFormatProperties *properties)
{
    (void)format;
    *properties = (VkFormatProperties){0};
    if (!fake_of(device)->no_linear_filter)
        properties->optimalTilingFeatures = VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
}

static VKAPI_ATTR VkResult VKAPI_CALL get_format(VkPhysicalDevice device, VkFormat format,
                                                 VkImageType type, VkImageTiling tiling,
                                                 VkImageUsageFlags usage, VkImageCreateFlags flags,
                                                 VkImageFormatProperties *properties)
{
    (void)type, (void)tiling, (void)usage;
    *properties = (VkImageFormatProperties){.maxExtent = {16384, 16384, 1},
                                            .maxMipLevels = 15,
                                            .maxArrayLayers = 256,
                                            .maxResourceSize = 1ull << 40};
    bool lacks = flags & fake_of(device)->lacking_flags;
    return format == VK_FORMAT_R8G8B8A8_UNORM && !lacks ? VK_SUCCESS
                                                        : VK_ERROR_FORMAT_NOT_SUPPORTED;
}

static VKAPI_ATTR void VKAPI_CALL get_sparse_format(VkPhysicalDevice device, VkFormat format,
                                                    VkImageType type, VkSampleCountFlagBits samples,
                                                    VkImageUsageFlags usage, VkImageTiling tiling,
                                                    uint32_t *count,
                                                    VkSparseImageFormatProperties *properties)
{
    (void)device, (void)format, (void)type, (void)samples, (void)usage, (void)tiling;
    if (properties && *count)
        properties[0] = (VkSparseImageFormatProperties){
            VK_IMAGE_ASPECT_COLOR_BIT, {FAKE_TILE, FAKE_TILE, 1}, 0};
    *count = 1;
}

const struct fake_function fake_property_functions[] = {
    FAKE_FUNCTION(GetPhysicalDeviceFeatures2, get_features),
    FAKE_FUNCTION(GetPhysicalDeviceFormatProperties, get_format_features),
    FAKE_FUNCTION(GetPhysicalDeviceImageFormatProperties, get_format),
    FAKE_FUNCTION(GetPhysicalDeviceMemoryProperties, get_memory),
    FAKE_FUNCTION(GetPhysicalDeviceMemoryProperties2, get_memory2),
    FAKE_FUNCTION(EnumerateDeviceExtensionProperties, list_extensions),
    FAKE_FUNCTION(GetPhysicalDeviceProperties2, get_properties),
    FAKE_FUNCTION(GetPhysicalDeviceQueueFamilyProperties, get_families),
    FAKE_FUNCTION(GetPhysicalDeviceSparseImageFormatProperties, get_sparse_format),
    {NULL, NULL},
};
