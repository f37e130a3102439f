#include "vulkan/device_budget.h"

#include "base/alloc.h"
#include "base/checked.h"

#include <string.h>

#define STEPS_PER_HEAP 64u
#define MAX_STEP (UINT64_C(128) << 20)

/* Errors: OUT_OF_HOST_MEMORY. */
static SluiceResult find_extension(const struct slc_vk *vk, const SluiceAllocationCallbacks *cb,
                                   PFN_vkEnumerateDeviceExtensionProperties enumerate, bool *found)
{
    *found = false;
    uint32_t count = 0, written;
    if (!enumerate || enumerate(vk->physical_device, NULL, &count, NULL) < 0 || count == 0)
        return SLUICE_SUCCESS;
    VkExtensionProperties *list = slc_alloc(cb, count, sizeof *list);
    if (!list)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    written = count;
    if (enumerate(vk->physical_device, NULL, &written, list) >= 0)
        for (uint32_t i = 0; i < written; i++)
            *found |= strcmp(list[i].extensionName, VK_EXT_MEMORY_BUDGET_EXTENSION_NAME) == 0;
    slc_free(cb, list, count, sizeof *list);
    return SLUICE_SUCCESS;
}

/* Returns tile memory in use, plus bytes that the heap can spare, or minus bytes that it lacks. */
static uint64_t ask(const struct slc_device_budget *device, struct slc_memory_budget *budget)
{
    VkPhysicalDeviceMemoryBudgetPropertiesEXT answer = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_BUDGET_PROPERTIES_EXT};
    VkPhysicalDeviceMemoryProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_PROPERTIES_2, .pNext = &answer};
    device->get(device->physical_device, &properties);
    uint64_t all = answer.heapBudget[device->heap], used = answer.heapUsage[device->heap];
    uint64_t tiles = slc_memory_budget_tile_memory(budget);
    if (used + device->step > all)
        return tiles - slc_min_u64(tiles, used + device->step - all);
    return tiles + (all - used - device->step);
}

static void poll(struct slc_device_budget *device, struct slc_memory_budget *budget)
{
    uint64_t now = ask(device, budget);
    uint64_t change = now > device->limit ? now - device->limit : device->limit - now;
    device->turns = 0;
    if (change < device->step)
        return;
    device->limit = now;
    slc_memory_budget_set_device_limit(budget, now);
}

SluiceResult slc_device_budget_init(struct slc_device_budget *device, const struct slc_vk *vk,
                                    const struct slc_caps *caps,
                                    const SluiceAllocationCallbacks *cb,
                                    PFN_vkGetInstanceProcAddr get, struct slc_memory_budget *budget)
{
    *device = (struct slc_device_budget){.physical_device = vk->physical_device,
                                         .limit = SLC_NO_MEMORY_LIMIT};
    bool found;
    SluiceResult result = find_extension(vk, cb,
                                         (PFN_vkEnumerateDeviceExtensionProperties)get(
                                             vk->instance, "vkEnumerateDeviceExtensionProperties"),
                                         &found);
    if (!found)
        return result;
    device->get = (PFN_vkGetPhysicalDeviceMemoryProperties2)get(
        vk->instance, "vkGetPhysicalDeviceMemoryProperties2");
    device->heap = slc_device_memory_heap(caps);
    device->step =
        slc_min_u64(MAX_STEP, caps->memory.memoryHeaps[device->heap].size / STEPS_PER_HEAP);
    if (device->get && !slc_mutex_init(&device->mutex))
        device->get = NULL;
    if (device->get)
        poll(device, budget);
    return SLUICE_SUCCESS;
}

void slc_device_budget_finish(struct slc_device_budget *device)
{
    if (device->get)
        slc_mutex_finish(&device->mutex);
}

void slc_device_budget_turn(struct slc_device_budget *device, struct slc_memory_budget *budget)
{
    if (!device->get)
        return;
    slc_mutex_lock(&device->mutex);
    if (++device->turns >= SLC_DEVICE_BUDGET_TURNS)
        poll(device, budget);
    slc_mutex_unlock(&device->mutex);
}
