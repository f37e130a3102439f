#include "device/maker.h"

#include "device/conform.h"
#include "support/test.h"

#include "maker_comp.h"
#include "maker_shared.h"

#define TILE_SIZE 65536u
#define COPIES 512u /* tiles of texels */

static void create_pipeline(struct maker *m)
{
    struct harness *h = m->h;
    const VkDescriptorSetLayoutBinding bindings[] = {
        {0, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1, VK_SHADER_STAGE_COMPUTE_BIT, NULL},
        {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, NULL}};
    VkDescriptorSetLayoutCreateInfo set = {.sType =
                                               VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                           .bindingCount = 2,
                                           .pBindings = bindings};
    assert_int_equal(h->CreateDescriptorSetLayout(h->device, &set, NULL, &m->set_layout),
                     VK_SUCCESS);
    const VkPushConstantRange push = {VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(uint32_t)};
    VkPipelineLayoutCreateInfo layout = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                         .setLayoutCount = 1,
                                         .pSetLayouts = &m->set_layout,
                                         .pushConstantRangeCount = 1,
                                         .pPushConstantRanges = &push};
    assert_int_equal(h->CreatePipelineLayout(h->device, &layout, NULL, &m->layout), VK_SUCCESS);
    m->pipeline = conform_compute_pipeline(h, m->layout,
                                           conform_module(h, maker_comp, sizeof maker_comp), NULL);
}

static void create_sets(struct maker *m)
{
    struct harness *h = m->h;
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, MAKER_SETS},
                                          {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, MAKER_SETS}};
    VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                       .maxSets = MAKER_SETS,
                                       .poolSizeCount = 2,
                                       .pPoolSizes = sizes};
    assert_int_equal(h->CreateDescriptorPool(h->device, &pool, NULL, &m->pool), VK_SUCCESS);
    for (uint32_t i = 0; i < MAKER_SETS; i++) {
        VkDescriptorSetAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                            .descriptorPool = m->pool,
                                            .descriptorSetCount = 1,
                                            .pSetLayouts = &m->set_layout};
        assert_int_equal(h->AllocateDescriptorSets(h->device, &info, &m->sets[i]), VK_SUCCESS);
    }
}

