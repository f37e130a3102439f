/* Training on a device: gradients against a reference in double, the result of 32 x 32 texels, and
 * equal bits from equal input. */
#include "device/harness.h"
#include "neural_train/neural_compressor.h"
#include "neural_train/naive_texel.h"
#include "neural_train/trained_network.h"
#include "neural_train/train_schedule.h"
#include "vulkan/context.h"

#include "support/failing_allocator.h"
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MAX_MIPS 6u

/* A set of float mips. */
struct set {
    uint32_t size, channels, mips;
    float *texels[MAX_MIPS];
    SluiceNeuralTrainingChannel meaning[16];
    SluiceNeuralCompressorCreateInfo info;
};

/* Waves and a disk. The last channel is a mask that is 1 in the disk. */
static float texel_of(uint32_t size, uint32_t channels, uint32_t x, uint32_t y, uint32_t c)
{
    double u = (x + 0.5) / size, v = (y + 0.5) / size, r = hypot(u - 0.5, v - 0.5);
    if (c + 1 == channels)
        return (float)fmax(fmin((0.36 - r) * 16.0, 1.0), 0.0);
    double wave = sin(6.0 * u + 2.0 * c) * cos(5.0 * v + c);
    return (float)(0.5 + 0.3 * wave + (r < 0.36 ? 0.15 : -0.15));
}

static void set_init(struct set *set, uint32_t size, uint32_t channels, uint32_t mips)
{
    *set = (struct set){.size = size, .channels = channels, .mips = mips};
    for (uint32_t m = 0; m < mips; m++) {
        uint32_t edge = size >> m;
        set->texels[m] = malloc((size_t)edge * edge * channels * sizeof(float));
        for (uint32_t i = 0; i < edge * edge * channels; i++)
            set->texels[m][i] =
                texel_of(edge, channels, i / channels % edge, i / channels / edge, i % channels);
    }
    for (uint32_t c = 0; c < channels; c++)
        set->meaning[c] = (SluiceNeuralTrainingChannel){.clamped = true, .mask = c + 1 == channels};
    set->info = (SluiceNeuralCompressorCreateInfo){.structSize = sizeof set->info,
                                                   .width = size,
                                                   .height = size,
                                                   .mipCount = mips,
                                                   .channelCount = channels,
                                                   .pChannels = set->meaning,
                                                   .ppMips = (const float *const *)set->texels,
                                                   .gridSizeScale = 4,
                                                   .featureCount = 8,
                                                   .stepCount = 40,
                                                   .batchSize = 128,
                                                   .seed = 5};
}

static void set_finish(struct set *set)
{
    for (uint32_t m = 0; m < set->mips; m++)
        free(set->texels[m]);
}

struct recording {
    SluiceNeuralCompressor *compressor;
    uint32_t max_steps, steps;
};

static void record_training(void *user, VkCommandBuffer commands)
{
    struct recording *r = user;
    CHECK_OK(sluiceRecordNeuralTraining(r->compressor, commands, r->max_steps, &r->steps));
}

static void record_readback(void *user, VkCommandBuffer commands)
{
    struct recording *r = user;
    CHECK_OK(sluiceRecordNeuralReadback(r->compressor, commands));
}

/* Trains until `step`, and reads back. */
static void train(struct harness *h, SluiceNeuralCompressor *compressor,
                  uint32_t per_command_buffer, uint32_t step)
{
    struct recording r = {compressor, per_command_buffer, 1};
    while (r.steps > 0 && compressor->step < step) {
        if (r.max_steps > step - compressor->step)
            r.max_steps = step - compressor->step;
        harness_run(h, record_training, &r);
    }
    harness_run(h, record_readback, &r);
}

static void *checkpoint_of(SluiceNeuralCompressor *compressor, size_t *size)
{
    CHECK_OK(sluiceGetNeuralCheckpoint(compressor, NULL, size));
    void *checkpoint = malloc(*size);
    CHECK_OK(sluiceGetNeuralCheckpoint(compressor, checkpoint, size));
    return checkpoint;
}

