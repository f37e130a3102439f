#include "device/demand_rig.h"

#include "support/roll.h"
#include "support/test.h"
#include "vulkan/compute.h"

#include <stdlib.h>

void demand_rig_init(struct harness *h, struct slc_vk *vk, struct slc_caps *caps)
{
    CHECK_OK(slc_vk_init_instance(vk, h->instance, h->physical_device, h->get, NULL));
    CHECK_OK(slc_vk_init_device(vk, h->device));
    slc_caps_init(caps, vk);
}

static PFN_vkAllocateMemory allocate_memory; /* vkAllocateMemory has no user data */
static uint32_t allocations_left = UINT32_MAX;

static VKAPI_ATTR VkResult VKAPI_CALL allocate_or_not(VkDevice device,
                                                      const VkMemoryAllocateInfo *info,
                                                      const VkAllocationCallbacks *cb,
                                                      VkDeviceMemory *memory)
{
    if (allocations_left == 0)
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    if (allocations_left != UINT32_MAX)
        allocations_left--;
    return allocate_memory(device, info, cb, memory);
}

void demand_rig_limit_memory(struct slc_vk *vk, uint32_t count)
{
    if (vk->AllocateMemory != allocate_or_not)
        allocate_memory = vk->AllocateMemory;
    vk->AllocateMemory = allocate_or_not;
    allocations_left = count;
}

void *demand_rig_allocate(size_t count, size_t size)
{
    void *memory = calloc(count ? count : 1, size);
    assert_non_null(memory);
    return memory;
}

uint32_t demand_rig_random(uint32_t limit)
{
    return ((uint32_t)(roll() & 0x7FFF) << 15 | (uint32_t)(roll() & 0x7FFF)) % limit;
}

void demand_rig_record_upload(const struct slc_vk *vk, VkCommandBuffer commands,
                              const struct harness_buffer *from, const struct slc_buffer *to)
{
    const VkBufferCopy all = {0, 0, to->size};
    slc_compute_barrier(vk, commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                        VK_ACCESS_MEMORY_WRITE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT,
                        VK_ACCESS_TRANSFER_WRITE_BIT);
    vk->CmdCopyBuffer(commands, from->buffer, to->buffer, 1, &all);
    slc_compute_barrier(vk, commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                        VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                        VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT);
}

void demand_rig_record_download(const struct slc_vk *vk, VkCommandBuffer commands,
                                const struct slc_buffer *from, const struct harness_buffer *to)
{
    const VkBufferCopy all = {0, 0, from->size};
    vk->CmdCopyBuffer(commands, from->buffer, to->buffer, 1, &all);
    slc_compute_barrier(vk, commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                        VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
}
