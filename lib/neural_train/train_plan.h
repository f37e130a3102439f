/** Plan of a training: sizes, latent images, samples per mip. Independent of the device. */
#ifndef SLC_NEURAL_TRAIN_PLAN_H
#define SLC_NEURAL_TRAIN_PLAN_H

#include <sluice/neural_compress.h>

#include <train_layout.h>

#define SLC_TRAIN_MAX_LATENT_IMAGES 8u

struct slc_latent_image {
    uint32_t width, height;
    uint32_t first_texel; ///< index among all latent texels
};

struct slc_train_plan {
    uint32_t width, height, mip_count, channel_count;
    uint32_t scale, feature_count;
    uint32_t step_count, tile_count, seed; ///< a tile is TRAIN_TILE samples
    uint32_t fp8_steps;                    ///< steps after step_count, with frozen latents
    float network_rate, latent_rate;
    uint32_t image_count;
    struct slc_latent_image images[SLC_TRAIN_MAX_LATENT_IMAGES];
    uint32_t latent_texels; ///< texels of all latent images
    uint64_t texel_count;   ///< texels of all mips
    uint32_t mip_tiles[TRAIN_MIPS];
    SluiceNeuralTrainingChannel channels[SLUICE_NEURAL_COMPRESS_MAX_CHANNELS];
};

/** Makes a plan. `info` has this version's size. Errors, logged: INVALID_ARGUMENT, NULL_POINTER. */
SluiceResult slc_train_plan_init(struct slc_train_plan *plan,
                                 const SluiceNeuralCompressorCreateInfo *info,
                                 const SluiceLogCallback *log);

/** Returns the finer of a mip's two latent images. */
uint32_t slc_train_first_image(const struct slc_train_plan *plan, uint32_t mip);
float slc_train_position_scale(const struct slc_train_plan *plan, uint32_t mip);
float slc_train_position_lod(const struct slc_train_plan *plan, uint32_t mip);

/** Returns the number of features of all latent texels. */
uint32_t slc_train_latent_count(const struct slc_train_plan *plan);

/** Fills TRAIN_TABLE_WORDS words. */
void slc_train_write_table(const struct slc_train_plan *plan, uint32_t *table);

/** Returns the unit: latents' gradients are integers in 1/unit. Sums of a step fit in 32 bits. */
float slc_train_latent_unit(const struct slc_train_plan *plan);

#endif /* SLC_NEURAL_TRAIN_PLAN_H */
