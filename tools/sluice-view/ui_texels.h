/** An image that the host fills and the user interface shows. */
#ifndef SLUICE_VIEW_UI_TEXELS_H
#define SLUICE_VIEW_UI_TEXELS_H

#include "../common/gpu.h"

struct ui_texels {
    const struct gpu *gpu; ///< borrowed
    struct gpu_image image;
    struct gpu_buffer staging; ///< RGBA8, tightly packed
    uint32_t width, height;
    bool changed; ///< the staging buffer holds texels that the image lacks
    bool filled;  ///< the image holds texels
};

/** Creates the image. If the size differs, waits for the queue and replaces the image by an empty
 * one. False, with a line on stderr, on failure. */
bool ui_texels_fit(const struct gpu *gpu, uint32_t width, uint32_t height,
                   struct ui_texels *texels);
/** Destroys the image. No frame may be in flight. A zeroed struct is allowed. */
void ui_texels_destroy(struct ui_texels *texels);
/** Records a copy to the image if the texels changed. Call outside a render pass. Do not write the
 *  staging buffer before the frame is complete. */
void ui_texels_record(struct ui_texels *texels, VkCommandBuffer commands);
/** Records a layout transition: `before` a copy of all texels, or after it, for fragment shaders.
 */
void ui_texels_record_layout(VkCommandBuffer commands, VkImage image, bool before);

#endif /* SLUICE_VIEW_UI_TEXELS_H */
