/** Pipeline, commands and submissions: what any renderer has, kept out of minimal.c. */
#ifndef SAMPLES_MINIMAL_VULKAN_DRAWING_H
#define SAMPLES_MINIMAL_VULKAN_DRAWING_H

#include "vulkan_setup.h"

/** Everything around the two shaders, and the picture that they draw. */
struct drawing {
    struct picture picture;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    VkCommandPool command_pool;
};

/** `size`: width and height in pixels. `set_layout` is set 0 of room.frag, `paged` its constant 0.
 */
void create_drawing(const struct gpu *gpu, const uint32_t size[2], VkDescriptorSetLayout set_layout,
                    bool paged, struct drawing *drawing);
/** With the picture and all commands. */
void destroy_drawing(const struct gpu *gpu, const struct drawing *drawing);

VkCommandBuffer allocate_commands(const struct gpu *gpu, const struct drawing *drawing);
void begin_commands(VkCommandBuffer commands);
/** Records a render pass of one draw per surface of corridor.h: binds the set and pushes the index
 * of the texture, the number of the frame and where the eye is. */
void draw_corridor(VkCommandBuffer commands, const struct drawing *drawing, VkDescriptorSet set,
                   const uint32_t *table_indices, uint32_t frame, float eye_z);
/** Ends and submits the commands, which signal the timeline semaphore with this value. */
void submit(const struct gpu *gpu, VkCommandBuffer commands, VkSemaphore semaphore, uint64_t value);
/** Waits for a timeline semaphore; not for VK_NULL_HANDLE. */
void wait_for(const struct gpu *gpu, VkSemaphore semaphore, uint64_t value);

#endif /* SAMPLES_MINIMAL_VULKAN_DRAWING_H */
