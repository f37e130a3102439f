/** A streamer with textures, and samples of each that are taken in every frame. */
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
    SluiceTextureFilter filter;       ///< of textures that are added
    SluiceResidencyMode texture_mode; ///< of textures that are added
    struct scene_texture textures[SCENE_TEXTURES];
};

/** `info` without handles and log. */
void scene_init(struct scene *scene, struct harness *h, SluiceVulkanStreamerCreateInfo info);
/** Checks that validation was silent, too. */
void scene_finish(struct scene *scene);

/** Takes over the source unless told otherwise with `owns` later. Repeats, trilinear. */
uint32_t scene_add(struct scene *scene, SluiceImageSource *source);
uint32_t scene_add_as(struct scene *scene, SluiceImageSource *source, VkSamplerAddressMode u,
                      VkSamplerAddressMode v, float anisotropy, SluiceTextureId primary);
/** A texture whose tiles a producer writes. Repeats, trilinear. */
uint32_t scene_add_produced(struct scene *scene, const SluiceTileProducer *producer);
/** Its source is destroyed with the scene. */
void scene_remove(struct scene *scene, uint32_t texture);

/** Where the samples of a texture are. */
struct scene_aim {
    double left, top, width, height; ///< a window in uv
    double min_lod, max_lod;
    double max_ratio; ///< of the derivatives' lengths, at any angles; 0: equal, along the axes
    float bias;
};
void scene_aim(struct scene *scene, uint32_t texture, uint32_t count, const struct scene_aim *aim);

struct ProbeInput *scene_inputs(struct scene *scene, uint32_t texture);
const struct ProbeOutput *scene_outputs(const struct scene *scene, uint32_t texture);

/** For harness_frame and harness_settle; user is the scene. */
void scene_record(void *user, VkCommandBuffer commands);
void scene_settle(struct scene *scene, uint32_t frame_count);

/** Sets the counters of the outputs to 0; waits for the device. */
void scene_clear_outputs(struct scene *scene);
/** Waits for the device; samples of all textures that touched what is not resident. */
uint64_t scene_non_resident(struct scene *scene);
/** The level that a device would begin with which takes the axes of the ellipse of dx and dy, and
 *  clamps where samplers do. */
double scene_ellipse_lod(const struct ProbeOutput *out, const struct scene_texture *texture);

/**
 * Fails the test if a sample of PATTERN_LEVEL shows a finer level than it was allowed to, which is
 * also what texels that are not resident look like. Independent of residency codes. Or if a device
 * with another rule for anisotropy than this one's would show such a level.
 */
void scene_check_levels(const struct scene *scene);
/** Samples of all textures that are coarser than they should be. */
uint32_t scene_missing(const struct scene *scene);

#endif /* TESTS_DEVICE_SCENE_H */
