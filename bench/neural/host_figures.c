/*
 * How many texels per second one core decodes on the host: each kind of weights, and each mip-0
 * texel of a set that is made up, or of a file.
 *
 *     host_figures [--json] [FILE.ntc]
 */
#define _POSIX_C_SOURCE 200809L

#include <sluice/neural.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { SIZE = 128, ROUNDS = 5, ROWS = 64 };

static bool json;

static void fail(const char *what)
{
    fprintf(stderr, "host_figures: %s failed\n", what);
    exit(1);
}

/* Of this thread, so that a busy machine matters little. */
static double cpu_seconds(void)
{
    struct timespec t;
    if (clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t) != 0)
        fail("the clock");
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void figure(uint32_t schema, const char *kind, double value)
{
    if (json)
        printf("{\"name\": \"neural_host.schema%u.%s\", \"value\": %.6g, \"unit\": \"texels/s\"}\n",
               schema, kind, value);
    else
        printf("schema %u, %s %28.3f million texels/s and core\n", schema, kind, value / 1e6);
}

struct bytes {
    uint8_t *data;
    size_t size;
};

static SluiceResult append(void *user, const void *data, size_t size)
{
    struct bytes *bytes = user;
    uint8_t *grown = realloc(bytes->data, bytes->size + size);
    if (!grown)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    bytes->data = grown;
    memcpy(grown + bytes->size, data, size);
    bytes->size += size;
    return SLUICE_SUCCESS;
}

/* The speed depends on no code and no weight: both are 0. */
static void make_set(uint32_t schema, struct bytes *bytes)
{
    static uint8_t weights[32768];
    SluiceNeuralWriteInfo info = {
        .structSize = sizeof info,
        .pUserData = bytes,
        .pfnWrite = append,
        .schema = schema,
        .width = SIZE,
        .height = SIZE,
        .channelCount = 8,
        .network = schema == 1 ? SLUICE_NEURAL_NETWORK_MEDIUM : SLUICE_NEURAL_NETWORK_SCHEMA3,
        .highFeatures = schema == 1 ? 8 : 16,
        .highBits = 4,
        .lowFeatures = 16,
        .lowBits = 4,
        .gridScale = 4,
        .pInt8Weights = weights,
        .pFp8Weights = weights,
    };
    SluiceNeuralConstants constants;
    uint64_t size;
    if (sluicePlanNeuralFile(&info, &constants, &size) != SLUICE_SUCCESS)
        fail("a plan");
    uint8_t *latents = calloc(1, (size_t)size);
    info.pLatents = latents;
    if (!latents || sluiceWriteNeuralFile(&info) != SLUICE_SUCCESS)
        fail("writing a set");
    free(latents);
}

static double best_rate(SluiceNeuralDecodeInfo *info, uint32_t width, uint32_t height)
{
    double best = 0;
    for (int round = 0; round < ROUNDS; round++) {
        double start = cpu_seconds();
        for (info->y = 0; info->y < height; info->y += info->height) {
            info->height = height - info->y < ROWS ? height - info->y : ROWS;
            if (sluiceDecodeNeuralTexels(info) != SLUICE_SUCCESS)
                fail("decoding");
        }
        double rate = (double)width * height / (cpu_seconds() - start);
        best = rate > best ? rate : best;
    }
    return best;
}

static void measure_kind(const SluiceNeuralSet *set, const SluiceNeuralSetInfo *info,
                         SluiceNeuralWeightKind kind)
{
    SluiceNeuralConstants constants;
    uint64_t size = 0, weight_size = 0;
    if (sluiceReadNeuralLatents(set, NULL, &constants, &size, NULL) != SLUICE_SUCCESS ||
        sluiceGetNeuralWeights(set, kind, NULL, &weight_size, NULL) != SLUICE_SUCCESS)
        fail("a question");
    uint8_t *latents = malloc((size_t)size), *weights = malloc((size_t)weight_size);
    float *texels = calloc((size_t)info->width * ROWS * info->channelCount, sizeof *texels);
    if (!latents || !weights || !texels ||
        sluiceReadNeuralLatents(set, NULL, &constants, &size, latents) != SLUICE_SUCCESS ||
        sluiceGetNeuralWeights(set, kind, NULL, &weight_size, weights) != SLUICE_SUCCESS)
        fail("reading");
    SluiceNeuralDecodeInfo decode = {
        .structSize = sizeof decode,
        .pConstants = &constants,
        .pLatents = latents,
        .latentSize = size,
        .pWeights = weights,
        .weightSize = weight_size,
        .weightKind = kind,
        .width = info->width,
        .height = ROWS,
        .channelCount = info->channelCount,
        .pTexels = texels,
    };
    figure(info->schema, kind == SLUICE_NEURAL_WEIGHTS_INT8 ? "int8" : "fp8",
           best_rate(&decode, info->width, info->height));
    free(latents);
    free(weights);
    free(texels);
}

static void measure(const SluiceNeuralSetCreateInfo *create)
{
    SluiceNeuralSetInfo info = {.structSize = sizeof info};
    SluiceNeuralSet *set = NULL;
    if (sluiceOpenNeuralSet(create, &set) != SLUICE_SUCCESS ||
        sluiceGetNeuralSetInfo(set, &info) != SLUICE_SUCCESS)
        fail("opening");
    if (info.hasInt8)
        measure_kind(set, &info, SLUICE_NEURAL_WEIGHTS_INT8);
    if (info.hasFp8)
        measure_kind(set, &info, SLUICE_NEURAL_WEIGHTS_FP8);
    sluiceDestroyNeuralSet(set);
}

int main(int argc, char **argv)
{
    json = argc > 1 && strcmp(argv[1], "--json") == 0;
    if (argc > 1 + json) {
        SluiceNeuralSetCreateInfo create = {.structSize = sizeof create, .pPath = argv[1 + json]};
        measure(&create);
        return 0;
    }
    for (uint32_t schema = 1; schema <= 3; schema += 2) {
        struct bytes bytes = {NULL, 0};
        make_set(schema, &bytes);
        SluiceInput input = {.structSize = sizeof input, .pBytes = bytes.data, .size = bytes.size};
        SluiceNeuralSetCreateInfo create = {.structSize = sizeof create, .pInput = &input};
        measure(&create);
        free(bytes.data);
    }
    return 0;
}
