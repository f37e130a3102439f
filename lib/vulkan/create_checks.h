/** What create-infos of Vulkan objects must say, checked before anything is made of it. */
#ifndef SLC_VULKAN_CREATE_CHECKS_H
#define SLC_VULKAN_CREATE_CHECKS_H

#include "base/limits.h"
#include "vulkan/dispatch.h"

/** A field of a create-info that must not be NULL, and whether it is there. */
struct slc_required {
    const char *field;
    bool given;
};

/** Logs the first field that is NULL. Errors: NULL_POINTER. */
SluiceResult slc_check_required(const SluiceLogCallback *log, const struct slc_required *fields,
                                size_t count);

/**
 * Needs only the instance functions. Logs a family that the device has not, or that has none of the
 * bits; `purpose` completes "it must". Errors: INVALID_ARGUMENT.
 */
SluiceResult slc_check_queue_family(const struct slc_vk *vk, const char *field, uint32_t index,
                                    VkQueueFlags any_of, const char *purpose);

/** minImageTransferGranularity of a family that exists. */
VkExtent3D slc_transfer_granularity(const struct slc_vk *vk, uint32_t family);

#endif /* SLC_VULKAN_CREATE_CHECKS_H */
