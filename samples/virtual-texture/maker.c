#include "maker.h"

#include "fractal_shared.h"
#include "make_comp.h"

static bool create_pipeline(struct maker *m)
{
    VkDevice device = m->gpu->device;
    const VkDescriptorSetLayoutBinding bindings[] = {
        {0, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1, VK_SHADER_STAGE_COMPUTE_BIT, NULL},
        {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, NULL}};
    const VkDescriptorSetLayoutCreateInfo sets = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = 2,
        .pBindings = bindings};
    const VkPushConstantRange range = {VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(struct FractalMake)};
    VkPipelineLayoutCreateInfo layout = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                         .setLayoutCount = 1,
                                         .pSetLayouts = &m->set_layout,
                                         .pushConstantRangeCount = 1,
                                         .pPushConstantRanges = &range};
    if (!gpu_check(vkCreateDescriptorSetLayout(device, &sets, NULL, &m->set_layout), "layout") ||
        !gpu_check(vkCreatePipelineLayout(device, &layout, NULL, &m->layout), "layout"))
        return false;
    return gpu_create_compute_pipeline(m->gpu, m->layout, make_comp, sizeof make_comp, NULL,
                                       &m->pipeline);
}

static bool create_sets(struct maker *m)
{
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, MAKER_SETS},
                                          {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, MAKER_SETS}};
    const VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = MAKER_SETS,
                                             .poolSizeCount = 2,
                                             .pPoolSizes = sizes};
    VkDescriptorSetLayout layouts[MAKER_SETS];
    for (uint32_t i = 0; i < MAKER_SETS; i++)
        layouts[i] = m->set_layout;
    if (!gpu_check(vkCreateDescriptorPool(m->gpu->device, &pool, NULL, &m->pool), "pool"))
        return false;
    const VkDescriptorSetAllocateInfo sets = {.sType =
                                                  VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                              .descriptorPool = m->pool,
                                              .descriptorSetCount = MAKER_SETS,
                                              .pSetLayouts = layouts};
    return gpu_check(vkAllocateDescriptorSets(m->gpu->device, &sets, m->sets), "sets");
}

bool maker_create(struct maker *m, const struct gpu *gpu, uint32_t size_log2)
{
    *m = (struct maker){.gpu = gpu, .size_log2 = size_log2};
    return gpu_create_buffer(gpu, MAKER_TILES * sizeof(struct FractalTile),
                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, &m->tiles) &&
           create_pipeline(m) && create_sets(m);
}

void maker_destroy(struct maker *m)
{
    if (!m->gpu)
        return;
    VkDevice device = m->gpu->device;
    vkDestroyPipeline(device, m->pipeline, NULL);
    vkDestroyPipelineLayout(device, m->layout, NULL);
    vkDestroyDescriptorPool(device, m->pool, NULL);
    vkDestroyDescriptorSetLayout(device, m->set_layout, NULL);
    gpu_destroy_buffer(m->gpu, &m->tiles);
}

void maker_begin_frame(struct maker *m)
{
    m->set_count = m->tile_count = 0;
}

static VkDescriptorSet write_set(struct maker *m, VkImageView view)
{
    VkDescriptorSet set = m->sets[m->set_count++];
    const VkDescriptorImageInfo image = {.imageView = view, .imageLayout = VK_IMAGE_LAYOUT_GENERAL};
    const VkDescriptorBufferInfo tiles = {m->tiles.buffer, 0, VK_WHOLE_SIZE};
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
                                            .pBufferInfo = &tiles}};
    vkUpdateDescriptorSets(m->gpu->device, 2, writes, 0, NULL);
    return set;
}

SluiceResult maker_record_tiles(void *pUserData, const SluiceTileBatch *pBatch,
                                SluiceResult *pResults)
{
    struct maker *m = pUserData;
    (void)pResults; /* all tiles of a batch have the same result */
    if (!pBatch->imageView)
        return SLUICE_ERROR_UNSUPPORTED;
    if (m->set_count == MAKER_SETS || m->tile_count + pBatch->tileCount > MAKER_TILES)
        return SLUICE_NOT_READY;
    const struct FractalMake make = {m->tile_count, m->size_log2};
    struct FractalTile *tiles = m->tiles.mapped;
    uint32_t width = 0, height = 0;
    for (uint32_t i = 0; i < pBatch->tileCount; i++) {
        const SluiceTileTarget *t = &pBatch->pTiles[i];
        const SluiceImageRegion *r = &t->region;
        tiles[m->tile_count++] = (struct FractalTile){r->mipLevel, r->x, r->y, r->width,
                                                      r->height,   t->x, t->y, t->layer};
        width = r->width > width ? r->width : width;
        height = r->height > height ? r->height : height;
    }
    VkCommandBuffer commands = pBatch->commandBuffer;
    VkDescriptorSet set = write_set(m, pBatch->imageView);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, m->pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, m->layout, 0, 1, &set, 0,
                            NULL);
    vkCmdPushConstants(commands, m->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof make, &make);
    vkCmdDispatch(commands, (width + FRACTAL_GROUP - 1) / FRACTAL_GROUP,
                  (height + FRACTAL_GROUP - 1) / FRACTAL_GROUP, pBatch->tileCount);
    return SLUICE_SUCCESS;
}
