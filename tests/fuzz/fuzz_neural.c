/*
 * Any bytes as a .ntc file: an error, or a set whose latents can be read and decoded. With clang:
 *
 *     CC=clang meson setup BUILD -Db_sanitize=address,undefined -Db_lundef=false \
 *         -Dc_args=-fsanitize=fuzzer-no-link
 *     ninja -C BUILD tests/neural/fuzz_neural_libfuzzer
 *     BUILD/tests/neural/fuzz_neural_libfuzzer -max_len=8192 NEW_FOLDER tests/fuzz/corpus/neural
 *
 * In the ordinary test run standalone.c plays the corpus.
 */
#include <sluice/neural.h>

#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* More is no fault, but slow. */
#define MAX_LATENTS (1u << 20)

static void ask(const SluiceNeuralSet *set, const SluiceNeuralSetInfo *info)
{
    uint64_t offset, size;
    for (uint32_t i = 0; i < info->textureCount; i++) {
        SluiceNeuralTexture texture = {.structSize = sizeof texture};
        if (sluiceGetNeuralTexture(set, i, &texture) != SLUICE_SUCCESS || !texture.pName ||
            texture.firstChannel + texture.channelCount > info->channelCount)
            abort();
    }
    for (uint32_t i = 0; i < info->mipCount; i++) {
        SluiceNeuralMip mip = {.structSize = sizeof mip};
        if (sluiceGetNeuralMip(set, i, &mip) != SLUICE_SUCCESS ||
            mip.latentImage + mip.latentImageCount > info->latentImageCount ||
            sluiceGetNeuralLatentRange(set, i, 1, &offset, &size) != SLUICE_SUCCESS ||
            offset > info->fileSize || size > info->fileSize - offset)
            abort();
    }
}

/* The first and the last texel of a mip, from a slice of its own. */
static void decode_mip(const SluiceNeuralSet *set, uint32_t mip, SluiceNeuralWeightKind kind)
{
    static uint8_t latents[MAX_LATENTS], weights[32768];
    SluiceNeuralConstants constants;
    SluiceNeuralMip m = {.structSize = sizeof m};
    float texels[16];
    sluiceGetNeuralMip(set, mip, &m);
    for (int last = 0; last < 2; last++) {
        const SluiceNeuralRequest request = {
            mip, 1, last ? m.width - 1 : 0, last ? m.height - 1 : 0, 1, 1};
        uint64_t size = sizeof latents, weight_size = sizeof weights;
        if (sluiceReadNeuralLatents(set, &request, &constants, &size, latents) != SLUICE_SUCCESS ||
            sluiceGetNeuralWeights(set, kind, NULL, &weight_size, weights) != SLUICE_SUCCESS)
            return;
        const SluiceNeuralDecodeInfo info = {
            .structSize = sizeof info,
            .pConstants = &constants,
            .pLatents = latents,
            .latentSize = size,
            .pWeights = weights,
            .weightSize = weight_size,
            .weightKind = kind,
            .mip = mip,
            .x = request.x,
            .y = request.y,
            .width = 1,
            .height = 1,
            .channelCount = 16,
            .pTexels = texels,
        };
        if (sluiceDecodeNeuralTexels(&info) != SLUICE_SUCCESS)
            abort();
    }
}

static void read_whole(const SluiceNeuralSet *set)
{
    SluiceNeuralConstants constants;
    uint64_t size = 0;
    if (sluiceReadNeuralLatents(set, NULL, &constants, &size, NULL) != SLUICE_SUCCESS ||
        size > MAX_LATENTS)
        return;
    void *bytes = malloc(size ? (size_t)size : 1);
    if (!bytes)
        abort();
    (void)sluiceReadNeuralLatents(set, NULL, &constants, &size, bytes);
    free(bytes);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    SluiceInput input = {.structSize = sizeof input, .pBytes = data, .size = size};
    SluiceNeuralSetCreateInfo create = {.structSize = sizeof create, .pInput = &input};
    SluiceNeuralSetInfo info = {.structSize = sizeof info};
    SluiceNeuralSet *set = NULL;
    if (size == 0 || sluiceOpenNeuralSet(&create, &set) != SLUICE_SUCCESS)
        return 0;
    if (sluiceGetNeuralSetInfo(set, &info) != SLUICE_SUCCESS)
        abort();
    ask(set, &info);
    read_whole(set);
    for (uint32_t mip = 0; mip < info.mipCount; mip++) {
        decode_mip(set, mip, SLUICE_NEURAL_WEIGHTS_INT8);
        decode_mip(set, mip, SLUICE_NEURAL_WEIGHTS_FP8);
    }
    sluiceDestroyNeuralSet(set);
    return 0;
}
