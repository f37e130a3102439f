/** What all programs say on a machine that cannot do what they need. */
#ifndef TOOLS_COMMON_NO_VULKAN_H
#define TOOLS_COMMON_NO_VULKAN_H

#define NO_VULKAN_DRIVER                                                                           \
    "there is no Vulkan driver; install the one for your GPU, or lavapipe, which needs no GPU "    \
    "(package mesa-vulkan-drivers)"

/** Behind "no Vulkan device", or "no Vulkan device like NAME". */
#define CANNOT_STREAM "can stream in this residency mode; sluice-info says what each device can do"
/** Also behind these words, if no sparse residency is wanted. */
#define LACKS_FEATURES "has what this program needs; sluice-info says what each device can do"

#endif /* TOOLS_COMMON_NO_VULKAN_H */
