/** Commands that run once while the host waits. */
#ifndef SAMPLES_COMMON_ONE_TIME_H
#define SAMPLES_COMMON_ONE_TIME_H

#include "../../tools/common/gpu.h"

/** Says on stderr why it failed. */
bool one_time_run(const struct gpu *gpu, void (*record)(void *user_data, VkCommandBuffer commands),
                  void *user_data);
/** The same after another queue has signaled a timeline semaphore. VK_NULL_HANDLE: none. */
bool one_time_run_after(const struct gpu *gpu, VkSemaphore semaphore, uint64_t value,
                        void (*record)(void *user_data, VkCommandBuffer commands), void *user_data);

#endif /* SAMPLES_COMMON_ONE_TIME_H */
