#include "training_run.h"

#include "clock.h"
#include "input.h"
#include "log.h"
#include "output_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FIRST_SUBMISSION 64u /* steps; a software device takes a second or more for them */
#define MOST_STEPS 1024u     /* limit of steps per submission */
#define SHORT_SECONDS 0.1    /* after a shorter submission, the next one has twice the steps */
#define CHECKPOINT_SECONDS 60.0
#define CHECKPOINT_LIMIT (UINT64_C(4) << 30)

struct session {
    struct training_run *run;
    SluiceVulkanContext *context;
    SluiceNeuralCompressor *compressor;
    VkCommandBuffer commands;
    VkFence fence;
    double start, shown, saved;
};

static bool check(SluiceResult result, const char *what)
{
    if (result < 0)
        fprintf(stderr, "%s: %s\n", what, sluiceGetResultName(result));
    return result == SLUICE_SUCCESS;
}

static bool create(struct session *s)
{
    const struct training_run *run = s->run;
    const struct training_set *set = run->set;
    const SluiceVulkanContextCreateInfo context = {.structSize = sizeof context,
                                                   .queueFamilyIndex = run->gpu->family,
                                                   .instance = run->gpu->instance,
                                                   .physicalDevice = run->gpu->physical_device,
                                                   .device = run->gpu->device,
                                                   .pfnGetInstanceProcAddr = vkGetInstanceProcAddr,
                                                   .log = {NULL, log_say}};
    SluiceNeuralCompressorCreateInfo info = {.structSize = sizeof info,
                                             .width = set->width,
                                             .height = set->height,
                                             .mipCount = set->mip_count,
                                             .channelCount = set->channel_count,
                                             .pChannels = set->meaning,
                                             .ppMips = (const float *const *)set->mips,
                                             .gridSizeScale = run->scale,
                                             .featureCount = run->features,
                                             .stepCount = run->steps,
                                             .batchSize = run->batch,
                                             .seed = run->seed};
    char *checkpoint = NULL;
    if (run->checkpoint &&
        input_read_file(run->checkpoint, CHECKPOINT_LIMIT, &checkpoint, &info.checkpointSize))
        info.pCheckpoint = checkpoint;
    bool is_made = check(sluiceCreateVulkanContext(&context, &s->context), "Vulkan context") &&
                   check(sluiceCreateNeuralCompressor(s->context, &info, &s->compressor),
                         info.pCheckpoint ? run->checkpoint : "compressor");
    free(checkpoint);
    const VkCommandBufferAllocateInfo commands = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = run->gpu->command_pool,
        .commandBufferCount = 1};
    const VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    return is_made &&
           gpu_check(vkAllocateCommandBuffers(run->gpu->device, &commands, &s->commands),
                     "vkAllocateCommandBuffers") &&
           gpu_check(vkCreateFence(run->gpu->device, &fence, NULL, &s->fence), "vkCreateFence");
}

static void destroy(struct session *s)
{
    VkDevice device = s->run->gpu->device;
    sluiceDestroyNeuralCompressor(s->compressor);
    sluiceDestroyVulkanContext(s->context);
    vkDestroyFence(device, s->fence, NULL);
    if (s->commands)
        vkFreeCommandBuffers(device, s->run->gpu->command_pool, 1, &s->commands);
}

/* Submits up to `max_steps` steps, or a readback if 0. `*steps`: number of recorded steps. */
static bool run_commands(struct session *s, uint32_t max_steps, uint32_t *steps)
{
    const struct gpu *gpu = s->run->gpu;
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    const VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                                 .commandBufferCount = 1,
                                 .pCommandBuffers = &s->commands};
    *steps = 0;
    return gpu_check(vkBeginCommandBuffer(s->commands, &begin), "vkBeginCommandBuffer") &&
           check(max_steps
                     ? sluiceRecordNeuralTraining(s->compressor, s->commands, max_steps, steps)
                     : sluiceRecordNeuralReadback(s->compressor, s->commands),
                 "training") &&
           gpu_check(vkEndCommandBuffer(s->commands), "vkEndCommandBuffer") &&
           gpu_check(vkQueueSubmit(gpu->queue, 1, &submit, s->fence), "vkQueueSubmit") &&
           gpu_check(vkWaitForFences(gpu->device, 1, &s->fence, VK_TRUE, UINT64_MAX),
                     "vkWaitForFences") &&
           gpu_check(vkResetFences(gpu->device, 1, &s->fence), "vkResetFences");
}

