/* Descriptors and pipelines of a rig. */
#include "rig.h"

#include <string.h>

#include "bench_screen_vert.h"
#include "bench_wants_comp.h"

#define STAGES (VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_FRAGMENT_BIT)
#define BUFFER_COUNT 6u /* bindings 0 to 5 of set 0; then two images */
#define BINDING_COUNT 8u

static bool create_layouts(struct rig *rig)
{
    VkDevice device = rig->bench->gpu.device;
    VkDescriptorSetLayoutBinding bindings[BINDING_COUNT];
    for (uint32_t i = 0; i < BINDING_COUNT; i++)
        bindings[i] = (VkDescriptorSetLayoutBinding){
            .binding = i,
            .descriptorType = i < BUFFER_COUNT ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
                                               : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
            .descriptorCount = 1,
            .stageFlags = STAGES};
    VkDescriptorSetLayoutBinding page_bindings[2] = {
        {0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, STAGES, NULL},
        {1, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, BENCH_PAGE_CHUNKS, STAGES, NULL}};
    VkDescriptorSetLayoutCreateInfo infos[2] = {
        {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
         .bindingCount = BINDING_COUNT,
         .pBindings = bindings},
        {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
         .bindingCount = 2,
         .pBindings = page_bindings}};
    for (uint32_t i = 0; i < 2; i++)
        if (!gpu_check(vkCreateDescriptorSetLayout(device, &infos[i], NULL, &rig->set_layouts[i]),
                       "vkCreateDescriptorSetLayout"))
            return false;
    VkPushConstantRange range = {STAGES, 0, sizeof(struct BenchParams)};
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
    VkDescriptorPoolSize sizes[2] = {
        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, BUFFER_COUNT + RIG_FRAMES},
        {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 2 + RIG_FRAMES * BENCH_PAGE_CHUNKS}};
    VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                       .maxSets = 1 + RIG_FRAMES,
                                       .poolSizeCount = 2,
                                       .pPoolSizes = sizes};
    if (!gpu_check(vkCreateDescriptorPool(device, &pool, NULL, &rig->descriptor_pool),
                   "vkCreateDescriptorPool"))
        return false;
    VkDescriptorSetLayout layouts[1 + RIG_FRAMES] = {rig->set_layouts[0]};
    for (uint32_t i = 0; i < RIG_FRAMES; i++)
        layouts[1 + i] = rig->set_layouts[1];
    VkDescriptorSet sets[1 + RIG_FRAMES];
    VkDescriptorSetAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                        .descriptorPool = rig->descriptor_pool,
                                        .descriptorSetCount = 1 + RIG_FRAMES,
                                        .pSetLayouts = layouts};
    if (!gpu_check(vkAllocateDescriptorSets(device, &info, sets), "vkAllocateDescriptorSets"))
        return false;
    rig->set = sets[0];
    for (uint32_t i = 0; i < RIG_FRAMES; i++)
        rig->slots[i].pages = sets[1 + i];
    return true;
}

static bool create_sampler(struct rig *rig, float anisotropy)
{
    bool anisotropic = anisotropy > 1.0f && rig->bench->gpu.capabilities.samplerAnisotropy;
    VkSamplerCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                .magFilter = VK_FILTER_LINEAR,
                                .minFilter = VK_FILTER_LINEAR,
                                .mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR,
                                .anisotropyEnable = anisotropic,
                                .maxAnisotropy = anisotropic ? anisotropy : 1.0f,
                                .maxLod = VK_LOD_CLAMP_NONE};
    return gpu_check(vkCreateSampler(rig->bench->gpu.device, &info, NULL, &rig->sampler),
                     "vkCreateSampler");
}

