/**
 * Samples streamed textures in a compute shader at given positions, and writes their feedback.
 * Checks each sample with residency codes if the device has them.
 */
#ifndef TESTS_DEVICE_PROBE_H
#define TESTS_DEVICE_PROBE_H

#include "device/harness.h"

#include <sluice/shared/texture_table.h>

#include "probe_shared.h"

#define PROBE_CAPACITY 16384u
#define PROBE_MAX_TEXTURES 64u
#define PROBE_MAX_SAMPLERS 64u

struct probe_texture {
    VkDescriptorSet set;
    uint32_t table_index;
};

struct prober {
    struct harness *h;
    SluiceVulkanStreamer *streamer;
    bool paged;
    /** Request residency codes. For sparse images only: a driver crashes with other images. */
    bool codes;
    struct harness_buffer inputs, outputs;
    VkDescriptorSetLayout set_layout, page_layout;
    struct {
        VkDescriptorSet set;
        uint64_t generation; ///< generation of the page views in the set
    } pages[HARNESS_FRAMES];
    VkPipelineLayout layout;
    VkPipeline pipeline; ///< owned by the harness
    VkDescriptorPool pool;
    VkSampler samplers[PROBE_MAX_SAMPLERS];
    struct {
        uint32_t u, v, anisotropy, nearest_mip;
    } sampler_keys[PROBE_MAX_SAMPLERS];
    uint32_t sampler_count;
};

void prober_init(struct prober *p, struct harness *h, SluiceVulkanStreamer *streamer);
void prober_finish(struct prober *p);
/** Call after a switch of the harness has changed. */
void prober_choose_pipeline(struct prober *p);

/** Creates a set for a texture with these address modes. anisotropy 1: none. */
struct probe_texture prober_texture(struct prober *p, const SluiceVulkanTexture *texture,
                                    VkSamplerAddressMode u, VkSamplerAddressMode v,
                                    float anisotropy);

/** Creates a set for shaders/array.glsl: the view of all layers, and the layer's own view. */
struct probe_texture prober_layer(struct prober *p, const SluiceVulkanTexture *layer,
                                  VkSamplerAddressMode u, VkSamplerAddressMode v, float anisotropy);

/** Creates a set for shaders/cube.comp: the views of its cube and of all cubes. */
struct probe_texture prober_cube(struct prober *p, const SluiceVulkanTexture *face,
                                 float anisotropy);

/** Creates a set for shaders/integer.comp: samplers without filters. */
struct probe_texture prober_nearest(struct prober *p, const SluiceVulkanTexture *texture);

/** Releases the set for reuse. No frame may use it: wait for the device before. */
void prober_release(struct prober *p, struct probe_texture texture);

VkSampler prober_sampler(struct prober *p, VkSamplerAddressMode u, VkSamplerAddressMode v,
                         float anisotropy, bool nearest_mip);

/** Returns the inputs [0, PROBE_CAPACITY) for writing. */
struct ProbeInput *prober_inputs(struct prober *p);
const struct ProbeOutput *prober_outputs(const struct prober *p);

/** Records inputs [first, first + count) for one texture, inside a frame. */
void prober_record(struct prober *p, VkCommandBuffer commands, struct probe_texture texture,
                   uint32_t first, uint32_t count, uint32_t flags);

/** Binds set 1 with the current pages. */
void prober_bind_pages(struct prober *p, VkCommandBuffer commands, VkPipelineBindPoint point);

/** Specialization constants that adapt one shader to every mode. */
struct prober_specialization {
    VkBool32 values[3]; ///< paged, cubic, mixed
    VkSpecializationMapEntry entries[3];
    VkSpecializationInfo info;
};
const VkSpecializationInfo *prober_specialize(const struct prober *p,
                                              struct prober_specialization *specialization);

#endif /* TESTS_DEVICE_PROBE_H */
