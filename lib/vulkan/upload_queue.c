#include "vulkan/upload_queue.h"

#include "vulkan/queues.h"
#include "vulkan/timeline.h"

SluiceResult slc_upload_queue_init(struct slc_upload_queue *q, const struct slc_vk *vk,
                                   VkQueue queue, uint32_t family)
{
    *q = (struct slc_upload_queue){.queue = queue};
    const VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                          .queueFamilyIndex = family};
    SluiceResult result = slc_vk_result(
        vk, vk->CreateCommandPool(vk->device, &pool, NULL, &q->pool), "vkCreateCommandPool");
    if (result != SLUICE_SUCCESS) {
        q->pool = VK_NULL_HANDLE;
        return result;
    }
    slc_vk_name(vk, VK_OBJECT_TYPE_COMMAND_POOL, (uint64_t)q->pool, "uploads");
    const VkCommandBufferAllocateInfo buffers = {.sType =
                                                     VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                 .commandPool = q->pool,
                                                 .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                 .commandBufferCount = SLC_UPLOAD_BATCHES};
    result = slc_vk_result(vk, vk->AllocateCommandBuffers(vk->device, &buffers, q->commands),
                           "vkAllocateCommandBuffers");
    return result == SLUICE_SUCCESS ? slc_timeline_create(vk, "uploads", &q->semaphore) : result;
}

void slc_upload_queue_finish(struct slc_upload_queue *q, const struct slc_vk *vk)
{
    if (q->semaphore)
        vk->DestroySemaphore(vk->device, q->semaphore, NULL);
    if (q->pool)
        vk->DestroyCommandPool(vk->device, q->pool, NULL);
    *q = (struct slc_upload_queue){0};
}

SluiceResult slc_upload_queue_poll(struct slc_upload_queue *q, const struct slc_vk *vk)
{
    uint64_t value = 0;
    if (q->completed == q->submitted)
        return SLUICE_SUCCESS;
    SluiceResult result =
        slc_vk_result(vk, vk->GetSemaphoreCounterValue(vk->device, q->semaphore, &value),
                      "vkGetSemaphoreCounterValue");
    if (result == SLUICE_SUCCESS && value > q->completed)
        q->completed = value;
    return result;
}

SluiceResult slc_upload_queue_wait(struct slc_upload_queue *q, const struct slc_vk *vk)
{
    if (q->completed == q->submitted)
        return SLUICE_SUCCESS;
    const VkSemaphoreWaitInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                      .semaphoreCount = 1,
                                      .pSemaphores = &q->semaphore,
                                      .pValues = &q->submitted};
    return slc_vk_result(vk, vk->WaitSemaphores(vk->device, &info, UINT64_MAX), "vkWaitSemaphores");
}

void slc_upload_queue_drain(const struct slc_upload_queue *q, const struct slc_vk *vk)
{
    if (q->completed < q->submitted)
        slc_timeline_wait(vk, q->semaphore, q->submitted, "batch of uploads");
}

SluiceResult slc_upload_queue_begin(const struct slc_upload_queue *q, const struct slc_vk *vk,
                                    VkCommandBuffer *commands)
{
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                            .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    *commands = q->commands[q->submitted % SLC_UPLOAD_BATCHES];
    SluiceResult result =
        slc_vk_result(vk, vk->BeginCommandBuffer(*commands, &begin), "vkBeginCommandBuffer");
    if (result == SLUICE_SUCCESS)
        slc_record_transfer_barrier(vk, *commands);
    return result;
}

SluiceResult slc_upload_queue_submit(struct slc_upload_queue *q, const struct slc_vk *vk,
                                     VkSemaphore after, uint64_t value)
{
    const VkCommandBuffer *commands = &q->commands[q->submitted % SLC_UPLOAD_BATCHES];
    SluiceResult result = slc_vk_result(vk, vk->EndCommandBuffer(*commands), "vkEndCommandBuffer");
    if (result != SLUICE_SUCCESS)
        return result;
    const uint64_t signal = q->submitted + 1;
    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_TRANSFER_BIT;
    const VkTimelineSemaphoreSubmitInfo timeline = {
        .sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
        .waitSemaphoreValueCount = 1,
        .pWaitSemaphoreValues = &value,
        .signalSemaphoreValueCount = 1,
        .pSignalSemaphoreValues = &signal};
    const VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                                 .pNext = &timeline,
                                 .waitSemaphoreCount = 1,
                                 .pWaitSemaphores = &after,
                                 .pWaitDstStageMask = &stage,
                                 .commandBufferCount = 1,
                                 .pCommandBuffers = commands,
                                 .signalSemaphoreCount = 1,
                                 .pSignalSemaphores = &q->semaphore};
    result = slc_vk_result(vk, slc_queue_submit(vk, q->queue, &submit), "vkQueueSubmit");
    q->submitted += result == SLUICE_SUCCESS;
    return result;
}

void slc_record_transfer_barrier(const struct slc_vk *vk, VkCommandBuffer commands)
{
    const VkMemoryBarrier memory = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                    .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                                    .dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT};
    vk->CmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT,
                           0, 1, &memory, 0, NULL, 0, NULL);
}
