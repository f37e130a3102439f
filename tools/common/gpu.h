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
    const char *device; ///< index in --list-devices, or part of a name or type; NULL: the best
    bool validation;    ///< includes synchronization validation
    /** Modes of the streamers. AUTO for the second: sparse if the first is sparse, else dense. */
    SluiceResidencyMode modes[2];
    bool ray_tracing;      ///< enable the ray-tracing pipeline if the device has it
    bool buffer_addresses; ///< enable buffer addresses if the device has them
    bool build_queue;      ///< create a queue for builds beside the others if the device has one
    bool every_mode;       ///< enable the features of all residency modes that the device has
    bool byte_pages; ///< enable byte pages of demand loaders, and addresses, if the device has them
    bool neural;     ///< enable all decode paths of the device; not with ray_tracing
    /** Extensions for a window's surface. Enables presentation (VK_KHR_swapchain). Not with neural.
     * At most 8. */
    const char *const *instance_extensions;
    uint32_t instance_extension_count;
    /** Device whose instance is used. Its validation_messages count those of both devices. Destroy
     * it after the new device. NULL: creates an instance. */
    const struct gpu *first;
};

struct gpu {
    VkInstance instance;
    bool borrows_instance;
    VkPhysicalDevice physical_device;
    VkDevice device;
    VkQueue queue, sparse_queue; ///< may be equal; second NULL without sparse residency
    VkQueue build_queue;         ///< build queue if requested and available; else `queue`
    uint32_t family, sparse_family;
    uint32_t build_family;      ///< if it differs from `family`, buffers are shared by both
    VkCommandPool command_pool; ///< its buffers can be reset one by one
    VkPhysicalDeviceProperties properties;
    VkPhysicalDeviceMemoryProperties memory;
    SluiceVulkanDeviceCapabilities capabilities;
    SluiceResidencyMode modes[2]; ///< as requested; AUTO is resolved
    bool is_auto;                 ///< modes[0] was AUTO: gpu_choose_mode may change it
    bool ray_tracing;             ///< requested and available; includes buffer addresses
    bool has_build_queue;         ///< requested and available
    bool buffer_addresses;        ///< requested and available, or ray_tracing
    bool byte_pages;              ///< requested and available
    bool presents;                ///< true: a window's extensions were requested
    SluiceNeuralPaths neural;     ///< requested and available
    VkDebugUtilsMessengerEXT messenger;
    atomic_uint validation_messages; ///< warnings and errors of the validation layers so far
};

/** A buffer with its own memory. `mapped` is NULL in device memory. */
struct gpu_buffer {
    VkBuffer buffer;
    VkDeviceMemory memory;
    VkDeviceSize size;
    void *mapped;
};

/** An image with its own memory, and a view of it. */
struct gpu_image {
    VkImage image;
    VkDeviceMemory memory;
    VkImageView view;
};

/** Prints a line per device. Returns the number of devices. */
uint32_t gpu_list_devices(void);

/** Prints device and driver on stdout as JSON lines, like figures. */
void gpu_print_json(const struct gpu *gpu);

/**
 * Creates a device. Reports errors on stderr. `*unsupported`: true if the machine lacks a device
 * that streams; false after other failures.
 */
bool gpu_create(const struct gpu_request *request, struct gpu *gpu, bool *unsupported);
/**
 * Lists the devices that `list` selects, as indices of --list-devices. "all" and counts select
 * devices of the type of `gpu` that stream in its modes. `gpu` was created without a name and comes
 * first. Returns the number of devices. Returns 0 if there are fewer than requested, and reports it
 * on stderr.
 */
uint32_t gpu_list_alike(const struct gpu *gpu, const struct device_list *list,
                        uint32_t indices[DEVICE_LIST_MOST]);
/** Resolves modes[0] for a streamer of `texture_count` textures if it was AUTO. Call before using
 * the mode. */
void gpu_choose_mode(struct gpu *gpu, uint32_t texture_count);
/** Accepts a zeroed struct. */
void gpu_destroy(struct gpu *gpu);

/** Prints "what: VK_..." and returns false unless `result` is VK_SUCCESS. */
bool gpu_check(VkResult result, const char *what);

/** Creates a host-visible, coherent buffer. It is cached if `usage` is only a transfer destination.
 * It has an address if `usage` includes SHADER_DEVICE_ADDRESS. */
bool gpu_create_buffer(const struct gpu *gpu, VkDeviceSize size, VkBufferUsageFlags usage,
                       struct gpu_buffer *buffer);
/** Creates a buffer in device memory, not mapped. */
bool gpu_create_device_buffer(const struct gpu *gpu, VkDeviceSize size, VkBufferUsageFlags usage,
                              struct gpu_buffer *buffer);
void gpu_destroy_buffer(const struct gpu *gpu, struct gpu_buffer *buffer);

/** Creates a 2D image with one level in device memory. */
bool gpu_create_image(const struct gpu *gpu, VkFormat format, uint32_t width, uint32_t height,
                      VkSampleCountFlagBits samples, VkImageUsageFlags usage,
                      VkImageAspectFlags aspect, struct gpu_image *image);
/** Creates an image with one sample like gpu_create_image. Views may have either format;
 * `image->view` has the first. */
bool gpu_create_viewed_image(const struct gpu *gpu, const VkFormat formats[2], uint32_t width,
                             uint32_t height, VkImageUsageFlags usage, struct gpu_image *image);
/** Creates a color image with several levels, to copy to and sample. The view shows all levels. */
bool gpu_create_texture(const struct gpu *gpu, VkFormat format, uint32_t width, uint32_t height,
                        uint32_t levels, struct gpu_image *image);
void gpu_destroy_image(const struct gpu *gpu, struct gpu_image *image);

VkShaderModule gpu_create_shader(const struct gpu *gpu, const uint32_t *words, size_t size);
/** Creates a compute pipeline from SPIR-V of `size` bytes. `constants` may be NULL. */
bool gpu_create_compute_pipeline(const struct gpu *gpu, VkPipelineLayout layout,
                                 const uint32_t *words, size_t size,
                                 const VkSpecializationInfo *constants, VkPipeline *pipeline);
/** Creates a compute pipeline with full subgroups, for gpu->neural.matrix. */
bool gpu_create_subgroup_pipeline(const struct gpu *gpu, VkPipelineLayout layout,
                                  const uint32_t *words, size_t size,
                                  const VkSpecializationInfo *constants, VkPipeline *pipeline);

/** Records a barrier for all memory. */
void gpu_barrier(VkCommandBuffer commands, VkPipelineStageFlags from, VkAccessFlags from_access,
                 VkPipelineStageFlags to, VkAccessFlags to_access);

#endif /* TOOLS_COMMON_GPU_H */