static void *checkpoint_after(struct harness *h, const SluiceNeuralCompressorCreateInfo *info,
                              uint32_t per_command_buffer, uint32_t step, size_t *size)
{
    SluiceNeuralCompressor *compressor;
    CHECK_OK(sluiceCreateNeuralCompressor(h->context, info, &compressor));
    train(h, compressor, per_command_buffer, step);
    void *checkpoint = checkpoint_of(compressor, size);
    sluiceDestroyNeuralCompressor(compressor);
    return checkpoint;
}

static void bits_are_the_same_again_and_when_resumed(void **state)
{
    struct harness *h = *state;
    struct set set;
    size_t size, again_size, half_size;
    set_init(&set, 32, 4, 6);
    const uint32_t all = 42; /* 40, and two of the FP8 network */
    void *first = checkpoint_after(h, &set.info, 17, all, &size);
    void *half = checkpoint_after(h, &set.info, 100, 15, &half_size);
    set.info.pCheckpoint = half;
    set.info.checkpointSize = half_size;
    void *resumed = checkpoint_after(h, &set.info, 9, all, &again_size);
    assert_int_equal(size, again_size);
    assert_memory_equal(first, resumed, size);
    free(resumed);
    free(half);
    /* also from stages where only the network learns, and where the FP8 network does */
    set.info.pCheckpoint = NULL;
    half = checkpoint_after(h, &set.info, 64, 41, &half_size);
    set.info.pCheckpoint = half;
    resumed = checkpoint_after(h, &set.info, 1, all, &again_size);
    assert_memory_equal(first, resumed, size);
    set.info.pCheckpoint = NULL;
    set.info.seed++;
    void *other = checkpoint_after(h, &set.info, 17, all, &again_size);
    assert_memory_not_equal(first, other, size);
    free(other);
    free(resumed);
    free(half);
    free(first);
    set_finish(&set);
}

static double psnr(double squares, double count)
{
    return -10.0 * log10(squares / count);
}

/* Decodes mip 0 with the int8 network. Returns the PSNR after clamping. `*exact`: share of the
 * mask's 0s and 1s that are exact. */
static double decode(const struct set *set, const SluiceNeuralTrainedSet *trained, double *exact)
{
    double squares = 0.0, certain = 0.0, right = 0.0;
    for (uint32_t i = 0; i < set->size * set->size; i++) {
        int8_t inputs[48];
        float outputs[16];
        naive_inputs(trained, 0, set->size, set->size, i % set->size, i / set->size, inputs);
        naive_network(trained->pInt8Weights, inputs, outputs);
        for (uint32_t c = 0; c < set->channels; c++) {
            float wanted = set->texels[0][i * set->channels + c];
            float value = fmaxf(fminf(outputs[c], 1.0f), 0.0f);
            squares += pow((double)(value - wanted), 2.0);
            if (c + 1 == set->channels && (wanted <= 0.0f || wanted >= 1.0f)) {
                certain += 1.0;
                right += value == wanted;
            }
        }
    }
    *exact = right / certain;
    return psnr(squares, (double)set->size * set->size * set->channels);
}

static void the_int8_decoder_shows_what_was_trained(void **state)
{
    struct harness *h = *state;
    struct set set;
    SluiceNeuralCompressor *compressor;
    SluiceNeuralTrainedSet trained = {.structSize = sizeof trained};
    SluiceNeuralProgress progress = {.structSize = sizeof progress};
    double exact;
    set_init(&set, 32, 4, 6);
    set.info.stepCount = 200;
    set.info.batchSize = 1024;
    CHECK_OK(sluiceCreateNeuralCompressor(h->context, &set.info, &compressor));
    train(h, compressor, 25, 200);
    CHECK_OK(sluiceGetNeuralProgress(compressor, &progress));
    assert_int_equal(progress.step, 200);
    assert_int_equal(progress.stepCount, 210);
    CHECK_OK(sluiceGetNeuralTrainedSet(compressor, &trained));
    double decoded = decode(&set, &trained, &exact);
    double during = psnr(progress.meanSquaredError, 1.0);
    print_message("# %.2f dB decoded, %.2f dB in training, %.3f of the mask exact\n", decoded,
                  during, exact);
    assert_true(decoded > 26.5);
    /* The margin of the mask counts during training only, and includes mips. */
    assert_true(fabs(decoded - during) < 3.0);
    assert_true(exact > 0.98);
    sluiceDestroyNeuralCompressor(compressor);
    set_finish(&set);
}

