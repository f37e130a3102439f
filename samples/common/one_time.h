/** Records commands, runs them once, and waits. */
#ifndef SAMPLES_COMMON_ONE_TIME_H
#define SAMPLES_COMMON_ONE_TIME_H

#include "../../tools/common/gpu.h"

/** Reports errors on stderr. */
bool one_time_run(const struct gpu *gpu, void (*record)(void *user_data, VkCommandBuffer commands),
                  void *user_data);
/** Runs commands after another queue has signaled `value` on a timeline semaphore. VK_NULL_HANDLE:
 * does not wait. */
bool one_time_run_after(const struct gpu *gpu, VkSemaphore semaphore, uint64_t value,
                        void (*record)(void *user_data, VkCommandBuffer commands), void *user_data);

#endif /* SAMPLES_COMMON_ONE_TIME_H */
