/** Decodes for tests. */
#ifndef TESTS_NEURAL_DECODED_H
#define TESTS_NEURAL_DECODED_H

#include <sluice/neural.h>

/** Latents of a request, with constants and weights. */
struct decodable {
    SluiceNeuralConstants constants;
    uint8_t *latents, *weights;
    uint64_t latent_size, weight_size;
    SluiceNeuralWeightKind kind;
};

/** Reads. `request` NULL: everything. Free afterwards. */
void read_decodable(const SluiceNeuralSet *set, const SluiceNeuralRequest *request,
                    SluiceNeuralWeightKind kind, struct decodable *decodable);
void free_decodable(struct decodable *decodable);

/** Decodes all channels of a rectangle, without checking the result. */
SluiceResult decode_rectangle(const struct decodable *decodable, uint32_t mip, uint32_t x,
                              uint32_t y, uint32_t width, uint32_t height, float *texels);

/** Decodes a whole mip; to be freed. */
float *decode_mip(const SluiceNeuralSet *set, SluiceNeuralWeightKind kind, uint32_t mip);

/** 10 log10(1 / mean squared difference). */
double psnr_of(const float *a, const float *b, size_t count);

#endif /* TESTS_NEURAL_DECODED_H */