/* ---- gradients ---- */

static const int ins[4] = {48, 64, 48, 32}, outs[4] = {64, 48, 32, 16};
static const int firsts[4] = {TRAIN_WEIGHTS0, TRAIN_WEIGHTS1, TRAIN_WEIGHTS2, TRAIN_WEIGHTS3};
static const int rows[4] = {0, 64, 112, 144};

struct gradients {
    const struct slc_train_plan *plan;
    const float *parameters, *latents;
    double network[TRAIN_PARAMETERS], *of_latents, loss;
};

/* The four corners of a texel in a grid, and their weights. */
struct corners {
    size_t at[4];
    double weight[4];
};

static struct corners corners_of(const struct slc_train_plan *plan, uint32_t image, uint32_t mip,
                                 uint32_t x, uint32_t y)
{
    const struct slc_latent_image *grid = &plan->images[image];
    int64_t width = plan->width >> mip, height = plan->height >> mip, w = grid->width,
            h = grid->height;
    double gx = (x + 0.5) / (double)width * (double)w - 0.5,
           gy = (y + 0.5) / (double)height * (double)h - 0.5;
    int64_t x0 = (int64_t)floor(gx), y0 = (int64_t)floor(gy);
    double fx = gx - floor(gx), fy = gy - floor(gy);
    struct corners c;
    for (int i = 0; i < 4; i++) {
        int64_t cx = (x0 + i % 2 + w) % w, cy = (y0 + i / 2 + h) % h;
        c.at[i] = (grid->first_texel + (size_t)(cy * w + cx)) * plan->feature_count;
        c.weight[i] = (i % 2 ? fx : 1.0 - fx) * (i / 2 ? fy : 1.0 - fy);
    }
    return c;
}

static double gelu(double r, double *slope)
{
    double t = fmax(fmin(r * 0.333333 + 0.5, 1.0), 0.0);
    *slope = r < -1.5 || r > 3.0 ? 0.0 : r > 1.5 ? 1.0 : r * 0.666667 + 0.5;
    return fmin(r, 3.0) * t;
}

static void fill_inputs(const struct gradients *g, uint32_t mip, uint32_t x, uint32_t y,
                        double *inputs)
{
    uint32_t first = slc_train_first_image(g->plan, mip);
    for (uint32_t image = 0; image < 2; image++) {
        struct corners c = corners_of(g->plan, first + image, mip, x, y);
        for (uint32_t f = 0; f < g->plan->feature_count; f++) {
            double s = 0.0;
            for (int i = 0; i < 4; i++)
                s += c.weight[i] * (double)g->latents[c.at[i] + f];
            inputs[image * 16 + f] = (255.0 * s - 128.5) / 127.5;
        }
        for (uint32_t f = g->plan->feature_count; f < 16; f++)
            inputs[image * 16 + f] = 0.0;
    }
    double scale = (double)slc_train_position_scale(g->plan, mip);
    for (uint32_t i = 0; i < 12; i++) {
        double t = (i % 2 ? y : x) * scale * (1 << i / 4) + (i % 4 < 2 ? 0.0 : 0.25);
        inputs[32 + i] = 2.0 * (t - floor(t)) - 1.0;
    }
    inputs[44] = inputs[45] = (double)slc_train_position_lod(g->plan, mip);
    inputs[46] = inputs[47] = 0.0;
}

