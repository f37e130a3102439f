/** Draws the room: pipelines, samplers, vertices. Knows textures only as descriptor sets. */
#ifndef SAMPLES_STREAMING_RENDERER_H
#define SAMPLES_STREAMING_RENDERER_H

#include "../../tools/common/gpu.h"
#include "../../tools/common/target.h"
#include "room.h"
#include "walk.h"

enum renderer_pass {
    RENDERER_PLAIN,
    RENDERER_SURFACE,
    RENDERER_NEURAL,
    RENDERER_COUNT,
    RENDERER_NEEDS,
    RENDERER_PASS_COUNT
};

struct renderer {
    const struct gpu *gpu;   ///< borrowed
    const struct room *room; ///< borrowed
    VkDescriptorSetLayout frame_layout, texture_layout;
    VkPipelineLayout pipeline_layout;
    VkShaderModule vertex;                     ///< vertex shader of all pipelines
    VkPipeline pipelines[RENDERER_PASS_COUNT]; ///< the last three exist only if requested
    VkSampler clamp, repeat;                   ///< samplers of the drawing pass
    VkSampler probe_clamp, probe_repeat; ///< samplers of the counting pass; nearest between levels
    struct gpu_buffer vertices, lights;
};

/** Textures and parameters of a surface. */
struct renderer_surface {
    VkDescriptorSet textures;
    uint32_t color_index, relief_index; ///< in the texture table
    bool relief_feedback;               ///< true: the relief writes feedback of its own
    float exposure, relief_scale;
    bool gray, painted;
    bool hdr;     ///< true: decoded, with values above 1
    bool missing; ///< true: left out; drawn like a plain part
    bool decoded; ///< true: decoded by the shader; plain except in RENDERER_SURFACE
};

struct renderer_request {
    const struct room *room;     ///< must outlive the renderer
    const struct target *target; ///< compatible with the targets that are drawn to
    VkDescriptorSetLayout streamer_layout;
    VkDescriptorSetLayout neural_layout; ///< layout of set 3; VK_NULL_HANDLE: nothing is decoded
    const uint32_t *neural_words;        ///< SPIR-V of RENDERER_NEURAL
    size_t neural_size;                  ///< bytes
    uint32_t anisotropy;
    bool counting, needs; ///< also create the pipelines of these passes
    bool paged;           ///< shaders for paged residency
};

/** Sets of a frame. Set 1, a surface's textures, is bound per surface. */
struct renderer_sets {
    VkDescriptorSet streamer; ///< set 0; the streamer's set for this frame
    VkDescriptorSet frame;    ///< set 2; of `frame_layout`
    VkDescriptorSet neural;   ///< set 3; VK_NULL_HANDLE: nothing is decoded
};

bool renderer_create(const struct gpu *gpu, const struct renderer_request *request,
                     struct renderer *renderer);
/** Accepts a zeroed struct. */
void renderer_destroy(struct renderer *renderer);

/** Writes set 2. Pass any buffer for bindings that no pass with this set uses. */
void renderer_write_frame_set(const struct renderer *renderer, VkDescriptorSet set, VkBuffer frame,
                              VkBuffer counts, VkBuffer required);
/** Writes set 1. Without a relief, pass the color's view twice. */
void renderer_write_texture_set(const struct renderer *renderer, VkDescriptorSet set,
                                VkImageView color, VkImageView relief, bool repeat);

/**
 * Creates a pipeline for the room's vertices. Without a `fragment` shader it writes depth only.
 * `target`: target of the pass, with the sample count to draw with.
 */
bool renderer_create_pipeline(const struct renderer *renderer, const struct target *target,
                              VkShaderModule fragment, bool writes_color, VkPipeline *pipeline);
/** Returns the surface of a part. Returns NULL if it has no streamed texture. */
const struct renderer_surface *renderer_surface_of(const struct room_part *part,
                                                   const struct renderer_surface *surfaces);

/** Binds vertices and sets. renderer_draw calls it. */
void renderer_bind(const struct renderer *renderer, VkCommandBuffer commands,
                   const struct renderer_sets *sets);

/** Draws inside a render pass. `surfaces`: floor, wall, then one per picture. `pass`: selects the
 * pipeline. */
void renderer_draw(const struct renderer *renderer, VkCommandBuffer commands,
                   const struct renderer_sets *sets, const struct renderer_surface *surfaces,
                   enum renderer_pass pass);

#endif /* SAMPLES_STREAMING_RENDERER_H */