/* Prints progress each second, and after the last step. */
static void show(struct session *s)
{
    SluiceNeuralProgress progress = {.structSize = sizeof progress};
    double time = clock_seconds();
    if (!s->run->progress ||
        !check(sluiceGetNeuralProgress(s->compressor, &progress), "progress") ||
        (time < s->shown + 1.0 && progress.step < progress.stepCount))
        return;
    s->shown = time;
    double left = (time - s->start) / s->run->steps_run * (progress.stepCount - progress.step);
    fprintf(stderr, "step %u of %u: %.2f dB in all mips, %.1f s left\n", progress.step,
            progress.stepCount, -10.0 * log10(progress.meanSquaredError), left);
}

static bool save(struct session *s)
{
    uint32_t steps;
    size_t size;
    if (!run_commands(s, 0, &steps) ||
        !check(sluiceGetNeuralCheckpoint(s->compressor, NULL, &size), "checkpoint"))
        return false;
    void *checkpoint = malloc(size);
    struct output_file *file = checkpoint ? output_file_begin(s->run->checkpoint) : NULL;
    bool is_whole =
        file && check(sluiceGetNeuralCheckpoint(s->compressor, checkpoint, &size), "checkpoint") &&
        fwrite(checkpoint, 1, size, output_file_stream(file)) == size;
    is_whole = output_file_end(file, is_whole) && is_whole;
    free(checkpoint);
    s->saved = clock_seconds();
    return is_whole;
}

static bool train(struct session *s)
{
    uint32_t steps = 1, wanted = FIRST_SUBMISSION;
    s->start = clock_seconds();
    s->saved = s->start - CHECKPOINT_SECONDS; /* saves at once, so that a bad path fails early */
    while (steps > 0) {
        const double begin = clock_seconds();
        if (!run_commands(s, wanted, &steps))
            return false;
        if (clock_seconds() - begin < SHORT_SECONDS && wanted < MOST_STEPS)
            wanted *= 2;
        s->run->steps_run += steps;
        s->run->seconds = clock_seconds() - s->start;
        if (steps > 0)
            show(s);
        if (s->run->checkpoint && steps > 0 && clock_seconds() > s->saved + CHECKPOINT_SECONDS &&
            !save(s))
            return false;
    }
    return run_commands(s, 0, &steps);
}

/* Packs codes of 4 bits into the layout of slices. */
static void pack(const SluiceNeuralTrainedSet *trained, const SluiceNeuralConstants *constants,
                 uint8_t *latents)
{
    const uint32_t features = trained->featureCount;
    for (uint32_t n = 0; n < trained->latentImageCount; n++) {
        const SluiceNeuralTrainedImage *image = &trained->latentImages[n];
        uint8_t *slice = latents + constants->slices[n].dataOffset;
        const size_t texels = (size_t)image->width * image->height;
        for (size_t i = 0; i < texels; i++)
            for (uint32_t f = 0; f < features; f += 4) {
                const uint16_t codes = image->pTexels[f / 4 * texels + i];
                slice[(i * features + f) / 2] = (uint8_t)codes;
                slice[(i * features + f) / 2 + 1] = (uint8_t)(codes >> 8);
            }
    }
}

