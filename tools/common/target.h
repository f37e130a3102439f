/** A picture to render to, with depth and optional multisampling, that can be copied out. */
#ifndef TOOLS_COMMON_TARGET_H
#define TOOLS_COMMON_TARGET_H

#include "gpu.h"

#define TARGET_FORMAT VK_FORMAT_R8G8B8A8_UNORM

struct target {
    uint32_t width, height;
    VkSampleCountFlagBits samples;
    struct gpu_image color;        ///< image that is copied out
    struct gpu_image multisampled; ///< exists only with more than one sample
    struct gpu_image depth;
    VkImageView encoding; ///< view of `color` as sRGB; only from target_create_encoding
    VkRenderPass pass;
    VkFramebuffer framebuffer;
};

/** Creates a target. Uses the largest sample count of the device that is at most `samples`. */
bool target_create(const struct gpu *gpu, uint32_t width, uint32_t height, uint32_t samples,
                   struct target *target);
/** Creates a target of one sample with sRGB encoding on writes. Shaders, blending and the clear
 * color use linear light. `color` shows and copies encoded values. */
bool target_create_encoding(const struct gpu *gpu, uint32_t width, uint32_t height,
                            struct target *target);
/** Accepts a zeroed struct. */
void target_destroy(const struct gpu *gpu, struct target *target);

/** Begins the render pass, clears, and sets viewport and scissor. */
void target_begin(const struct target *target, VkCommandBuffer commands, const float clear[4]);
/** Ends the render pass. The picture can be copied out afterwards. */
void target_end(const struct target *target, VkCommandBuffer commands);
/** Records a copy to a host buffer of width * height * 4 bytes, and makes it visible to the
 * host. */
void target_copy_out(const struct target *target, VkCommandBuffer commands, VkBuffer buffer);

#endif /* TOOLS_COMMON_TARGET_H */
