/** Creates a device and a picture to draw to. Plain Vulkan, kept out of minimal.c. */
#ifndef SAMPLES_MINIMAL_VULKAN_SETUP_H
#define SAMPLES_MINIMAL_VULKAN_SETUP_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <vulkan/vulkan.h>

/** Exits with "`what` failed: `why`" unless `good`. */
void check(bool good, const char *what, const char *why);
/** Exits with the number of the result unless it is VK_SUCCESS. */
void check_vulkan(VkResult result, const char *call);
#define VK(call) check_vulkan((call), #call)

struct gpu {
    VkInstance instance;
    VkPhysicalDevice physical_device;
    VkDevice device;
    uint32_t family, sparse_family; ///< may be equal
    VkQueue queue, sparse_queue;    ///< `queue` draws and computes
};

/** Features and queue family that a device is opened with. */
struct device_needs {
    VkPhysicalDeviceFeatures features;
    VkPhysicalDeviceVulkan12Features vulkan12;
    uint32_t sparse_family; ///< VK_QUEUE_FAMILY_IGNORED: none; the drawing queue is used instead
};

/** Returns whether a device is suitable, and writes what to open it with. */
typedef bool device_test(VkInstance instance, VkPhysicalDevice device, const void *user,
                         struct device_needs *needs);

/** Opens the first device that passes the test. Exits with status 77 if none does. */
void open_device(struct gpu *gpu, device_test *test, const void *user);
void close_device(const struct gpu *gpu);

/** An sRGB picture that is drawn to and read back. */
struct picture {
    uint32_t width, height;
    VkImage image;
    VkImageView view;
    VkDeviceMemory image_memory, buffer_memory;
    VkRenderPass render_pass; ///< clears; leaves the image ready to be copied
    VkFramebuffer framebuffer;
    VkBuffer buffer;
    const uint8_t *texels; ///< mapped: [height][width] RGBA, as copied last
};

void create_picture(const struct gpu *gpu, uint32_t width, uint32_t height,
                    struct picture *picture);
void destroy_picture(const struct gpu *gpu, const struct picture *picture);
/** Records a copy to `texels`, which the host may read when the commands have completed. */
void copy_picture(VkCommandBuffer commands, const struct picture *picture);

#endif /* SAMPLES_MINIMAL_VULKAN_SETUP_H */
