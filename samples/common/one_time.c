#include "one_time.h"

bool one_time_run(const struct gpu *gpu, void (*record)(void *user_data, VkCommandBuffer commands),
                  void *user_data)
{
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
                               .commandBufferCount = 1,
                               .pCommandBuffers = &commands};
        done = gpu_check(vkEndCommandBuffer(commands), "vkEndCommandBuffer") &&
               gpu_check(vkQueueSubmit(gpu->queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit") &&
               gpu_check(vkQueueWaitIdle(gpu->queue), "vkQueueWaitIdle");
    }
    vkFreeCommandBuffers(gpu->device, gpu->command_pool, 1, &commands);
    return done;
}
