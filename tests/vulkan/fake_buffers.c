#include "support/test.h"
#include "vulkan/fake_functions.h"
#include "vulkan/fake_objects.h"

#include <stdlib.h>

static VKAPI_ATTR VkResult VKAPI_CALL create_buffer(VkDevice device, const VkBufferCreateInfo *info,
                                                    const VkAllocationCallbacks *cb,
                                                    VkBuffer *buffer)
{
    FAKE_MAY_FAIL(device);
    (void)cb;
    struct fake_object *object = fake_make_shown(fake_of(device), info->size);
    object->usage = info->usage;
    FAKE_SHARE(object, info);
    *buffer = (VkBuffer)object;
    return VK_SUCCESS;
}

/* Buffer and memory must have been made for it. */
static VKAPI_ATTR VkDeviceAddress VKAPI_CALL buffer_address(VkDevice device,
                                                            const VkBufferDeviceAddressInfo *info)
{
    (void)device;
    const struct fake_object *buffer = FAKE_OBJECT(info->buffer);
    assert_true(buffer->usage & VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT);
    assert_true(FAKE_OBJECT(buffer->memory)->flags & VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT);
    return (VkDeviceAddress)(uintptr_t)buffer;
}

static VKAPI_ATTR void VKAPI_CALL destroy_buffer(VkDevice device, VkBuffer buffer,
                                                 const VkAllocationCallbacks *cb)
{
    (void)cb;
    fake_drop(fake_of(device), buffer);
}

static VKAPI_ATTR void VKAPI_CALL buffer_requirements(VkDevice device, VkBuffer buffer,
                                                      VkMemoryRequirements *requirements)
{
    (void)device;
    *requirements = (VkMemoryRequirements){FAKE_OBJECT(buffer)->size, 16, 1};
}

static VKAPI_ATTR VkResult VKAPI_CALL allocate(VkDevice device, const VkMemoryAllocateInfo *info,
                                               const VkAllocationCallbacks *cb,
                                               VkDeviceMemory *memory)
{
    FAKE_MAY_FAIL(device);
    (void)cb;
    struct fake_vulkan *fake = fake_of(device);
    if (fake->memory_limit && fake->live_memory + info->allocationSize > fake->memory_limit)
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    if (fake->refused_size == info->allocationSize)
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    struct fake_object *object = fake_make_shown(fake, info->allocationSize);
    const VkMemoryAllocateFlagsInfo *flags = info->pNext;
    object->flags = flags ? flags->flags : 0;
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
    fake->live_memory -= FAKE_OBJECT(memory)->size;
    if (fake->freed_count < FAKE_EVENTS)
        fake->freed_memories[fake->freed_count++] = memory;
    free(FAKE_OBJECT(memory)->memory);
    fake_drop(fake_of(device), memory);
}

static VKAPI_ATTR VkResult VKAPI_CALL bind_buffer(VkDevice device, VkBuffer buffer,
                                                  VkDeviceMemory memory, VkDeviceSize offset)
{
    FAKE_MAY_FAIL(device);
    (void)device, (void)offset;
    FAKE_OBJECT(buffer)->memory = memory; /* the object, whose memory comes when it is mapped */
    return VK_SUCCESS;
}

static VKAPI_ATTR VkResult VKAPI_CALL bind_image(VkDevice device, VkImage image,
                                                 VkDeviceMemory memory, VkDeviceSize offset)
{
    FAKE_MAY_FAIL(device);
    (void)device, (void)image, (void)memory, (void)offset;
    return VK_SUCCESS;
}

static VKAPI_ATTR VkResult VKAPI_CALL map_memory(VkDevice device, VkDeviceMemory memory,
                                                 VkDeviceSize offset, VkDeviceSize size,
                                                 VkMemoryMapFlags flags, void **data)
{
    FAKE_MAY_FAIL(device);
    (void)device, (void)offset, (void)size, (void)flags;
    FAKE_OBJECT(memory)->memory = calloc(1, FAKE_OBJECT(memory)->size);
    *data = FAKE_OBJECT(memory)->memory;
    return *data ? VK_SUCCESS : VK_ERROR_MEMORY_MAP_FAILED;
}

const struct fake_function fake_buffer_functions[] = {
    FAKE_FUNCTION(AllocateMemory, allocate),
    FAKE_FUNCTION(BindBufferMemory, bind_buffer),
    FAKE_FUNCTION(BindImageMemory, bind_image),
    FAKE_FUNCTION(CreateBuffer, create_buffer),
    FAKE_FUNCTION(DestroyBuffer, destroy_buffer),
    FAKE_FUNCTION(FreeMemory, free_memory),
    FAKE_FUNCTION(GetBufferDeviceAddress, buffer_address),
    FAKE_FUNCTION(GetBufferMemoryRequirements, buffer_requirements),
    FAKE_FUNCTION(MapMemory, map_memory),
    {NULL, NULL},
};
