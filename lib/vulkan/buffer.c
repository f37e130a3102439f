#include "vulkan/buffer.h"

static uint32_t find_type(const struct slc_caps *caps, uint32_t type_bits,
                          enum slc_buffer_kind kind)
{
    /* Coherent for all, so that nothing needs to be flushed or invalidated. */
    const VkMemoryPropertyFlags host =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    switch (kind) {
    case SLC_BUFFER_DEVICE:
        return slc_find_memory_type(&caps->memory, type_bits, 0,
                                    VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    case SLC_BUFFER_UPLOAD: return slc_find_memory_type(&caps->memory, type_bits, host, 0);
    case SLC_BUFFER_TABLE:
        return slc_find_memory_type(&caps->memory, type_bits, host,
                                    VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    case SLC_BUFFER_READBACK:
        return slc_find_memory_type(&caps->memory, type_bits, host,
                                    VK_MEMORY_PROPERTY_HOST_CACHED_BIT);
    }
    return UINT32_MAX;
}

static SluiceDeviceMemoryPurpose purpose_of(enum slc_buffer_kind kind)
{
    switch (kind) {
    case SLC_BUFFER_UPLOAD: return SLUICE_DEVICE_MEMORY_PURPOSE_STAGING;
    case SLC_BUFFER_READBACK: return SLUICE_DEVICE_MEMORY_PURPOSE_READBACK;
    default: return SLUICE_DEVICE_MEMORY_PURPOSE_TABLE;
    }
}

static const char *name_of(enum slc_buffer_kind kind)
{
    switch (kind) {
    case SLC_BUFFER_UPLOAD: return "staging";
    case SLC_BUFFER_READBACK: return "readback";
    default: return "table";
    }
}

SluiceResult slc_buffer_init(struct slc_buffer *buffer, const struct slc_vk *vk,
                             const struct slc_caps *caps, uint64_t size, VkBufferUsageFlags usage,
                             enum slc_buffer_kind kind)
{
    *buffer = (struct slc_buffer){.size = size};
    VkBufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                               .size = size,
                               .usage = usage,
                               .sharingMode = VK_SHARING_MODE_EXCLUSIVE};
    SluiceResult result = slc_vk_result(
        vk, vk->CreateBuffer(vk->device, &info, NULL, &buffer->buffer), "vkCreateBuffer");
    if (result != SLUICE_SUCCESS)
        return result;
    VkMemoryRequirements memory;
    vk->GetBufferMemoryRequirements(vk->device, buffer->buffer, &memory);
    uint32_t type = find_type(caps, memory.memoryTypeBits, kind);
    const struct slc_memory_request request = {.size = memory.size,
                                               .alignment = memory.alignment,
                                               .type = type,
                                               .purpose = purpose_of(kind),
                                               .mapped = kind != SLC_BUFFER_DEVICE,
                                               .name = name_of(kind)};
    VkResult status = VK_ERROR_OUT_OF_DEVICE_MEMORY;
    if (type != UINT32_MAX)
        status = slc_memory_allocate(vk, &request, &buffer->memory);
    buffer->mapped = buffer->memory.mapped;
    if (status == VK_SUCCESS)
        status = vk->BindBufferMemory(vk->device, buffer->buffer, buffer->memory.memory,
                                      buffer->memory.offset);
    result = slc_vk_result(vk, status, "memory of a buffer");
    if (result != SLUICE_SUCCESS)
        slc_buffer_finish(buffer, vk);
    else
        slc_buffer_set_name(buffer, vk, name_of(kind));
    return result;
}

void slc_buffer_set_name(const struct slc_buffer *buffer, const struct slc_vk *vk, const char *name)
{
    slc_vk_name(vk, VK_OBJECT_TYPE_BUFFER, (uint64_t)buffer->buffer, name);
}

void slc_buffer_finish(struct slc_buffer *buffer, const struct slc_vk *vk)
{
    if (!buffer->buffer)
        return; /* also where nothing was loaded yet */
    vk->DestroyBuffer(vk->device, buffer->buffer, NULL);
    slc_memory_free(vk, &buffer->memory);
    *buffer = (struct slc_buffer){0};
}
