/** Which queues a device is created with; gpu.c uses it. */
#ifndef TOOLS_COMMON_GPU_QUEUES_H
#define TOOLS_COMMON_GPU_QUEUES_H

#include "gpu.h"

/** Queues of each family. Zeroed is empty. */
struct gpu_queue_list {
    VkDeviceQueueCreateInfo infos[3];
    uint32_t count;
};

/** Adds a queue, if the family has so many. Returns its index in the family; 0 if there is but the
 *  one that was added before. */
uint32_t gpu_queue_add(struct gpu_queue_list *list, const VkQueueFamilyProperties *families,
                       uint32_t family);
/** Adds a queue for gpu->build_queue: of a family that computes and does not draw, or else a second
 *  one of gpu->family. Sets gpu->build_family and returns the index; without such a queue, that of
 *  gpu->queue. */
uint32_t gpu_queue_add_builder(struct gpu_queue_list *list, const VkQueueFamilyProperties *families,
                               uint32_t family_count, struct gpu *gpu);

#endif /* TOOLS_COMMON_GPU_QUEUES_H */
