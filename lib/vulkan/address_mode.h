/** Which address modes a texture has: the caller's, or what its source records. */
#ifndef SLC_VULKAN_ADDRESS_MODE_H
#define SLC_VULKAN_ADDRESS_MODE_H

#include <sluice/vulkan.h>

/** REPEAT is 0, so without `is_explicit` it means that the caller says nothing. */
static inline VkSamplerAddressMode slc_address_mode(VkSamplerAddressMode given, bool is_explicit,
                                                    SluiceImageAddressMode recorded)
{
    bool said = is_explicit || given != VK_SAMPLER_ADDRESS_MODE_REPEAT;
    if (said || recorded == SLUICE_IMAGE_ADDRESS_MODE_UNKNOWN)
        return given;
    return (VkSamplerAddressMode)((int)recorded - SLUICE_IMAGE_ADDRESS_MODE_REPEAT);
}

/** The source records another mode than the one that is used. */
static inline bool slc_address_mode_differs(VkSamplerAddressMode used,
                                            SluiceImageAddressMode recorded)
{
    return recorded != SLUICE_IMAGE_ADDRESS_MODE_UNKNOWN &&
           (int)recorded - SLUICE_IMAGE_ADDRESS_MODE_REPEAT != (int)used;
}

#endif /* SLC_VULKAN_ADDRESS_MODE_H */
