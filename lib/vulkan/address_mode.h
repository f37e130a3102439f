/** Address modes of a texture: the caller's, or the modes that its source records. */
#ifndef SLC_VULKAN_ADDRESS_MODE_H
#define SLC_VULKAN_ADDRESS_MODE_H

#include <sluice/vulkan.h>

#include "base/log.h"

/** Returns the recorded address mode, or `otherwise` if the source records none. */
static inline VkSamplerAddressMode slc_recorded_address_mode(SluiceImageAddressMode recorded,
                                                             VkSamplerAddressMode otherwise)
{
    if (recorded == SLUICE_IMAGE_ADDRESS_MODE_UNKNOWN)
        return otherwise;
    return (VkSamplerAddressMode)((int)recorded - SLUICE_IMAGE_ADDRESS_MODE_REPEAT);
}

/** Returns the mode to use. Without `is_explicit`, REPEAT (0) means that the caller chose none. */
static inline VkSamplerAddressMode slc_address_mode(VkSamplerAddressMode given, bool is_explicit,
                                                    SluiceImageAddressMode recorded)
{
    bool said = is_explicit || given != VK_SAMPLER_ADDRESS_MODE_REPEAT;
    return said ? given : slc_recorded_address_mode(recorded, given);
}

/** True if the source records another mode than the one that is used. */
static inline bool slc_address_mode_differs(VkSamplerAddressMode used,
                                            SluiceImageAddressMode recorded)
{
    return recorded != SLUICE_IMAGE_ADDRESS_MODE_UNKNOWN &&
           (int)recorded - SLUICE_IMAGE_ADDRESS_MODE_REPEAT != (int)used;
}

/** Returns the name of a mode, as in Vulkan's constants. */
static inline const char *slc_address_mode_name(VkSamplerAddressMode mode)
{
    switch ((int)mode) {
    case VK_SAMPLER_ADDRESS_MODE_REPEAT: return "repeat";
    case VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT: return "mirrored repeat";
    case VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE: return "clamp to edge";
    case VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER: return "clamp to border";
    default: return "mirror clamp to edge";
    }
}

/** Warns that an image is sampled with other modes than it records. */
static inline void slc_warn_of_address_modes(const SluiceLogCallback *log,
                                             const SluiceImageInfo *info, VkSamplerAddressMode u,
                                             VkSamplerAddressMode v)
{
    const VkSamplerAddressMode made_u = slc_recorded_address_mode(info->addressModeU, u),
                               made_v = slc_recorded_address_mode(info->addressModeV, v);
    slc_log(log, SLUICE_LOG_WARNING,
            "%s: is sampled with address modes %s (u), %s (v), but its coarser levels were made "
            "for %s, %s: seams may show at its edges",
            info->pName ? info->pName : "image", slc_address_mode_name(u), slc_address_mode_name(v),
            slc_address_mode_name(made_u), slc_address_mode_name(made_v));
}

#endif /* SLC_VULKAN_ADDRESS_MODE_H */