static void write_set(struct rig *rig, VkImageView plain)
{
    SluiceVulkanBuffers buffers = {.structSize = sizeof buffers};
    sluiceGetVulkanBuffers(rig->streamer, &buffers);
    const VkBuffer used[BUFFER_COUNT] = {buffers.textureTable, buffers.minMip,
                                         buffers.feedback,     rig->outputs.buffer,
                                         rig->indices.buffer,  rig->picture.buffer};
    VkDescriptorBufferInfo infos[BUFFER_COUNT + RIG_FRAMES];
    VkDescriptorImageInfo images[2];
    VkWriteDescriptorSet writes[BINDING_COUNT + RIG_FRAMES];
    for (uint32_t i = 0; i < BINDING_COUNT + RIG_FRAMES; i++) {
        bool image = i >= BUFFER_COUNT && i < BINDING_COUNT;
        uint32_t buffer = i < BUFFER_COUNT ? i : i - 2;
        writes[i] = (VkWriteDescriptorSet){
            .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
            .dstSet = i < BINDING_COUNT ? rig->set : rig->slots[i - BINDING_COUNT].pages,
            .dstBinding = i < BINDING_COUNT ? i : 0,
            .descriptorCount = 1,
            .descriptorType = image ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER
                                    : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
            .pImageInfo = image ? &images[i - BUFFER_COUNT] : NULL,
            .pBufferInfo = image ? NULL : &infos[buffer]};
        if (!image)
            infos[buffer] = (VkDescriptorBufferInfo){i < BUFFER_COUNT ? used[i] : buffers.pageTable,
                                                     0, VK_WHOLE_SIZE};
    }
    images[0] =
        (VkDescriptorImageInfo){rig->sampler, rig->textures[0].imageView, VK_IMAGE_LAYOUT_GENERAL};
    images[1] = images[0];
    if (plain)
        images[1].imageView = plain;
    vkUpdateDescriptorSets(rig->bench->gpu.device, BINDING_COUNT + RIG_FRAMES, writes, 0, NULL);
}

bool rig_create_descriptors(struct rig *rig, const struct rig_info *info)
{
    if (!create_layouts(rig) || !create_sets(rig) || !create_sampler(rig, info->anisotropy))
        return false;
    write_set(rig, info->plain_view);
    return true;
}

void rig_destroy_descriptors(struct rig *rig)
{
    VkDevice device = rig->bench->gpu.device;
    vkDestroyDescriptorPool(device, rig->descriptor_pool, NULL);
    vkDestroyPipelineLayout(device, rig->layout, NULL);
    for (uint32_t i = 0; i < 2; i++)
        vkDestroyDescriptorSetLayout(device, rig->set_layouts[i], NULL);
    vkDestroySampler(device, rig->sampler, NULL);
}

/* The frame that used this set is over. */
void rig_write_pages(struct rig *rig, struct rig_slot *slot)
{
    SluiceVulkanPages pages = {.structSize = sizeof pages};
    sluiceGetVulkanPages(rig->streamer, &pages);
    if (slot->page_generation == pages.generation)
        return;
    slot->page_generation = pages.generation;
    VkDescriptorImageInfo images[BENCH_PAGE_CHUNKS];
    for (uint32_t i = 0; i < BENCH_PAGE_CHUNKS; i++)
        images[i] =
            (VkDescriptorImageInfo){pages.sampler, pages.pViews[i], VK_IMAGE_LAYOUT_GENERAL};
    VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                  .dstSet = slot->pages,
                                  .dstBinding = 1,
                                  .descriptorCount = BENCH_PAGE_CHUNKS,
                                  .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                  .pImageInfo = images};
    vkUpdateDescriptorSets(rig->bench->gpu.device, 1, &write, 0, NULL);
}

static const VkSpecializationMapEntry constant_entries[BENCH_CONSTANT_COUNT] = {
    {0, 0, 4}, {1, 4, 4}, {2, 8, 4}, {3, 12, 4}, {4, 16, 4}};

static VkSpecializationInfo specialize(const struct rig_constants *constants)
{
    return (VkSpecializationInfo){BENCH_CONSTANT_COUNT, constant_entries, sizeof constants->values,
                                  constants->values};
}

static VkPipeline keep(struct rig *rig, VkResult result, VkPipeline pipeline, const char *what)
{
    if (!gpu_check(result, what) || rig->pipeline_count == RIG_MAX_PIPELINES)
        return VK_NULL_HANDLE;
    rig->pipelines[rig->pipeline_count++] = pipeline;
    return pipeline;
}

VkPipeline rig_compute_pipeline(struct rig *rig, const uint32_t *words, size_t size,
                                const struct rig_constants *constants)
{
    VkDevice device = rig->bench->gpu.device;
    VkSpecializationInfo special = specialize(constants);
    VkShaderModule module = gpu_create_shader(&rig->bench->gpu, words, size);
    if (!module)
        return VK_NULL_HANDLE;
    VkComputePipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = module,
                  .pName = "main",
                  .pSpecializationInfo = &special},
        .layout = rig->layout};
    VkPipeline pipeline = VK_NULL_HANDLE;
    VkResult result = vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &info, NULL, &pipeline);
    vkDestroyShaderModule(device, module, NULL);
    return keep(rig, result, pipeline, "vkCreateComputePipelines");
}

