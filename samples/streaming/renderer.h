/** How the room is drawn: pipelines, samplers, vertices; knows textures only as descriptor sets. */
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
    VkShaderModule vertex;                     ///< of all pipelines
    VkPipeline pipelines[RENDERER_PASS_COUNT]; ///< the last three only where asked for
    VkSampler clamp, repeat;                   ///< as drawn
    VkSampler probe_clamp, probe_repeat;       ///< nearest between levels, for the counting pass
    struct gpu_buffer vertices, lights;
};

/** What a surface is drawn with. */
struct renderer_surface {
    VkDescriptorSet textures;
    uint32_t color_index, relief_index; ///< in the texture table
    bool relief_feedback;               ///< writes feedback of its own
    float exposure, relief_scale;
    bool gray, painted;
    bool hdr;     ///< decoded, and values may be above 1
    bool missing; ///< left out: drawn like a plain part
    bool decoded; ///< by the shader, of a neural set; plain but in RENDERER_SURFACE
};

struct renderer_request {
    const struct room *room;     ///< must outlive the renderer
    const struct target *target; ///< compatible with those drawn to
    VkDescriptorSetLayout streamer_layout;
    VkDescriptorSetLayout neural_layout; ///< of set 3; VK_NULL_HANDLE: nothing is decoded
    const uint32_t *neural_words;        ///< SPIR-V of RENDERER_NEURAL
    size_t neural_size;                  ///< bytes
    uint32_t anisotropy;
    bool counting, needs; ///< create the pipelines of these passes, too
    bool paged;           ///< shaders for paged residency
};

/** Sets of a frame. Set 1 has the textures of a surface and is bound for each surface. */
struct renderer_sets {
    VkDescriptorSet streamer; ///< set 0; the streamer's for this frame
    VkDescriptorSet frame;    ///< set 2; of `frame_layout`
    VkDescriptorSet neural;   ///< set 3; VK_NULL_HANDLE: nothing is decoded
};

bool renderer_create(const struct gpu *gpu, const struct renderer_request *request,
                     struct renderer *renderer);
/** A zeroed struct is fine. */
void renderer_destroy(struct renderer *renderer);

/** Descriptors of set 2. Buffers that no pass with this set uses may be any. */
void renderer_write_frame_set(const struct renderer *renderer, VkDescriptorSet set, VkBuffer frame,
                              VkBuffer counts, VkBuffer required);
/** Descriptors of set 1; without a relief, pass the color's view twice. */
void renderer_write_texture_set(const struct renderer *renderer, VkDescriptorSet set,
                                VkImageView color, VkImageView relief, bool repeat);

/**
 * A pipeline of the room's vertices. Without a `fragment` shader it writes depth alone. `target` is
 * of the pass and the samples that are drawn to.
 */
bool renderer_create_pipeline(const struct renderer *renderer, const struct target *target,
                              VkShaderModule fragment, bool writes_color, VkPipeline *pipeline);
/** What a part is drawn with; NULL if it has no streamed texture. */
const struct renderer_surface *renderer_surface_of(const struct room_part *part,
                                                   const struct renderer_surface *surfaces);

/** Binds vertices and sets. Done by renderer_draw. */
void renderer_bind(const struct renderer *renderer, VkCommandBuffer commands,
                   const struct renderer_sets *sets);

/** `surfaces`: floor, wall, then one per picture; `pass` is how they are drawn. Inside a render
 * pass. */
void renderer_draw(const struct renderer *renderer, VkCommandBuffer commands,
                   const struct renderer_sets *sets, const struct renderer_surface *surfaces,
                   enum renderer_pass pass);

#endif /* SAMPLES_STREAMING_RENDERER_H */
