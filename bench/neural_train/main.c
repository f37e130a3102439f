/* Compresses the three materials of docs/neural.md and prints a line per run: PSNR of mip 0 by the
 * C decoder, time per step, size. */
#include "../../tools/common/gpu.h"
#include "../../tools/common/input.h"
#include "../../tools/common/shared_options.h"
#include "../../tools/common/training_run.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EDGE 512u

/* Planes of 512 x 512 samples; FIRST channels of a picture, the last of it a mask or not. */
static const struct material {
    const char *name, *file;
    bool is_half;
    uint32_t channels;
    struct {
        const char *name;
        uint32_t first, count;
        SluiceNeuralColorSpace space;
        bool mask;
    } pictures[4];
} materials[] = {
    {"bronze",
     "bronze.u8",
     false,
     8,
     {{"albedo", 0, 3, SLUICE_NEURAL_COLOR_SRGB, false},
      {"height", 3, 1, SLUICE_NEURAL_COLOR_LINEAR, false},
      {"normal", 4, 2, SLUICE_NEURAL_COLOR_LINEAR, false},
      {"surface", 6, 2, SLUICE_NEURAL_COLOR_LINEAR, false}}},
    {"foliage", "foliage.u8", false, 4, {{"albedo", 0, 4, SLUICE_NEURAL_COLOR_SRGB, true}}},
    {"window", "window.f16", true, 3, {{"radiance", 0, 3, SLUICE_NEURAL_COLOR_HLG, false}}},
};

struct arguments {
    const char *folder, *only, *output, *device;
    int bits;
    uint32_t steps, batch, seed;
    bool progress;
};

static const struct {
    const char *bits;
    uint32_t scale, features;
} sizes[] = {{"2.5", 4, 8}, {"5", 4, 16}, {"10", 2, 8}};

static float half_to_float(uint16_t half)
{
    float size = (float)(half & 1023) + (half >> 10 ? 1024.0f : 0.0f);
    int exponent = (half >> 10 & 31) - 25;
    for (; exponent < 0; exponent++)
        size *= 0.5f;
    for (; exponent > 0; exponent--)
        size *= 2.0f;
    return size;
}

static float *read_planes(const char *folder, const struct material *material)
{
    const size_t count = (size_t)EDGE * EDGE * material->channels;
    char path[1024], *bytes = NULL;
    size_t size = 0;
    snprintf(path, sizeof path, "%s/%s", folder, material->file);
    float *planes = malloc(count * sizeof *planes);
    bool is_read = planes && input_read_file(path, UINT64_C(1) << 30, &bytes, &size) &&
                   size == count * (material->is_half ? 2 : 1);
    for (size_t i = 0; i < count && is_read; i++) {
        uint16_t half;
        memcpy(&half, bytes + (material->is_half ? 2 * i : 0), 2);
        planes[i] = material->is_half ? half_to_float(half) : (float)(uint8_t)bytes[i] / 255.0f;
    }
    free(bytes);
    if (is_read)
        return planes;
    fprintf(stderr, "%s: cannot be read\n", path);
    free(planes);
    return NULL;
}

static bool make_set(const char *folder, const struct material *material, struct training_set *set)
{
    float *planes = read_planes(folder, material);
    float *texels = malloc((size_t)EDGE * EDGE * 4 * sizeof *texels);
    bool is_made = planes && texels;
    for (uint32_t p = 0; p < 4 && is_made && material->pictures[p].name; p++) {
        const uint32_t first = material->pictures[p].first, count = material->pictures[p].count;
        for (size_t i = 0; i < (size_t)EDGE * EDGE; i++)
            for (uint32_t c = 0; c < count; c++)
                texels[i * count + c] = planes[(size_t)(first + c) * EDGE * EDGE + i];
        const struct training_picture picture = {material->pictures[p].name,
                                                 EDGE,
                                                 EDGE,
                                                 count,
                                                 texels,
                                                 material->is_half ? SLUICE_NEURAL_CHANNEL_FLOAT16
                                                                   : SLUICE_NEURAL_CHANNEL_UNORM8,
                                                 material->pictures[p].space,
                                                 material->pictures[p].mask};
        is_made = training_set_add(set, &picture);
    }
    free(texels);
    free(planes);
    return is_made && training_set_finish_mips(set);
}

