#include "vulkan/memory.h"

#include "base/log.h"
#include "vulkan/memory_budget.h"

#include <assert.h>

static VkResult allocate_by_vulkan(const struct slc_vk *vk,
                                   const struct slc_memory_request *request,
                                   struct slc_memory *memory)
{
    const VkMemoryAllocateFlagsInfo flags = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO,
                                             .flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT};
    const VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                       .pNext = request->device_address ? &flags : NULL,
                                       .allocationSize = request->size,
                                       .memoryTypeIndex = request->type};
    VkResult result = vk->AllocateMemory(vk->device, &info, NULL, &memory->memory);
    if (result != VK_SUCCESS) {
        memory->memory = VK_NULL_HANDLE;
        return result;
    }
    if (request->mapped)
        result = vk->MapMemory(vk->device, memory->memory, 0, VK_WHOLE_SIZE, 0, &memory->mapped);
    if (result != VK_SUCCESS)
        vk->FreeMemory(vk->device, memory->memory, NULL);
    else
        slc_vk_name(vk, VK_OBJECT_TYPE_DEVICE_MEMORY, (uint64_t)memory->memory, request->name);
    return result;
}

/* Checks the memory that a callback returned. Returns NULL, or the error. */
static const char *check_answer(const struct slc_memory_request *request,
                                const SluiceDeviceMemory *answer)
{
    if (!answer->memory)
        return "memory is NULL";
    if (answer->offset % request->alignment)
        return "offset is not a multiple of alignment";
    if (request->mapped && !answer->pMapped)
        return "pMapped is NULL for mapped memory";
    return NULL;
}

static VkResult allocate_by_callback(const struct slc_vk *vk,
                                     const struct slc_memory_request *request,
                                     struct slc_memory *memory)
{
    const SluiceDeviceMemoryCallbacks *callbacks = vk->memory_callbacks;
    const SluiceDeviceMemoryRequest asked = {.structSize = sizeof asked,
                                             .purpose = request->purpose,
                                             .size = request->size,
                                             .alignment = request->alignment,
                                             .memoryTypeIndex = request->type,
                                             .mapped = request->mapped,
                                             .images = request->images,
                                             .deviceAddress = request->device_address,
                                             .pName = request->name};
    SluiceDeviceMemory answer = {0};
    VkResult result = callbacks->pfnAllocate(callbacks->pUserData, &asked, &answer);
    if (result != VK_SUCCESS) /* positive results are failures, too */
        return result < 0 ? result : VK_ERROR_UNKNOWN;
    const char *trouble = check_answer(request, &answer);
    if (trouble) {
        slc_log(&vk->log, SLUICE_LOG_ERROR,
                "pfnAllocate of pDeviceMemory, for %llu bytes at an alignment of %llu: %s",
                (unsigned long long)request->size, (unsigned long long)request->alignment, trouble);
        callbacks->pfnFree(callbacks->pUserData, &answer);
        return VK_ERROR_UNKNOWN;
    }
    memory->memory = answer.memory;
    memory->offset = answer.offset;
    memory->mapped = request->mapped ? answer.pMapped : NULL;
    memory->allocation = answer.pAllocation;
    return VK_SUCCESS;
}

VkResult slc_memory_allocate(const struct slc_vk *vk, const struct slc_memory_request *request,
                             struct slc_memory *memory)
{
    assert(request->alignment > 0 && (request->alignment & (request->alignment - 1)) == 0);
    struct slc_memory_client *client = vk->memory_client;
    struct slc_memory made = {.size = request->size, .purpose = request->purpose};
    *memory = (struct slc_memory){0};
    if (client &&
        !slc_memory_client_take(client, request->purpose, request->mapped, request->size)) {
        memory->is_beyond_budget = true;
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    }
    VkResult result = vk->memory_callbacks ? allocate_by_callback(vk, request, &made)
                                           : allocate_by_vulkan(vk, request, &made);
    if (result == VK_SUCCESS)
        *memory = made;
    else if (client)
        slc_memory_client_refuse(client, request->purpose, request->mapped, request->size);
    return result;
}

void slc_memory_free(const struct slc_vk *vk, struct slc_memory *memory)
{
    if (!memory->memory)
        return;
    if (vk->memory_callbacks) {
        const SluiceDeviceMemory block = {.memory = memory->memory,
                                          .offset = memory->offset,
                                          .pMapped = memory->mapped,
                                          .pAllocation = memory->allocation};
        vk->memory_callbacks->pfnFree(vk->memory_callbacks->pUserData, &block);
    } else {
        vk->FreeMemory(vk->device, memory->memory, NULL);
    }
    if (vk->memory_client)
        slc_memory_client_give(vk->memory_client, memory->purpose, memory->mapped != NULL,
                               memory->size);
    *memory = (struct slc_memory){0};
}

void slc_memory_move(const struct slc_vk *from, const struct slc_vk *to,
                     const struct slc_memory *memory)
{
    if (from->memory_client && to->memory_client)
        slc_memory_client_move(from->memory_client, to->memory_client, memory->purpose,
                               memory->mapped != NULL, memory->size);
}
