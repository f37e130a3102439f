#include "neural_vulkan/tile_decoder.h"

#include "base/alloc.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "vulkan/context.h"

#include <string.h>

#include "neural_produce_comp.h"
#include "neural_produce_comp_schema3.h"

#define DEFAULT_SCRATCH (UINT64_C(4) << 20)
#define MAX_SCRATCH (UINT64_C(256) << 20)
#define MAX_SLICE (UINT64_C(1) << 29) /* bytes: shaders count bits in 32 bits */

/* Returns the bytes of weights, scales and biases. 0: no such network exists. */
static uint64_t weight_size(const SluiceNeuralConstants *constants)
{
    const uint32_t in = constants->inputCount;
    const bool third = constants->schema == 3;
    if (third ? in != 48 : constants->schema != 1 || in < 48 || in > 96 || in % 16)
        return 0;
    const uint32_t sizes[SLUICE_NEURAL_LAYERS + 1] = {in, 64, third ? 48 : 64, third ? 32 : 64, 16};
    uint64_t size = 0;
    for (int i = 0; i < SLUICE_NEURAL_LAYERS; i++)
        size += (uint64_t)sizes[i] * sizes[i + 1] + sizes[i + 1] * UINT64_C(8);
    return size;
}

/* Checks the number of inputs. Shaders hold a texel's inputs in an array of fixed size. */
static bool inputs_are_right(const SluiceNeuralConstants *c)
{
    if (c->schema == 3)
        return c->networkFeatures == 16 && c->lowFeatures == c->highFeatures && c->highBits == 4 &&
               c->lowBits == 4;
    return c->networkFeatures == (c->inputCount - 32) / 4;
}

static bool features_are_right(uint32_t features, uint32_t bits)
{
    return features >= 4 && features <= 16 && features % 4 == 0 &&
           (bits == 1 || bits == 2 || bits == 4 || bits == 8);
}

/* Errors: INVALID_ARGUMENT. */
static SluiceResult check_slice(const SluiceVulkanNeuralDecoderCreateInfo *info, uint32_t index,
                                uint32_t features, uint32_t bits)
{
    const SluiceNeuralSlice *slice = &info->pConstants->slices[index];
    uint64_t width = slice->sliceSize & 0xFFFFu, height = slice->sliceSize >> 16;
    uint64_t size = (width * height * features * bits + 31) / 32 * 4;
    uint64_t end = slice->dataOffset + size;
    if (slice->sliceSize != slice->gridSize || slice->origin || !width || !height)
        return slc_log_refusal(&info->context->vk.log,
                               "pConstants->slices[%u] is not the whole of its grid", index);
    if (width > SLUICE_NEURAL_MAX_SIZE || height > SLUICE_NEURAL_MAX_SIZE || size > MAX_SLICE)
        return slc_log_refusal(&info->context->vk.log,
                               "pConstants->slices[%u] has %u x %u texels and %llu bytes; the "
                               "limits are %u texels and 2^29 bytes",
                               index, (uint32_t)width, (uint32_t)height, (unsigned long long)size,
                               SLUICE_NEURAL_MAX_SIZE);
    if (slice->dataOffset % 4 || end > info->latentSize)
        return slc_log_refusal(&info->context->vk.log,
                               "pConstants->slices[%u] ends at byte %llu, but latentSize is %llu",
                               index, (unsigned long long)end,
                               (unsigned long long)info->latentSize);
    return SLUICE_SUCCESS;
}

