/**
 * Runs feedback.glsl on samples that have a map each, in buffers laid out by hand. Without a
 * streamer, tests can use any texture and region size, and every mark belongs to a known sample.
 */
#ifndef TESTS_DEVICE_CONFORM_H
#define TESTS_DEVICE_CONFORM_H

#include "device/harness.h"

#include <sluice/shared/texture_table.h>

#include "conform_shared.h"

/* Guard words around and between the maps. */
#define CONFORM_GUARD_COUNT 4u
#define CONFORM_GUARD UINT32_MAX
#define CONFORM_WORDS (1u << 20)

enum conform_stage {
    CONFORM_STAGE_COMPUTE,
    CONFORM_STAGE_FRAGMENT,
    CONFORM_STAGE_COUNT,
};

struct conform_sample {
    struct SluiceTextureEntry entry; ///< conform_run sets the offsets
    struct ConformInput in;          ///< conform_run sets tableIndex
};

/** Storage buffers, then textures with samplers, for compute and fragment shaders. */
struct conform_set {
    VkDescriptorSetLayout set_layout;
    VkPipelineLayout layout;
    VkDescriptorPool pool;
    VkDescriptorSet set;
};

/** A dispatch of groups of 64, or a draw of a quad per sample. */
struct conform_job {
    const struct conform_set *set;
    enum conform_stage stage;
    VkPipeline pipeline;
    VkRenderPass pass;
    VkFramebuffer framebuffer;
    uint32_t count;
    const void *push;
    uint32_t push_size;
};

struct conform {
    struct harness *h;
    struct harness_buffer table, feedback, inputs;
    struct conform_set set;
    VkRenderPass pass;
    VkFramebuffer framebuffer;
    VkPipeline pipelines[CONFORM_STAGE_COUNT];
    float subtexel; ///< half a step of the device's fixed-point coordinates, in texels
};

void conform_init(struct conform *c, struct harness *h);
void conform_finish(struct conform *c);

VkShaderModule conform_module(struct harness *h, const uint32_t *code, size_t size);
/** Creates the vertex shader of a triangle that covers the whole target. */
VkShaderModule conform_vertex_module(struct harness *h);
void conform_create_set(struct harness *h, uint32_t buffer_count, uint32_t texture_count,
                        uint32_t push_size, struct conform_set *set);
void conform_destroy_set(struct harness *h, struct conform_set *set);
void conform_write_buffers(struct harness *h, const struct conform_set *set, uint32_t count,
                           const struct harness_buffer *const *buffers);
/** Creates a target without attachments: fragments only write to buffers. */
void conform_create_target(struct harness *h, VkRenderPass *pass, VkFramebuffer *framebuffer);
void conform_record(struct harness *h, VkCommandBuffer commands, const struct conform_job *job);
void conform_run_job(struct harness *h, const struct conform_job *job);

/** Consumes the module, as does the next function. `constants` may be NULL. */
VkPipeline conform_compute_pipeline(struct harness *h, VkPipelineLayout layout,
                                    VkShaderModule compute, const VkSpecializationInfo *constants);
/** Creates a compute pipeline with full subgroups. Requires computeFullSubgroups. */
VkPipeline conform_subgroup_pipeline(struct harness *h, VkPipelineLayout layout,
                                     VkShaderModule compute, const VkSpecializationInfo *constants);

/** Creates a pipeline for a target of CONFORM_TARGET_SIZE. */
VkPipeline conform_graphics_pipeline(struct harness *h, VkPipelineLayout layout, VkRenderPass pass,
                                     VkShaderModule vertex, VkShaderModule fragment,
                                     uint32_t attachment_count);

/** Describes a texture with all levels, none of them packed. `mode`: both address modes. */
struct SluiceTextureEntry conform_entry(uint32_t width, uint32_t height, uint32_t region_width,
                                        uint32_t region_height, uint32_t mode);

/**
 * Writes the feedback of samples[0, return value), and calls `check` for each with its map, row by
 * row. Returns less than `count` if no more maps fit. Fails the test if a guard word around a map
 * changed.
 */
uint32_t conform_run(struct conform *c, enum conform_stage stage, struct conform_sample *samples,
                     uint32_t count,
                     void (*check)(void *user, const struct conform_sample *sample,
                                   const uint32_t *map),
                     void *user);

#endif /* TESTS_DEVICE_CONFORM_H */
