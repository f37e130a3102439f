/**
 * Limits the context's memory budget to the memory that the device can spare
 * (VK_EXT_memory_budget). The device is polled every SLC_DEVICE_BUDGET_TURNS frames and launches.
 * Changes below a step are ignored, so that tiles are not evicted and loaded in turns.
 */
#ifndef SLC_VULKAN_DEVICE_BUDGET_H
#define SLC_VULKAN_DEVICE_BUDGET_H

#include "vulkan/caps.h"
#include "vulkan/memory_budget.h"

/** Zeroed: no limit, and the device is not polled. */
struct slc_device_budget {
    struct slc_mutex mutex; ///< guards `limit` and `turns`: front ends may be on different threads
    PFN_vkGetPhysicalDeviceMemoryProperties2 get; ///< NULL: the limit stays SLC_NO_MEMORY_LIMIT
    VkPhysicalDevice physical_device;
    uint32_t heap;  ///< largest device-local heap
    uint64_t step;  ///< bytes left to other processes; smaller changes are ignored
    uint64_t limit; ///< bytes of tile memory
    uint32_t turns; ///< frames and launches since the last poll
};

/** Frames and launches, of all front ends together, between two polls. */
#define SLC_DEVICE_BUDGET_TURNS 256u

/** Polls for the first time, if the device has the extension. `get` is the application's.
 *  Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_device_budget_init(struct slc_device_budget *device, const struct slc_vk *vk,
                                    const struct slc_caps *caps,
                                    const SluiceAllocationCallbacks *cb,
                                    PFN_vkGetInstanceProcAddr get,
                                    struct slc_memory_budget *budget);

/** `device` may be zeroed. */
void slc_device_budget_finish(struct slc_device_budget *device);

/** Polls every SLC_DEVICE_BUDGET_TURNS calls. Call it when a frame or launch begins. */
void slc_device_budget_turn(struct slc_device_budget *device, struct slc_memory_budget *budget);

#endif /* SLC_VULKAN_DEVICE_BUDGET_H */
