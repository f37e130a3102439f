#include "vulkan/caps.h"

#include "base/checked.h"
#include "base/log.h"
#include "base/struct_size.h"

#include <stdio.h>
#include <string.h>

#define MAX_QUEUE_FAMILIES 32u
#define USUAL_PACKED_TILES                                                                         \
    8u /* packed tiles per texture on software devices, which pack no levels */

/* A software device maps every bound page into the process, and keeps the map until the image is
 * destroyed. It loses data silently when the system refuses more maps. A quarter of the system's
 * limit is left to others. */
static uint32_t find_max_touched_tiles(void)
{
    unsigned long maps = 65530; /* Linux's default */
    FILE *file = fopen("/proc/sys/vm/max_map_count", "r");
    if (file) {
        if (fscanf(file, "%lu", &maps) != 1 || maps < 4)
            maps = 65530;
        fclose(file);
    }
    unsigned long limit = maps / 4 * 3;
    return limit < UINT32_MAX ? (uint32_t)limit : UINT32_MAX;
}

/* Prefers a family that does not draw: its binds run beside frames instead of waiting for them. */
static bool find_sparse_family(const struct slc_vk *vk, SluiceVulkanDeviceCapabilities *caps)
{
    VkQueueFamilyProperties families[MAX_QUEUE_FAMILIES];
    uint32_t count = MAX_QUEUE_FAMILIES;
    vk->GetPhysicalDeviceQueueFamilyProperties(vk->physical_device, &count, families);
    int best = -1;
    for (uint32_t i = 0; i < count; i++) {
        if (!(families[i].queueFlags & VK_QUEUE_SPARSE_BINDING_BIT))
            continue;
        int score = !(families[i].queueFlags & VK_QUEUE_GRAPHICS_BIT);
        score += !(families[i].queueFlags & (VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT));
        if (score > best) {
            best = score;
            caps->sparseQueueFamilyIndex = i;
            caps->sparseQueueCount = families[i].queueCount;
            caps->dedicatedSparseQueue = score == 2;
        }
    }
    return best >= 0;
}

static void take_features(SluiceVulkanDeviceCapabilities *out, const VkPhysicalDeviceFeatures *f)
{
    out->shaderResourceResidency = f->shaderResourceResidency;
    out->shaderResourceMinLod = f->shaderResourceMinLod;
    out->fragmentStoresAndAtomics = f->fragmentStoresAndAtomics;
    out->textureCompressionBC = f->textureCompressionBC;
    out->samplerAnisotropy = f->samplerAnisotropy;
    out->sparseResidencyAliased = f->sparseResidencyAliased;
}

static void take_properties(SluiceVulkanDeviceCapabilities *out,
                            const VkPhysicalDeviceProperties *p)
{
    bool software = p->deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    memcpy(out->deviceName, p->deviceName, sizeof out->deviceName);
    out->deviceType = p->deviceType;
    out->apiVersion = p->apiVersion;
    out->residencyNonResidentStrict = p->sparseProperties.residencyNonResidentStrict;
    out->standardTiles = p->sparseProperties.residencyStandard2DBlockShape;
    out->residencyCodesExact = out->shaderResourceResidency && !software;
    out->sparseCubes = !software;
    out->sparseAddressSpaceSize = p->limits.sparseAddressSpaceSize;
    out->maxTouchedTiles = software ? find_max_touched_tiles() : 0;
    out->maxImageExtent = p->limits.maxImageDimension2D;
    out->maxImageArrayLayers = p->limits.maxImageArrayLayers;
    out->maxStorageBufferRange = p->limits.maxStorageBufferRange;
    out->maxSamplerAnisotropy = p->limits.maxSamplerAnisotropy;
    out->timestampPeriod = p->limits.timestampComputeAndGraphics ? p->limits.timestampPeriod : 0.0f;
}

/* Takes the lower limit: per stage or per layout. Combined image samplers count as images and as
 * samplers. */
