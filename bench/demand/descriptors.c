/* Descriptors and pipelines of a rig. */
#include "rig.h"

#include "demand_samples_comp.h"

#define BUFFER_COUNT 9u
#define STAGE VK_SHADER_STAGE_COMPUTE_BIT

static bool create_layouts(struct rig *rig)
{
    VkDevice device = rig->bench->gpu.device;
    VkDescriptorSetLayoutBinding bindings[BUFFER_COUNT + 1];
    for (uint32_t i = 0; i < BUFFER_COUNT; i++)
        bindings[i] =
            (VkDescriptorSetLayoutBinding){i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, STAGE, NULL};
    bindings[BUFFER_COUNT] =
        (VkDescriptorSetLayoutBinding){BUFFER_COUNT, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                       DEMAND_BENCH_TEXTURES, STAGE, NULL};
    VkDescriptorSetLayoutBinding pages = {0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                          DEMAND_BENCH_CHUNKS, STAGE, NULL};
    VkDescriptorSetLayoutCreateInfo infos[2] = {
        {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
         .bindingCount = BUFFER_COUNT + 1,
         .pBindings = bindings},
        {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
         .bindingCount = 1,
         .pBindings = &pages}};
    for (uint32_t i = 0; i < 2; i++)
        if (!gpu_check(vkCreateDescriptorSetLayout(device, &infos[i], NULL, &rig->set_layouts[i]),
                       "vkCreateDescriptorSetLayout"))
            return false;
    VkPushConstantRange range = {STAGE, 0, sizeof(struct DemandBenchParams)};
    VkPipelineLayoutCreateInfo layout = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                         .setLayoutCount = 2,
                                         .pSetLayouts = rig->set_layouts,
                                         .pushConstantRangeCount = 1,
                                         .pPushConstantRanges = &range};
    return gpu_check(vkCreatePipelineLayout(device, &layout, NULL, &rig->layout),
                     "vkCreatePipelineLayout");
}

static bool create_sets(struct rig *rig)
{
    VkDevice device = rig->bench->gpu.device;
    VkDescriptorPoolSize sizes[2] = {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, BUFFER_COUNT},
                                     {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                      DEMAND_BENCH_TEXTURES + RIG_SLOTS * DEMAND_BENCH_CHUNKS}};
    VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                       .maxSets = 1 + RIG_SLOTS,
                                       .poolSizeCount = 2,
                                       .pPoolSizes = sizes};
    if (!gpu_check(vkCreateDescriptorPool(device, &pool, NULL, &rig->descriptor_pool),
                   "vkCreateDescriptorPool"))
        return false;
    VkDescriptorSetLayout layouts[1 + RIG_SLOTS] = {rig->set_layouts[0]};
    for (uint32_t i = 0; i < RIG_SLOTS; i++)
        layouts[1 + i] = rig->set_layouts[1];
    VkDescriptorSet sets[1 + RIG_SLOTS];
    VkDescriptorSetAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                        .descriptorPool = rig->descriptor_pool,
                                        .descriptorSetCount = 1 + RIG_SLOTS,
                                        .pSetLayouts = layouts};
    if (!gpu_check(vkAllocateDescriptorSets(device, &info, sets), "vkAllocateDescriptorSets"))
        return false;
    rig->set = sets[0];
    for (uint32_t i = 0; i < RIG_SLOTS; i++)
        rig->slots[i].pages = sets[1 + i];
    return true;
}

static bool create_sampler(struct rig *rig)
{
    VkSamplerCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                .magFilter = VK_FILTER_LINEAR,
                                .minFilter = VK_FILTER_LINEAR,
                                .mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR,
                                .maxLod = VK_LOD_CLAMP_NONE};
    return gpu_check(vkCreateSampler(rig->bench->gpu.device, &info, NULL, &rig->sampler),
                     "vkCreateSampler");
}

/* Writes the set. Devices without plain images get pages in their place, which no shader reads
 * then. */
