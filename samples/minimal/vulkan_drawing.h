/** Pipeline, descriptors, commands and submissions: what any renderer has, kept out of minimal.c.
 */
#ifndef SAMPLES_MINIMAL_VULKAN_DRAWING_H
#define SAMPLES_MINIMAL_VULKAN_DRAWING_H

#include "vulkan_setup.h"

#define PAGE_CHUNKS 8 /* as room.frag has it */

/** Everything around the two shaders, and the picture that they draw. */
struct drawing {
    struct picture picture;
    VkDescriptorSetLayout set_layouts[2]; ///< as room.frag has them
    VkDescriptorPool set_pool;
    VkSampler sampler;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    VkCommandPool command_pool;
};

/** What a draw needs of a texture. */
struct drawn_texture {
    VkDescriptorSet set; ///< 1 of room.frag
    uint32_t table_index;
};

/** `size`: width and height in pixels. `paged` is the fragment shader's constant 0. */
void create_drawing(const struct gpu *gpu, const uint32_t size[2], bool paged,
                    struct drawing *drawing);
/** With the picture, all sets and all commands. */
void destroy_drawing(const struct gpu *gpu, const struct drawing *drawing);

/** `index`: of the set in room.frag. */
VkDescriptorSet allocate_set(const struct gpu *gpu, const struct drawing *drawing, uint32_t index);
/** Storage buffers, from binding 0 on. */
void write_buffers(const struct gpu *gpu, VkDescriptorSet set, uint32_t count,
                   const VkBuffer *buffers);
/** Array elements of one binding, in VK_IMAGE_LAYOUT_GENERAL, all with one sampler. */
void write_images(const struct gpu *gpu, VkDescriptorSet set, uint32_t binding, uint32_t count,
                  const VkImageView *views, VkSampler sampler);

VkCommandBuffer allocate_commands(const struct gpu *gpu, const struct drawing *drawing);
void begin_commands(VkCommandBuffer commands);
/** Records a render pass of one draw per surface of corridor.h: binds both sets and pushes the
 *  texture's place in the table, the number of the frame and where the eye is. */
void draw_corridor(VkCommandBuffer commands, const struct drawing *drawing, VkDescriptorSet set,
                   const struct drawn_texture *textures, uint32_t frame, float eye_z);
/** Ends and submits the commands, which signal the timeline semaphore with this value. */
void submit(const struct gpu *gpu, VkCommandBuffer commands, VkSemaphore semaphore, uint64_t value);
/** Waits for a timeline semaphore; not for VK_NULL_HANDLE. */
void wait_for(const struct gpu *gpu, VkSemaphore semaphore, uint64_t value);

#endif /* SAMPLES_MINIMAL_VULKAN_DRAWING_H */