/* Adds a texel's squared error times `times`, and its gradient, computed layer by layer. */
static void add_texel(struct gradients *g, const float *wanted, uint32_t mip, uint32_t x,
                      uint32_t y, double times)
{
    double value[5][64] = {{0}}, slope[4][64], delta[64] = {0}, before[64];
    fill_inputs(g, mip, x, y, value[0]);
    for (int l = 0; l < 4; l++)
        for (int o = 0; o < outs[l]; o++) {
            double sum = (double)g->parameters[TRAIN_BIASES + rows[l] + o];
            for (int i = 0; i < ins[l]; i++)
                sum += (double)g->parameters[firsts[l] + o * ins[l] + i] * value[l][i];
            value[l + 1][o] = l < 3 ? gelu(sum, &slope[l][o]) : sum;
        }
    for (uint32_t c = 0; c < g->plan->channel_count; c++) {
        delta[c] = (value[4][c] - (double)wanted[c]) * times;
        g->loss += 0.5 * delta[c] * delta[c] / times;
    }
    for (int l = 3; l >= 0; l--) {
        for (int i = 0; i < ins[l]; i++) {
            before[i] = 0.0;
            for (int o = 0; o < outs[l]; o++) {
                g->network[firsts[l] + o * ins[l] + i] += delta[o] * value[l][i];
                before[i] += delta[o] * (double)g->parameters[firsts[l] + o * ins[l] + i];
            }
        }
        for (int o = 0; o < outs[l]; o++)
            g->network[TRAIN_BIASES + rows[l] + o] += delta[o];
        for (int i = 0; i < ins[l]; i++)
            delta[i] = l > 0 ? before[i] * slope[l - 1][i] : before[i];
    }
    uint32_t first = slc_train_first_image(g->plan, mip);
    for (uint32_t image = 0; image < 2; image++) {
        struct corners c = corners_of(g->plan, first + image, mip, x, y);
        for (uint32_t f = 0; f < g->plan->feature_count; f++)
            for (int i = 0; i < 4; i++)
                g->of_latents[c.at[i] + f] += 2.0 * delta[image * 16 + f] * c.weight[i];
    }
}

/* Computes each texel of a mip as often as a step samples it. */
static void compute(struct gradients *g, const struct set *set)
{
    memset(g->network, 0, sizeof g->network);
    memset(g->of_latents, 0, slc_train_latent_count(g->plan) * sizeof *g->of_latents);
    g->loss = 0.0;
    for (uint32_t m = 0; m < g->plan->mip_count; m++) {
        uint32_t edge = set->size >> m;
        double times = g->plan->mip_tiles[m] * (double)TRAIN_TILE / (edge * edge);
        for (uint32_t i = 0; i < edge * edge; i++)
            add_texel(g, set->texels[m] + i * set->channels, m, i % edge, i / edge, times);
    }
}

struct gradient_pass {
    SluiceNeuralCompressor *compressor;
    struct harness_buffer partials, latents;
};