static void take_descriptor_limits(struct slc_caps *caps, const VkPhysicalDeviceLimits *limits)
{
    caps->max_stage_images = slc_min_u32(limits->maxPerStageDescriptorSampledImages,
                                         limits->maxDescriptorSetSampledImages);
    caps->max_stage_samplers =
        slc_min_u32(caps->max_stage_images, slc_min_u32(limits->maxPerStageDescriptorSamplers,
                                                        limits->maxDescriptorSetSamplers));
}

static void take_buffer_limits(struct slc_caps *caps, const VkPhysicalDeviceLimits *limits)
{
    caps->max_stage_storage_buffers = slc_min_u32(limits->maxPerStageDescriptorStorageBuffers,
                                                  limits->maxDescriptorSetStorageBuffers);
}

static uint64_t largest_local_heap(const VkPhysicalDeviceMemoryProperties *memory)
{
    uint64_t size = 0;
    for (uint32_t i = 0; i < memory->memoryHeapCount; i++)
        if (memory->memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT &&
            memory->memoryHeaps[i].size > size)
            size = memory->memoryHeaps[i].size;
    return size;
}

void slc_caps_init(struct slc_caps *caps, const struct slc_vk *vk)
{
    *caps = (struct slc_caps){0};
    VkPhysicalDeviceVulkan12Features features12 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                          .pNext = &features12};
    VkPhysicalDeviceMaintenance3Properties maintenance3 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES};
    VkPhysicalDeviceDriverProperties driver = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES, .pNext = &maintenance3};
    VkPhysicalDeviceProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &driver};
    vk->GetPhysicalDeviceFeatures2(vk->physical_device, &features);
    vk->GetPhysicalDeviceProperties2(vk->physical_device, &properties);
    vk->GetPhysicalDeviceMemoryProperties(vk->physical_device, &caps->memory);
    SluiceVulkanDeviceCapabilities *out = &caps->public;
    take_features(out, &features.features);
    take_properties(out, &properties.properties);
    memcpy(out->driverName, driver.driverName, sizeof out->driverName);
    memcpy(out->driverInfo, driver.driverInfo, sizeof out->driverInfo);
    out->deviceLocalMemorySize = largest_local_heap(&caps->memory);
    out->nonUniformIndexing = features12.shaderSampledImageArrayNonUniformIndexing;
    out->runtimeDescriptorArrays = features12.runtimeDescriptorArray;
    take_descriptor_limits(caps, &properties.properties.limits);
    take_buffer_limits(caps, &properties.properties.limits);
    caps->buffer_device_address = features12.bufferDeviceAddress;
    caps->image_cube_array = features.features.imageCubeArray;
    caps->array_dynamic_indexing = features.features.shaderSampledImageArrayDynamicIndexing;
    caps->max_image_array_layers = out->maxImageArrayLayers;
    caps->max_allocation_size = maintenance3.maxMemoryAllocationSize;
    caps->max_storage_buffer_range = out->maxStorageBufferRange;
    bool vulkan12 = out->apiVersion >= VK_API_VERSION_1_2;
    out->timelineSemaphore = vulkan12 && features12.timelineSemaphore;
    caps->timeline_semaphore = out->timelineSemaphore;
    bool queue = find_sparse_family(vk, out);
    out->sparse = vulkan12 && features.features.sparseBinding &&
                  features.features.sparseResidencyImage2D && queue;
}

uint32_t slc_find_memory_type(const VkPhysicalDeviceMemoryProperties *memory, uint32_t type_bits,
                              VkMemoryPropertyFlags required, VkMemoryPropertyFlags preferred)
{
    for (int pass = 0; pass < 2; pass++) {
        VkMemoryPropertyFlags wanted = required | (pass == 0 ? preferred : 0);
        for (uint32_t i = 0; i < memory->memoryTypeCount; i++)
            if (type_bits >> i & 1 && (memory->memoryTypes[i].propertyFlags & wanted) == wanted)
                return i;
    }
    return UINT32_MAX;
}

