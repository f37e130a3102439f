#include "neural_path.h"

#include <stdlib.h>
#include <string.h>

#include "../../tools/common/text.h"

#include "gallery_neural_vector_fp8.h"
#include "gallery_neural_vector_int8.h"
#include "neural_dot_frag.h"
#include "neural_frag.h"
#include "neural_schema1_dot_frag.h"

static const char *const names[] = {"auto", "plain", "dot", "vector", "vector-fp8"};

/** Returns NULL if the device and the set support the path, otherwise the reason against it. */
static const char *what_lacks(const struct gpu *gpu, const SluiceNeuralSetInfo *info,
                              enum neural_path path)
{
    const SluiceNeuralPaths *there = &gpu->neural;
    bool in_fragments = there->vectorStages & VK_SHADER_STAGE_FRAGMENT_BIT;
    switch (path) {
    case NEURAL_PATH_DOT:
        return there->integerDot ? NULL : "the device has no integer dot products";
    case NEURAL_PATH_VECTOR:
    case NEURAL_PATH_VECTOR_FP8:
        if (info->schema != 3)
            return "the shaders with cooperative vectors are for sets of schema 3";
        if (!there->vectorInt8 || !in_fragments)
            return "the device has no cooperative vectors in fragment shaders";
        if (path == NEURAL_PATH_VECTOR_FP8 && !(there->vectorFp8 && info->hasFp8))
            return info->hasFp8 ? "the device has no cooperative vectors of FP8"
                                : "the set has no FP8 weights";
        return NULL;
    default: return NULL;
    }
}

/** Returns the fastest path that gives the same bits as the C decoder (docs/neural.md). */
static enum neural_path choose(const struct gpu *gpu, const SluiceNeuralSetInfo *info)
{
    if (!what_lacks(gpu, info, NEURAL_PATH_VECTOR))
        return NEURAL_PATH_VECTOR;
    return what_lacks(gpu, info, NEURAL_PATH_DOT) ? NEURAL_PATH_PLAIN : NEURAL_PATH_DOT;
}

static void choose_words(enum neural_path path, uint32_t schema, struct neural_program *program)
{
    static const struct {
        const uint32_t *words;
        size_t size;
    } list[][2] = {
        [NEURAL_PATH_PLAIN] = {{neural_frag, sizeof neural_frag},
                               {neural_frag, sizeof neural_frag}},
        [NEURAL_PATH_DOT] = {{neural_schema1_dot_frag, sizeof neural_schema1_dot_frag},
                             {neural_dot_frag, sizeof neural_dot_frag}},
        [NEURAL_PATH_VECTOR] = {{NULL, 0},
                                {gallery_neural_vector_int8, sizeof gallery_neural_vector_int8}},
        [NEURAL_PATH_VECTOR_FP8] = {{NULL, 0},
                                    {gallery_neural_vector_fp8, sizeof gallery_neural_vector_fp8}},
    };
    program->words = list[path][schema == 3].words;
    program->words_size = list[path][schema == 3].size;
}

static SluiceResult read_weights(const SluiceNeuralSet *set, SluiceNeuralWeightKind kind,
                                 struct neural_program *program)
{
    SluiceResult result = sluiceGetNeuralWeights(set, kind, NULL, &program->weight_size, NULL);
    if (result != SLUICE_SUCCESS)
        return result;
    program->weights = malloc((size_t)program->weight_size);
    return program->weights
               ? sluiceGetNeuralWeights(set, kind, NULL, &program->weight_size, program->weights)
               : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

/** Converts the weights to the device's layout. */
static SluiceResult convert_weights(const struct gpu *gpu, const SluiceNeuralSet *set,
                                    SluiceNeuralWeightKind kind, struct neural_program *program)
{
    SluiceNeuralConstants constants;
    uint64_t latents = 0, size = 0;
    const SluiceNeuralConvertInfo info = {.structSize = sizeof info,
                                          .device = gpu->device,
                                          .pfnGetDeviceProcAddr = vkGetDeviceProcAddr,
                                          .pConstants = &constants,
                                          .weightKind = kind,
                                          .pWeights = program->weights,
                                          .weightSize = program->weight_size};
    SluiceResult result = sluiceReadNeuralLatents(set, NULL, &constants, &latents, NULL);
    if (result == SLUICE_SUCCESS)
        result = sluiceConvertNeuralWeights(&info, &size, NULL);
    if (result != SLUICE_SUCCESS)
        return result;
    void *made = malloc((size_t)size);
    result =
        made ? sluiceConvertNeuralWeights(&info, &size, made) : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    free(program->weights);
    program->weights = made;
    program->weight_size = size;
    return result;
}

bool neural_program_create(const struct gpu *gpu, const SluiceNeuralSet *set, enum neural_path path,
                           struct neural_program *program)
{
    SluiceNeuralSetInfo info = {.structSize = sizeof info};
    *program = (struct neural_program){0};
    SluiceResult result = sluiceGetNeuralSetInfo(set, &info);
    const char *lacks = what_lacks(gpu, &info, path);
    if (lacks)
        text_say("--neural-path %s: %s", names[path], lacks);
    if (result != SLUICE_SUCCESS || lacks)
        return false;
    if (path == NEURAL_PATH_AUTO)
        path = choose(gpu, &info);
    choose_words(path, info.schema, program);
    SluiceNeuralWeightKind kind =
        path == NEURAL_PATH_VECTOR_FP8 ? SLUICE_NEURAL_WEIGHTS_FP8 : SLUICE_NEURAL_WEIGHTS_INT8;
    result = read_weights(set, kind, program);
    if (result == SLUICE_SUCCESS && path >= NEURAL_PATH_VECTOR)
        result = convert_weights(gpu, set, kind, program);
    if (result != SLUICE_SUCCESS)
        text_say("--neural-path %s: %s", names[path], sluiceGetResultName(result));
    return result == SLUICE_SUCCESS;
}

void neural_program_destroy(struct neural_program *program)
{
    free(program->weights);
    *program = (struct neural_program){0};
}
