/** The two passes over the room: pipelines, sets and buffers. Only the set layouts come from
 * Sluice. */
#ifndef SAMPLES_SHARED_PASSES_H
#define SAMPLES_SHARED_PASSES_H

#include "../../tools/common/target.h"

#include <sluice/demand.h>

#define SURFACES 4
#define TEXTURES 3

/* Push constants; the layout equals room.glsl. */
struct draw {
    uint32_t surface, table_index, width, height;
    uint32_t textures[SURFACES];
};

struct passes {
    const struct gpu *gpu;
    struct target target;
    struct gpu_buffer picture, reflections; ///< RGBA bytes; alpha of `reflections` is their weight
    VkSampler sampler;
    VkDescriptorSetLayout texture_layout, buffer_layout;
    VkDescriptorPool pool;
    VkDescriptorSet texture_sets[TEXTURES], buffer_set;
    VkPipelineLayout room_layout, reflections_layout;
    VkPipeline room, reflections_pipeline;
    VkCommandBuffer commands[2]; ///< 0: frame; 1: launch
};

bool passes_create(struct passes *p, const struct gpu *gpu, uint32_t width, uint32_t height,
                   VkDescriptorSetLayout streamer_layout, VkDescriptorSetLayout loader_layout);
void passes_destroy(struct passes *p);
/** Sets the image in set 1 of a texture. */
void passes_set_image(struct passes *p, uint32_t texture, VkImageView view);

/** Draws the room into `picture`. `tables`: texture table indices. */
void passes_record_room(const struct passes *p, VkDescriptorSet set,
                        const uint32_t tables[TEXTURES]);
/** Traces the floor's reflections into `reflections`. `ids`: shaders' ids of the demand
 * textures. */
void passes_record_reflections(const struct passes *p, VkDescriptorSet set,
                               const uint32_t ids[TEXTURES]);

#endif /* SAMPLES_SHARED_PASSES_H */
