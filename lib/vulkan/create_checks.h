/** Checks of create-infos of Vulkan objects. */
#ifndef SLC_VULKAN_CREATE_CHECKS_H
#define SLC_VULKAN_CREATE_CHECKS_H

#include "base/limits.h"
#include "vulkan/dispatch.h"

/** Field of a create-info that must not be NULL, and whether it is set. */
struct slc_required {
    const char *field;
    bool given;
};

/** Checks required fields; logs the first one that is NULL. Errors: NULL_POINTER. */
SluiceResult slc_check_required(const SluiceLogCallback *log, const struct slc_required *fields,
                                size_t count);

/**
 * Checks that the device has a queue family with one of the bits, else logs why not. `purpose`
 * completes "it must". Uses only instance functions. Errors: INVALID_ARGUMENT.
 */
SluiceResult slc_check_queue_family(const struct slc_vk *vk, const char *field, uint32_t index,
                                    VkQueueFlags any_of, const char *purpose);

/** Returns minImageTransferGranularity of an existing family. */
VkExtent3D slc_transfer_granularity(const struct slc_vk *vk, uint32_t family);

#endif /* SLC_VULKAN_CREATE_CHECKS_H */
