/* Commands of training, and their results in mapped memory. */
#include "neural_train/neural_compressor.h"

#include "base/checked.h"
#include "base/struct_size.h"
#include "neural_train/train_schedule.h"
#include "vulkan/context.h"

#include <string.h>

#define LATENT_GROUP 128u
#define LATENT_COLUMNS 65535u
#define NETWORK_GROUPS (TRAIN_ROWS + 4u) /* rows of weights, three of biases, the losses */

enum { PASS_TRAIN, PASS_NETWORK, PASS_LATENTS };

static void barrier(const SluiceNeuralCompressor *c, VkCommandBuffer commands,
                    VkPipelineStageFlags from, VkAccessFlags written, VkPipelineStageFlags to,
                    VkAccessFlags used)
{
    slc_compute_barrier(&c->context->vk, commands, from, written, to, used);
}

static void barrier_of_shaders(const SluiceNeuralCompressor *c, VkCommandBuffer commands)
{
    barrier(c, commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
            VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
            VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
}

static void copy(const SluiceNeuralCompressor *c, VkCommandBuffer commands, VkBuffer from,
                 uint64_t from_offset, VkBuffer to, uint64_t to_offset, uint64_t size)
{
    VkBufferCopy region = {from_offset, to_offset, size};
    c->context->vk.CmdCopyBuffer(commands, from, to, 1, &region);
}

static void dispatch_latents(const SluiceNeuralCompressor *c, VkCommandBuffer commands)
{
    uint32_t groups = slc_div_up_u32(slc_train_latent_count(&c->plan) / 2, LATENT_GROUP);
    slc_compute_dispatch(&c->compute, &c->context->vk, commands, PASS_LATENTS,
                         slc_min_u32(groups, LATENT_COLUMNS),
                         slc_div_up_u32(groups, LATENT_COLUMNS));
}

static void bind(const SluiceNeuralCompressor *c, VkCommandBuffer commands,
                 struct slc_train_push *push, uint32_t loss_slot)
{
    push->tilesPerGroup = c->tiles_per_group;
    push->groupCount = c->group_count;
    push->lossSlot = loss_slot;
    slc_compute_bind(&c->compute, &c->context->vk, commands, 0, push);
}

/* Records copies to the device's buffers, and the effective values for the first step. */
static void record_start(const SluiceNeuralCompressor *c, VkCommandBuffer commands)
{
    const struct slc_buffer *b = c->buffers;
    const VkBuffer from = c->upload.buffer;
    uint64_t at = slc_train_network_size();
    copy(c, commands, from, 0, b[SLC_TRAIN_NETWORK].buffer, 0, at);
    copy(c, commands, from, at, b[SLC_TRAIN_STATE].buffer, 0, b[SLC_TRAIN_STATE].size);
    at += b[SLC_TRAIN_STATE].size;
    copy(c, commands, from, at, b[SLC_TRAIN_TABLE].buffer, 0, b[SLC_TRAIN_TABLE].size);
    at += b[SLC_TRAIN_TABLE].size;
    copy(c, commands, from, at, b[SLC_TRAIN_REFERENCES].buffer, 0, b[SLC_TRAIN_REFERENCES].size);
    c->context->vk.CmdFillBuffer(commands, b[SLC_TRAIN_GRADIENTS].buffer, 0, VK_WHOLE_SIZE, 0);
    barrier(c, commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
            VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
            VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
    struct slc_train_push push;
    slc_train_write_push(&c->plan, c->step - 1u, &push);
    push.flags = 0;
    bind(c, commands, &push, 0);
    slc_compute_dispatch(&c->compute, &c->context->vk, commands, PASS_NETWORK, NETWORK_GROUPS, 1);
    dispatch_latents(c, commands);
    barrier_of_shaders(c, commands);
}

static void record_step(const SluiceNeuralCompressor *c, VkCommandBuffer commands,
                        uint32_t loss_slot)
{
    struct slc_train_push push;
    slc_train_write_push(&c->plan, c->step, &push);
    bind(c, commands, &push, loss_slot);
    slc_compute_dispatch(&c->compute, &c->context->vk, commands, PASS_TRAIN, c->group_count, 1);
    barrier_of_shaders(c, commands);
    slc_compute_dispatch(&c->compute, &c->context->vk, commands, PASS_NETWORK, NETWORK_GROUPS, 1);
    if (push.flags & TRAIN_LATENTS)
        dispatch_latents(c, commands);
    barrier_of_shaders(c, commands);
}

/* Records the begin of FP8 training: keeps a copy of the int8 network. */
static void record_int8(const SluiceNeuralCompressor *c, VkCommandBuffer commands)
{
    VkBuffer network = c->buffers[SLC_TRAIN_NETWORK].buffer;
    barrier(c, commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
            VK_PIPELINE_STAGE_TRANSFER_BIT,
            VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT);
    copy(c, commands, network, TRAIN_MASTER * 4, network, TRAIN_INT8_MASTER * 4,
         TRAIN_PARAMETERS * 4);
    barrier(c, commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
            VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
            VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
}

SluiceResult sluiceRecordNeuralTraining(SluiceNeuralCompressor *compressor,
                                        VkCommandBuffer commandBuffer, uint32_t maxSteps,
                                        uint32_t *pStepCount)
{
    SluiceNeuralCompressor *c = compressor;
    if (!c || !commandBuffer || !pStepCount)
        return SLUICE_ERROR_NULL_POINTER;
    uint32_t left = slc_train_total_steps(&c->plan) - c->step;
    uint32_t count = slc_min_u32(slc_min_u32(left, maxSteps), SLC_TRAIN_MAX_STEPS_PER_RECORD);
    if (c->is_started)
        slc_buffer_finish(&c->upload, &c->context->vk); /* earlier commands have ended */
    if (!c->is_started)
        record_start(c, commandBuffer);
    else if (count > 0)
        /* Waits for earlier commands of this or another queue. */
        barrier(c, commandBuffer, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_WRITE_BIT,
                VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
    c->is_started = true;
    for (uint32_t i = 0; i < count; i++) {
        record_step(c, commandBuffer, i);
        c->step++;
        if (c->step == c->plan.step_count)
            record_int8(c, commandBuffer);
    }
    barrier(c, commandBuffer, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
            VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    if (count > 0)
        c->recorded_count = count;
    *pStepCount = count;
    return SLUICE_SUCCESS;
}

SluiceResult sluiceGetNeuralProgress(const SluiceNeuralCompressor *compressor,
                                     SluiceNeuralProgress *pProgress)
{
    const SluiceNeuralCompressor *c = compressor;
    if (!c || !pProgress)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result =
        slc_struct_check(SLC_STRUCT(SluiceNeuralProgress), pProgress, &c->context->vk.log);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceNeuralProgress progress = {.structSize = sizeof progress,
                                     .step = c->step,
                                     .stepCount = slc_train_total_steps(&c->plan)};
    const float *losses = c->buffers[SLC_TRAIN_LOSSES].mapped;
    double samples = (double)c->recorded_count * c->plan.tile_count * TRAIN_TILE;
    for (uint32_t channel = 0; channel < c->plan.channel_count && samples > 0; channel++) {
        double sum = 0.0;
        for (uint32_t i = 0; i < c->recorded_count; i++)
            sum += (double)losses[(size_t)i * TRAIN_OUTPUTS + channel];
        progress.channelErrors[channel] = sum / samples;
        progress.meanSquaredError += sum / samples / c->plan.channel_count;
    }
    slc_struct_write(SLC_STRUCT(SluiceNeuralProgress), pProgress, &progress);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceRecordNeuralReadback(SluiceNeuralCompressor *compressor,
                                        VkCommandBuffer commandBuffer)
{
    SluiceNeuralCompressor *c = compressor;
    if (!c || !commandBuffer)
        return SLUICE_ERROR_NULL_POINTER;
    if (!c->is_started)
        record_start(c, commandBuffer);
    c->is_started = true;
    barrier(c, commandBuffer, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_WRITE_BIT,
            VK_PIPELINE_STAGE_TRANSFER_BIT,
            VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT);
    const struct slc_buffer *b = c->buffers;
    copy(c, commandBuffer, b[SLC_TRAIN_NETWORK].buffer, 0, c->readback.buffer, 0,
         slc_train_network_size());
    copy(c, commandBuffer, b[SLC_TRAIN_STATE].buffer, 0, c->readback.buffer,
         slc_train_network_size(), b[SLC_TRAIN_STATE].size);
    barrier(c, commandBuffer, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
            VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    c->readback_step = c->step;
    c->has_readback = true;
    return SLUICE_SUCCESS;
}

const float *slc_train_read_latents(const SluiceNeuralCompressor *compressor)
{
    return (const float *)compressor->readback.mapped + slc_train_network_size() / sizeof(float);
}

const float *slc_train_read_int8(const SluiceNeuralCompressor *compressor)
{
    bool is_kept = compressor->readback_step >= compressor->plan.step_count;
    return (const float *)compressor->readback.mapped +
           (is_kept ? TRAIN_INT8_MASTER : TRAIN_MASTER);
}

const float *slc_train_read_fp8(const SluiceNeuralCompressor *compressor)
{
    return (const float *)compressor->readback.mapped + TRAIN_MASTER;
}