/* Errors: INVALID_ARGUMENT. */
static SluiceResult check_constants(const SluiceVulkanNeuralDecoderCreateInfo *info)
{
    const SluiceNeuralConstants *c = info->pConstants;
    const SluiceLogCallback *log = &info->context->vk.log;
    if (weight_size(c) == 0 || weight_size(c) != info->weightSize)
        return slc_log_refusal(log, "weightSize is %llu; schema %u with %u inputs has %llu",
                               (unsigned long long)info->weightSize, c->schema, c->inputCount,
                               (unsigned long long)weight_size(c));
    if (c->width - 1 >= SLUICE_NEURAL_MAX_SIZE || c->height - 1 >= SLUICE_NEURAL_MAX_SIZE)
        return slc_log_refusal(log, "pConstants has %u x %u texels; a side has 1 to %u", c->width,
                               c->height, SLUICE_NEURAL_MAX_SIZE);
    if (c->mipCount - 1 >= SLUICE_NEURAL_MAX_MIPS || c->firstMip != 0 ||
        c->residentMipCount != c->mipCount)
        return slc_log_refusal(log, "pConstants has mips %u to %u of %u; all are needed",
                               c->firstMip, c->firstMip + c->residentMipCount, c->mipCount);
    if (c->channelCount - 1 >= SLUICE_NEURAL_MAX_CHANNELS || !inputs_are_right(c) ||
        !features_are_right(c->highFeatures, c->highBits) ||
        !features_are_right(c->lowFeatures, c->lowBits) || c->highFeatures > c->networkFeatures)
        return slc_log_refusal(log, "pConstants has channels or features that no set has");
    for (uint32_t m = 0; m < c->mipCount; m++) {
        uint32_t first = c->mips[m].firstSlice;
        if (first > 14)
            return slc_log_refusal(log, "pConstants->mips[%u].firstSlice is %u; the last is 14", m,
                                   first);
        SluiceResult result = check_slice(info, first, c->highFeatures, c->highBits);
        if (result == SLUICE_SUCCESS)
            result = check_slice(info, first + 1, c->lowFeatures, c->lowBits);
        if (result != SLUICE_SUCCESS)
            return result;
    }
    return SLUICE_SUCCESS;
}

/* Errors: LIMIT_EXCEEDED. */
static SluiceResult check_range(const SluiceVulkanNeuralDecoderCreateInfo *info)
{
    const uint32_t most = info->context->caps.max_storage_buffer_range;
    if (info->latentSize <= most && info->scratchSize <= most)
        return SLUICE_SUCCESS;
    slc_log(&info->context->vk.log, SLUICE_LOG_ERROR,
            "latentSize is %llu and scratchSize is %llu; maxStorageBufferRange of the device is %u",
            (unsigned long long)info->latentSize, (unsigned long long)info->scratchSize, most);
    return SLUICE_ERROR_LIMIT_EXCEEDED;
}

/* Errors: NULL_POINTER, INVALID_ARGUMENT, LIMIT_EXCEEDED. */
static SluiceResult read_info(SluiceVulkanNeuralDecoderCreateInfo *info,
                              const SluiceVulkanNeuralDecoderCreateInfo *given)
{
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceVulkanNeuralDecoderCreateInfo), info, given, NULL);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!info->context || !info->pConstants || !info->pLatents || !info->pWeights)
        return SLUICE_ERROR_NULL_POINTER;
    const SluiceLogCallback *log = &info->context->vk.log;
    if (!slc_allocator_is_valid(info->pAllocator))
        return slc_log_refusal(log, "pAllocator lacks a function");
    if (info->scratchSize == 0)
        info->scratchSize = DEFAULT_SCRATCH;
    if (info->scratchSize < 65536 || info->scratchSize > MAX_SCRATCH)
        return slc_log_refusal(log, "scratchSize is %llu; it must be 65536 to %llu",
                               (unsigned long long)info->scratchSize,
                               (unsigned long long)MAX_SCRATCH);
    if (info->latentSize == 0 || info->latentSize % 4 || info->latentSize > UINT32_MAX)
        return slc_log_refusal(log, "latentSize is %llu; it must be a multiple of 4 below 2^32",
                               (unsigned long long)info->latentSize);
    result = check_constants(info);
    return result == SLUICE_SUCCESS ? check_range(info) : result;
}

static SluiceResult upload(SluiceVulkanNeuralDecoder *d, enum slc_neural_buffer which,
                           const void *data, uint64_t size)
{
    SluiceResult result =
        slc_buffer_init(&d->buffers[which], &d->context->vk, &d->context->caps, size,
                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, SLC_BUFFER_TABLE);
    if (result == SLUICE_SUCCESS)
        memcpy(d->buffers[which].mapped, data, (size_t)size);
    return result;
}

