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

/** Creates it, or another one if the size differs. Then it waits for the queue, and the image is
 *  empty. Says on stderr what failed. */
bool ui_texels_fit(const struct gpu *gpu, uint32_t width, uint32_t height,
                   struct ui_texels *texels);
/** A zeroed struct is fine. No frame may be in flight. */
void ui_texels_destroy(struct ui_texels *texels);
/** Records the copy to the image if the texels changed, outside a render pass. Do not write the
 *  staging buffer before that frame is complete. */
void ui_texels_record(struct ui_texels *texels, VkCommandBuffer commands);
/** Records the layout of an image `before` a copy of all of its texels, or after it, for shaders of
 *  fragments. */
void ui_texels_record_layout(VkCommandBuffer commands, VkImage image, bool before);

#endif /* SLUICE_VIEW_UI_TEXELS_H */
