#include "vulkan/submitted_work.h"

#include "base/log.h"

#define SECOND 1000000000ull
#define PATIENCE 5u /* seconds without progress */

static VkResult wait_a_second(const struct slc_vk *vk, VkSemaphore semaphore, uint64_t value)
{
    VkSemaphoreWaitInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                .semaphoreCount = 1,
                                .pSemaphores = &semaphore,
                                .pValues = &value};
    return vk->WaitSemaphores(vk->device, &info, SECOND);
}

void slc_submitted_work_wait(const struct slc_vk *vk, VkSemaphore semaphore, uint64_t value,
                             const char *what)
{
    uint64_t reached = 0;
    for (uint32_t idle = 0; idle < PATIENCE; idle++) {
        VkResult result = wait_a_second(vk, semaphore, value);
        if (result != VK_TIMEOUT) {
            slc_vk_result(vk, result, "vkWaitSemaphores");
            return;
        }
        uint64_t now = 0;
        if (vk->GetSemaphoreCounterValue(vk->device, semaphore, &now) != VK_SUCCESS)
            return;
        if (now > reached)
            idle = 0;
        reached = now;
    }
    slc_log(&vk->log, SLUICE_LOG_WARNING,
            "%s %llu was ended, but its semaphore is still at %llu after %u seconds: if it was not "
            "submitted, abandon it; waiting for the whole device instead",
            what, (unsigned long long)value, (unsigned long long)reached, PATIENCE);
    vk->DeviceWaitIdle(vk->device);
}
