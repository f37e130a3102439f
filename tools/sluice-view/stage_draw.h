/** The pictures of a stage: buffers of triangles, pipeline and targets. */
#ifndef SLUICE_VIEW_STAGE_DRAW_H
#define SLUICE_VIEW_STAGE_DRAW_H

#include "scene_data.h"
#include "shader_files.h"
#include "stage.h"
#include "stage_lines.h"
#include "stage_sets.h"
#include "tile_marks.h"

/** By enum scene_alpha; the second half shows both sides of triangles. */
#define STAGE_PIPELINES 6

struct stage_drawing {
    const struct gpu *gpu;          ///< borrowed
    const struct tile_marks *marks; ///< borrowed
    struct gpu_buffer vertices, indices;
    struct stage_sets sets;
    VkPipelineLayout layout;
    VkPipeline pipelines[STAGE_PIPELINES]; ///< those that materials need
    VkPipeline prepared[STAGE_PIPELINES];  ///< of other shaders, until they are taken or dropped
    bool paged;
    struct stage_lines lines;            ///< from the first frame on that shows them
    struct stage_order *order;           ///< owned; of the parts that blend
    struct target targets[FRAMES_SLOTS]; ///< one for each frame in flight
    struct target ahead[FRAMES_SLOTS];   ///< of the camera ahead; empty before it is drawn
};

struct stage_drawing_info {
    const uint32_t *table_indices;    ///< of the images
    VkDescriptorSetLayout set_layout; ///< the streamer's
    const struct tile_marks *marks;   ///< outlive the drawing
    const struct shader_code *code;   ///< SCENE_SHADER_COUNT modules; NULL: those of the build
    bool paged;
};

/** Says on stderr what failed. */
bool stage_drawing_create(const struct gpu *gpu, const struct scene_data *scene,
                          const struct stage_drawing_info *info, struct stage_drawing *drawing);
/** No frame may be in flight. A zeroed struct is fine. */
void stage_drawing_destroy(struct stage_drawing *drawing);
/** Creates pipelines of other shaders, with the same interface. False, and none are prepared, if
 *  that failed. */
bool stage_drawing_prepare(struct stage_drawing *drawing, const struct scene_data *scene,
                           const struct shader_code code[SCENE_SHADER_COUNT]);
/** Draws with the pipelines that are prepared. No frame may be in flight. */
void stage_drawing_take(struct stage_drawing *drawing);
/** Destroys the pipelines that are prepared, if there are any. */
void stage_drawing_drop(struct stage_drawing *drawing);
/** Records the picture into the slot's target, whose view it returns in SHADER_READ_ONLY_OPTIMAL.
 *  VK_NULL_HANDLE if that failed. */
VkImageView stage_drawing_record(struct stage_drawing *drawing, const struct scene_data *scene,
                                 const struct stage_draw *draw, VkDescriptorSet set, uint32_t slot,
                                 VkCommandBuffer commands);

#endif /* SLUICE_VIEW_STAGE_DRAW_H */