static SluiceResult create_buffers(SluiceVulkanNeuralDecoder *d,
                                   const SluiceVulkanNeuralDecoderCreateInfo *info)
{
    SluiceResult result =
        upload(d, SLC_NEURAL_CONSTANTS, info->pConstants, sizeof *info->pConstants);
    if (result == SLUICE_SUCCESS)
        result = upload(d, SLC_NEURAL_LATENTS, info->pLatents, info->latentSize);
    if (result == SLUICE_SUCCESS)
        result = upload(d, SLC_NEURAL_WEIGHTS, info->pWeights, info->weightSize);
    if (result == SLUICE_SUCCESS)
        result = slc_buffer_init(
            &d->buffers[SLC_NEURAL_SCRATCH], &d->context->vk, &d->context->caps, info->scratchSize,
            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
            SLC_BUFFER_DEVICE);
    return result;
}

/* Creates a pipeline. A shader for schema 3 alone is twice as fast as a shader for both; a shader
 * for schema 1 alone gains nothing (docs/neural.md). */
static SluiceResult create_pipeline(SluiceVulkanNeuralDecoder *d, uint32_t schema)
{
    static const struct slc_compute_pass passes[2] = {
        {slc_neural_produce_comp, sizeof slc_neural_produce_comp, {0, 0}},
        {slc_neural_produce_comp_schema3, sizeof slc_neural_produce_comp_schema3, {0, 0}}};
    SluiceResult result = slc_compute_init(
        &d->compute, &d->context->vk,
        &(struct slc_compute_create_info){.binding_count = SLC_NEURAL_BUFFER_COUNT,
                                          .push_size = sizeof(struct SluiceNeuralTile),
                                          .set_count = 1,
                                          .passes = &passes[schema == 3],
                                          .pass_count = 1,
                                          .name = "decode neural tiles"});
    if (result != SLUICE_SUCCESS)
        return result;
    VkBuffer buffers[SLC_NEURAL_BUFFER_COUNT];
    for (uint32_t i = 0; i < SLC_NEURAL_BUFFER_COUNT; i++)
        buffers[i] = d->buffers[i].buffer;
    slc_compute_set_buffers(&d->compute, &d->context->vk, 0, buffers);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceCreateVulkanNeuralDecoder(const SluiceVulkanNeuralDecoderCreateInfo *pInfo,
                                             SluiceVulkanNeuralDecoder **pDecoder)
{
    SluiceVulkanNeuralDecoderCreateInfo info;
    if (!pInfo || !pDecoder)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = read_info(&info, pInfo);
    if (result != SLUICE_SUCCESS)
        return result;
    const SluiceAllocationCallbacks cb = slc_allocator(info.pAllocator);
    SluiceVulkanNeuralDecoder *d = slc_alloc(&cb, 1, sizeof *d);
    if (!d)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    *d = (SluiceVulkanNeuralDecoder){.cb = cb,
                                     .context = info.context,
                                     .width = info.pConstants->width,
                                     .height = info.pConstants->height,
                                     .mip_count = info.pConstants->mipCount,
                                     .channel_count = info.pConstants->channelCount};
    slc_context_add_child(info.context);
    result = create_buffers(d, &info);
    if (result == SLUICE_SUCCESS)
        result = create_pipeline(d, info.pConstants->schema);
    if (result != SLUICE_SUCCESS) {
        sluiceDestroyVulkanNeuralDecoder(d);
        return result;
    }
    *pDecoder = d;
    return SLUICE_SUCCESS;
}

void sluiceDestroyVulkanNeuralDecoder(SluiceVulkanNeuralDecoder *decoder)
{
    if (!decoder)
        return;
    const struct slc_vk *vk = &decoder->context->vk;
    slc_compute_finish(&decoder->compute, vk);
    for (uint32_t i = 0; i < SLC_NEURAL_BUFFER_COUNT; i++)
        slc_buffer_finish(&decoder->buffers[i], vk);
    for (struct slc_neural_output *o = decoder->outputs, *next; o; o = next) {
        next = o->next;
        slc_free(&decoder->cb, o, 1, sizeof *o);
    }
    slc_context_remove_child(decoder->context);
    const SluiceAllocationCallbacks cb = decoder->cb;
    slc_free(&cb, decoder, 1, sizeof *decoder);
}