uint32_t slc_device_memory_heap(const struct slc_caps *caps)
{
    const VkPhysicalDeviceMemoryProperties *memory = &caps->memory;
    uint32_t largest = 0;
    uint64_t size = 0;
    for (uint32_t i = 0; i < memory->memoryTypeCount; i++) {
        uint32_t heap = memory->memoryTypes[i].heapIndex;
        if (memory->memoryTypes[i].propertyFlags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT &&
            memory->memoryHeaps[heap].size > size) {
            largest = heap;
            size = memory->memoryHeaps[heap].size;
        }
    }
    return largest;
}

uint64_t slc_device_memory_size(const struct slc_caps *caps)
{
    return caps->memory.memoryHeaps[slc_device_memory_heap(caps)].size;
}

static SluiceResidencyMode resolve_mode(const SluiceVulkanDeviceCapabilities *capabilities,
                                        SluiceResidencyMode mode, uint32_t max_texture_count)
{
    if (mode != SLUICE_RESIDENCY_MODE_AUTO)
        return mode;
    uint32_t count = max_texture_count ? max_texture_count : SLC_DEFAULT_TEXTURE_COUNT;
    uint32_t bearable = capabilities->maxTouchedTiles / (2 * USUAL_PACKED_TILES);
    bool crowded = capabilities->maxTouchedTiles > 0 && count > bearable;
    return capabilities->sparse && !crowded ? SLUICE_RESIDENCY_MODE_SPARSE
                                            : SLUICE_RESIDENCY_MODE_PAGED;
}

SluiceResult sluiceChooseVulkanResidencyMode(const SluiceVulkanDeviceCapabilities *pCapabilities,
                                             SluiceResidencyMode mode, uint32_t maxTextureCount,
                                             SluiceResidencyMode *pMode)
{
    if (!pCapabilities || !pMode)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceVulkanDeviceCapabilities capabilities = {.structSize = sizeof capabilities};
    SluiceResult result = slc_struct_read(SLC_STRUCT(SluiceVulkanDeviceCapabilities), &capabilities,
                                          pCapabilities, NULL);
    if (result == SLUICE_SUCCESS)
        *pMode = resolve_mode(&capabilities, mode, maxTextureCount);
    return result;
}

SluiceResidencyMode slc_choose_mode(const struct slc_caps *caps, SluiceResidencyMode mode,
                                    uint32_t max_texture_count)
{
    SluiceResidencyMode chosen = resolve_mode(&caps->public, mode, max_texture_count);
    bool sparse = chosen != mode && caps->public.sparse && !caps->array_dynamic_indexing;
    return sparse ? SLUICE_RESIDENCY_MODE_SPARSE : chosen;
}

const char *slc_missing_for_mode(const struct slc_caps *caps, SluiceResidencyMode mode)
{
    if (!caps->timeline_semaphore)
        return "timeline semaphores (Vulkan 1.2)";
    if (mode == SLUICE_RESIDENCY_MODE_SPARSE && !caps->public.sparse)
        return "sparse residency of 2D images";
    if (mode == SLUICE_RESIDENCY_MODE_PAGED && !caps->array_dynamic_indexing)
        return "shaderSampledImageArrayDynamicIndexing";
    return NULL;
}

SluiceResult sluiceGetVulkanDeviceCapabilities(VkInstance instance, VkPhysicalDevice physicalDevice,
                                               PFN_vkGetInstanceProcAddr pfnGetInstanceProcAddr,
                                               SluiceVulkanDeviceCapabilities *pCapabilities)
{
    if (!instance || !physicalDevice || !pfnGetInstanceProcAddr || !pCapabilities)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult checked =
        slc_struct_check(SLC_STRUCT(SluiceVulkanDeviceCapabilities), pCapabilities, NULL);
    if (checked != SLUICE_SUCCESS)
        return checked;
    struct slc_vk vk;
    SluiceResult result =
        slc_vk_init_instance(&vk, instance, physicalDevice, pfnGetInstanceProcAddr, NULL);
    if (result != SLUICE_SUCCESS)
        return result;
    struct slc_caps caps;
    slc_caps_init(&caps, &vk);
    slc_struct_write(SLC_STRUCT(SluiceVulkanDeviceCapabilities), pCapabilities, &caps.public);
    return SLUICE_SUCCESS;
}