static void record_gradients(void *user, VkCommandBuffer commands)
{
    struct gradient_pass *pass = user;
    SluiceNeuralCompressor *c = pass->compressor;
    const struct slc_vk *vk = &c->context->vk;
    struct slc_train_push push;
    slc_train_write_push(&c->plan, 0, &push);
    push.flags = TRAIN_LATENTS;
    push.nextFlags = TRAIN_EXACT_LATENTS;
    push.tilesPerGroup = c->tiles_per_group;
    push.groupCount = c->group_count;
    const VkPipelineStageFlags compute = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
    const VkAccessFlags all = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT;
    struct slc_train_push exact = push;
    exact.flags = 0;
    slc_compute_barrier(vk, commands, compute, VK_ACCESS_SHADER_WRITE_BIT, compute, all);
    slc_compute_bind(&c->compute, vk, commands, 0, &exact);
    slc_compute_dispatch(&c->compute, vk, commands, 2,
                         (slc_train_latent_count(&c->plan) / 2 + 127) / 128, 1);
    slc_compute_barrier(vk, commands, compute, VK_ACCESS_SHADER_WRITE_BIT, compute, all);
    slc_compute_bind(&c->compute, vk, commands, 0, &push);
    slc_compute_dispatch(&c->compute, vk, commands, 0, c->group_count, 1);
    slc_compute_barrier(vk, commands, compute, VK_ACCESS_SHADER_WRITE_BIT,
                        VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
    VkBufferCopy whole = {0, 0, pass->partials.size};
    vk->CmdCopyBuffer(commands, c->buffers[SLC_TRAIN_PARTIALS].buffer, pass->partials.buffer, 1,
                      &whole);
    whole.size = pass->latents.size;
    vk->CmdCopyBuffer(commands, c->buffers[SLC_TRAIN_GRADIENTS].buffer, pass->latents.buffer, 1,
                      &whole);
    slc_compute_barrier(vk, commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                        VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
}

static void check_gradients(const struct gradients *g, const SluiceNeuralCompressor *c,
                            const struct gradient_pass *pass)
{
    const float *partials = pass->partials.mapped;
    const int32_t *latents = pass->latents.mapped;
    double off = 0.0, all = 0.0;
    for (uint32_t i = 0; i < TRAIN_PARAMETERS; i++) {
        double sum = 0.0;
        for (uint32_t group = 0; group < c->group_count; group++)
            sum += (double)partials[group * TRAIN_PARTIAL + i];
        off += pow(sum - g->network[i], 2.0);
        all += g->network[i] * g->network[i];
    }
    print_message("# network's gradient: relative error %.2e\n", sqrt(off / all));
    assert_true(sqrt(off / all) < 2e-3); /* references and latents have half precision */
    off = all = 0.0;
    for (uint32_t i = 0; i < slc_train_latent_count(g->plan); i++) {
        double value = latents[i] / (double)slc_train_latent_unit(g->plan);
        off += pow(value - g->of_latents[i], 2.0);
        all += g->of_latents[i] * g->of_latents[i];
    }
    print_message("# latents' gradient: relative error %.2e\n", sqrt(off / all));
    assert_true(sqrt(off / all) < 2e-3);
}

/* Compares the reference with differences of its loss. */
static void check_reference(struct gradients *g, const struct set *set, float *values, uint32_t at,
                            double gradient)
{
    const float step = 1e-3f, kept = values[at];
    values[at] = kept + step;
    compute(g, set);
    double above = g->loss;
    values[at] = kept - step;
    compute(g, set);
    double below = g->loss;
    values[at] = kept;
    double slope = (above - below) / (2.0 * (double)step);
    assert_true(fabs(slope - gradient) <= 0.02 * fabs(gradient) + 2e-3);
}

static void gradients_are_those_of_the_reference(void **state)
{
    struct harness *h = *state;
    struct set set;
    set_init(&set, 16, 3, 3);
    for (uint32_t c = 0; c < 3; c++)
        set.meaning[c] = (SluiceNeuralTrainingChannel){0};
    set.info.batchSize = 256 + 64 + 32; /* each texel of 16, 8 and 4; those of 4 twice */
    SluiceNeuralCompressor *c;
    CHECK_OK(sluiceCreateNeuralCompressor(h->context, &set.info, &c));
    train(h, c, 0, 1); /* no step: initial values */
    float *values = malloc((size_t)slc_train_latent_count(&c->plan) * sizeof *values);
    memcpy(values, slc_train_read_latents(c), slc_train_latent_count(&c->plan) * sizeof *values);
    float parameters[TRAIN_PARAMETERS];
    memcpy(parameters, slc_train_read_fp8(c), sizeof parameters);
    static struct gradients g;
    g = (struct gradients){.plan = &c->plan, .parameters = parameters, .latents = values};
    g.of_latents = calloc(slc_train_latent_count(&c->plan), sizeof *g.of_latents);
    compute(&g, &set);

    struct gradient_pass pass = {c, {0}, {0}};
    harness_buffer_init(h, &pass.partials, c->buffers[SLC_TRAIN_PARTIALS].size,
                        VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    harness_buffer_init(h, &pass.latents, c->buffers[SLC_TRAIN_GRADIENTS].size,
                        VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    harness_run(h, record_gradients, &pass);
    assert_int_equal(c->plan.tile_count * TRAIN_TILE, set.info.batchSize);
    check_gradients(&g, c, &pass);
    static const uint32_t places[] = {5, 3100, 6200, 7700, TRAIN_BIASES + 3, TRAIN_BIAS3 + 1};
    double network[TRAIN_PARAMETERS];
    memcpy(network, g.network, sizeof network);
    for (size_t i = 0; i < sizeof places / sizeof *places; i++)
        check_reference(&g, &set, parameters, places[i], network[places[i]]);
    compute(&g, &set);
    double of_latent = g.of_latents[9];
    check_reference(&g, &set, values, 9, of_latent);
    harness_buffer_finish(h, &pass.partials);
    harness_buffer_finish(h, &pass.latents);
    free(g.of_latents);
    free(values);
    sluiceDestroyNeuralCompressor(c);
    set_finish(&set);
}

static void damaged_checkpoints_are_refused(void **state)
{
    struct harness *h = *state;
    struct set set;
    size_t size;
    SluiceNeuralCompressor *compressor = NULL;
    set_init(&set, 16, 3, 1);
    unsigned char *checkpoint = checkpoint_after(h, &set.info, 10, 2, &size);
    set.info.pCheckpoint = checkpoint;
    h->quiet = true;
    for (size_t at = 0; at < size; at += at < 64 ? 5 : size / 7) {
        set.info.checkpointSize = size;
        checkpoint[at] ^= 0x10;
        CHECK_RESULT(sluiceCreateNeuralCompressor(h->context, &set.info, &compressor),
                     SLUICE_ERROR_CORRUPT_DATA);
        checkpoint[at] ^= 0x10;
        set.info.checkpointSize = at;
        CHECK_RESULT(sluiceCreateNeuralCompressor(h->context, &set.info, &compressor),
                     SLUICE_ERROR_CORRUPT_DATA);
    }
    set.info.checkpointSize = size;
    set.texels[0][7] = 0.25f;
    CHECK_RESULT(sluiceCreateNeuralCompressor(h->context, &set.info, &compressor),
                 SLUICE_ERROR_CORRUPT_DATA);
    set.texels[0][7] = INFINITY;
    CHECK_RESULT(sluiceCreateNeuralCompressor(h->context, &set.info, &compressor),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    h->quiet = false;
    assert_null(compressor);
    free(checkpoint);
    set_finish(&set);
}

/* Makes all calls with an allocator that refuses from call `refuse_from` on. Returns false if a
 * call was refused. */
static bool live(struct harness *h, struct failing_allocator *allocator, const struct set *set,
                 uint64_t refuse_from)
{
    SluiceNeuralCompressor *compressor = NULL;
    SluiceNeuralTrainedSet trained = {.structSize = sizeof trained};
    SluiceNeuralProgress progress = {.structSize = sizeof progress};
    size_t size;
    allocator->calls = 0;
    allocator->refuse_from = refuse_from;
    SluiceResult result = sluiceCreateNeuralCompressor(h->context, &set->info, &compressor);
    if (result == SLUICE_SUCCESS) {
        train(h, compressor, 1, 1);
        CHECK_OK(sluiceGetNeuralProgress(compressor, &progress));
        free(checkpoint_of(compressor, &size));
        result = sluiceGetNeuralTrainedSet(compressor, &trained);
    }
    if (result != SLUICE_SUCCESS)
        CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    sluiceDestroyNeuralCompressor(compressor);
    return result == SLUICE_SUCCESS;
}

static void every_refused_allocation_is_survived(void **state)
{
    struct harness *h = *state;
    struct failing_allocator allocator;
    struct set set;
    failing_allocator_init(&allocator, UINT64_MAX);
    SluiceVulkanContextCreateInfo context = harness_context_info(h);
    context.pAllocator = &allocator.callbacks;
    CHECK_OK(harness_set_context(h, &context));
    set_init(&set, 16, 3, 1);
    const uint64_t before = allocator.live_bytes;
    uint64_t refused = 0;
    while (!live(h, &allocator, &set, refused)) {
        assert_int_equal(allocator.live_bytes, before);
        refused++;
    }
    assert_int_equal(allocator.live_bytes, before);
    assert_int_equal(refused, 2); /* the compressor, and the texels of its result */
    allocator.refuse_from = UINT64_MAX;
    CHECK_OK(harness_set_context(h, NULL));
    set_finish(&set);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(gradients_are_those_of_the_reference),
        cmocka_unit_test(bits_are_the_same_again_and_when_resumed),
        cmocka_unit_test(the_int8_decoder_shows_what_was_trained),
        cmocka_unit_test(damaged_checkpoints_are_refused),
        cmocka_unit_test(every_refused_allocation_is_survived),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
