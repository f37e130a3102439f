/** Pass that shows the texture, in a compute shader. */
#ifndef SAMPLES_VIRTUAL_TEXTURE_VIEWER_H
#define SAMPLES_VIRTUAL_TEXTURE_VIEWER_H

#include "../../tools/common/gpu.h"
#include "fractal_shared.h"

struct viewer {
    const struct gpu *gpu; ///< NULL: not created
    uint32_t width, height;
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    VkDescriptorPool pool;
    VkDescriptorSet set;
    struct gpu_buffer pixels, counts;
    VkCommandBuffer commands;
};

/** `streamer_layout` is the layout of the streamer's descriptor sets. */
bool viewer_create(struct viewer *viewer, const struct gpu *gpu, uint32_t width, uint32_t height,
                   VkDescriptorSetLayout streamer_layout);
void viewer_destroy(struct viewer *viewer);

void viewer_record(const struct viewer *viewer, VkDescriptorSet frame_set,
                   const struct FractalView *view);

/** Returns the counts of the last frame that compared. */
static inline struct FractalCounts *viewer_counts(const struct viewer *viewer)
{
    return (struct FractalCounts *)viewer->counts.mapped;
}

#endif /* SAMPLES_VIRTUAL_TEXTURE_VIEWER_H */