/* Requires features for arrays of pages and textures, in every mode: one shader may serve all
 * modes. */
static void require_arrays(const struct slc_caps *caps, VkPhysicalDeviceFeatures *features,
                           VkPhysicalDeviceVulkan12Features *vulkan12)
{
    if (caps->array_dynamic_indexing)
        features->shaderSampledImageArrayDynamicIndexing = VK_TRUE;
    if (caps->public.nonUniformIndexing)
        vulkan12->shaderSampledImageArrayNonUniformIndexing = VK_TRUE;
    if (caps->public.runtimeDescriptorArrays)
        vulkan12->runtimeDescriptorArray = VK_TRUE;
}

/* Features for the samplers of sluiceGetVulkanSampler and for the views of textures. */
static void require_samplers(const VkPhysicalDeviceFeatures *there,
                             const VkPhysicalDeviceVulkan12Features *there12,
                             VkPhysicalDeviceFeatures *features,
                             VkPhysicalDeviceVulkan12Features *vulkan12)
{
    if (there->samplerAnisotropy)
        features->samplerAnisotropy = VK_TRUE;
    if (there12->samplerMirrorClampToEdge)
        vulkan12->samplerMirrorClampToEdge = VK_TRUE;
    if (there->imageCubeArray)
        features->imageCubeArray = VK_TRUE;
}

SluiceResult sluiceRequireVulkanFeatures(VkInstance instance, VkPhysicalDevice physicalDevice,
                                         PFN_vkGetInstanceProcAddr pfnGetInstanceProcAddr,
                                         SluiceResidencyMode mode, const SluiceLogCallback *pLog,
                                         VkPhysicalDeviceFeatures *pFeatures,
                                         VkPhysicalDeviceVulkan12Features *pVulkan12)
{
    if (!instance || !physicalDevice || !pfnGetInstanceProcAddr || !pFeatures || !pVulkan12)
        return SLUICE_ERROR_NULL_POINTER;
    if (!slc_mode_is_known(mode))
        return slc_log_refusal(pLog, "mode is %d; it must be from %d to %d", (int)mode,
                               SLUICE_RESIDENCY_MODE_AUTO, SLUICE_RESIDENCY_MODE_DENSE);
    struct slc_vk vk;
    SluiceResult result =
        slc_vk_init_instance(&vk, instance, physicalDevice, pfnGetInstanceProcAddr, pLog);
    if (result != SLUICE_SUCCESS)
        return result;
    struct slc_caps caps;
    slc_caps_init(&caps, &vk);
    mode = slc_choose_mode(&caps, mode, 0);
    VkPhysicalDeviceVulkan12Features there12 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 there = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                       .pNext = &there12};
    vk.GetPhysicalDeviceFeatures2(physicalDevice, &there);
    const char *missing = slc_missing_for_mode(&caps, mode);
    if (!missing && !there.features.fragmentStoresAndAtomics)
        missing = "fragmentStoresAndAtomics";
    if (missing) {
        slc_log(pLog, SLUICE_LOG_ERROR, "%s has no %s", caps.public.deviceName, missing);
        return SLUICE_ERROR_UNSUPPORTED;
    }
    if (mode == SLUICE_RESIDENCY_MODE_SPARSE) {
        pFeatures->sparseBinding = VK_TRUE;
        pFeatures->sparseResidencyImage2D = VK_TRUE;
    }
    require_arrays(&caps, pFeatures, pVulkan12);
    require_samplers(&there.features, &there12, pFeatures, pVulkan12);
    pFeatures->fragmentStoresAndAtomics = VK_TRUE;
    if (there.features.textureCompressionBC)
        pFeatures->textureCompressionBC = VK_TRUE;
    if (there.features.textureCompressionETC2)
        pFeatures->textureCompressionETC2 = VK_TRUE;
    if (there.features.textureCompressionASTC_LDR)
        pFeatures->textureCompressionASTC_LDR = VK_TRUE;
    pVulkan12->timelineSemaphore = VK_TRUE;
    return SLUICE_SUCCESS;
}