static bool repair_masks(struct training_run *run, const SluiceNeuralConstants *constants,
                         const SluiceNeuralTrainedSet *trained, uint8_t *latents,
                         uint64_t latent_size)
{
    const struct training_set *set = run->set;
    const double start = clock_seconds();
    float weights[SLUICE_NEURAL_MAX_CHANNELS];
    SluiceNeuralMaskReport report = {.structSize = sizeof report};
    SluiceNeuralMaskInfo info = {
        .structSize = sizeof info,
        .pConstants = constants,
        .pLatents = latents,
        .latentSize = latent_size,
        .pInt8Weights = trained->pInt8Weights,
        .weightSize = trained->int8Size,
        .channelCount = set->channel_count,
        .pLossWeights = weights,
        .ppMips = (const float *const *)set->mips,
        /* More wrong texels mean that training was too short. Repair would take long. */
        .maxWrongCount = 1 + (uint64_t)set->width * set->height / 50,
        .log = {NULL, log_say}};
    for (uint32_t c = 0; c < set->channel_count; c++) {
        weights[c] = set->meaning[c].weight > 0.0f ? set->meaning[c].weight : 1.0f;
        info.maskChannels |= (uint32_t)set->meaning[c].mask << c;
        info.clampedChannels |= (uint32_t)set->meaning[c].clamped << c;
    }
    if (info.maskChannels == 0)
        return true;
    if (!check(sluiceRepairNeuralMasks(&info, &report), "masks"))
        return false;
    run->repaired = report.wrongBefore - report.wrongAfter;
    run->repair_seconds = clock_seconds() - start;
    if (report.wrongAfter > 0)
        fprintf(stderr, "%llu texels of masks that should be 0 or 1 are not exactly that\n",
                (unsigned long long)report.wrongAfter);
    return true;
}

static bool write_file(struct session *s)
{
    struct training_run *run = s->run;
    SluiceNeuralTrainedSet trained = {.structSize = sizeof trained};
    SluiceNeuralConstants constants;
    uint64_t latent_size;
    if (!check(sluiceGetNeuralTrainedSet(s->compressor, &trained), "trained set"))
        return false;
    SluiceNeuralWriteInfo info = {.structSize = sizeof info,
                                  .pPath = run->output,
                                  .schema = 3,
                                  .width = run->set->width,
                                  .height = run->set->height,
                                  .mipCount = run->set->mip_count,
                                  .channelCount = run->set->channel_count,
                                  .textureCount = run->set->texture_count,
                                  .pTextures = run->set->textures,
                                  .pColorSpaces = run->set->spaces,
                                  .network = SLUICE_NEURAL_NETWORK_SCHEMA3,
                                  .highFeatures = run->features,
                                  .gridScale = run->scale,
                                  .latentImageCount = trained.latentImageCount,
                                  .pInt8Weights = trained.pInt8Weights,
                                  .pFp8Weights = trained.pFp8Weights,
                                  .log = {NULL, log_say}};
    if (!check(sluicePlanNeuralFile(&info, &constants, &latent_size), run->output))
        return false;
    uint8_t *latents = calloc((size_t)latent_size, 1);
    if (!latents) {
        fprintf(stderr, "%s: out of memory\n", run->output);
        return false;
    }
    pack(&trained, &constants, latents);
    info.pLatents = latents;
    bool is_written = repair_masks(run, &constants, &trained, latents, latent_size) &&
                      check(sluiceWriteNeuralFile(&info), run->output);
    free(latents);
    return is_written;
}

/* Squared errors of mip 0 by channel. Masks are counted in all mips. */
struct errors {
    double squares[SLUICE_NEURAL_MAX_CHANNELS], certain, exact;
};

static void add_row(const struct training_set *set, const float *decoded, const float *wanted,
                    uint32_t width, bool is_mip0, struct errors *errors)
{
    for (uint32_t i = 0; i < width * set->channel_count; i++) {
        uint32_t c = i % set->channel_count;
        float value = decoded[i];
        if (set->meaning[c].clamped)
            value = fmaxf(fminf(value, 1.0f), 0.0f);
        if (is_mip0)
            errors->squares[c] += pow((double)(value - wanted[i]), 2.0);
        if (set->meaning[c].mask && (wanted[i] <= 0.0f || wanted[i] >= 1.0f)) {
            errors->certain += 1.0;
            errors->exact += value == wanted[i];
        }
    }
}

