/** What any Vulkan program needs and nothing of which is about streaming, kept out of minimal.c. */
#ifndef SAMPLES_MINIMAL_VULKAN_SETUP_H
#define SAMPLES_MINIMAL_VULKAN_SETUP_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <vulkan/vulkan.h>

/** Ends the program with "`what` failed: `why`" unless `good`. */
void check(bool good, const char *what, const char *why);
/** Ends the program unless the call succeeds. */
#define VK(call) check((call) == VK_SUCCESS, #call, "see the Vulkan specification")

#define PAGE_CHUNKS 8 /* as room.frag has it */

struct gpu {
    VkInstance instance;
    VkPhysicalDevice physical_device;
    VkDevice device;
    uint32_t family, sparse_family; ///< may be the same
    VkQueue queue, sparse_queue;
};

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

/** Everything around the two shaders. Set 0: buffers and pages; set 1: the texture of a draw. */
struct drawing {
    VkDescriptorSetLayout set_layouts[2];
    VkDescriptorPool set_pool;
    VkSampler sampler;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    VkCommandPool command_pool;
};

/** Creates the instance; returns how many devices there are, 16 at most. */
uint32_t find_devices(struct gpu *gpu, VkPhysicalDevice devices[16]);
/** The first family with all of `flags`, or UINT32_MAX. */
uint32_t find_queue_family(VkPhysicalDevice physical_device, VkQueueFlags flags);
/** With a queue of each family. */
void open_device(struct gpu *gpu, const VkPhysicalDeviceFeatures2 *features);
void close_device(const struct gpu *gpu);

void create_picture(const struct gpu *gpu, uint32_t width, uint32_t height,
                    struct picture *picture);
void destroy_picture(const struct gpu *gpu, const struct picture *picture);
/** Records a copy to `texels`, which the host may read when the commands have completed. */
void copy_picture(VkCommandBuffer commands, const struct picture *picture);

/** `paged` is the fragment shader's constant 0; the first `constant_size` bytes are pushed. */
void create_drawing(const struct gpu *gpu, const struct picture *target, bool paged,
                    uint32_t constant_size, struct drawing *drawing);
void destroy_drawing(const struct gpu *gpu, const struct drawing *drawing);
VkDescriptorSet allocate_set(const struct gpu *gpu, const struct drawing *drawing, uint32_t index);
VkCommandBuffer allocate_commands(const struct gpu *gpu, const struct drawing *drawing);
/** From binding 0 on. */
void write_buffers(const struct gpu *gpu, VkDescriptorSet set, uint32_t count,
                   const VkBuffer *buffers);
/** Array elements of one binding, in VK_IMAGE_LAYOUT_GENERAL, all with one sampler. */
void write_images(const struct gpu *gpu, VkDescriptorSet set, uint32_t binding, uint32_t count,
                  const VkImageView *views, VkSampler sampler);
/** Begins the render pass and binds the pipeline. */
void begin_drawing(VkCommandBuffer commands, const struct drawing *drawing,
                   const struct picture *target);

#endif /* SAMPLES_MINIMAL_VULKAN_SETUP_H */
