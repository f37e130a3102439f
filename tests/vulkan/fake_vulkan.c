#include "vulkan/fake_vulkan.h"

#include "support/test.h"
#include "vulkan/feedback_map.h"
#include "vulkan/streamer.h"

#include <sluice/shared/texture_table.h>

#include <stdlib.h>
#include <string.h>

/* Whatever a handle stands for. */
struct fake_object {
    VkExtent3D extent;
    uint32_t level_count, layer_count;
    uint64_t size;
    void *memory;
    VkImage image; ///< of a view
    bool general;  ///< the layout of an image
    bool has_name, needs_name;
    uint32_t first_image; ///< binding of a set layout; UINT32_MAX: it has buffers alone
};

/* All dispatchable handles are the device itself. */
static struct fake_vulkan *fake_of(void *handle)
{
    return handle;
}

/* Counts the calls of functions that may fail. */
static VkResult next_call(struct fake_vulkan *fake)
{
    uint64_t call = ++fake->calls, failing = fake->failing_call;
    bool fails = call == failing || (fake->fails_on && failing > 0 && call > failing);
    return fails ? fake->failure : VK_SUCCESS;
}

#define MAY_FAIL(handle)                                                                           \
    do {                                                                                           \
        VkResult status = next_call(fake_of(handle));                                              \
        if (status != VK_SUCCESS)                                                                  \
            return status;                                                                         \
    } while (0)

static void *make(struct fake_vulkan *fake, uint64_t size)
{
    struct fake_object *object = calloc(1, sizeof *object);
    assert_non_null(object);
    object->size = size;
    fake->live_objects++;
    return object;
}

static void drop(struct fake_vulkan *fake, void *object)
{
    if (object) {
        const struct fake_object *o = object;
        fake->live_objects--;
        fake->unnamed_objects -= o->needs_name && !o->has_name;
    }
    free(object);
}

#define OBJECT(handle) ((struct fake_object *)(handle))

/* An object of a kind that debuggers show. */
static void *make_shown(struct fake_vulkan *fake, uint64_t size)
{
    struct fake_object *object = make(fake, size);
    object->needs_name = true;
    fake->unnamed_objects++;
    return object;
}

static VKAPI_ATTR VkResult VKAPI_CALL set_name(VkDevice device,
                                               const VkDebugUtilsObjectNameInfoEXT *info)
{
    struct fake_object *object = (struct fake_object *)info->objectHandle;
    struct fake_vulkan *fake = fake_of(device);
    assert_memory_equal(info->pObjectName, "sluice: ", 8);
    if (object->needs_name && !object->has_name) {
        fake->unnamed_objects--;
        fake->named_count++;
    }
    object->has_name = true;
    return VK_SUCCESS;
}

/* Functions that make and drop objects of which nothing is asked. */
#define PLAIN_OBJECT(name, info_type)                                                              \
    static VKAPI_ATTR VkResult VKAPI_CALL create_##name(                                           \
        VkDevice device, const info_type *info, const VkAllocationCallbacks *cb, Vk##name *out)    \
    {                                                                                              \
        (void)info;                                                                                \
        (void)cb;                                                                                  \
        MAY_FAIL(device);                                                                          \
        *out = make(fake_of(device), 0);                                                           \
        return VK_SUCCESS;                                                                         \
    }                                                                                              \
    static VKAPI_ATTR void VKAPI_CALL destroy_##name(VkDevice device, Vk##name object,             \
                                                     const VkAllocationCallbacks *cb)              \
    {                                                                                              \
        (void)cb;                                                                                  \
        drop(fake_of(device), object);                                                             \
    }

PLAIN_OBJECT(Sampler, VkSamplerCreateInfo)
PLAIN_OBJECT(PipelineCache, VkPipelineCacheCreateInfo)
PLAIN_OBJECT(PipelineLayout, VkPipelineLayoutCreateInfo)
PLAIN_OBJECT(ShaderModule, VkShaderModuleCreateInfo)

static VKAPI_ATTR VkResult VKAPI_CALL
create_DescriptorSetLayout(VkDevice device, const VkDescriptorSetLayoutCreateInfo *info,
                           const VkAllocationCallbacks *cb, VkDescriptorSetLayout *layout)
{
    (void)cb;
    MAY_FAIL(device);
    struct fake_object *object = make(fake_of(device), 0);
    object->first_image = UINT32_MAX;
    for (uint32_t i = info->bindingCount; i-- > 0;)
        if (info->pBindings[i].descriptorType != VK_DESCRIPTOR_TYPE_STORAGE_BUFFER)
            object->first_image = info->pBindings[i].binding;
    *layout = (VkDescriptorSetLayout)object;
    return VK_SUCCESS;
}

