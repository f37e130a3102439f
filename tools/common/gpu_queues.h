/** Selects the queues that a device is created with. Used by gpu.c. */
#ifndef TOOLS_COMMON_GPU_QUEUES_H
#define TOOLS_COMMON_GPU_QUEUES_H

#include "gpu.h"

/** Queues of each family. Zeroed is empty. */
struct gpu_queue_list {
    VkDeviceQueueCreateInfo infos[3];
    uint32_t count;
};

/** Adds a queue if the family has another one. Returns its index in the family, or 0 if the
 * family's only queue was added before. */
uint32_t gpu_queue_add(struct gpu_queue_list *list, const VkQueueFamilyProperties *families,
                       uint32_t family);
/** Adds a queue for gpu->build_queue: from a compute family without graphics, else a second one of
 * gpu->family. Sets gpu->build_family and returns the queue's index. Without such a queue, returns
 * the index of gpu->queue. */
uint32_t gpu_queue_add_builder(struct gpu_queue_list *list, const VkQueueFamilyProperties *families,
                               uint32_t family_count, struct gpu *gpu);

#endif /* TOOLS_COMMON_GPU_QUEUES_H */
