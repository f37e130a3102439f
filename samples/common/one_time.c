#include "one_time.h"

bool one_time_run(const struct gpu *gpu, void (*record)(void *user_data, VkCommandBuffer commands),
                  void *user_data)
{
    return one_time_run_after(gpu, VK_NULL_HANDLE, 0, record, user_data);
}

bool one_time_run_after(const struct gpu *gpu, VkSemaphore semaphore, uint64_t value,
                        void (*record)(void *user_data, VkCommandBuffer commands), void *user_data)
{
    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    const VkTimelineSemaphoreSubmitInfo timeline = {
        .sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
        .waitSemaphoreValueCount = 1,
        .pWaitSemaphoreValues = &value};
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkCommandBufferAllocateInfo allocate = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                            .commandPool = gpu->command_pool,
                                            .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                            .commandBufferCount = 1};
    VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                      .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    if (!gpu_check(vkAllocateCommandBuffers(gpu->device, &allocate, &commands),
                   "vkAllocateCommandBuffers"))
        return false;
    bool done = gpu_check(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
    if (done) {
        record(user_data, commands);
        VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                               .pNext = semaphore ? &timeline : NULL,
                               .waitSemaphoreCount = semaphore ? 1 : 0,
                               .pWaitSemaphores = &semaphore,
                               .pWaitDstStageMask = &stage,
                               .commandBufferCount = 1,
                               .pCommandBuffers = &commands};
        done = gpu_check(vkEndCommandBuffer(commands), "vkEndCommandBuffer") &&
               gpu_check(vkQueueSubmit(gpu->queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit") &&
               gpu_check(vkQueueWaitIdle(gpu->queue), "vkQueueWaitIdle");
    }
    vkFreeCommandBuffers(gpu->device, gpu->command_pool, 1, &commands);
    return done;
}
