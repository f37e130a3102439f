/** Timeline semaphores: creation, and waits for submitted work. */
#ifndef SLC_VULKAN_TIMELINE_H
#define SLC_VULKAN_TIMELINE_H

#include "vulkan/dispatch.h"

/** Creates a timeline semaphore of value 0. `*semaphore` is VK_NULL_HANDLE after an error. `name`:
 * for debuggers. */
SluiceResult slc_timeline_create(const struct slc_vk *vk, const char *name, VkSemaphore *semaphore);

/**
 * Waits until `semaphore` reaches `value`, which the application's submission signals. `what` and
 * `value` name the submission in messages, for example "frame" 7.
 *
 * Vulkan cannot tell work that runs from work that was never submitted. If the timeline stands
 * still for five seconds, a warning is logged, and vkDeviceWaitIdle ends the wait: it waits for
 * submitted work only. Returns at once if the device is lost.
 */
void slc_timeline_wait(const struct slc_vk *vk, VkSemaphore semaphore, uint64_t value,
                       const char *what);

#endif /* SLC_VULKAN_TIMELINE_H */
