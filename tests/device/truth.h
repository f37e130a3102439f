/** Asks a device's sampler which tiles of a texture it reads, see shaders/truth.glsl. */
#ifndef TESTS_DEVICE_TRUTH_H
#define TESTS_DEVICE_TRUTH_H

#include "device/conform.h"
#include "device/oracle.h"

#include "truth_shared.h"

struct truth {
    struct harness *h;
    struct harness_buffer inputs, touched;
    struct conform_set set;
    VkRenderPass pass;
    VkFramebuffer framebuffer;
    VkPipeline pipelines[CONFORM_STAGE_COUNT];
    VkImage image;
    VkDeviceMemory memory;
    VkImageView view;
    VkSampler sampler;
    uint32_t layer_count;
};

/** A texture of this size, whose tiles are the regions, all of it resident. */
void truth_init(struct truth *t, struct harness *h, const struct SluiceTextureEntry *entry);
void truth_finish(struct truth *t);

/** Address modes as the entry has them; anisotropy 1: none. */
void truth_set_sampler(struct truth *t, const struct SluiceTextureEntry *entry, bool nearest,
                       bool nearest_mip, float anisotropy);

/** Samples; with CONFORM_STAGE_FRAGMENT implicitly. At most CONFORM_CAPACITY. */
void truth_run(struct truth *t, enum conform_stage stage, const struct conform_sample *samples,
               uint32_t count);

/** Adds the tiles that sample `at` of the last run touched; `tiles` is of the same entry. */
void truth_add(const struct truth *t, uint32_t at, struct oracle_tiles *tiles);

#endif /* TESTS_DEVICE_TRUTH_H */
