/* Descriptor sets of an engine's own, as docs/frame-loop.md shows them. Compiled, not run. */
#include <sluice/vulkan.h>

#define PAGE_IMAGES 64 /* maxPageChunkCount of the context */

struct own_set { /* one per frame in flight */
    VkDescriptorSet set;
    uint64_t page_generation; /* 0: no pages written yet */
};

/* Once: the handles never change. */
void write_buffers(VkDevice device, const SluiceVulkanStreamer *streamer, VkDescriptorSet set);
void write_buffers(VkDevice device, const SluiceVulkanStreamer *streamer, VkDescriptorSet set)
{
    SluiceVulkanBuffers buffers = {.structSize = sizeof buffers};
    sluiceGetVulkanBuffers(streamer, &buffers);
    const VkDescriptorBufferInfo infos[4] = {
        {buffers.textureTable, 0, VK_WHOLE_SIZE}, /* bindings 0 to 3 */
        {buffers.minMip, 0, VK_WHOLE_SIZE},
        {buffers.feedback, 0, VK_WHOLE_SIZE},
        {buffers.pageTable, 0, VK_WHOLE_SIZE},
    };
    const VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                        .dstSet = set,
                                        .descriptorCount = 4,
                                        .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                        .pBufferInfo = infos};
    vkUpdateDescriptorSets(device, 1, &write, 0, NULL);
}

/* Paged mode, after each sluiceBeginStreamingFrame, for the set of that frame. */
void write_pages(VkDevice device, const SluiceVulkanStreamer *streamer, struct own_set *own);
void write_pages(VkDevice device, const SluiceVulkanStreamer *streamer, struct own_set *own)
{
    SluiceVulkanPages pages = {.structSize = sizeof pages};
    sluiceGetVulkanPages(streamer, &pages);
    if (own->page_generation == pages.generation)
        return;
    own->page_generation = pages.generation;
    VkDescriptorImageInfo images[PAGE_IMAGES];
    for (uint32_t i = 0; i < PAGE_IMAGES; i++)
        images[i] = (VkDescriptorImageInfo){.sampler = pages.sampler,
                                            .imageView = pages.pViews[i],
                                            .imageLayout = VK_IMAGE_LAYOUT_GENERAL};
    const VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                        .dstSet = own->set,
                                        .dstBinding = 4,
                                        .descriptorCount = PAGE_IMAGES,
                                        .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                        .pImageInfo = images};
    vkUpdateDescriptorSets(device, 1, &write, 0, NULL);
}
