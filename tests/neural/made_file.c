#include "neural/made_file.h"

#include "neural/network.h"
#include "neural/neural_files.h"
#include "support/roll.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

const struct made_shape made_shapes[MADE_SHAPE_COUNT] = {
    {1, 64, 32, 2, 4, 2, 8, 4, SLUICE_NEURAL_NETWORK_SMALL},
    {1, 64, 64, 4, 16, 8, 16, 8, SLUICE_NEURAL_NETWORK_XLARGE},
    {1, 75, 50, 3, 4, 1, 12, 1, SLUICE_NEURAL_NETWORK_MEDIUM},
    {1, 128, 8, 4, 12, 1, 4, 1, SLUICE_NEURAL_NETWORK_LARGE},
    {1, 37, 90, 1, 4, 1, 4, 2, SLUICE_NEURAL_NETWORK_SMALL},
    {3, 64, 64, 4, 16, 0, 0, 0, SLUICE_NEURAL_NETWORK_SCHEMA3},
    {3, 300, 200, 4, 4, 0, 0, 0, SLUICE_NEURAL_NETWORK_SCHEMA3},
    {3, 97, 61, 6, 12, 0, 0, 0, SLUICE_NEURAL_NETWORK_SCHEMA3},
    {3, 16, 128, 2, 8, 0, 0, 0, SLUICE_NEURAL_NETWORK_SCHEMA3},
    {3, 5, 3, 1, 8, 0, 0, 0, SLUICE_NEURAL_NETWORK_SCHEMA3},
};

/* Bytes that are no NaN as E4M3, scales about 1 / 4096, small biases. */
static uint8_t *make_weights(const struct slc_neural_shape *shape, SluiceNeuralWeightKind kind)
{
    struct slc_neural_blob at = slc_neural_blob_of(shape, kind);
    uint8_t *blob = calloc(at.size, 1);
    assert_non_null(blob);
    for (uint32_t i = 0; i < 4; i++) {
        bool is_half = kind == SLUICE_NEURAL_WEIGHTS_FP8 && i < 3;
        for (uint32_t w = 0; w < shape->inputs[i] * shape->outputs[i]; w++)
            blob[at.weights[i] + w] = (uint8_t)((uint32_t)roll() % 255);
        for (uint32_t w = 0; is_half && w < shape->inputs[i] * shape->outputs[i]; w++)
            blob[at.weights[i] + w] &= 0xB7; /* below 1 */
        for (uint32_t o = 0; o < shape->outputs[i]; o++) {
            float scale = (float)(1 + (uint32_t)roll() % 64) / 65536.0f;
            int32_t bias = roll() % 20000 - 10000;
            if (is_half) {
                blob[at.biases[i] + 2 * o + 1] = (uint8_t)((uint32_t)roll() % 0x38);
                continue;
            }
            memcpy(blob + at.scales[i] + 4 * o, &scale, 4);
            memcpy(blob + at.biases[i] + 4 * o, &bias, 4);
        }
    }
    return blob;
}

static void make_codes(struct made_parts *p)
{
    const SluiceNeuralConstants *k = &p->constants;
    size_t count = 0;
    for (int pass = 0; pass < 2; pass++) {
        count = 0;
        for (uint32_t i = 0; i < 16; i++) {
            bool is_low = p->info.schema == 1 && i % 2;
            uint32_t size = k->slices[i].gridSize, bits = is_low ? k->lowBits : k->highBits;
            size_t codes = (size_t)(size & 0xFFFF) * (size >> 16) *
                           (is_low ? k->lowFeatures : k->highFeatures);
            for (size_t c = 0; pass && c < codes; c++)
                p->codes[count + c] = (uint8_t)((uint32_t)roll() % (1u << bits));
            count += codes;
        }
        if (!pass)
            p->codes = malloc(count);
    }
    p->code_count = count;
}

void make_parts(struct made_parts *p, const struct made_shape *shape, uint32_t seed)
{
    struct slc_neural_shape layers = slc_neural_shape_of(shape->network);
    memset(p, 0, sizeof *p);
    roll_seed(seed);
    p->textures[0] = (SluiceNeuralTexture){.structSize = sizeof p->textures[0],
                                           .pName = "one \"\\\n\xC3\xA9",
                                           .channelCount = 4,
                                           .format = SLUICE_NEURAL_CHANNEL_FLOAT16,
                                           .rgbColorSpace = SLUICE_NEURAL_COLOR_HLG,
                                           .alphaColorSpace = SLUICE_NEURAL_COLOR_SRGB,
                                           .bcFormat = 7};
    p->textures[1] = (SluiceNeuralTexture){.structSize = sizeof p->textures[1],
                                           .pName = "",
                                           .firstChannel = 4,
                                           .channelCount = 1,
                                           .format = SLUICE_NEURAL_CHANNEL_UNORM8};
    p->spaces[1] = SLUICE_NEURAL_COLOR_HLG;
    p->spaces[3] = SLUICE_NEURAL_COLOR_SRGB;
    p->info = (SluiceNeuralWriteInfo){
        .structSize = sizeof p->info,
        .schema = shape->schema,
        .width = shape->width,
        .height = shape->height,
        .channelCount = 5,
        .textureCount = 2,
        .pTextures = p->textures,
        .pColorSpaces = p->spaces,
        .network = shape->network,
        .highFeatures = shape->high_features,
        .highBits = shape->high_bits,
        .lowFeatures = shape->low_features,
        .lowBits = shape->low_bits,
        .gridScale = shape->grid_scale,
    };
    CHECK_OK(sluicePlanNeuralFile(&p->info, &p->constants, &p->latent_size));
    make_codes(p);
    p->int8_weights = make_weights(&layers, SLUICE_NEURAL_WEIGHTS_INT8);
    p->fp8_weights = make_weights(&layers, SLUICE_NEURAL_WEIGHTS_FP8);
    p->info.pCodes = p->codes;
    p->info.pInt8Weights = p->int8_weights;
    p->info.pFp8Weights = p->fp8_weights;
}

void free_made_parts(struct made_parts *p)
{
    free(p->codes);
    free(p->int8_weights);
    free(p->fp8_weights);
}

static SluiceResult append(void *user, const void *bytes, size_t size)
{
    struct made_file *file = user;
    if (++file->writes == file->fail_at)
        return SLUICE_ERROR_IO;
    file->bytes = realloc(file->bytes, file->size + size);
    assert_non_null(file->bytes);
    memcpy(file->bytes + file->size, bytes, size);
    file->size += size;
    return SLUICE_SUCCESS;
}

SluiceResult write_made_file(const struct made_parts *parts, struct made_file *file)
{
    SluiceNeuralWriteInfo info = parts->info;
    info.pUserData = file;
    info.pfnWrite = append;
    return sluiceWriteNeuralFile(&info);
}

SluiceNeuralSet *open_made_file(const struct made_shape *shape, uint32_t seed,
                                struct made_file *file)
{
    struct made_parts parts;
    SluiceNeuralSet *set = NULL;
    *file = (struct made_file){0};
    make_parts(&parts, shape, seed);
    CHECK_OK(write_made_file(&parts, file));
    free_made_parts(&parts);
    CHECK_OK(open_neural_bytes(file->bytes, file->size, NULL, &set));
    return set;
}