static void write_set(struct rig *rig)
{
    SluiceDemandBuffers b = {.structSize = sizeof b};
    SluiceVulkanPages pages = {.structSize = sizeof pages};
    sluiceGetDemandBuffers(rig->loader, &b);
    sluiceGetDemandPages(rig->loader, &pages);
    const VkBuffer buffers[BUFFER_COUNT] = {
        b.textures, b.levels,   b.directory,         b.blocks,           b.masks,
        b.requests, b.sections, rig->outputs.buffer, rig->picture.buffer};
    VkDescriptorBufferInfo infos[BUFFER_COUNT];
    VkDescriptorImageInfo images[DEMAND_BENCH_TEXTURES];
    VkWriteDescriptorSet writes[2] = {{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                       .dstSet = rig->set,
                                       .descriptorCount = BUFFER_COUNT,
                                       .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                       .pBufferInfo = infos},
                                      {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                       .dstSet = rig->set,
                                       .dstBinding = BUFFER_COUNT,
                                       .descriptorCount = DEMAND_BENCH_TEXTURES,
                                       .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                       .pImageInfo = images}};
    for (uint32_t i = 0; i < BUFFER_COUNT; i++)
        infos[i] = (VkDescriptorBufferInfo){buffers[i], 0, VK_WHOLE_SIZE};
    for (uint32_t i = 0; i < DEMAND_BENCH_TEXTURES; i++)
        images[i] = (VkDescriptorImageInfo){rig->sampler, rig->plain[i % rig->texture_count].view,
                                            VK_IMAGE_LAYOUT_GENERAL};
    vkUpdateDescriptorSets(rig->bench->gpu.device, images[0].imageView ? 2 : 1, writes, 0, NULL);
}

bool rig_create_descriptors(struct rig *rig)
{
    if (!create_layouts(rig) || !create_sets(rig) || !create_sampler(rig))
        return false;
    write_set(rig);
    return true;
}

void rig_destroy_descriptors(struct rig *rig)
{
    VkDevice device = rig->bench->gpu.device;
    for (uint32_t i = 0; i < DEMAND_BENCH_KINDS; i++)
        vkDestroyPipeline(device, rig->pipelines[i], NULL);
    vkDestroyDescriptorPool(device, rig->descriptor_pool, NULL);
    vkDestroyPipelineLayout(device, rig->layout, NULL);
    for (uint32_t i = 0; i < 2; i++)
        vkDestroyDescriptorSetLayout(device, rig->set_layouts[i], NULL);
    vkDestroySampler(device, rig->sampler, NULL);
}

/* The launch that used this set is over. */
void rig_write_pages(struct rig *rig, struct rig_slot *slot)
{
    SluiceVulkanPages pages = {.structSize = sizeof pages};
    sluiceGetDemandPages(rig->loader, &pages);
    if (slot->generation == pages.generation)
        return;
    slot->generation = pages.generation;
    VkDescriptorImageInfo images[DEMAND_BENCH_CHUNKS];
    for (uint32_t i = 0; i < DEMAND_BENCH_CHUNKS; i++)
        images[i] =
            (VkDescriptorImageInfo){pages.sampler, pages.pViews[i], VK_IMAGE_LAYOUT_GENERAL};
    VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                  .dstSet = slot->pages,
                                  .descriptorCount = DEMAND_BENCH_CHUNKS,
                                  .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                  .pImageInfo = images};
    vkUpdateDescriptorSets(rig->bench->gpu.device, 1, &write, 0, NULL);
}

VkPipeline rig_pipeline(struct rig *rig, uint32_t kind)
{
    if (rig->pipelines[kind])
        return rig->pipelines[kind];
    const struct gpu *gpu = &rig->bench->gpu;
    VkSpecializationMapEntry entry = {.constantID = 0, .offset = 0, .size = 4};
    VkSpecializationInfo constants = {1, &entry, sizeof kind, &kind};
    if (!gpu_create_compute_pipeline(gpu, rig->layout, demand_samples_comp,
                                     sizeof demand_samples_comp, &constants, &rig->pipelines[kind]))
        rig->pipelines[kind] = VK_NULL_HANDLE;
    return rig->pipelines[kind];
}
