/** A Vulkan device without a window: instance, device, queues, and small helpers over them. */
#ifndef TOOLS_COMMON_GPU_H
#define TOOLS_COMMON_GPU_H

#include <vulkan/vulkan.h>

#include <sluice/neural_paths.h>
#include <sluice/vulkan.h>

#include <stdatomic.h>
#include <stdbool.h>

#include "device_list.h"

struct gpu_request {
    const char *device; ///< an index of --list-devices, part of a name or type; NULL: the best
    bool validation;    ///< with synchronization validation
    /** That streamers will have. AUTO for the second: sparse if the first is, else dense. */
    SluiceResidencyMode modes[2];
    bool ray_tracing;      ///< the ray-tracing pipeline is enabled, where the device has it
    bool buffer_addresses; ///< buffers have addresses, where the device knows them
    bool build_queue;      ///< there is a queue beside the others, where the device has one
    bool byte_pages; ///< byte pages of demand loaders, with addresses, where the device has them
    bool neural;     ///< all decode paths that the device has are enabled; without rays
    /** Extensions for a window's surface; with them the device can present (VK_KHR_swapchain).
     * Without neural. At most 8. */
    const char *const *instance_extensions;
    uint32_t instance_extension_count;
    /** Its instance is used, and its validation_messages count those of both. It must be destroyed
     *  after the new one. NULL: a new instance. */
    const struct gpu *first;
};

struct gpu {
    VkInstance instance;
    bool borrows_instance;
    VkPhysicalDevice physical_device;
    VkDevice device;
    VkQueue queue, sparse_queue; ///< may be the same; the latter VK_NULL_HANDLE without sparse
                                 ///< residency
    VkQueue build_queue;         ///< asked for and there, or `queue`
    uint32_t family, sparse_family;
    uint32_t build_family;      ///< if it is not `family`, buffers belong to both
    VkCommandPool command_pool; ///< buffers can be reset one by one
    VkPhysicalDeviceProperties properties;
    VkPhysicalDeviceMemoryProperties memory;
    SluiceVulkanDeviceCapabilities capabilities;
    SluiceResidencyMode modes[2]; ///< as asked for, never AUTO
    bool is_auto;                 ///< the first was AUTO: gpu_choose_mode may change it
    bool ray_tracing;             ///< asked for and there, with buffer addresses
    bool has_build_queue;         ///< asked for and there
    bool buffer_addresses;        ///< asked for and there, or rays are traced
    bool byte_pages;              ///< asked for and there
    bool presents;                ///< extensions of a window were asked for
    SluiceNeuralPaths neural;     ///< asked for and there
    VkDebugUtilsMessengerEXT messenger;
    atomic_uint validation_messages; ///< warnings and errors of the validation layers so far
};

/** A buffer of its own memory; `mapped` unless it is in device memory. */
struct gpu_buffer {
    VkBuffer buffer;
    VkDeviceMemory memory;
    VkDeviceSize size;
    void *mapped;
};

/** An image of its own memory and a view of it. */
struct gpu_image {
    VkImage image;
    VkDeviceMemory memory;
    VkImageView view;
};

/** Prints a line per device. Returns how many there are. */
uint32_t gpu_list_devices(void);

/** Device and driver on stdout, as JSON lines like those of figures. */
void gpu_print_json(const struct gpu *gpu);

/**
 * Says on stderr what is missing. `*unsupported` tells a machine without a device that streams from
 * other failures.
 */
bool gpu_create(const struct gpu_request *request, struct gpu *gpu, bool *unsupported);
/**
 * Lists the devices that `list` names, as indices of --list-devices. "all" and counts are devices
 * of the type of `gpu`, which was created without a name, and stream in its modes: it is the first.
 * Returns how many there are. 0: fewer than the list wants, which stderr says.
 */
uint32_t gpu_list_alike(const struct gpu *gpu, const struct device_list *list,
                        uint32_t indices[DEVICE_LIST_MOST]);
/** Where modes[0] was AUTO: what it is for a streamer of so many textures. Before it is used. */
void gpu_choose_mode(struct gpu *gpu, uint32_t texture_count);
/** A zeroed struct is fine. */
void gpu_destroy(struct gpu *gpu);

/** Prints "what: VK_..." and returns false unless `result` is VK_SUCCESS. */
bool gpu_check(VkResult result, const char *what);

/** Host-visible buffers are coherent, and cached where `usage` is only a transfer destination. With
 *  SHADER_DEVICE_ADDRESS in `usage` they have an address. */
bool gpu_create_buffer(const struct gpu *gpu, VkDeviceSize size, VkBufferUsageFlags usage,
                       struct gpu_buffer *buffer);
/** In the device's own memory, not mapped. */
bool gpu_create_device_buffer(const struct gpu *gpu, VkDeviceSize size, VkBufferUsageFlags usage,
                              struct gpu_buffer *buffer);
void gpu_destroy_buffer(const struct gpu *gpu, struct gpu_buffer *buffer);

/** A 2D image of one level in device memory. */
bool gpu_create_image(const struct gpu *gpu, VkFormat format, uint32_t width, uint32_t height,
                      VkSampleCountFlagBits samples, VkImageUsageFlags usage,
                      VkImageAspectFlags aspect, struct gpu_image *image);
/** As gpu_create_image, of one sample. Views may have both formats; its own has the first. */
bool gpu_create_viewed_image(const struct gpu *gpu, const VkFormat formats[2], uint32_t width,
                             uint32_t height, VkImageUsageFlags usage, struct gpu_image *image);
/** A color image of several levels to be copied to and sampled; the view shows them all. */
bool gpu_create_texture(const struct gpu *gpu, VkFormat format, uint32_t width, uint32_t height,
                        uint32_t levels, struct gpu_image *image);
void gpu_destroy_image(const struct gpu *gpu, struct gpu_image *image);

VkShaderModule gpu_create_shader(const struct gpu *gpu, const uint32_t *words, size_t size);
/** A compute pipeline of SPIR-V of `size` bytes. `constants` may be NULL. */
bool gpu_create_compute_pipeline(const struct gpu *gpu, VkPipelineLayout layout,
                                 const uint32_t *words, size_t size,
                                 const VkSpecializationInfo *constants, VkPipeline *pipeline);
/** The same with full subgroups: for gpu->neural.matrix. */
bool gpu_create_subgroup_pipeline(const struct gpu *gpu, VkPipelineLayout layout,
                                  const uint32_t *words, size_t size,
                                  const VkSpecializationInfo *constants, VkPipeline *pipeline);

/** Of all memory. */
void gpu_barrier(VkCommandBuffer commands, VkPipelineStageFlags from, VkAccessFlags from_access,
                 VkPipelineStageFlags to, VkAccessFlags to_access);

#endif /* TOOLS_COMMON_GPU_H */
