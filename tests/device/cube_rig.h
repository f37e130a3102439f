/** Two streamed cube maps in one image, and the shader that samples them. */
#ifndef TESTS_DEVICE_CUBE_RIG_H
#define TESTS_DEVICE_CUBE_RIG_H

#include "device/cube_oracle.h"
#include "device/scene.h"

#include "cube_shared.h"

#define CUBE_RIG_CUBES 2u
#define CUBE_RIG_LAYERS (CUBE_RIG_CUBES * CUBE_ORACLE_FACES)
#define CUBE_RIG_CAPACITY (PROBE_CAPACITY / 2) ///< samples

/** Ways to pass the texture to the shader. CUBE_FORM_HLSL: like CUBE_FORM_CUBE, in HLSL. */
enum cube_form { CUBE_FORM_CUBE, CUBE_FORM_ARRAY, CUBE_FORM_NUMBER, CUBE_FORM_HLSL };

struct cube_rig {
    struct scene scene; ///< without textures
    uint32_t size, level_count;
    SluiceImageSource *layers[CUBE_RIG_LAYERS], *source;
    SluiceVulkanTexture textures[CUBE_RIG_LAYERS];
    struct probe_texture sets[CUBE_RIG_CUBES];
    VkPipeline pipeline; ///< owned by the harness
    float anisotropy;
    uint32_t cube, first, count, flags; ///< parameters of the next dispatch
};

/** Returns false if refused, as is right in sparse mode without sparseCubes. Call cube_rig_finish
 * in any case. */
bool cube_rig_init(struct cube_rig *rig, struct harness *h, SluiceVulkanStreamerCreateInfo info,
                   uint32_t size, float anisotropy);
void cube_rig_finish(struct cube_rig *rig);

/** Selects the form for the next samples. Default: CUBE_FORM_CUBE. */
void cube_rig_use(struct cube_rig *rig, enum cube_form form);

/** Returns a texel of the sources. Red is (level + 1) / 16, so red 0 means not resident. */
void cube_rig_texel(uint32_t cube, uint32_t face, uint32_t level, uint32_t x, uint32_t y,
                    float rgba[4]);

struct CubeInput *cube_rig_inputs(struct cube_rig *rig);
const struct ProbeOutput *cube_rig_outputs(const struct cube_rig *rig);

/** Callback of harness_frame and harness_settle; `user` is the rig. */
void cube_rig_record(void *user, VkCommandBuffer commands);
/** Runs frames with these flags, for `count` samples. */
void cube_rig_settle(struct cube_rig *rig, uint32_t frame_count, uint32_t cube, uint32_t count,
                     uint32_t flags);

/** Makes a sample at a position on a face, with `texels` of level 0 per pixel along both axes. The
 * direction has a random length, which also varies by pixel. */
struct CubeInput cube_rig_input(const struct cube_rig *rig, uint32_t face, double u, double v,
                                double texels);
/** Makes a sample like cube_rig_input, with derivatives of (u, v) in texels. */
struct CubeInput cube_rig_input_with(const struct cube_rig *rig, uint32_t face, double u, double v,
                                     const double dx[2], const double dy[2]);

/** Computes the color at a LOD, filtered in double precision. */
void cube_rig_expect(const struct cube_rig *rig, uint32_t cube, const struct CubeInput *input,
                     double lod, double rgba[4]);

#endif /* TESTS_DEVICE_CUBE_RIG_H */
