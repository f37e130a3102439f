/** The pictures of a stage: buffers of triangles, pipeline and targets. */
#ifndef SLUICE_VIEW_STAGE_DRAW_H
#define SLUICE_VIEW_STAGE_DRAW_H

#include "frames.h"
#include "scene_data.h"
#include "stage.h"

struct stage_drawing {
    const struct gpu *gpu; ///< borrowed
    struct gpu_buffer vertices, indices;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    struct target targets[FRAMES_SLOTS]; ///< one for each frame in flight
};

/** `set_layout`: the streamer's. Says on stderr what failed. */
bool stage_drawing_create(const struct gpu *gpu, const struct scene_data *scene,
                          VkDescriptorSetLayout set_layout, bool paged,
                          struct stage_drawing *drawing);
/** No frame may be in flight. A zeroed struct is fine. */
void stage_drawing_destroy(struct stage_drawing *drawing);
/** Records the picture into the slot's target, whose view it returns in SHADER_READ_ONLY_OPTIMAL.
 *  `table_indices`: of the images. VK_NULL_HANDLE if that failed. */
VkImageView stage_drawing_record(struct stage_drawing *drawing, const struct scene_data *scene,
                                 const struct stage_draw *draw, const uint32_t *table_indices,
                                 VkDescriptorSet set, uint32_t slot, VkCommandBuffer commands);

#endif /* SLUICE_VIEW_STAGE_DRAW_H */
