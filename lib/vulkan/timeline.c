#include "vulkan/timeline.h"

#include "base/log.h"
#include "vulkan/queues.h"

#define SECOND 1000000000ull
#define PATIENCE 5u /* seconds without progress */

SluiceResult slc_timeline_create(const struct slc_vk *vk, const char *name, VkSemaphore *semaphore)
{
    const VkSemaphoreTypeCreateInfo type = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO,
                                            .semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE};
    const VkSemaphoreCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO,
                                        .pNext = &type};
    SluiceResult result = slc_vk_result(vk, vk->CreateSemaphore(vk->device, &info, NULL, semaphore),
                                        "vkCreateSemaphore");
    if (result != SLUICE_SUCCESS)
        *semaphore = VK_NULL_HANDLE;
    slc_vk_name(vk, VK_OBJECT_TYPE_SEMAPHORE, (uint64_t)*semaphore, name);
    return result;
}

static VkResult wait_a_second(const struct slc_vk *vk, VkSemaphore semaphore, uint64_t value)
{
    VkSemaphoreWaitInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                .semaphoreCount = 1,
                                .pSemaphores = &semaphore,
                                .pValues = &value};
    return vk->WaitSemaphores(vk->device, &info, SECOND);
}

void slc_timeline_wait(const struct slc_vk *vk, VkSemaphore semaphore, uint64_t value,
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
    slc_wait_for_device(vk);
}
