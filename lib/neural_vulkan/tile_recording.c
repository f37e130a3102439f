/* Recording of a batch: decode tiles to the scratch buffer, then copy to the image. */
#include "neural_vulkan/tile_decoder.h"

#include "base/checked.h"
#include "vulkan/context.h"

#include <assert.h>

enum { MAX_COPIES = 64 };

struct recording {
    const struct slc_neural_output *output;
    const SluiceTileBatch *batch;
    VkBufferImageCopy copies[MAX_COPIES];
    uint32_t copy_count;
    uint64_t used; ///< used bytes of the scratch buffer
};

static uint64_t size_of(const struct slc_neural_output *output, const SluiceImageRegion *region)
{
    return (uint64_t)slc_div_up_u32(region->width, output->block) *
           slc_div_up_u32(region->height, output->block) * output->words * 4;
}

/* Records a barrier after copies. By submission order, earlier frames of the queue are covered. */
static void wait_for_copies(const struct recording *r)
{
    slc_compute_barrier(&r->output->decoder->context->vk, r->batch->commandBuffer,
                        VK_PIPELINE_STAGE_TRANSFER_BIT, 0, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0);
}

static void copy_decoded(struct recording *r)
{
    const struct slc_vk *vk = &r->output->decoder->context->vk;
    if (r->copy_count == 0)
        return;
    slc_compute_barrier(vk, r->batch->commandBuffer, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                        VK_ACCESS_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT,
                        VK_ACCESS_TRANSFER_READ_BIT);
    vk->CmdCopyBufferToImage(r->batch->commandBuffer,
                             r->output->decoder->buffers[SLC_NEURAL_SCRATCH].buffer,
                             r->batch->image, VK_IMAGE_LAYOUT_GENERAL, r->copy_count, r->copies);
    r->copy_count = 0;
    r->used = 0;
}

/* Returns the extent of a copy in texels: whole blocks, or up to the level's edge. */
static uint32_t extent(uint32_t at, uint32_t size, uint32_t block, uint32_t level_size)
{
    uint32_t whole = slc_div_up_u32(size, block) * block;
    return whole < level_size - at ? whole : level_size - at;
}

static void add_copy(struct recording *r, const SluiceTileTarget *target)
{
    const SluiceTileBatch *batch = r->batch;
    uint32_t block = r->output->block;
    r->copies[r->copy_count++] = (VkBufferImageCopy){
        .bufferOffset = r->used,
        .bufferRowLength = slc_div_up_u32(target->region.width, block) * block,
        .bufferImageHeight = slc_div_up_u32(target->region.height, block) * block,
        .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, batch->mipLevel, target->layer, 1},
        .imageOffset = {(int32_t)target->x, (int32_t)target->y, 0},
        .imageExtent = {extent(target->x, target->region.width, block, batch->levelWidth),
                        extent(target->y, target->region.height, block, batch->levelHeight), 1}};
}

static void decode(struct recording *r, const SluiceTileTarget *target)
{
    const struct slc_neural_output *output = r->output;
    const struct slc_vk *vk = &output->decoder->context->vk;
    const SluiceImageRegion *region = &target->region;
    const struct SluiceNeuralTile tile = {.mip = region->mipLevel,
                                          .x = region->x,
                                          .y = region->y,
                                          .width = region->width,
                                          .height = region->height,
                                          .word = (uint32_t)(r->used / 4),
                                          .pitch = slc_div_up_u32(region->width, output->block) *
                                                   output->words,
                                          .store = output->store,
                                          .firstChannel = output->first_channel,
                                          .channelCount = output->channel_count,
                                          .spaces = output->spaces};
    if (r->copy_count == 0)
        wait_for_copies(r);
    slc_compute_bind(&output->decoder->compute, vk, r->batch->commandBuffer, 0, &tile);
    slc_compute_dispatch(&output->decoder->compute, vk, r->batch->commandBuffer, 0,
                         slc_div_up_u32(region->width, SLUICE_NEURAL_GROUP),
                         slc_div_up_u32(region->height, SLUICE_NEURAL_GROUP));
    add_copy(r, target);
    r->used += size_of(output, region);
}

SluiceResult slc_neural_record_tiles(void *user, const SluiceTileBatch *batch,
                                     SluiceResult *results)
{
    struct recording r = {.output = user, .batch = batch};
    const SluiceVulkanNeuralDecoder *decoder = r.output->decoder;
    uint64_t scratch = decoder->buffers[SLC_NEURAL_SCRATCH].size;
    for (uint32_t i = 0; i < batch->tileCount; i++) {
        const SluiceTileTarget *target = &batch->pTiles[i];
        uint64_t size = size_of(r.output, &target->region);
        if (size > scratch) {
            results[i] = SLUICE_ERROR_LIMIT_EXCEEDED;
            continue;
        }
        if (r.used + size > scratch || r.copy_count == MAX_COPIES)
            copy_decoded(&r);
        decode(&r, target);
    }
    copy_decoded(&r);
    return SLUICE_SUCCESS;
}