static bool measure(const struct arguments *a, const struct gpu *gpu,
                    const struct material *material, size_t size)
{
    struct training_set set = {0};
    struct training_run run = {.gpu = gpu,
                               .set = &set,
                               .scale = sizes[size].scale,
                               .features = sizes[size].features,
                               .steps = a->steps,
                               .batch = a->batch,
                               .seed = a->seed,
                               .output = a->output,
                               .progress = a->progress};
    bool is_done = make_set(a->folder, material, &set) && training_run(&run);
    if (is_done) {
        printf("{\"material\": \"%s\", \"bits_per_texel\": %s, \"steps\": %u, \"psnr\": %.3f, "
               "\"fp8_psnr\": %.3f, \"exact_mask\": %.5f, \"repaired\": %llu, "
               "\"repair_seconds\": %.3f, \"size\": %llu, \"seconds\": %.3f, "
               "\"ms_per_step\": %.4f, \"channels\": [",
               material->name, sizes[size].bits, run.steps_run, run.psnr, run.fp8_psnr,
               run.exact_mask, (unsigned long long)run.repaired, run.repair_seconds,
               (unsigned long long)run.file_size, run.seconds, run.seconds * 1e3 / run.steps_run);
        for (uint32_t c = 0; c < set.channel_count; c++)
            printf("%s%.2f", c ? ", " : "", run.channel_psnr[c]);
        printf("], \"device\": \"%s\"}\n", gpu->properties.deviceName);
        fflush(stdout);
    }
    training_set_free(&set);
    return is_done;
}

static bool measure_all(const struct arguments *a, const struct gpu *gpu)
{
    for (size_t m = 0; m < sizeof materials / sizeof *materials; m++)
        if (!a->only || strcmp(a->only, materials[m].name) == 0)
            for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++)
                if ((a->bits == 0 || (size_t)a->bits == s + 1) &&
                    !measure(a, gpu, &materials[m], s))
                    return false;
    return true;
}

int main(int argc, char **argv)
{
    struct arguments a = {0};
    const struct option options[] = {
        {OPTION_WORD, .value = &a.folder, .help = "the folder of the materials", .minimum = 1},
        {OPTION_TEXT, "only", "NAME", "(all)", &a.only, "bronze, foliage or window"},
        {OPTION_CHOICE, "bits-per-texel", "all|2.5|5|10", "all", &a.bits, "latents of mip 0"},
        {OPTION_UINT, "steps", "N", "20000", &a.steps, "steps of training", 20, 10000000},
        {OPTION_UINT, "batch", "N", "65536", &a.batch, "samples of a step, a multiple of 32", 32,
         1048576},
        option_seed(&a.seed),
        {OPTION_TEXT, "output", "FILE", "neural_train.ntc", &a.output, "file that each run writes",
         .letter = 'o'},
        {OPTION_FLAG, "progress", .value = &a.progress, .help = "print the progress of each run"},
        option_device(&a.device),
    };
    const struct option_table table = {
        "neural_train",
        "usage: neural_train FOLDER [options]\n\nCompresses bronze.u8, foliage.u8 and window.f16 "
        "of FOLDER and prints PSNR and time.\n",
        NULL, options, sizeof options / sizeof *options};
    struct gpu gpu;
    bool unsupported;
    enum option_outcome outcome = options_parse(&table, argc, argv);
    if (outcome != OPTIONS_RUN)
        return outcome == OPTIONS_HELP ? 0 : 2;
    const struct gpu_request request = {.device = a.device};
    if (!gpu_create(&request, &gpu, &unsupported))
        return unsupported ? 77 : 1;
    bool is_done = measure_all(&a, &gpu);
    gpu_destroy(&gpu);
    return is_done ? 0 : 1;
}