static VKAPI_ATTR void VKAPI_CALL destroy_DescriptorSetLayout(VkDevice device,
                                                              VkDescriptorSetLayout layout,
                                                              const VkAllocationCallbacks *cb)
{
    (void)cb;
    drop(fake_of(device), layout);
}

static VKAPI_ATTR VkResult VKAPI_CALL create_DescriptorPool(VkDevice device,
                                                            const VkDescriptorPoolCreateInfo *info,
                                                            const VkAllocationCallbacks *cb,
                                                            VkDescriptorPool *pool)
{
    (void)info, (void)cb;
    MAY_FAIL(device);
    *pool = make(fake_of(device), 0);
    return VK_SUCCESS;
}

static VKAPI_ATTR void VKAPI_CALL destroy_DescriptorPool(VkDevice device, VkDescriptorPool pool,
                                                         const VkAllocationCallbacks *cb)
{
    (void)cb;
    struct fake_vulkan *fake = fake_of(device);
    for (uint32_t i = 0; i < FAKE_SETS; i++) {
        if (!pool || fake->sets[i].pool != pool)
            continue;
        fake->sets[i].pool = VK_NULL_HANDLE;
        fake->set_count--;
    }
    drop(fake, pool);
}

static VKAPI_ATTR VkResult VKAPI_CALL create_ImageView(VkDevice device,
                                                       const VkImageViewCreateInfo *info,
                                                       const VkAllocationCallbacks *cb,
                                                       VkImageView *view)
{
    (void)cb;
    MAY_FAIL(device);
    struct fake_object *object = make_shown(fake_of(device), 0);
    object->image = info->image;
    *view = (VkImageView)object;
    return VK_SUCCESS;
}

static VKAPI_ATTR void VKAPI_CALL destroy_ImageView(VkDevice device, VkImageView view,
                                                    const VkAllocationCallbacks *cb)
{
    (void)cb;
    drop(fake_of(device), view);
}

static VKAPI_ATTR void VKAPI_CALL get_features(VkPhysicalDevice device,
                                               VkPhysicalDeviceFeatures2 *features)
{
    (void)device;
    features->features =
        (VkPhysicalDeviceFeatures){.sparseBinding = VK_TRUE,
                                   .sparseResidencyImage2D = VK_TRUE,
                                   .shaderSampledImageArrayDynamicIndexing = VK_TRUE,
                                   .fragmentStoresAndAtomics = VK_TRUE};
    for (VkBaseOutStructure *next = features->pNext; next; next = next->pNext)
        if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES)
            ((VkPhysicalDeviceVulkan12Features *)next)->timelineSemaphore = VK_TRUE;
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
    (void)device;
    static const VkQueueFlags all[FAKE_FAMILIES] = {
        [0] = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT | VK_QUEUE_SPARSE_BINDING_BIT,
        [FAKE_TRANSFER_FAMILY] = VK_QUEUE_TRANSFER_BIT,
        [FAKE_SPARSE_FAMILY] = VK_QUEUE_TRANSFER_BIT | VK_QUEUE_SPARSE_BINDING_BIT,
        [FAKE_COMPUTE_FAMILY] = VK_QUEUE_COMPUTE_BIT};
    uint32_t room = families ? *count : 0;
    *count = FAKE_FAMILIES;
    for (uint32_t i = 0; i < room && i < FAKE_FAMILIES; i++)
        families[i] = (VkQueueFamilyProperties){.queueFlags = all[i], .queueCount = 1};
}

static VKAPI_ATTR void VKAPI_CALL get_format_features(VkPhysicalDevice device, VkFormat format,
                                                      VkFormatProperties *properties)
{
    (void)device, (void)format;
    *properties = (VkFormatProperties){0};
}

