#include "vulkan/create_checks.h"

#include "base/log.h"

#define MAX_FAMILIES 64u /* families that are checked; further ones are accepted */

SluiceResult slc_check_required(const SluiceLogCallback *log, const struct slc_required *fields,
                                size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!fields[i].given) {
            slc_log(log, SLUICE_LOG_ERROR, "%s is NULL", fields[i].field);
            return SLUICE_ERROR_NULL_POINTER;
        }
    return SLUICE_SUCCESS;
}

SluiceResult slc_check_queue_family(const struct slc_vk *vk, const char *field, uint32_t index,
                                    VkQueueFlags any_of, const char *purpose)
{
    VkQueueFamilyProperties families[MAX_FAMILIES];
    uint32_t count = 0, known = MAX_FAMILIES;
    vk->GetPhysicalDeviceQueueFamilyProperties(vk->physical_device, &count, NULL);
    vk->GetPhysicalDeviceQueueFamilyProperties(vk->physical_device, &known, families);
    if (index >= count)
        return slc_log_refusal(&vk->log, "%s is %u, but the device has %u queue families", field,
                               index, count);
    if (index >= known || families[index].queueFlags & any_of)
        return SLUICE_SUCCESS;
    return slc_log_refusal(&vk->log, "%s is %u, a family with VkQueueFlags 0x%x, but it must %s",
                           field, index, (unsigned)families[index].queueFlags, purpose);
}

VkExtent3D slc_transfer_granularity(const struct slc_vk *vk, uint32_t family)
{
    VkQueueFamilyProperties families[MAX_FAMILIES];
    uint32_t count = MAX_FAMILIES;
    vk->GetPhysicalDeviceQueueFamilyProperties(vk->physical_device, &count, families);
    return family < count ? families[family].minImageTransferGranularity
                          : (VkExtent3D){0, 0, 0}; /* whole levels, which every family can copy */
}
