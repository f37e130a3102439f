#include "vulkan/queues.h"

static void lock(const struct slc_vk *vk, VkQueue queue)
{
    if (vk->queue_lock)
        vk->queue_lock->pfnLock(vk->queue_lock->pUserData, queue);
}

static void unlock(const struct slc_vk *vk, VkQueue queue)
{
    if (vk->queue_lock)
        vk->queue_lock->pfnUnlock(vk->queue_lock->pUserData, queue);
}

VkResult slc_queue_bind_sparse(const struct slc_vk *vk, VkQueue queue, const VkBindSparseInfo *info)
{
    lock(vk, queue);
    VkResult result = vk->QueueBindSparse(queue, 1, info, VK_NULL_HANDLE);
    unlock(vk, queue);
    return result;
}

VkResult slc_queue_submit(const struct slc_vk *vk, VkQueue queue, const VkSubmitInfo *info)
{
    lock(vk, queue);
    VkResult result = vk->QueueSubmit(queue, 1, info, VK_NULL_HANDLE);
    unlock(vk, queue);
    return result;
}

VkResult slc_wait_for_device(const struct slc_vk *vk)
{
    lock(vk, VK_NULL_HANDLE);
    VkResult result = vk->DeviceWaitIdle(vk->device);
    unlock(vk, VK_NULL_HANDLE);
    return result;
}
