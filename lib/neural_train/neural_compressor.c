#include "neural_train/neural_compressor.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "image/half.h"
#include "neural_train/trained_network.h"
#include "neural_train/train_schedule.h"
#include "vulkan/context.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "neural_train_train_comp.h"
#include "neural_train_train_latents_comp.h"
#include "neural_train_train_network_comp.h"
#include "neural_train_train_software_comp.h"

/* Most workgroups. Each writes 33 KB of partial sums per step. A multiple of 132, the number of
 * multiprocessors of a large device, so that rounds of workgroups are full. */
#define MAX_GROUPS 528u

uint64_t slc_train_network_size(void)
{
    return UINT64_C(4) * TRAIN_PARAMETERS * sizeof(float);
}

uint64_t slc_train_state_size(const struct slc_train_plan *plan)
{
    return UINT64_C(3) * slc_train_latent_count(plan) * sizeof(float);
}

static uint32_t reference_words(const struct slc_train_plan *plan)
{
    return (plan->channel_count + 1) / 2;
}

static uint64_t reference_size(const struct slc_train_plan *plan)
{
    return plan->texel_count * reference_words(plan) * 4;
}

static uint64_t upload_size(const struct slc_train_plan *plan)
{
    return slc_train_network_size() + slc_train_state_size(plan) + TRAIN_TABLE_WORDS * 4 +
           reference_size(plan);
}

static uint64_t size_of(const SluiceNeuralCompressor *c, uint32_t buffer)
{
    uint64_t latents = slc_train_latent_count(&c->plan);
    switch (buffer) {
    case SLC_TRAIN_NETWORK: return TRAIN_NETWORK_SIZE * sizeof(float);
    case SLC_TRAIN_PARTIALS: return (uint64_t)c->group_count * TRAIN_PARTIAL * sizeof(float);
    case SLC_TRAIN_LATENTS: return latents * 2;
    case SLC_TRAIN_STATE: return slc_train_state_size(&c->plan);
    case SLC_TRAIN_GRADIENTS: return latents * 4;
    case SLC_TRAIN_REFERENCES: return reference_size(&c->plan);
    case SLC_TRAIN_TABLE: return TRAIN_TABLE_WORDS * 4;
    default: return SLC_TRAIN_MAX_STEPS_PER_RECORD * TRAIN_OUTPUTS * sizeof(float);
    }
}

static SluiceResult create_buffers(SluiceNeuralCompressor *c)
{
    const struct slc_vk *vk = &c->context->vk;
    const struct slc_caps *caps = &c->context->caps;
    const VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                     VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                     VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    SluiceResult result = SLUICE_SUCCESS;
    for (uint32_t i = 0; i < SLC_TRAIN_BUFFER_COUNT && result == SLUICE_SUCCESS; i++)
        result = slc_buffer_init(&c->buffers[i], vk, caps, size_of(c, i), usage,
                                 i == SLC_TRAIN_LOSSES ? SLC_BUFFER_READBACK : SLC_BUFFER_DEVICE);
    if (result == SLUICE_SUCCESS)
        result = slc_buffer_init(&c->upload, vk, caps, upload_size(&c->plan),
                                 VK_BUFFER_USAGE_TRANSFER_SRC_BIT, SLC_BUFFER_UPLOAD);
    if (result == SLUICE_SUCCESS)
        result = slc_buffer_init(&c->readback, vk, caps,
                                 slc_train_network_size() + slc_train_state_size(&c->plan),
                                 VK_BUFFER_USAGE_TRANSFER_DST_BIT, SLC_BUFFER_READBACK);
    return result;
}

