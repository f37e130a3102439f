/** The two passes over the room: pipelines, sets and buffers. Nothing here is special to Sluice but
 *  the set layouts. */
#ifndef SAMPLES_SHARED_PASSES_H
#define SAMPLES_SHARED_PASSES_H

#include "../../tools/common/target.h"

#include <sluice/demand.h>

#define SURFACES 4
#define TEXTURES 3

/* Push constants, as in room.glsl. */
struct draw {
    uint32_t surface, table_index, width, height;
    uint32_t textures[SURFACES];
};

struct passes {
    const struct gpu *gpu;
    struct target target;
    struct gpu_buffer picture, reflections; ///< RGBA bytes; alpha of the latter is its weight
    VkSampler sampler;
    VkDescriptorSetLayout texture_layout, buffer_layout;
    VkDescriptorPool pool;
    VkDescriptorSet texture_sets[TEXTURES], buffer_set;
    VkPipelineLayout room_layout, reflections_layout;
    VkPipeline room, reflections_pipeline;
    VkCommandBuffer commands[2]; ///< of the frame, of the launch
};

bool passes_create(struct passes *p, const struct gpu *gpu, uint32_t width, uint32_t height,
                   VkDescriptorSetLayout streamer_layout, VkDescriptorSetLayout loader_layout);
void passes_destroy(struct passes *p);
/** The image that set 1 of a texture shows. */
void passes_set_image(struct passes *p, uint32_t texture, VkImageView view);

/** The room, into `picture`. `tables`: of the textures. */
void passes_record_room(const struct passes *p, VkDescriptorSet set,
                        const uint32_t tables[TEXTURES]);
/** What the floor reflects, into `reflections`. `ids`: shaders' part of the demand textures. */
void passes_record_reflections(const struct passes *p, VkDescriptorSet set,
                               const uint32_t ids[TEXTURES]);

#endif /* SAMPLES_SHARED_PASSES_H */
