/** Queries the Vulkan devices of a machine. */
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

/** Reports errors on stderr. */
bool open_devices(struct devices *devices);
void close_devices(struct devices *devices);

struct format_report {
    SluiceVulkanFormatCapabilities capabilities;
    bool has_layout;
    SluiceVulkanSparseImageLayout layout; ///< layout of an image of the requested size
};

struct device_report {
    uint32_t index;
    SluiceVulkanDeviceCapabilities capabilities;
    char missing[MAX_REASON]; ///< reason why the device cannot stream; empty: it can
    char missing_for[FORMAT_MODES]
                    [MAX_REASON]; ///< by mode: reason why the device lacks it; empty: supported
    uint32_t width, height;
    struct format_report formats[SLUICE_FORMAT_COUNT];
};

/** Returns false if the device cannot be queried, and reports it on stderr. */
bool ask_device(const struct devices *devices, uint32_t index, uint32_t width, uint32_t height,
                struct device_report *report);

#endif /* TOOLS_SLUICE_INFO_DEVICES_H */
