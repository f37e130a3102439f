/** The calls of Vulkan that use a queue, and the application's lock around them. */
#ifndef SLC_VULKAN_QUEUES_H
#define SLC_VULKAN_QUEUES_H

#include "vulkan/dispatch.h"

/** Calls vkQueueBindSparse with one batch, with the queue locked. */
VkResult slc_queue_bind_sparse(const struct slc_vk *vk, VkQueue queue,
                               const VkBindSparseInfo *info);

/** Calls vkQueueSubmit with one batch and no fence, with the queue locked. */
VkResult slc_queue_submit(const struct slc_vk *vk, VkQueue queue, const VkSubmitInfo *info);

/** Calls vkDeviceWaitIdle, which uses all queues, with all of them locked. */
VkResult slc_wait_for_device(const struct slc_vk *vk);

#endif /* SLC_VULKAN_QUEUES_H */