static VkPhysicalDeviceProperties properties_of(const SluiceNeuralCompressor *c)
{
    const struct slc_vk *vk = &c->context->vk;
    VkPhysicalDeviceProperties2 properties = {.sType =
                                                  VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    vk->GetPhysicalDeviceProperties2(vk->physical_device, &properties);
    return properties.properties;
}

static SluiceResult create_passes(SluiceNeuralCompressor *c)
{
    const uint32_t features = c->plan.feature_count, words = reference_words(&c->plan);
    const struct slc_compute_pass train = {
        slc_neural_train_train_comp, sizeof slc_neural_train_train_comp, {features, words}};
    const struct slc_compute_pass train_software = {slc_neural_train_train_software_comp,
                                                    sizeof slc_neural_train_train_software_comp,
                                                    {features, words}};
    const struct slc_compute_pass passes[3] = {
        properties_of(c).deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU ? train_software : train,
        {slc_neural_train_train_network_comp, sizeof slc_neural_train_train_network_comp, {0}},
        {slc_neural_train_train_latents_comp, sizeof slc_neural_train_train_latents_comp, {0}}};
    const struct slc_compute_create_info info = {.binding_count = SLC_TRAIN_BUFFER_COUNT,
                                                 .push_size = sizeof(struct slc_train_push),
                                                 .set_count = 1,
                                                 .passes = passes,
                                                 .pass_count = 3,
                                                 .name = "train a neural set"};
    SluiceResult result = slc_compute_init(&c->compute, &c->context->vk, &info);
    if (result != SLUICE_SUCCESS)
        return result;
    VkBuffer buffers[SLC_TRAIN_BUFFER_COUNT];
    for (uint32_t i = 0; i < SLC_TRAIN_BUFFER_COUNT; i++)
        buffers[i] = c->buffers[i].buffer;
    slc_compute_set_buffers(&c->compute, &c->context->vk, 0, buffers);
    return SLUICE_SUCCESS;
}

/* Writes references, two channels per word. Errors: INVALID_ARGUMENT for values not finite. */
static SluiceResult write_references(const struct slc_train_plan *plan, const float *const *mips,
                                     uint32_t *words, const SluiceLogCallback *log)
{
    const uint32_t channels = plan->channel_count, per_texel = reference_words(plan);
    for (uint32_t m = 0; m < plan->mip_count; m++) {
        size_t count = (size_t)slc_mip_size(plan->width, m) * slc_mip_size(plan->height, m);
        for (size_t i = 0; i < count; i++, words += per_texel) {
            memset(words, 0, per_texel * sizeof *words);
            for (uint32_t c = 0; c < channels; c++) {
                float value = mips[m][i * channels + c];
                if (!isfinite(value))
                    return slc_log_refusal(log, "ppMips[%u][%" PRIu64 "] is not finite", m,
                                           (uint64_t)(i * channels + c));
                words[c / 2] |= (uint32_t)slc_half_from_float(value) << (c % 2 * 16);
            }
        }
    }
    return SLUICE_SUCCESS;
}

static void init_state(const struct slc_train_plan *plan, float *network, float *state)
{
    uint32_t count = slc_train_latent_count(plan);
    memset(network, 0, (size_t)slc_train_network_size());
    memset(state, 0, (size_t)slc_train_state_size(plan));
    slc_network_init(network, plan->seed);
    for (uint32_t i = 0; i < count; i++)
        state[i] = 0.25f +
                   0.5f * slc_train_unit_float(slc_train_hash(i + slc_train_hash(plan->seed + 1u)));
}

static uint64_t fingerprint(const void *data, size_t words, uint64_t hash)
{
    const uint32_t *word = data;
    for (size_t i = 0; i < words; i++) /* FNV-1a over words */
        hash = (hash ^ word[i]) * UINT64_C(0x100000001B3);
    return hash;
}

static uint64_t fingerprint_of_plan(const struct slc_train_plan *plan)
{
    const uint32_t facts[] = {plan->width,
                              plan->height,
                              plan->mip_count,
                              plan->scale,
                              plan->feature_count,
                              plan->step_count,
                              plan->tile_count,
                              plan->seed,
                              plan->channel_count,
                              slc_float_bits(plan->network_rate),
                              slc_float_bits(plan->latent_rate)};
    uint64_t hash = fingerprint(facts, sizeof facts / 4, UINT64_C(0xCBF29CE484222325));
    for (uint32_t i = 0; i < plan->channel_count; i++) {
        const SluiceNeuralTrainingChannel *channel = &plan->channels[i];
        const uint32_t words[] = {slc_float_bits(channel->weight), channel->clamped, channel->mask};
        hash = fingerprint(words, 3, hash);
    }
    return hash;
}

static SluiceResult fill_upload(SluiceNeuralCompressor *c,
                                const SluiceNeuralCompressorCreateInfo *info)
{
    char *at = c->upload.mapped;
    float *network = (float *)(void *)at;
    at += slc_train_network_size();
    float *state = (float *)(void *)at;
    at += slc_train_state_size(&c->plan);
    slc_train_write_table(&c->plan, (uint32_t *)(void *)at);
    at += TRAIN_TABLE_WORDS * 4;
    SluiceResult result =
        write_references(&c->plan, info->ppMips, (uint32_t *)(void *)at, &c->context->vk.log);
    if (result != SLUICE_SUCCESS)
        return result;
    c->fingerprint =
        fingerprint(at, (size_t)(reference_size(&c->plan) / 4), fingerprint_of_plan(&c->plan));
    if (info->pCheckpoint)
        return slc_train_restore(c, info->pCheckpoint, info->checkpointSize, network);
    init_state(&c->plan, network, state);
    return SLUICE_SUCCESS;
}

static SluiceResult check_sizes(const SluiceNeuralCompressor *c)
{
    const uint32_t most = properties_of(c).limits.maxStorageBufferRange;
    for (uint32_t i = 0; i < SLC_TRAIN_BUFFER_COUNT; i++)
        if (size_of(c, i) > most) {
            slc_log(&c->context->vk.log, SLUICE_LOG_ERROR,
                    "neural set of %u x %u: a buffer of %llu bytes is beyond "
                    "maxStorageBufferRange, %u",
                    c->plan.width, c->plan.height, (unsigned long long)size_of(c, i), most);
            return SLUICE_ERROR_LIMIT_EXCEEDED;
        }
    return SLUICE_SUCCESS;
}

static SluiceResult init(SluiceNeuralCompressor *c, const SluiceNeuralCompressorCreateInfo *info)
{
    c->group_count = slc_min_u32(c->plan.tile_count, MAX_GROUPS);
    c->tiles_per_group = slc_div_up_u32(c->plan.tile_count, c->group_count);
    SluiceResult result = check_sizes(c);
    if (result == SLUICE_SUCCESS)
        result = create_buffers(c);
    if (result == SLUICE_SUCCESS)
        result = create_passes(c);
    return result == SLUICE_SUCCESS ? fill_upload(c, info) : result;
}

SluiceResult sluiceCreateNeuralCompressor(SluiceVulkanContext *context,
                                          const SluiceNeuralCompressorCreateInfo *pInfo,
                                          SluiceNeuralCompressor **pCompressor)
{
    SluiceNeuralCompressorCreateInfo info;
    if (!context || !pInfo || !pCompressor)
        return SLUICE_ERROR_NULL_POINTER;
    const SluiceLogCallback *log = &context->vk.log;
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceNeuralCompressorCreateInfo), &info, pInfo, log);
    if (result != SLUICE_SUCCESS)
        return result;
    struct slc_train_plan plan;
    result = slc_train_plan_init(&plan, &info, log);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceNeuralCompressor *c = slc_calloc(&context->cb, 1, sizeof *c);
    if (!c)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    c->context = context;
    c->plan = plan;
    slc_context_add_child(context);
    result = init(c, &info);
    if (result == SLUICE_SUCCESS)
        *pCompressor = c;
    else
        sluiceDestroyNeuralCompressor(c);
    return result;
}

void sluiceDestroyNeuralCompressor(SluiceNeuralCompressor *compressor)
{
    if (!compressor)
        return;
    SluiceVulkanContext *context = compressor->context;
    slc_compute_finish(&compressor->compute, &context->vk);
    for (uint32_t i = 0; i < SLC_TRAIN_BUFFER_COUNT; i++)
        slc_buffer_finish(&compressor->buffers[i], &context->vk);
    slc_buffer_finish(&compressor->upload, &context->vk);
    slc_buffer_finish(&compressor->readback, &context->vk);
    slc_train_free_result(compressor);
    slc_free(&context->cb, compressor, 1, sizeof *compressor);
    slc_context_remove_child(context);
}
