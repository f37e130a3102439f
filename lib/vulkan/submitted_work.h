/** Waits for the work of one timeline, and for nothing else on the device. */
#ifndef SLC_VULKAN_SUBMITTED_WORK_H
#define SLC_VULKAN_SUBMITTED_WORK_H

#include "vulkan/dispatch.h"

/**
 * Waits until `semaphore` reaches `value`, which the application's submission signals. `what` and
 * `value` name the submission in messages, for example "frame" 7.
 *
 * Vulkan cannot tell work that runs from work that was never submitted. If the timeline stands
 * still for five seconds, a warning is logged, and vkDeviceWaitIdle ends the wait: it waits for
 * submitted work only. Returns at once if the device is lost.
 */
void slc_submitted_work_wait(const struct slc_vk *vk, VkSemaphore semaphore, uint64_t value,
                             const char *what);

#endif /* SLC_VULKAN_SUBMITTED_WORK_H */
