/** A picture to render into, with depth and optional multisampling, that can be copied out. */
#ifndef TOOLS_COMMON_TARGET_H
#define TOOLS_COMMON_TARGET_H

#include "gpu.h"

#define TARGET_FORMAT VK_FORMAT_R8G8B8A8_UNORM

struct target {
    uint32_t width, height;
    VkSampleCountFlagBits samples;
    struct gpu_image color;        ///< what is copied out
    struct gpu_image multisampled; ///< only with more than one sample
    struct gpu_image depth;
    VkImageView encoding; ///< of `color`, as sRGB: only of target_create_encoding
    VkRenderPass pass;
    VkFramebuffer framebuffer;
};

/** As many samples as asked for, or the next lower number that the device has. */
bool target_create(const struct gpu *gpu, uint32_t width, uint32_t height, uint32_t samples,
                   struct target *target);
/** A target of one sample that shaders and blending give linear light, the color to clear with
 *  included. Memory holds sRGB: `color` shows and copies encoded values. */
bool target_create_encoding(const struct gpu *gpu, uint32_t width, uint32_t height,
                            struct target *target);
/** A zeroed struct is fine. */
void target_destroy(const struct gpu *gpu, struct target *target);

/** Begins the render pass, clears, and sets viewport and scissor. */
void target_begin(const struct target *target, VkCommandBuffer commands, const float clear[4]);
/** Ends the render pass; the picture can be copied out after it. */
void target_end(const struct target *target, VkCommandBuffer commands);
/** Records the copy to a host buffer of width * height * 4 bytes, and makes it visible there. */
void target_copy_out(const struct target *target, VkCommandBuffer commands, VkBuffer buffer);

#endif /* TOOLS_COMMON_TARGET_H */
