/** Draws the triangles of the user interface, and pictures in it, into a render pass. */
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

/** `target`: any with one sample; its render pass is compatible with all others. RGBA texels of the
 *  font. Says on stderr what failed. */
bool ui_drawing_create(const struct gpu *gpu, const struct target *target, const uint8_t *font,
                       uint32_t font_width, uint32_t font_height, struct ui_drawing *drawing);
/** A zeroed struct is fine. No frame may be in flight. */
void ui_drawing_destroy(struct ui_drawing *drawing);

/** Takes the geometry and the views of UI_TEXTURE_PICTURE and later ones (VK_NULL_HANDLE: the font
 *  instead) into a slot whose frame is complete. The views' images must be in
 *  SHADER_READ_ONLY_OPTIMAL when they are drawn. */
bool ui_drawing_prepare(struct ui_drawing *drawing, uint32_t slot,
                        const struct ui_geometry *geometry, const VkImageView *views);
/** Records the draws of a slot, within the render pass. */
void ui_drawing_record(const struct ui_drawing *drawing, uint32_t slot,
                       const struct ui_geometry *geometry, VkCommandBuffer commands);

#endif /* SLUICE_VIEW_UI_DRAW_H */
