/** Draws the triangles and pictures of the user interface in a render pass. */
#ifndef SLUICE_VIEW_UI_DRAW_H
#define SLUICE_VIEW_UI_DRAW_H

#include "ui_geometry.h"

#include "../common/gpu.h"
#include "../common/target.h"

#define UI_DRAW_SLOTS 2 ///< frames in flight

struct ui_draw_slot {
    struct gpu_buffer vertices, indices;
    VkDescriptorSet sets[UI_TEXTURE_COUNT];
};

struct ui_drawing {
    const struct gpu *gpu; ///< borrowed
    VkSampler sampler;
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    VkDescriptorPool pool;
    struct gpu_image font;
    struct ui_draw_slot slots[UI_DRAW_SLOTS];
};

/** Creates a drawing. `target`: any target with one sample; render passes of all targets are
 *  compatible. `font`: RGBA texels. False, with a line on stderr, on failure. */
bool ui_drawing_create(const struct gpu *gpu, const struct target *target, const uint8_t *font,
                       uint32_t font_width, uint32_t font_height, struct ui_drawing *drawing);
/** Destroys the drawing. No frame may be in flight. A zeroed struct is allowed. */
void ui_drawing_destroy(struct ui_drawing *drawing);

/** Copies the geometry and views into a slot whose frame is complete. `views`: views from
 *  UI_TEXTURE_PICTURE on; VK_NULL_HANDLE draws the font instead. Their images must be in
 *  SHADER_READ_ONLY_OPTIMAL when they are drawn. */
bool ui_drawing_prepare(struct ui_drawing *drawing, uint32_t slot,
                        const struct ui_geometry *geometry, const VkImageView *views);
/** Records the draws of a slot. Call within the render pass. */
void ui_drawing_record(const struct ui_drawing *drawing, uint32_t slot,
                       const struct ui_geometry *geometry, VkCommandBuffer commands);

#endif /* SLUICE_VIEW_UI_DRAW_H */
