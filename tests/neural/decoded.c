#include "neural/decoded.h"

#include "support/test.h"

#include <math.h>
#include <stdlib.h>

void read_decodable(const SluiceNeuralSet *set, const SluiceNeuralRequest *request,
                    SluiceNeuralWeightKind kind, struct decodable *d)
{
    *d = (struct decodable){.kind = kind};
    CHECK_OK(sluiceReadNeuralLatents(set, request, &d->constants, &d->latent_size, NULL));
    d->latents = malloc((size_t)d->latent_size);
    assert_non_null(d->latents);
    CHECK_OK(sluiceReadNeuralLatents(set, request, &d->constants, &d->latent_size, d->latents));
    CHECK_OK(sluiceGetNeuralWeights(set, kind, NULL, &d->weight_size, NULL));
    d->weights = malloc((size_t)d->weight_size);
    assert_non_null(d->weights);
    CHECK_OK(sluiceGetNeuralWeights(set, kind, NULL, &d->weight_size, d->weights));
}

void free_decodable(struct decodable *d)
{
    free(d->latents);
    free(d->weights);
}

SluiceResult decode_rectangle(const struct decodable *d, uint32_t mip, uint32_t x, uint32_t y,
                              uint32_t width, uint32_t height, float *texels)
{
    SluiceNeuralDecodeInfo info = {
        .structSize = sizeof info,
        .pConstants = &d->constants,
        .pLatents = d->latents,
        .latentSize = d->latent_size,
        .pWeights = d->weights,
        .weightSize = d->weight_size,
        .weightKind = d->kind,
        .mip = mip,
        .x = x,
        .y = y,
        .width = width,
        .height = height,
        .channelCount = d->constants.channelCount,
        .pTexels = texels,
    };
    return sluiceDecodeNeuralTexels(&info);
}

float *decode_mip(const SluiceNeuralSet *set, SluiceNeuralWeightKind kind, uint32_t mip)
{
    SluiceNeuralMip m = {.structSize = sizeof m};
    struct decodable d;
    CHECK_OK(sluiceGetNeuralMip(set, mip, &m));
    read_decodable(set, NULL, kind, &d);
    float *texels = calloc((size_t)m.width * m.height * d.constants.channelCount, sizeof *texels);
    assert_non_null(texels);
    CHECK_OK(decode_rectangle(&d, mip, 0, 0, m.width, m.height, texels));
    free_decodable(&d);
    return texels;
}

double psnr_of(const float *a, const float *b, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += pow((double)a[i] - (double)b[i], 2);
    return -10 * log10(sum / (double)count);
}
