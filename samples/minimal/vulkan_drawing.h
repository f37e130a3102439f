/** Pipeline, commands and submissions, which any renderer has. */
#ifndef SAMPLES_MINIMAL_VULKAN_DRAWING_H
#define SAMPLES_MINIMAL_VULKAN_DRAWING_H

#include "vulkan_setup.h"

/** Objects of the two shaders' pipeline, and the picture that they draw. */
struct drawing {
    struct picture picture;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    VkCommandPool command_pool;
};

/** `size`: width and height in pixels. `set_layout`: layout of set 0 of room.frag. `paged`: value
 * of its constant 0. */
void create_drawing(const struct gpu *gpu, const uint32_t size[2], VkDescriptorSetLayout set_layout,
                    bool paged, struct drawing *drawing);
/** Destroys also the picture and all commands. */
void destroy_drawing(const struct gpu *gpu, const struct drawing *drawing);

VkCommandBuffer allocate_commands(const struct gpu *gpu, const struct drawing *drawing);
void begin_commands(VkCommandBuffer commands);
/** Records a render pass with one draw per surface of corridor.h. Binds the set and pushes the
 * texture's index, the frame's number and the eye's position. */
void draw_corridor(VkCommandBuffer commands, const struct drawing *drawing, VkDescriptorSet set,
                   const uint32_t *table_indices, uint32_t frame, float eye_z);
/** Ends and submits the commands, which signal `value` on the timeline semaphore. */
void submit(const struct gpu *gpu, VkCommandBuffer commands, VkSemaphore semaphore, uint64_t value);
/** Waits for a timeline semaphore. Returns at once for VK_NULL_HANDLE. */
void wait_for(const struct gpu *gpu, VkSemaphore semaphore, uint64_t value);

#endif /* SAMPLES_MINIMAL_VULKAN_DRAWING_H */
