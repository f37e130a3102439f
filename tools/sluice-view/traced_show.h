/** Shows a film in a picture for the window. */
#ifndef SLUICE_VIEW_TRACED_SHOW_H
#define SLUICE_VIEW_TRACED_SHOW_H

#include "../../samples/common/film.h"

/** Zeroed is empty. */
struct traced_show {
    const struct gpu *gpu; ///< borrowed
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    VkDescriptorPool pool;
    VkDescriptorSet set;
    struct gpu_image image; ///< in SHADER_READ_ONLY_OPTIMAL once it was drawn
    bool drawn;
    /* As the shader has them. */
    uint32_t width, height;
    float scale, tint;
    uint32_t marks;
};

/** Says on stderr why it failed. */
bool traced_show_create(const struct gpu *gpu, struct traced_show *show);
void traced_show_destroy(struct traced_show *show);
/** A picture for a film. No frame that reads the last one is under way. */
bool traced_show_fit(struct traced_show *show, const struct film *film);
/** Draws the film, of which no launch is under way, and waits for it. Frames that read the picture
 *  may be under way. `scale`: of the light; `tint`: how strong the marks of view 3 are; 0: none. */
bool traced_show_draw(struct traced_show *show, float scale, float tint);

#endif /* SLUICE_VIEW_TRACED_SHOW_H */
