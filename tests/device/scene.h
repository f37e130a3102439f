/** A streamer with textures, and samples of each in every frame. */
#ifndef TESTS_DEVICE_SCENE_H
#define TESTS_DEVICE_SCENE_H

#include "device/pattern.h"
#include "device/probe.h"

#define SCENE_TEXTURES 32u
#define SCENE_SAMPLES (PROBE_CAPACITY / SCENE_TEXTURES)

struct scene_texture {
    bool used;
    SluiceImageSource *source; ///< owned if `owns`
    bool owns;
    SluiceImageInfo info;
    SluiceVulkanTexture texture;
    VkSamplerAddressMode u, v;
    float anisotropy;
    struct probe_texture probe;
    uint32_t sample_count; ///< 0: not sampled in this frame
    bool no_feedback;
};

struct scene {
    struct harness *h;
    SluiceVulkanStreamer *streamer;
    struct prober prober;
    SluiceTextureFilter filter;       ///< filter of textures added later
    SluiceResidencyMode texture_mode; ///< mode of textures added later
    struct scene_texture textures[SCENE_TEXTURES];
};

/** `info`: without handles and log. */
void scene_init(struct scene *scene, struct harness *h, SluiceVulkanStreamerCreateInfo info);
/** Destroys the scene. Checks that validation was silent. */
void scene_finish(struct scene *scene);

/** Adds a texture with REPEAT and trilinear filters. Takes the source, unless the test clears
 * `owns` later. */
uint32_t scene_add(struct scene *scene, SluiceImageSource *source);
uint32_t scene_add_as(struct scene *scene, SluiceImageSource *source, VkSamplerAddressMode u,
                      VkSamplerAddressMode v, float anisotropy, SluiceTextureId primary);
/** Adds a texture whose tiles a producer writes, with REPEAT and trilinear filters. */
uint32_t scene_add_produced(struct scene *scene, const SluiceTileProducer *producer);
/** Removes a texture. Its source is destroyed with the scene. */
void scene_remove(struct scene *scene, uint32_t texture);

/** Position of a texture's samples. */
struct scene_aim {
    double left, top, width, height; ///< window in uv
    double min_lod, max_lod;
    double max_ratio; ///< largest ratio of the derivatives' lengths, at any angles; 0: equal, along
                      ///< the axes
    float bias;
};
void scene_aim(struct scene *scene, uint32_t texture, uint32_t count, const struct scene_aim *aim);

struct ProbeInput *scene_inputs(struct scene *scene, uint32_t texture);
const struct ProbeOutput *scene_outputs(const struct scene *scene, uint32_t texture);

/** Callback of harness_frame and harness_settle; `user` is the scene. */
void scene_record(void *user, VkCommandBuffer commands);
void scene_settle(struct scene *scene, uint32_t frame_count);

/** Resets the counters of the outputs to 0. Waits for the device. */
void scene_clear_outputs(struct scene *scene);
/** Waits for the device. Returns the number of samples, of all textures, that touched texels that
 * were not resident. */
uint64_t scene_non_resident(struct scene *scene);
/** Returns the first level of a device that uses the axes of the ellipse of dx and dy, clamped like
 * samplers. */
double scene_ellipse_lod(const struct ProbeOutput *out, const struct scene_texture *texture);

/**
 * Fails the test if a sample of PATTERN_LEVEL shows a finer level than allowed, or a texel that is
 * not resident. Independent of residency codes. Also fails if a device with the other rule for
 * anisotropy would show such a level.
 */
void scene_check_levels(const struct scene *scene);
/** Counts samples of all textures that are coarser than they should be. */
uint32_t scene_missing(const struct scene *scene);

#endif /* TESTS_DEVICE_SCENE_H */
