#include "vulkan/create_checks.h"

#include "base/log.h"

#define MAX_FAMILIES 64u /* those beyond are believed */

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

SluiceResult slc_check_limits(const SluiceLogCallback *log, const struct slc_limit *limits,
                              size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const struct slc_limit *l = &limits[i];
        if (l->value >= l->least && l->value <= l->most)
            continue;
        slc_log(log, SLUICE_LOG_ERROR, "%s is %llu; it must be from %llu to %llu", l->field,
                (unsigned long long)l->value, (unsigned long long)l->least,
                (unsigned long long)l->most);
        return SLUICE_ERROR_INVALID_ARGUMENT;
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
    if (index >= count) {
        slc_log(&vk->log, SLUICE_LOG_ERROR, "%s is %u, but the device has %u queue families", field,
                index, count);
        return SLUICE_ERROR_INVALID_ARGUMENT;
    }
    if (index >= known || families[index].queueFlags & any_of)
        return SLUICE_SUCCESS;
    slc_log(&vk->log, SLUICE_LOG_ERROR, "%s is %u, a family with VkQueueFlags 0x%x, but it must %s",
            field, index, (unsigned)families[index].queueFlags, purpose);
    return SLUICE_ERROR_INVALID_ARGUMENT;
}
