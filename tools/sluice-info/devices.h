/** The Vulkan devices of a machine, and what is asked of them. */
#ifndef TOOLS_SLUICE_INFO_DEVICES_H
#define TOOLS_SLUICE_INFO_DEVICES_H

#include "format_modes.h"

#define MAX_DEVICES 16u
#define MAX_REASON 256u ///< bytes

struct devices {
    void *library;
    PFN_vkGetInstanceProcAddr get;
    VkInstance instance;
    VkPhysicalDevice devices[MAX_DEVICES];
    uint32_t count;
};

/** Says on standard error what is missing. */
bool open_devices(struct devices *devices);
void close_devices(struct devices *devices);

struct format_report {
    SluiceVulkanFormatCapabilities capabilities;
    bool has_layout;
    SluiceVulkanSparseImageLayout layout; ///< of an image of the size asked for
};

struct device_report {
    uint32_t index;
    SluiceVulkanDeviceCapabilities capabilities;
    char missing[MAX_REASON];                   ///< what keeps it from streaming; empty: nothing
    char missing_for[FORMAT_MODES][MAX_REASON]; ///< what keeps it from a mode; empty: nothing
    uint32_t width, height;
    struct format_report formats[SLUICE_FORMAT_COUNT];
};

/** False, having said why, if the device cannot even be asked. */
bool ask_device(const struct devices *devices, uint32_t index, uint32_t width, uint32_t height,
                struct device_report *report);

#endif /* TOOLS_SLUICE_INFO_DEVICES_H */
