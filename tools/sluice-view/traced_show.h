/** Draws a film into a picture for the window. */
#ifndef SLUICE_VIEW_TRACED_SHOW_H
#define SLUICE_VIEW_TRACED_SHOW_H

#include "traced_tiles.h"
#include "traced_view.h"

/** Parameters of the picture of a film. */
struct traced_look {
    float scale, tint;      ///< factor of the light; strength of view colors, 0 to 1
    uint32_t view;          ///< enum view_number
    uint32_t launch;        ///< last launch that traced rays; 0: none in this frame
    bool is_short;          ///< the loader has a LOD bias
    uint32_t picture_count; ///< textures that `pictures` has words for
};

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
    VkBuffer sums, latest, probes, views; ///< borrowed
    struct gpu_buffer tiles, pictures;    ///< mapped; see traced_show.comp
    uint32_t tile_room;                   ///< entries of `tiles`
    uint32_t width, height;
    struct traced_look look; ///< parameters of the last picture
    uint32_t tile_mask;
};

/** False, with a line on stderr, on failure. */
bool traced_show_create(const struct gpu *gpu, struct traced_show *show);
void traced_show_destroy(struct traced_show *show);
/** Creates a picture as large as a film. No frame that reads the last picture may be in flight. */
bool traced_show_fit(struct traced_show *show, const struct film *film,
                     const struct traced_view *view);
/** Keeps the load times of tiles for view 5. False without memory. */
bool traced_show_keep_tiles(struct traced_show *show, const struct traced_tiles *tiles,
                            uint64_t now);
/** Returns one word per texture index of the loader, for view 6: 1 + picture << 1, | 1 if a side is
 *  not a power of two. NULL without memory. */
uint32_t *traced_show_pictures(struct traced_show *show, uint32_t count);
/** Draws the film, and waits. No launch of the film may be in flight. Frames that read the picture
 *  may be. */
bool traced_show_draw(struct traced_show *show, const struct traced_look *look);
/** Records a copy of the picture into `buffer`, for the host. */
void traced_show_copy(const struct traced_show *show, VkCommandBuffer commands, VkBuffer buffer);

#endif /* SLUICE_VIEW_TRACED_SHOW_H */