static VKAPI_ATTR VkResult VKAPI_CALL get_format(VkPhysicalDevice device, VkFormat format,
                                                 VkImageType type, VkImageTiling tiling,
                                                 VkImageUsageFlags usage, VkImageCreateFlags flags,
                                                 VkImageFormatProperties *properties)
{
    (void)device, (void)type, (void)tiling, (void)usage, (void)flags;
    *properties = (VkImageFormatProperties){.maxExtent = {16384, 16384, 1},
                                            .maxMipLevels = 15,
                                            .maxArrayLayers = 256,
                                            .maxResourceSize = 1ull << 40};
    return format == VK_FORMAT_R8G8B8A8_UNORM ? VK_SUCCESS : VK_ERROR_FORMAT_NOT_SUPPORTED;
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

static VKAPI_ATTR VkResult VKAPI_CALL create_image(VkDevice device, const VkImageCreateInfo *info,
                                                   const VkAllocationCallbacks *cb, VkImage *image)
{
    MAY_FAIL(device);
    (void)cb;
    struct fake_object *object = make_shown(fake_of(device), 0);
    object->extent = info->extent;
    object->level_count = info->mipLevels;
    object->layer_count = info->arrayLayers;
    *image = (VkImage)object;
    return VK_SUCCESS;
}

static VKAPI_ATTR void VKAPI_CALL destroy_image(VkDevice device, VkImage image,
                                                const VkAllocationCallbacks *cb)
{
    (void)cb;
    struct fake_vulkan *fake = fake_of(device);
    if (image && fake->destroyed_count < FAKE_EVENTS)
        fake->destroyed_images[fake->destroyed_count++] = image;
    drop(fake, image);
}

static VKAPI_ATTR void VKAPI_CALL image_requirements(VkDevice device, VkImage image,
                                                     VkMemoryRequirements *requirements)
{
    uint64_t layer_size = fake_of(device)->layer_size;
    uint64_t size = layer_size ? layer_size * OBJECT(image)->layer_count : 1u << 24;
    *requirements = (VkMemoryRequirements){.size = size, .alignment = 65536, .memoryTypeBits = 1};
}

static VKAPI_ATTR void VKAPI_CALL sparse_requirements(VkDevice device, VkImage image,
                                                      uint32_t *count,
                                                      VkSparseImageMemoryRequirements *requirements)
{
    struct fake_vulkan *fake = fake_of(device);
    const struct fake_object *object = OBJECT(image);
    uint32_t tail = 0;
    while (object->extent.width >> tail > FAKE_TILE || object->extent.height >> tail > FAKE_TILE)
        tail++;
    *count = fake->metadata_size ? 2 : 1;
    requirements[1] = (VkSparseImageMemoryRequirements){
        .formatProperties = {VK_IMAGE_ASPECT_METADATA_BIT, {0}, 0},
        .imageMipTailSize = fake->metadata_size,
        .imageMipTailOffset = 1ull << 31,
        .imageMipTailStride = FAKE_TAIL_STRIDE};
    requirements[0] = (VkSparseImageMemoryRequirements){
        .formatProperties = {VK_IMAGE_ASPECT_COLOR_BIT, {FAKE_TILE, FAKE_TILE, 1}, 0},
        .imageMipTailFirstLod = fake->tail_page_count ? tail : object->level_count,
        .imageMipTailSize = fake->tail_page_count * 65536ull,
        .imageMipTailOffset = 1ull << 30,
        .imageMipTailStride = FAKE_TAIL_STRIDE};
}

static VKAPI_ATTR VkResult VKAPI_CALL create_buffer(VkDevice device, const VkBufferCreateInfo *info,
                                                    const VkAllocationCallbacks *cb,
                                                    VkBuffer *buffer)
{
    MAY_FAIL(device);
    (void)cb;
    *buffer = make_shown(fake_of(device), info->size);
    return VK_SUCCESS;
}

static VKAPI_ATTR void VKAPI_CALL destroy_buffer(VkDevice device, VkBuffer buffer,
                                                 const VkAllocationCallbacks *cb)
{
    (void)cb;
    drop(fake_of(device), buffer);
}

static VKAPI_ATTR void VKAPI_CALL buffer_requirements(VkDevice device, VkBuffer buffer,
                                                      VkMemoryRequirements *requirements)
{
    (void)device;
    *requirements = (VkMemoryRequirements){OBJECT(buffer)->size, 16, 1};
}

static VKAPI_ATTR VkResult VKAPI_CALL allocate(VkDevice device, const VkMemoryAllocateInfo *info,
                                               const VkAllocationCallbacks *cb,
                                               VkDeviceMemory *memory)
{
    MAY_FAIL(device);
    (void)cb;
    struct fake_vulkan *fake = fake_of(device);
    if (fake->memory_limit && fake->live_memory + info->allocationSize > fake->memory_limit)
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    if (fake->refused_size == info->allocationSize)
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    struct fake_object *object = make_shown(fake, info->allocationSize);
    fake->live_memory += info->allocationSize;
    *memory = (VkDeviceMemory)object;
    return VK_SUCCESS;
}

static VKAPI_ATTR void VKAPI_CALL free_memory(VkDevice device, VkDeviceMemory memory,
                                              const VkAllocationCallbacks *cb)
{
    (void)cb;
    if (!memory)
        return;
    struct fake_vulkan *fake = fake_of(device);
    fake->live_memory -= OBJECT(memory)->size;
    if (fake->freed_count < FAKE_EVENTS)
        fake->freed_memories[fake->freed_count++] = memory;
    free(OBJECT(memory)->memory);
    drop(fake_of(device), memory);
}

static VKAPI_ATTR VkResult VKAPI_CALL bind_buffer(VkDevice device, VkBuffer buffer,
                                                  VkDeviceMemory memory, VkDeviceSize offset)
{
    MAY_FAIL(device);
    (void)device, (void)offset;
    OBJECT(buffer)->memory = memory; /* the object, whose memory comes when it is mapped */
    return VK_SUCCESS;
}

static VKAPI_ATTR VkResult VKAPI_CALL bind_image(VkDevice device, VkImage image,
                                                 VkDeviceMemory memory, VkDeviceSize offset)
{
    MAY_FAIL(device);
    (void)device, (void)image, (void)memory, (void)offset;
    return VK_SUCCESS;
}

static VKAPI_ATTR VkResult VKAPI_CALL map_memory(VkDevice device, VkDeviceMemory memory,
                                                 VkDeviceSize offset, VkDeviceSize size,
                                                 VkMemoryMapFlags flags, void **data)
{
    MAY_FAIL(device);
    (void)device, (void)offset, (void)size, (void)flags;
    OBJECT(memory)->memory = calloc(1, OBJECT(memory)->size);
    *data = OBJECT(memory)->memory;
    return *data ? VK_SUCCESS : VK_ERROR_MEMORY_MAP_FAILED;
}

static VKAPI_ATTR VkResult VKAPI_CALL create_semaphore(VkDevice device,
                                                       const VkSemaphoreCreateInfo *info,
                                                       const VkAllocationCallbacks *cb,
                                                       VkSemaphore *semaphore)
{
    MAY_FAIL(device);
    (void)info, (void)cb;
    *semaphore = make_shown(fake_of(device), 0);
    return VK_SUCCESS;
}

static VKAPI_ATTR void VKAPI_CALL destroy_semaphore(VkDevice device, VkSemaphore semaphore,
                                                    const VkAllocationCallbacks *cb)
{
    (void)cb;
    drop(fake_of(device), semaphore);
}

static uint64_t value_of(const struct fake_vulkan *fake, VkSemaphore semaphore)
{
    /* until the first bind tells which one is its, both stand at 0 */
    bool binds = fake->submitted_bind_value == 0 || semaphore == fake->bind_semaphore;
    return semaphore == fake->frame_semaphore ? fake->frame_value : binds ? fake->bind_value : 0;
}

static VKAPI_ATTR VkResult VKAPI_CALL counter_value(VkDevice device, VkSemaphore semaphore,
                                                    uint64_t *value)
{
    MAY_FAIL(device);
    *value = value_of(fake_of(device), semaphore);
    return VK_SUCCESS;
}

/* Both timelines stand still unless the test moves them. */
static VKAPI_ATTR VkResult VKAPI_CALL wait_semaphores(VkDevice device,
                                                      const VkSemaphoreWaitInfo *info,
                                                      uint64_t timeout)
{
    MAY_FAIL(device);
    struct fake_vulkan *fake = fake_of(device);
    struct fake_wait wait = {info->pSemaphores[0], info->pValues[0], timeout, fake->live_objects};
    fake->waits[fake->wait_count++ % 64] = wait;
    bool waits = fake->waits_time_out && value_of(fake, wait.semaphore) < wait.value;
    return waits ? VK_TIMEOUT : VK_SUCCESS;
}

static void note_bind(struct fake_vulkan *fake, const struct fake_bind *bind)
{
    assert_true(fake->bind_count < FAKE_EVENTS);
    fake->binds[fake->bind_count++] = *bind;
}

static void note_tiles(struct fake_vulkan *fake, VkImage image, const VkSparseImageMemoryBind *b)
{
    const struct fake_object *object = OBJECT(image);
    uint32_t level = b->subresource.mipLevel;
    uint32_t width = object->extent.width >> level ? object->extent.width >> level : 1;
    uint32_t height = object->extent.height >> level ? object->extent.height >> level : 1;
    uint32_t x = (uint32_t)b->offset.x, y = (uint32_t)b->offset.y;
    /* whole tiles, or up to the edge; one row */
    assert_true(x % FAKE_TILE == 0 && y % FAKE_TILE == 0);
    assert_true(b->extent.width % FAKE_TILE == 0 || x + b->extent.width == width);
    assert_true(b->extent.height == FAKE_TILE || y + b->extent.height == height);
    for (uint32_t i = 0; i * FAKE_TILE < b->extent.width; i++)
        note_bind(fake, &(struct fake_bind){image, level, x / FAKE_TILE + i, y / FAKE_TILE,
                                            b->memory, b->memoryOffset + i * 65536ull});
}

static VKAPI_ATTR VkResult VKAPI_CALL bind_sparse(VkQueue queue, uint32_t count,
                                                  const VkBindSparseInfo *info, VkFence fence)
{
    MAY_FAIL(queue);
    (void)fence;
    struct fake_vulkan *fake = fake_of(queue);
    assert_int_equal(count, 1);
    for (uint32_t i = 0; i < info->imageBindCount; i++)
        for (uint32_t j = 0; j < info->pImageBinds[i].bindCount; j++)
            note_tiles(fake, info->pImageBinds[i].image, &info->pImageBinds[i].pBinds[j]);
    for (uint32_t i = 0; i < info->imageOpaqueBindCount; i++)
        for (uint32_t j = 0; j < info->pImageOpaqueBinds[i].bindCount; j++) {
            const VkSparseMemoryBind *b = &info->pImageOpaqueBinds[i].pBinds[j];
            if (b->flags & VK_SPARSE_MEMORY_BIND_METADATA_BIT) {
                assert_int_equal(b->resourceOffset % FAKE_TAIL_STRIDE, 0);
                assert_true(b->resourceOffset >= 1ull << 31);
                assert_int_equal((b->resourceOffset - (1ull << 31)) / FAKE_TAIL_STRIDE,
                                 b->memoryOffset / fake->metadata_size); /* the layer */
                assert_int_equal(b->size, fake->metadata_size);
                assert_true(b->memory != VK_NULL_HANDLE);
                fake->metadata_binds++;
                continue;
            }
            assert_int_equal(b->size, 65536);
            uint32_t page = (uint32_t)((b->resourceOffset - (1ull << 30)) / 65536);
            note_bind(fake, &(struct fake_bind){info->pImageOpaqueBinds[i].image, FAKE_TAIL, page,
                                                0, b->memory, b->memoryOffset});
        }
    const VkTimelineSemaphoreSubmitInfo *timeline = info->pNext;
    assert_int_equal(timeline->pSignalSemaphoreValues[0], fake->submitted_bind_value + 1);
    /* batches have no order but for this */
    assert_int_equal(timeline->pWaitSemaphoreValues[0], fake->submitted_bind_value);
    fake->bind_semaphore = info->pSignalSemaphores[0];
    fake->submitted_bind_value++;
    fake->bind_calls++;
    return VK_SUCCESS;
}

static VKAPI_ATTR void VKAPI_CALL copy_to_image(VkCommandBuffer commands, VkBuffer buffer,
                                                VkImage image, VkImageLayout layout, uint32_t count,
                                                const VkBufferImageCopy *regions)
{
    struct fake_vulkan *fake = fake_of(commands);
    assert_false(fake->published);
    assert_true(layout == VK_IMAGE_LAYOUT_GENERAL && OBJECT(image)->general);
    for (uint32_t i = 0; i < count; i++) {
        assert_true(fake->copy_count < FAKE_EVENTS);
        struct fake_copy *copy = &fake->copies[fake->copy_count++];
        *copy = (struct fake_copy){image,
                                   regions[i].imageSubresource.mipLevel,
                                   regions[i].imageSubresource.baseArrayLayer,
                                   (uint32_t)regions[i].imageOffset.x / FAKE_TILE,
                                   (uint32_t)regions[i].imageOffset.y / FAKE_TILE,
                                   0};
        const uint8_t *texels = OBJECT(OBJECT(buffer)->memory)->memory;
        memcpy(&copy->texel, texels + regions[i].bufferOffset, sizeof copy->texel);
    }
}

static VKAPI_ATTR void VKAPI_CALL copy_image(VkCommandBuffer commands, VkImage from,
                                             VkImageLayout from_layout, VkImage to,
                                             VkImageLayout to_layout, uint32_t count,
                                             const VkImageCopy *regions)
{
    struct fake_vulkan *fake = fake_of(commands);
    assert_false(fake->published);
    assert_true(from_layout == VK_IMAGE_LAYOUT_GENERAL && OBJECT(from)->general);
    assert_true(to_layout == VK_IMAGE_LAYOUT_GENERAL && OBJECT(to)->general);
    for (uint32_t i = 0; i < count; i++) {
        assert_true(fake->copy_count < FAKE_EVENTS);
        fake->copies[fake->copy_count++] =
            (struct fake_copy){.image = to,
                               .level = regions[i].dstSubresource.mipLevel,
                               .layer = regions[i].dstSubresource.baseArrayLayer,
                               .from = from,
                               .from_layer = regions[i].srcSubresource.baseArrayLayer};
    }
}

static void update_set(const VkWriteDescriptorSet *write)
{
    struct fake_set *set = (struct fake_set *)write->dstSet;
    set->write_count++;
    for (uint32_t i = 0; i < write->descriptorCount; i++) {
        if (write->descriptorType == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER)
            set->buffers[write->dstBinding + i] = write->pBufferInfo[i].buffer;
        else if (write->dstArrayElement + i < FAKE_SET_IMAGES)
            set->images[write->dstBinding - set->first_image][write->dstArrayElement + i] =
                write->pImageInfo[i];
    }
}

static VKAPI_ATTR void VKAPI_CALL update_sets(VkDevice device, uint32_t write_count,
                                              const VkWriteDescriptorSet *writes,
                                              uint32_t copy_count,
                                              const VkCopyDescriptorSet *copies)
{
    (void)copy_count, (void)copies;
    if ((void *)writes[0].dstSet != fake_of(device)) {
        for (uint32_t i = 0; i < write_count; i++)
            update_set(&writes[i]);
        return;
    }
    if (fake_of(device)->no_resolve)
        return;
    fake_of(device)->table = OBJECT(writes[0].pBufferInfo[2].buffer);
    fake_of(device)->readback = OBJECT(writes[0].pBufferInfo[4].buffer);
}

static VKAPI_ATTR VkResult VKAPI_CALL allocate_sets(VkDevice device,
                                                    const VkDescriptorSetAllocateInfo *info,
                                                    VkDescriptorSet *sets)
{
    MAY_FAIL(device);
    struct fake_vulkan *fake = fake_of(device);
    sets[0] = (VkDescriptorSet)fake; /* of passes: never looked at */
    if (OBJECT(info->pSetLayouts[0])->first_image == UINT32_MAX)
        return VK_SUCCESS;
    assert_in_range(fake->set_count, 0, FAKE_SETS - 1);
    struct fake_set *set = fake->sets;
    while (set->pool)
        set++;
    *set = (struct fake_set){.pool = info->descriptorPool,
                             .first_image = OBJECT(info->pSetLayouts[0])->first_image};
    fake->set_count++;
    sets[0] = (VkDescriptorSet)set;
    return VK_SUCCESS;
}

static VKAPI_ATTR VkResult VKAPI_CALL create_pipelines(VkDevice device, VkPipelineCache cache,
                                                       uint32_t count,
                                                       const VkComputePipelineCreateInfo *infos,
                                                       const VkAllocationCallbacks *cb,
                                                       VkPipeline *pipelines)
{
    MAY_FAIL(device);
    (void)cache, (void)infos, (void)cb, (void)count;
    assert_true(cache != VK_NULL_HANDLE);
    pipelines[0] = make_shown(fake_of(device), 0);
    return VK_SUCCESS;
}

static VKAPI_ATTR void VKAPI_CALL destroy_pipeline(VkDevice device, VkPipeline pipeline,
                                                   const VkAllocationCallbacks *cb)
{
    (void)cb;
    drop(fake_of(device), pipeline);
}

static VKAPI_ATTR void VKAPI_CALL push_constants(VkCommandBuffer commands, VkPipelineLayout layout,
                                                 VkShaderStageFlags stages, uint32_t offset,
                                                 uint32_t size, const void *values)
{
    (void)layout, (void)stages, (void)offset;
    if (fake_of(commands)->no_resolve)
        return;
    assert_int_equal(size, sizeof fake_of(commands)->push);
    memcpy(&fake_of(commands)->push, values, size);
}

/* Buffers that are mapped, and only those, have memory. */
static void *words_of(const struct fake_object *buffer)
{
    return OBJECT(buffer->memory)->memory;
}

static void resolve_item(struct fake_vulkan *fake, uint32_t index, uint32_t *at)
{
    const struct SluiceResolveSegment *segments = words_of(fake->table);
    const struct SluiceResolveItem *item =
        (const struct SluiceResolveItem *)words_of(fake->table) + fake->push.firstItem + index;
    uint32_t first = segments[fake->push.firstSegment + item->firstSegment].firstRegion;
    uint32_t *words = words_of(fake->readback);
    struct SluiceResolveResult result = {SLUICE_RESOLVED_MAP, (item->regionCount + 3) / 4, *at, 0};
    if (result.count > fake->push.capacity - *at)
        result = (struct SluiceResolveResult){SLUICE_RESOLVED_NOTHING, 0, 0, 0};
    *at += result.count;
    uint8_t *levels = (uint8_t *)&words[fake->push.dataOffset + result.offset];
    for (uint32_t i = 0; i < item->regionCount && result.count; i++) {
        levels[i] = fake->want(fake->user, first + i);
        result.checksum += slc_resolve_weight(i) * (SLUICE_MIP_UNTOUCHED - (uint32_t)levels[i]);
    }
    if (fake->damage_count && fake->damage_count--)
        result.checksum ^= 1;
    fake->whole_count += (item->flags & SLUICE_RESOLVE_WHOLE) != 0;
    memcpy(&words[fake->push.resultOffset + 4 * index], &result, sizeof result);
}

/* The resolve passes, with the feedback that the test wants: whole maps, which are always allowed.
 */
static VKAPI_ATTR void VKAPI_CALL dispatch(VkCommandBuffer commands, uint32_t x, uint32_t y,
                                           uint32_t z)
{
    (void)x, (void)y, (void)z;
    struct fake_vulkan *fake = fake_of(commands);
    if (fake->no_resolve || ++fake->dispatch_count % 3 != 0)
        return;
    for (uint32_t i = 0, at = 0; i < fake->push.itemCount; i++)
        resolve_item(fake, i, &at);
}

/* The resolve passes have none. */
static VKAPI_ATTR VkResult VKAPI_CALL wait_idle(VkDevice device)
{
    struct fake_vulkan *fake = fake_of(device);
    fake->device_waits++;
    bool is_lost = fake->fails_on && fake->failing_call && fake->calls >= fake->failing_call;
    return is_lost ? fake->failure : VK_SUCCESS;
}

/* The MinMip maps: they may only show what was copied before. */
static VKAPI_ATTR void VKAPI_CALL copy_buffer(VkCommandBuffer commands, VkBuffer from, VkBuffer to,
                                              uint32_t count, const VkBufferCopy *regions)
{
    (void)from, (void)to, (void)count, (void)regions;
    fake_of(commands)->published = true;
    fake_of(commands)->copy_calls++;
}

/* The rest leaves no trace here. */
static VKAPI_ATTR void VKAPI_CALL bind_sets(VkCommandBuffer commands, VkPipelineBindPoint point,
                                            VkPipelineLayout layout, uint32_t first, uint32_t count,
                                            const VkDescriptorSet *sets, uint32_t offset_count,
                                            const uint32_t *offsets)
{
    (void)commands, (void)point, (void)layout, (void)first, (void)count, (void)sets;
    (void)offset_count, (void)offsets;
}

static VKAPI_ATTR void VKAPI_CALL bind_pipeline(VkCommandBuffer commands, VkPipelineBindPoint point,
                                                VkPipeline pipeline)
{
    (void)commands, (void)point, (void)pipeline;
}

/* What is written there comes before the MinMip maps. */
static struct fake_watch *find_watch(struct fake_vulkan *fake, VkBuffer buffer)
{
    for (int i = 0; i < 2; i++)
        if (fake->watches[i].buffer == buffer) {
            assert_false(fake->published);
            return &fake->watches[i];
        }
    return NULL;
}

static VKAPI_ATTR void VKAPI_CALL fill_buffer(VkCommandBuffer commands, VkBuffer buffer,
                                              VkDeviceSize offset, VkDeviceSize size, uint32_t data)
{
    struct fake_watch *watch = find_watch(fake_of(commands), buffer);
    if (size == VK_WHOLE_SIZE)
        size = OBJECT(buffer)->size - offset;
    for (VkDeviceSize i = offset / 4; watch && i < (offset + size) / 4 && i < FAKE_WORDS; i++)
        watch->words[i] = data;
}

static VKAPI_ATTR void VKAPI_CALL update_buffer(VkCommandBuffer commands, VkBuffer buffer,
                                                VkDeviceSize offset, VkDeviceSize size,
                                                const void *data)
{
    struct fake_watch *watch = find_watch(fake_of(commands), buffer);
    if (!watch)
        return;
    assert_true(offset + size <= sizeof watch->words);
    memcpy((uint8_t *)watch->words + offset, data, size);
}

static VKAPI_ATTR void VKAPI_CALL barrier(VkCommandBuffer commands, VkPipelineStageFlags from,
                                          VkPipelineStageFlags to, VkDependencyFlags flags,
                                          uint32_t memory_count, const VkMemoryBarrier *memory,
                                          uint32_t buffer_count,
                                          const VkBufferMemoryBarrier *buffers,
                                          uint32_t image_count, const VkImageMemoryBarrier *images)
{
    (void)from, (void)to, (void)flags, (void)memory_count, (void)memory;
    (void)buffer_count, (void)buffers;
    struct fake_vulkan *fake = fake_of(commands);
    for (uint32_t i = 0; i < image_count; i++) {
        struct fake_object *image = OBJECT(images[i].image);
        assert_true(images[i].newLayout == VK_IMAGE_LAYOUT_GENERAL);
        if (!image->general && fake->general_count < FAKE_EVENTS)
            fake->general[fake->general_count++] = image;
        image->general = true;
    }
}

void fake_vulkan_mark(struct fake_vulkan *fake)
{
    fake->general_count = 0;
    for (int i = 0; i < 2; i++)
        memcpy(fake->watches[i].marked, fake->watches[i].words, sizeof fake->watches[i].words);
}

void fake_vulkan_undo(struct fake_vulkan *fake)
{
    while (fake->general_count)
        fake->general[--fake->general_count]->general = false;
    for (int i = 0; i < 2; i++)
        memcpy(fake->watches[i].words, fake->watches[i].marked, sizeof fake->watches[i].words);
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device_function(VkDevice device,
                                                                    const char *name);

#define ENTRY(name, function)                                                                      \
    {                                                                                              \
        "vk" #name, (PFN_vkVoidFunction)function                                                   \
    }
static const struct {
    const char *name;
    PFN_vkVoidFunction function;
} functions[] = {
    ENTRY(GetDeviceProcAddr, get_device_function),
    ENTRY(GetPhysicalDeviceFeatures2, get_features),
    ENTRY(GetPhysicalDeviceFormatProperties, get_format_features),
    ENTRY(GetPhysicalDeviceImageFormatProperties, get_format),
    ENTRY(GetPhysicalDeviceMemoryProperties, get_memory),
    ENTRY(GetPhysicalDeviceMemoryProperties2, get_memory2),
    ENTRY(EnumerateDeviceExtensionProperties, list_extensions),
    ENTRY(GetPhysicalDeviceProperties2, get_properties),
    ENTRY(GetPhysicalDeviceQueueFamilyProperties, get_families),
    ENTRY(GetPhysicalDeviceSparseImageFormatProperties, get_sparse_format),
    ENTRY(AllocateDescriptorSets, allocate_sets),
    ENTRY(AllocateMemory, allocate),
    ENTRY(BindBufferMemory, bind_buffer),
    ENTRY(BindImageMemory, bind_image),
    ENTRY(CmdBindDescriptorSets, bind_sets),
    ENTRY(CmdBindPipeline, bind_pipeline),
    ENTRY(CmdCopyBuffer, copy_buffer),
    ENTRY(CmdFillBuffer, fill_buffer),
    ENTRY(CmdPipelineBarrier, barrier),
    ENTRY(CmdUpdateBuffer, update_buffer),
    ENTRY(CmdCopyBufferToImage, copy_to_image),
    ENTRY(CmdCopyImage, copy_image),
    ENTRY(CmdDispatch, dispatch),
    ENTRY(CmdPushConstants, push_constants),
    ENTRY(CreateBuffer, create_buffer),
    ENTRY(CreateComputePipelines, create_pipelines),
    ENTRY(CreateDescriptorPool, create_DescriptorPool),
    ENTRY(CreateDescriptorSetLayout, create_DescriptorSetLayout),
    ENTRY(CreateImage, create_image),
    ENTRY(CreateImageView, create_ImageView),
    ENTRY(CreatePipelineCache, create_PipelineCache),
    ENTRY(CreatePipelineLayout, create_PipelineLayout),
    ENTRY(CreateSampler, create_Sampler),
    ENTRY(CreateSemaphore, create_semaphore),
    ENTRY(CreateShaderModule, create_ShaderModule),
    ENTRY(DestroyBuffer, destroy_buffer),
    ENTRY(DestroyDescriptorPool, destroy_DescriptorPool),
    ENTRY(DestroyDescriptorSetLayout, destroy_DescriptorSetLayout),
    ENTRY(DestroyImage, destroy_image),
    ENTRY(DestroyImageView, destroy_ImageView),
    ENTRY(DestroyPipeline, destroy_pipeline),
    ENTRY(DestroyPipelineCache, destroy_PipelineCache),
    ENTRY(DestroyPipelineLayout, destroy_PipelineLayout),
    ENTRY(DestroySampler, destroy_Sampler),
    ENTRY(DestroySemaphore, destroy_semaphore),
    ENTRY(DestroyShaderModule, destroy_ShaderModule),
    ENTRY(DeviceWaitIdle, wait_idle),
    ENTRY(FreeMemory, free_memory),
    ENTRY(GetBufferMemoryRequirements, buffer_requirements),
    ENTRY(GetImageMemoryRequirements, image_requirements),
    ENTRY(GetImageSparseMemoryRequirements, sparse_requirements),
    ENTRY(GetSemaphoreCounterValue, counter_value),
    ENTRY(MapMemory, map_memory),
    ENTRY(QueueBindSparse, bind_sparse),
    ENTRY(SetDebugUtilsObjectNameEXT, set_name),
    ENTRY(UpdateDescriptorSets, update_sets),
    ENTRY(WaitSemaphores, wait_semaphores),
};

static PFN_vkVoidFunction find(const char *name)
{
    for (size_t i = 0; i < sizeof functions / sizeof functions[0]; i++)
        if (strcmp(functions[i].name, name) == 0)
            return functions[i].function;
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

VkImage fake_vulkan_image_of(VkImageView view)
{
    return OBJECT(view)->image;
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
        .minStagingSize = fake->minStagingSize};
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

VkCommandBuffer fake_vulkan_commands(struct fake_vulkan *fake)
{
    return (VkCommandBuffer)(void *)fake;
}
