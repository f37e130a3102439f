/* decode_figures: texels per second and core of each way to decode, and their ratio to the plain
 * one. Decodes mip 0 of a set of random numbers, 256 x 256 texels. Prints the least time of some
 * rounds. */
#include "neural/decoded.h"
#include "neural/decoder.h"
#include "neural/made_file.h"
#include "support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { EDGE = 256, ROUNDS = 5 };

/* Processor time, so that other programs do not count. */
static double seconds(void)
{
    return (double)clock() / CLOCKS_PER_SEC;
}

static double rate_of(const SluiceNeuralDecodeInfo *info, slc_neural_way *way)
{
    double least = 1e9;
    for (int i = 0; i < ROUNDS; i++) {
        double start = seconds();
        CHECK_OK(slc_neural_decode(info, way));
        least = fmin(least, seconds() - start);
    }
    return EDGE * EDGE / least / 1e6;
}

static void measure(const SluiceNeuralSet *set, uint32_t schema, SluiceNeuralWeightKind kind)
{
    struct decodable d;
    read_decodable(set, NULL, kind, &d);
    float *texels = malloc(sizeof(float) * EDGE * EDGE * d.constants.channelCount);
    const SluiceNeuralDecodeInfo info = {.structSize = sizeof info,
                                         .pConstants = &d.constants,
                                         .pLatents = d.latents,
                                         .latentSize = d.latent_size,
                                         .pWeights = d.weights,
                                         .weightSize = d.weight_size,
                                         .weightKind = kind,
                                         .width = EDGE,
                                         .height = EDGE,
                                         .channelCount = d.constants.channelCount,
                                         .pTexels = texels};
    double plain = rate_of(&info, slc_neural_decode_plainly);
    double strips = rate_of(&info, slc_neural_decode_strips);
    double fastest = rate_of(&info, slc_neural_fastest_way());
    printf("schema %u, %s: plain %.3f, vectors of 16 bytes %.3f (%.1f), fastest %.3f (%.1f) "
           "million texels/s\n",
           schema, kind == SLUICE_NEURAL_WEIGHTS_INT8 ? "int8" : "fp8", plain, strips,
           strips / plain, fastest, fastest / plain);
    free(texels);
    free_decodable(&d);
}

int main(void)
{
    static const struct made_shape shapes[] = {
        {1, EDGE, EDGE, 4, 16, 4, 16, 4, SLUICE_NEURAL_NETWORK_XLARGE},
        {3, EDGE, EDGE, 4, 16, 0, 0, 0, SLUICE_NEURAL_NETWORK_SCHEMA3}};
    for (int s = 0; s < 2; s++) {
        struct made_file file = {0};
        SluiceNeuralSet *set = open_made_file(&shapes[s], 1, &file);
        measure(set, shapes[s].schema, SLUICE_NEURAL_WEIGHTS_INT8);
        measure(set, shapes[s].schema, SLUICE_NEURAL_WEIGHTS_FP8);
        sluiceDestroyNeuralSet(set);
        free(file.bytes);
    }
    return 0;
}