void maker_init(struct maker *m, struct harness *h, SluiceImageSource *source)
{
    *m = (struct maker){.h = h, .source = source};
    harness_buffer_init(h, &m->tiles, MAKER_TILES * sizeof(struct MakerTile),
                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    if (source)
        harness_buffer_init(h, &m->texels, (uint64_t)COPIES * TILE_SIZE,
                            VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    create_pipeline(m);
    create_sets(m);
}

void maker_finish(struct maker *m)
{
    struct harness *h = m->h;
    h->DestroyDescriptorPool(h->device, m->pool, NULL);
    h->DestroyPipeline(h->device, m->pipeline, NULL);
    h->DestroyPipelineLayout(h->device, m->layout, NULL);
    h->DestroyDescriptorSetLayout(h->device, m->set_layout, NULL);
    harness_buffer_finish(h, &m->tiles);
    if (m->source)
        harness_buffer_finish(h, &m->texels);
}

static VkDescriptorSet write_set(struct maker *m, VkImageView view)
{
    VkDescriptorSet set = m->sets[m->next_set++ % MAKER_SETS];
    const VkDescriptorImageInfo image = {.imageView = view, .imageLayout = VK_IMAGE_LAYOUT_GENERAL};
    const VkDescriptorBufferInfo buffer = {m->tiles.buffer, 0, VK_WHOLE_SIZE};
    const VkWriteDescriptorSet writes[] = {{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                            .dstSet = set,
                                            .dstBinding = 0,
                                            .descriptorCount = 1,
                                            .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
                                            .pImageInfo = &image},
                                           {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                            .dstSet = set,
                                            .dstBinding = 1,
                                            .descriptorCount = 1,
                                            .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                            .pBufferInfo = &buffer}};
    m->h->UpdateDescriptorSets(m->h->device, 2, writes, 0, NULL);
    return set;
}

/* Makes the batch with one dispatch. Leaves out tiles that are not made. */
static void dispatch(struct maker *m, const SluiceTileBatch *batch, const SluiceResult *results)
{
    struct harness *h = m->h;
    struct MakerTile *tiles = m->tiles.mapped;
    if (m->next_tile + batch->tileCount > MAKER_TILES)
        m->next_tile = 0;
    uint32_t first = m->next_tile, width = 0, height = 0;
    for (uint32_t i = 0; i < batch->tileCount; i++) {
        const SluiceTileTarget *t = &batch->pTiles[i];
        if (results[i] != SLUICE_SUCCESS)
            continue;
        tiles[m->next_tile++] = (struct MakerTile){t->region.mipLevel + m->version * MAKER_VERSION,
                                                   t->region.x,
                                                   t->region.y,
                                                   t->region.width,
                                                   t->region.height,
                                                   t->x,
                                                   t->y,
                                                   t->layer};
        width = t->region.width > width ? t->region.width : width;
        height = t->region.height > height ? t->region.height : height;
    }
    if (m->next_tile == first)
        return;
    VkDescriptorSet set = write_set(m, batch->imageView);
    h->CmdBindPipeline(batch->commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, m->pipeline);
    h->CmdBindDescriptorSets(batch->commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, m->layout, 0, 1,
                             &set, 0, NULL);
    h->CmdPushConstants(batch->commandBuffer, m->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                        sizeof first, &first);
    h->CmdDispatch(batch->commandBuffer, (width + MAKER_GROUP - 1) / MAKER_GROUP,
                   (height + MAKER_GROUP - 1) / MAKER_GROUP, m->next_tile - first);
}

static void copy(struct maker *m, const SluiceTileBatch *batch, const SluiceResult *results)
{
    VkBufferImageCopy copies[COPIES];
    SluiceImageInfo info = {.structSize = sizeof info};
    uint32_t count = 0;
    CHECK_OK(sluiceGetImageInfo(m->source, &info));
    for (uint32_t i = 0; i < batch->tileCount; i++) {
        const SluiceTileTarget *t = &batch->pTiles[i];
        if (results[i] != SLUICE_SUCCESS)
            continue;
        uint64_t offset = (uint64_t)(m->next_tile++ % COPIES) * TILE_SIZE;
        CHECK_OK(sluiceReadImageRegion(
            m->source, &t->region, (char *)m->texels.mapped + offset,
            (size_t)sluiceGetFormatRegionSize(info.format, t->region.width, 1)));
        copies[count++] = (VkBufferImageCopy){
            .bufferOffset = offset,
            .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, batch->mipLevel, t->layer, 1},
            .imageOffset = {(int32_t)t->x, (int32_t)t->y, 0},
            .imageExtent = {t->region.width, t->region.height, 1}};
    }
    if (count)
        m->h->CmdCopyBufferToImage(batch->commandBuffer, m->texels.buffer, batch->image,
                                   VK_IMAGE_LAYOUT_GENERAL, count, copies);
}

static SluiceResult record_tiles(void *user, const SluiceTileBatch *batch, SluiceResult *results)
{
    struct maker *m = user;
    for (uint32_t i = 0; i < batch->tileCount; i++) {
        const SluiceTileTarget *t = &batch->pTiles[i];
        assert_in_range(t->x + t->region.width, 1, batch->levelWidth);
        assert_in_range(t->y + t->region.height, 1, batch->levelHeight);
    }
    for (uint32_t i = 0; i < batch->tileCount; i++) {
        if (batch->pTiles[i].region.mipLevel > 2) /* the mip tail is all or nothing */
            continue;
        uint32_t turn = ++m->turn;
        if (m->unready_one_in && turn % m->unready_one_in == 0)
            results[i] = SLUICE_NOT_READY;
        else if (m->failing_one_in && turn % m->failing_one_in == 0)
            results[i] = SLUICE_ERROR_IO;
    }
    m->batch_count++;
    m->tile_count += batch->tileCount;
    if (m->source) {
        copy(m, batch, results);
    } else {
        assert_true(batch->imageView != VK_NULL_HANDLE);
        dispatch(m, batch, results);
    }
    return SLUICE_SUCCESS;
}

SluiceTileProducer maker_producer(struct maker *m, const SluiceImageInfo *image)
{
    return (SluiceTileProducer){.structSize = sizeof(SluiceTileProducer),
                                .pImage = image,
                                .pUserData = m,
                                .pfnRecordTiles = record_tiles};
}
