/** Drawing of a stage's pictures: buffers of triangles, pipelines and targets. */
#ifndef SLUICE_VIEW_STAGE_DRAW_H
#define SLUICE_VIEW_STAGE_DRAW_H

#include "scene_data.h"
#include "shader_files.h"
#include "stage.h"
#include "stage_lines.h"
#include "stage_sets.h"
#include "tile_marks.h"

/** Pipelines by enum scene_alpha. The second half shows both sides of triangles. */
#define STAGE_PIPELINES 6

struct stage_drawing {
    const struct gpu *gpu;          ///< borrowed
    const struct tile_marks *marks; ///< borrowed
    struct gpu_buffer vertices, indices;
    struct stage_sets sets;
    VkPipelineLayout layout;
    VkPipeline pipelines[STAGE_PIPELINES]; ///< VK_NULL_HANDLE: no material needs the pipeline
    VkPipeline prepared[STAGE_PIPELINES];  ///< pipelines of other shaders, until taken or dropped
    bool paged;
    struct stage_lines lines;            ///< created by the first frame that shows lines
    struct stage_order *order;           ///< owned; order of the parts that blend
    struct target targets[FRAMES_SLOTS]; ///< one per frame in flight
    struct target ahead[FRAMES_SLOTS];   ///< targets of the predicted camera; empty before use
};

struct stage_drawing_info {
    const uint32_t *table_indices;    ///< index of each image in the texture table
    VkDescriptorSetLayout set_layout; ///< set layout of the streamer
    const struct tile_marks *marks;   ///< must outlive the drawing
    const struct shader_code *code;   ///< SCENE_SHADER_COUNT modules; NULL: shaders of the build
    bool paged;
};

/** Creates a drawing. False, with a line on stderr, on failure. */
bool stage_drawing_create(const struct gpu *gpu, const struct scene_data *scene,
                          const struct stage_drawing_info *info, struct stage_drawing *drawing);
/** Destroys the drawing. No frame may be in flight. A zeroed struct is allowed. */
void stage_drawing_destroy(struct stage_drawing *drawing);
/** Creates pipelines of other shaders with the same interface. False on failure: none are prepared
 *  then. */
bool stage_drawing_prepare(struct stage_drawing *drawing, const struct scene_data *scene,
                           const struct shader_code code[SCENE_SHADER_COUNT]);
/** Draws with the prepared pipelines from now on. No frame may be in flight. */
void stage_drawing_take(struct stage_drawing *drawing);
/** Destroys prepared pipelines, if there are any. */
void stage_drawing_drop(struct stage_drawing *drawing);
/** Records the picture into the target of the slot. Returns a view of the target, in
 *  SHADER_READ_ONLY_OPTIMAL. VK_NULL_HANDLE on failure. */
VkImageView stage_drawing_record(struct stage_drawing *drawing, const struct scene_data *scene,
                                 const struct stage_draw *draw, VkDescriptorSet set, uint32_t slot,
                                 VkCommandBuffer commands);

#endif /* SLUICE_VIEW_STAGE_DRAW_H */