static bool decode_mip(const struct training_set *set, const SluiceNeuralDecodeInfo *decode,
                       struct errors *errors)
{
    SluiceNeuralDecodeInfo row = *decode;
    const uint32_t height = set->height >> row.mip ? set->height >> row.mip : 1;
    bool is_read = true;
    row.width = set->width >> row.mip ? set->width >> row.mip : 1;
    row.height = 1;
    for (row.y = 0; row.y < height && is_read; row.y++) {
        is_read = check(sluiceDecodeNeuralTexels(&row), "decoding");
        add_row(set, row.pTexels,
                set->mips[row.mip] + (size_t)row.y * row.width * set->channel_count, row.width,
                row.mip == 0, errors);
    }
    return is_read;
}

static bool has_mask(const struct training_set *set)
{
    for (uint32_t c = 0; c < set->channel_count; c++)
        if (set->meaning[c].mask)
            return true;
    return false;
}

/* Decodes the written file, as its readers do. */
static bool decode(const struct training_run *run, SluiceNeuralSet *file,
                   SluiceNeuralWeightKind kind, struct errors *errors)
{
    const struct training_set *set = run->set;
    SluiceNeuralConstants constants;
    uint64_t latent_size, weight_size;
    if (!check(sluiceReadNeuralLatents(file, NULL, &constants, &latent_size, NULL), "latents") ||
        !check(sluiceGetNeuralWeights(file, kind, NULL, &weight_size, NULL), "weights"))
        return false;
    char *latents = malloc((size_t)latent_size), *weights = malloc((size_t)weight_size);
    float *row = malloc((size_t)set->width * set->channel_count * sizeof *row);
    SluiceNeuralDecodeInfo info = {.structSize = sizeof info,
                                   .pConstants = &constants,
                                   .pLatents = latents,
                                   .latentSize = latent_size,
                                   .pWeights = weights,
                                   .weightSize = weight_size,
                                   .weightKind = kind,
                                   .channelCount = set->channel_count,
                                   .pTexels = row};
    bool is_read =
        latents && weights && row &&
        check(sluiceReadNeuralLatents(file, NULL, &constants, &latent_size, latents), "latents") &&
        check(sluiceGetNeuralWeights(file, kind, NULL, &weight_size, weights), "weights");
    const uint32_t mips = has_mask(set) ? set->mip_count : 1;
    for (info.mip = 0; info.mip < mips && is_read; info.mip++)
        is_read = decode_mip(set, &info, errors);
    free(row);
    free(weights);
    free(latents);
    return is_read;
}

static double psnr_of(const struct training_set *set, const struct errors *errors)
{
    double sum = 0.0;
    for (uint32_t c = 0; c < set->channel_count; c++)
        sum += errors->squares[c];
    return -10.0 * log10(sum / ((double)set->width * set->height * set->channel_count));
}

static bool compare(struct training_run *run)
{
    const SluiceNeuralSetCreateInfo info = {
        .structSize = sizeof info, .pPath = run->output, .log = {NULL, log_say}};
    SluiceNeuralSet *file = NULL;
    SluiceNeuralSetInfo facts = {.structSize = sizeof facts};
    struct errors int8 = {0}, fp8 = {0};
    bool is_read = check(sluiceOpenNeuralSet(&info, &file), run->output) &&
                   check(sluiceGetNeuralSetInfo(file, &facts), run->output) &&
                   decode(run, file, SLUICE_NEURAL_WEIGHTS_INT8, &int8) &&
                   decode(run, file, SLUICE_NEURAL_WEIGHTS_FP8, &fp8);
    sluiceDestroyNeuralSet(file);
    run->file_size = facts.fileSize;
    run->psnr = psnr_of(run->set, &int8);
    run->fp8_psnr = psnr_of(run->set, &fp8);
    run->exact_mask = int8.certain > 0.0 ? int8.exact / int8.certain : 1.0;
    for (uint32_t c = 0; c < run->set->channel_count; c++)
        run->channel_psnr[c] =
            -10.0 * log10(int8.squares[c] / ((double)run->set->width * run->set->height));
    return is_read;
}

bool training_run(struct training_run *run)
{
    struct session session = {.run = run};
    run->steps_run = 0;
    run->seconds = run->repair_seconds = 0.0;
    run->repaired = 0;
    bool is_done = create(&session) && train(&session) && write_file(&session);
    destroy(&session);
    return is_done && compare(run);
}
