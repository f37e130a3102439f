/** Messages of all programs for machines that lack required features. */
#ifndef TOOLS_COMMON_NO_VULKAN_H
#define TOOLS_COMMON_NO_VULKAN_H

#define NO_VULKAN_DRIVER                                                                           \
    "there is no Vulkan driver; install the one for your GPU, or lavapipe, which needs no GPU "    \
    "(package mesa-vulkan-drivers)"

/** Follows "no Vulkan device" or "no Vulkan device like NAME". */
#define CANNOT_STREAM "can stream in this residency mode; sluice-info says what each device can do"
/** Follows the same words, if sparse residency is not required. */
#define LACKS_FEATURES "has what this program needs; sluice-info says what each device can do"

#endif /* TOOLS_COMMON_NO_VULKAN_H */
