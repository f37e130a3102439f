#include "commands.h"

bool commands_begin(const struct gpu *gpu, VkCommandBuffer *commands)
{
    VkCommandBufferAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                        .commandPool = gpu->command_pool,
                                        .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                        .commandBufferCount = 1};
    VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                      .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    return gpu_check(vkAllocateCommandBuffers(gpu->device, &info, commands),
                     "vkAllocateCommandBuffers") &&
           gpu_check(vkBeginCommandBuffer(*commands, &begin), "vkBeginCommandBuffer");
}

bool commands_run(const struct gpu *gpu, VkCommandBuffer commands)
{
    VkSubmitInfo info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                         .commandBufferCount = 1,
                         .pCommandBuffers = &commands};
    bool done = gpu_check(vkEndCommandBuffer(commands), "vkEndCommandBuffer") &&
                gpu_check(vkQueueSubmit(gpu->queue, 1, &info, VK_NULL_HANDLE), "vkQueueSubmit") &&
                gpu_check(vkQueueWaitIdle(gpu->queue), "vkQueueWaitIdle");
    vkFreeCommandBuffers(gpu->device, gpu->command_pool, 1, &commands);
    return done;
}
