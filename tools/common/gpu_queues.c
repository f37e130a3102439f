#include "gpu_queues.h"

static const float priorities[3] = {1.0f, 1.0f, 1.0f};

static VkDeviceQueueCreateInfo *find(struct gpu_queue_list *list, uint32_t family)
{
    for (uint32_t i = 0; i < list->count; i++)
        if (list->infos[i].queueFamilyIndex == family)
            return &list->infos[i];
    return NULL;
}

uint32_t gpu_queue_add(struct gpu_queue_list *list, const VkQueueFamilyProperties *families,
                       uint32_t family)
{
    VkDeviceQueueCreateInfo *info = find(list, family);
    if (info)
        return info->queueCount < families[family].queueCount ? info->queueCount++ : 0;
    list->infos[list->count++] =
        (VkDeviceQueueCreateInfo){.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                  .queueFamilyIndex = family,
                                  .queueCount = 1,
                                  .pQueuePriorities = priorities};
    return 0;
}

uint32_t gpu_queue_add_builder(struct gpu_queue_list *list, const VkQueueFamilyProperties *families,
                               uint32_t family_count, struct gpu *gpu)
{
    const VkQueueFlags both = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (uint32_t i = 0; i < family_count; i++) {
        if ((families[i].queueFlags & both) != VK_QUEUE_COMPUTE_BIT)
            continue;
        /* Do not share the queue of sparse binds. */
        const bool is_new = !find(list, i);
        const uint32_t index = gpu_queue_add(list, families, i);
        if (!is_new && index == 0)
            continue;
        gpu->build_family = i;
        return index;
    }
    gpu->build_family = gpu->family;
    return gpu_queue_add(list, families, gpu->family);
}
