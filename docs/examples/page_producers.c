/* Lines that docs/producers.md shows. */
#include <sluice/demand.h>

struct shader_tile {
    uint32_t level, x, y, width, height, target_x, target_y, layer;
};

struct generator {
    VkDevice device;
    VkPipeline pipeline;
    VkPipelineLayout pipelineLayout;
    struct shader_tile *tiles; /* mapped memory of a storage buffer, a part for each frame */
    VkDescriptorSet sets[64];  /* of the frame that begins; binding 1 is that buffer */
    uint32_t setCount, usedSets, usedTiles, tileCapacity;
};

SluiceResult recordTiles(void *pUserData, const SluiceTileBatch *pBatch, SluiceResult *pResults);
SluiceResult addGenerated(SluiceVulkanStreamer *streamer, struct generator *generator,
                          SluiceVulkanTexture *pTexture);

SluiceResult addLoaded(SluiceDemandLoader *loader, SluiceTileProducer producer,
                       SluiceDemandTextureId *pTextureId);

SluiceResult addLoaded(SluiceDemandLoader *loader, SluiceTileProducer producer,
                       SluiceDemandTextureId *pTextureId)
{
    SluiceDemandTextureCreateInfo info = {
        .structSize = sizeof info, .pProducer = &producer, .lastLevelColor = {0.3f, 0.4f, 0.2f, 1}};
    return sluiceAddDemandTexture(loader, &info, pTextureId);
}

SluiceResult recordTiles(void *pUserData, const SluiceTileBatch *pBatch, SluiceResult *pResults)
{
    struct generator *g = pUserData;
    uint32_t first = g->usedTiles;
    (void)pResults; /* the returned value counts for all tiles */
    if (g->usedSets == g->setCount || first + pBatch->tileCount > g->tileCapacity)
        return SLUICE_NOT_READY; /* asked again in the next frame */
    for (uint32_t i = 0; i < pBatch->tileCount; i++) {
        const SluiceTileTarget *t = &pBatch->pTiles[i];
        g->tiles[g->usedTiles++] =
            (struct shader_tile){t->region.mipLevel, t->region.x, t->region.y, t->region.width,
                                 t->region.height,   t->x,        t->y,        t->layer};
    }
    VkDescriptorSet set = g->sets[g->usedSets++];
    VkDescriptorImageInfo image = {.imageView = pBatch->imageView,
                                   .imageLayout = VK_IMAGE_LAYOUT_GENERAL};
    VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                  .dstSet = set,
                                  .dstBinding = 0,
                                  .descriptorCount = 1,
                                  .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
                                  .pImageInfo = &image};
    vkUpdateDescriptorSets(g->device, 1, &write, 0, NULL);
    vkCmdBindPipeline(pBatch->commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, g->pipeline);
    vkCmdBindDescriptorSets(pBatch->commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE,
                            g->pipelineLayout, 0, 1, &set, 0, NULL);
    vkCmdPushConstants(pBatch->commandBuffer, g->pipelineLayout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                       sizeof first, &first);
    vkCmdDispatch(pBatch->commandBuffer, 128 / 8, 128 / 8, pBatch->tileCount); /* RGBA8 tiles */
    return SLUICE_SUCCESS;
}

SluiceResult addGenerated(SluiceVulkanStreamer *streamer, struct generator *generator,
                          SluiceVulkanTexture *pTexture)
{
    SluiceImageInfo image = {.structSize = sizeof image,
                             .width = 65536,
                             .height = 65536,
                             .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                             .pName = "terrain"};
    SluiceTileProducer producer = {.structSize = sizeof producer,
                                   .pImage = &image,
                                   .pUserData = generator,
                                   .pfnRecordTiles = recordTiles};
    SluiceVulkanTextureCreateInfo info = {.structSize = sizeof info, .pProducer = &producer};
    return sluiceAddVulkanTexture(streamer, &info, pTexture);
}