static VkResult create_screen_pipeline(struct rig *rig,
                                       const VkPipelineShaderStageCreateInfo *stages,
                                       VkRenderPass pass, VkPipeline *pipeline)
{
    VkPipelineVertexInputStateCreateInfo input = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    VkPipelineInputAssemblyStateCreateInfo assembly = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
    VkPipelineViewportStateCreateInfo viewport = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
        .viewportCount = 1,
        .scissorCount = 1};
    VkPipelineRasterizationStateCreateInfo raster = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
        .polygonMode = VK_POLYGON_MODE_FILL,
        .lineWidth = 1.0f};
    VkPipelineMultisampleStateCreateInfo samples = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
    VkPipelineDepthStencilStateCreateInfo depth = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
    VkPipelineColorBlendAttachmentState attachment = {.colorWriteMask = 15};
    VkPipelineColorBlendStateCreateInfo blend = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
        .attachmentCount = 1,
        .pAttachments = &attachment};
    const VkDynamicState states[2] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
        .dynamicStateCount = 2,
        .pDynamicStates = states};
    VkGraphicsPipelineCreateInfo info = {.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                         .stageCount = 2,
                                         .pStages = stages,
                                         .pVertexInputState = &input,
                                         .pInputAssemblyState = &assembly,
                                         .pViewportState = &viewport,
                                         .pRasterizationState = &raster,
                                         .pMultisampleState = &samples,
                                         .pDepthStencilState = &depth,
                                         .pColorBlendState = &blend,
                                         .pDynamicState = &dynamic,
                                         .layout = rig->layout,
                                         .renderPass = pass};
    return vkCreateGraphicsPipelines(rig->bench->gpu.device, VK_NULL_HANDLE, 1, &info, NULL,
                                     pipeline);
}

VkPipeline rig_screen_pipeline(struct rig *rig, const uint32_t *words, size_t size,
                               const struct rig_constants *constants, VkRenderPass pass)
{
    const struct gpu *gpu = &rig->bench->gpu;
    VkSpecializationInfo special = specialize(constants);
    VkShaderModule vertex = gpu_create_shader(gpu, bench_screen_vert, sizeof bench_screen_vert);
    VkShaderModule fragment = gpu_create_shader(gpu, words, size);
    VkPipelineShaderStageCreateInfo stages[2] = {
        {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
         .stage = VK_SHADER_STAGE_VERTEX_BIT,
         .module = vertex,
         .pName = "main"},
        {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
         .stage = VK_SHADER_STAGE_FRAGMENT_BIT,
         .module = fragment,
         .pName = "main",
         .pSpecializationInfo = &special}};
    VkPipeline pipeline = VK_NULL_HANDLE;
    VkResult result = VK_ERROR_INITIALIZATION_FAILED;
    if (vertex && fragment)
        result = create_screen_pipeline(rig, stages, pass, &pipeline);
    vkDestroyShaderModule(gpu->device, vertex, NULL);
    vkDestroyShaderModule(gpu->device, fragment, NULL);
    return keep(rig, result, pipeline, "vkCreateGraphicsPipelines");
}

void rig_bind(struct rig *rig, VkCommandBuffer commands, VkPipelineBindPoint point,
              VkPipeline pipeline, const struct BenchParams *params)
{
    const VkDescriptorSet sets[2] = {rig->set, rig->slots[rig->frame % RIG_FRAMES].pages};
    vkCmdBindPipeline(commands, point, pipeline);
    vkCmdBindDescriptorSets(commands, point, rig->layout, 0, 2, sets, 0, NULL);
    vkCmdPushConstants(commands, rig->layout, STAGES, 0, sizeof *params, params);
}

VkPipeline rig_wants_pipeline(struct rig *rig)
{
    struct rig_constants constants = {{0}};
    const float isotropic = 1.0f;
    memcpy(&constants.values[BENCH_CONSTANT_ANISOTROPY], &isotropic, 4);
    return rig_compute_pipeline(rig, bench_wants_comp, sizeof bench_wants_comp, &constants);
}

void rig_record_wants(struct rig *rig, VkCommandBuffer commands, void *user)
{
    struct rig_wants *wants = user;
    wants->params.width = rig->map_width;
    wants->params.height = rig->map_height;
    wants->params.textureCount = rig->texture_count;
    wants->params.seed = (uint32_t)rig->frame;
    rig_bind(rig, commands, VK_PIPELINE_BIND_POINT_COMPUTE, wants->pipeline, &wants->params);
    uint64_t threads = (uint64_t)rig->map_width * rig->map_height * rig->texture_count;
    vkCmdDispatch(commands, (uint32_t)((threads + 63) / 64), 1, 1);
}
