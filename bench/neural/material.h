/** A material of eight channels in all forms: latents, weights, and textures. */
#ifndef BENCH_NEURAL_MATERIAL_H
#define BENCH_NEURAL_MATERIAL_H

#include "../../tools/common/gpu.h"

#include <sluice/neural.h>

/** Weights in the form that a path reads. */
enum weights { INT8, FP8, HALF, VECTOR_INT8, VECTOR_FP8, WEIGHTS };

struct material {
    SluiceNeuralConstants constants;
    uint8_t *latents, *weights; ///< owned; INT8
    uint64_t latent_size, weight_size;
    struct gpu_buffer buffers[2]; ///< constants, latents
    struct gpu_buffer storage[WEIGHTS],
        uniform[WEIGHTS];              ///< no buffer: the device has no such path
    struct gpu_image rgba8[2], bc7[2]; ///< four channels each; bc7: no image without the baker
    uint64_t rgba8_size, bc7_size;     ///< bytes of both
};

/**
 * Reads a file, or makes a set of random numbers of `size` texels if `path` is NULL. Decoding takes
 * the same time for any numbers. The BC7 blocks are made from the decoded texels, like those of
 * sluice-bake; without the baker there are none. Reports errors on stderr.
 */
bool material_create(struct material *material, const struct gpu *gpu, const char *path,
                     uint32_t size);

/** Prints how many texels per second one core of the host decodes. False, said, if it fails. */
bool material_time_host(const struct material *material);
void material_destroy(struct material *material, const struct gpu *gpu);

#endif /* BENCH_NEURAL_MATERIAL_H */
