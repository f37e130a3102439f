#include "device/conform.h"

#include "support/test.h"
#include "vulkan/texture_entry.h"

#include "conform_comp.h"
#include "conform_frag.h"
#include "conform_vert.h"

#include <string.h>

#define BUFFERS 3u

VkShaderModule conform_module(struct harness *h, const uint32_t *code, size_t size)
{
    VkShaderModuleCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = size, .pCode = code};
    VkShaderModule result;
    assert_int_equal(h->CreateShaderModule(h->device, &info, NULL, &result), VK_SUCCESS);
    return result;
}

void conform_create_set(struct harness *h, uint32_t buffer_count, uint32_t texture_count,
                        uint32_t push_size, struct conform_set *set)
{
    const VkShaderStageFlags stages = VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
    const VkDescriptorType buffer = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    const VkDescriptorType texture = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    VkDescriptorSetLayoutBinding bindings[8];
    uint32_t count = buffer_count + texture_count;
    for (uint32_t i = 0; i < count; i++)
        bindings[i] =
            (VkDescriptorSetLayoutBinding){.binding = i,
                                           .descriptorType = i < buffer_count ? buffer : texture,
                                           .descriptorCount = 1,
                                           .stageFlags = stages};
    VkDescriptorSetLayoutCreateInfo info = {.sType =
                                                VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                            .bindingCount = count,
                                            .pBindings = bindings};
    assert_int_equal(h->CreateDescriptorSetLayout(h->device, &info, NULL, &set->set_layout),
                     VK_SUCCESS);
    VkPushConstantRange push = {stages, 0, push_size};
    VkPipelineLayoutCreateInfo layout = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                         .setLayoutCount = 1,
                                         .pSetLayouts = &set->set_layout,
                                         .pushConstantRangeCount = 1,
                                         .pPushConstantRanges = &push};
    assert_int_equal(h->CreatePipelineLayout(h->device, &layout, NULL, &set->layout), VK_SUCCESS);
    VkDescriptorPoolSize sizes[2] = {{buffer, buffer_count}, {texture, texture_count}};
    VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                       .maxSets = 1,
                                       .poolSizeCount = texture_count ? 2 : 1,
                                       .pPoolSizes = sizes};
    assert_int_equal(h->CreateDescriptorPool(h->device, &pool, NULL, &set->pool), VK_SUCCESS);
    VkDescriptorSetAllocateInfo allocate = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                            .descriptorPool = set->pool,
                                            .descriptorSetCount = 1,
                                            .pSetLayouts = &set->set_layout};
    assert_int_equal(h->AllocateDescriptorSets(h->device, &allocate, &set->set), VK_SUCCESS);
}

void conform_destroy_set(struct harness *h, struct conform_set *set)
{
    h->DestroyDescriptorPool(h->device, set->pool, NULL);
    h->DestroyPipelineLayout(h->device, set->layout, NULL);
    h->DestroyDescriptorSetLayout(h->device, set->set_layout, NULL);
}

void conform_write_buffers(struct harness *h, const struct conform_set *set, uint32_t count,
                           const struct harness_buffer *const *buffers)
{
    VkDescriptorBufferInfo infos[8];
    for (uint32_t i = 0; i < count; i++)
        infos[i] = (VkDescriptorBufferInfo){buffers[i]->buffer, 0, VK_WHOLE_SIZE};
    VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                  .dstSet = set->set,
                                  .descriptorCount = count,
                                  .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                  .pBufferInfo = infos};
    h->UpdateDescriptorSets(h->device, 1, &write, 0, NULL);
}

static VkPipeline compute_pipeline(struct harness *h, VkPipelineLayout layout,
                                   VkShaderModule compute, const VkSpecializationInfo *constants,
                                   VkPipelineShaderStageCreateFlags flags)
{
    VkComputePipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .flags = flags,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = compute,
                  .pName = "main",
                  .pSpecializationInfo = constants},
        .layout = layout};
    VkPipeline pipeline;
    assert_int_equal(
        h->CreateComputePipelines(h->device, VK_NULL_HANDLE, 1, &info, NULL, &pipeline),
        VK_SUCCESS);
    h->DestroyShaderModule(h->device, compute, NULL);
    return pipeline;
}

VkPipeline conform_compute_pipeline(struct harness *h, VkPipelineLayout layout,
                                    VkShaderModule compute, const VkSpecializationInfo *constants)
{
    return compute_pipeline(h, layout, compute, constants, 0);
}

VkPipeline conform_subgroup_pipeline(struct harness *h, VkPipelineLayout layout,
                                     VkShaderModule compute, const VkSpecializationInfo *constants)
{
    return compute_pipeline(h, layout, compute, constants,
                            VK_PIPELINE_SHADER_STAGE_CREATE_REQUIRE_FULL_SUBGROUPS_BIT_EXT);
}

void conform_create_target(struct harness *h, VkRenderPass *pass, VkFramebuffer *framebuffer)
{
    VkSubpassDescription subpass = {.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS};
    VkRenderPassCreateInfo pass_info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                        .subpassCount = 1,
                                        .pSubpasses = &subpass};
    assert_int_equal(h->CreateRenderPass(h->device, &pass_info, NULL, pass), VK_SUCCESS);
    VkFramebufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                    .renderPass = *pass,
                                    .width = CONFORM_TARGET_SIZE,
                                    .height = CONFORM_TARGET_SIZE,
                                    .layers = 1};
    assert_int_equal(h->CreateFramebuffer(h->device, &info, NULL, framebuffer), VK_SUCCESS);
}

VkShaderModule conform_vertex_module(struct harness *h)
{
    return conform_module(h, conform_vert, sizeof conform_vert);
}

VkPipeline conform_graphics_pipeline(struct harness *h, VkPipelineLayout layout, VkRenderPass pass,
                                     VkShaderModule vertex, VkShaderModule fragment,
                                     uint32_t attachment_count)
{
    VkPipelineShaderStageCreateInfo stages[2] = {
        {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
         .stage = VK_SHADER_STAGE_VERTEX_BIT,
         .module = vertex,
         .pName = "main"},
        {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
         .stage = VK_SHADER_STAGE_FRAGMENT_BIT,
         .module = fragment,
         .pName = "main"}};
    VkPipelineVertexInputStateCreateInfo input = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    VkPipelineInputAssemblyStateCreateInfo assembly = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
    VkViewport viewport = {0, 0, CONFORM_TARGET_SIZE, CONFORM_TARGET_SIZE, 0, 1};
    VkRect2D scissor = {{0, 0}, {CONFORM_TARGET_SIZE, CONFORM_TARGET_SIZE}};
    VkPipelineViewportStateCreateInfo viewports = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
        .viewportCount = 1,
        .pViewports = &viewport,
        .scissorCount = 1,
        .pScissors = &scissor};
    VkPipelineRasterizationStateCreateInfo raster = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO, .lineWidth = 1};
    VkPipelineMultisampleStateCreateInfo samples = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
    VkPipelineColorBlendAttachmentState blend = {.colorWriteMask = VK_COLOR_COMPONENT_R_BIT};
    VkPipelineColorBlendStateCreateInfo blends = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
        .attachmentCount = attachment_count,
        .pAttachments = &blend};
    VkGraphicsPipelineCreateInfo info = {.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                         .stageCount = 2,
                                         .pStages = stages,
                                         .pVertexInputState = &input,
                                         .pInputAssemblyState = &assembly,
                                         .pViewportState = &viewports,
                                         .pRasterizationState = &raster,
                                         .pMultisampleState = &samples,
                                         .pColorBlendState = attachment_count ? &blends : NULL,
                                         .layout = layout,
                                         .renderPass = pass};
    VkPipeline pipeline;
    assert_int_equal(
        h->CreateGraphicsPipelines(h->device, VK_NULL_HANDLE, 1, &info, NULL, &pipeline),
        VK_SUCCESS);
    h->DestroyShaderModule(h->device, vertex, NULL);
    h->DestroyShaderModule(h->device, fragment, NULL);
    return pipeline;
}

void conform_init(struct conform *c, struct harness *h)
{
    *c = (struct conform){.h = h};
    const VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    harness_buffer_init(h, &c->table, CONFORM_CAPACITY * sizeof(struct SluiceTextureEntry), usage);
    harness_buffer_init(h, &c->feedback, CONFORM_WORDS * sizeof(uint32_t), usage);
    harness_buffer_init(h, &c->inputs, CONFORM_CAPACITY * sizeof(struct ConformInput), usage);
    conform_create_set(h, BUFFERS, 0, sizeof(uint32_t), &c->set);
    conform_write_buffers(
        h, &c->set, BUFFERS,
        (const struct harness_buffer *const[]){&c->table, &c->feedback, &c->inputs});
    c->pipelines[CONFORM_STAGE_COMPUTE] = conform_compute_pipeline(
        h, c->set.layout, conform_module(h, conform_comp, sizeof conform_comp), NULL);
    conform_create_target(h, &c->pass, &c->framebuffer);
    c->pipelines[CONFORM_STAGE_FRAGMENT] =
        conform_graphics_pipeline(h, c->set.layout, c->pass, conform_vertex_module(h),
                                  conform_module(h, conform_frag, sizeof conform_frag), 0);
    VkPhysicalDeviceProperties properties;
    h->GetPhysicalDeviceProperties(h->physical_device, &properties);
    c->subtexel = 0.5f / (float)(1u << properties.limits.subTexelPrecisionBits);
}

void conform_finish(struct conform *c)
{
    struct harness *h = c->h;
    for (uint32_t i = 0; i < CONFORM_STAGE_COUNT; i++)
        h->DestroyPipeline(h->device, c->pipelines[i], NULL);
    h->DestroyFramebuffer(h->device, c->framebuffer, NULL);
    h->DestroyRenderPass(h->device, c->pass, NULL);
    conform_destroy_set(h, &c->set);
    harness_buffer_finish(h, &c->table);
    harness_buffer_finish(h, &c->feedback);
    harness_buffer_finish(h, &c->inputs);
}

void conform_record(struct harness *h, VkCommandBuffer commands, const struct conform_job *job)
{
    bool draws = job->stage == CONFORM_STAGE_FRAGMENT;
    VkPipelineBindPoint point =
        draws ? VK_PIPELINE_BIND_POINT_GRAPHICS : VK_PIPELINE_BIND_POINT_COMPUTE;
    VkRenderPassBeginInfo begin = {
        .sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
        .renderPass = job->pass,
        .framebuffer = job->framebuffer,
        .renderArea = {{0, 0}, {CONFORM_TARGET_SIZE, CONFORM_TARGET_SIZE}}};
    h->CmdBindPipeline(commands, point, job->pipeline);
    h->CmdBindDescriptorSets(commands, point, job->set->layout, 0, 1, &job->set->set, 0, NULL);
    h->CmdPushConstants(commands, job->set->layout,
                        VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                        job->push_size, job->push);
    if (draws) {
        h->CmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
        h->CmdDraw(commands, 3, 1, 0, 0);
        h->CmdEndRenderPass(commands);
    } else {
        h->CmdDispatch(commands, (job->count + 63) / 64, 1, 1);
    }
    VkMemoryBarrier barrier = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                               .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT,
                               .dstAccessMask = VK_ACCESS_HOST_READ_BIT};
    h->CmdPipelineBarrier(commands,
                          draws ? VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT
                                : VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                          VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier, 0, NULL, 0, NULL);
}

struct run {
    struct harness *h;
    const struct conform_job *job;
};

static void record(void *user, VkCommandBuffer commands)
{
    struct run *run = user;
    conform_record(run->h, commands, run->job);
}

void conform_run_job(struct harness *h, const struct conform_job *job)
{
    struct run run = {h, job};
    harness_run(h, record, &run);
}

/* Maps one behind the other, each cleared as the library clears them, guards between. */
static uint32_t lay_out(struct conform *c, struct conform_sample *samples, uint32_t count)
{
    uint32_t *words = c->feedback.mapped;
    uint32_t at = CONFORM_GUARD_COUNT, i = 0;
    memset(words, 0xff, c->feedback.size);
    for (; i < count && i < CONFORM_CAPACITY; i++) {
        uint32_t regions = samples[i].entry.regionCountX * samples[i].entry.regionCountY;
        assert_true(regions <= CONFORM_WORDS - 2 * CONFORM_GUARD_COUNT);
        if (at + regions + CONFORM_GUARD_COUNT > CONFORM_WORDS)
            break;
        samples[i].entry.feedbackOffset = at;
        samples[i].in.tableIndex = i;
        for (uint32_t r = 0; r < regions; r++)
            words[at + r] = SLUICE_MIP_UNTOUCHED;
        struct SluiceTextureEntry *entry = &((struct SluiceTextureEntry *)c->table.mapped)[i];
        *entry = samples[i].entry;
        slc_texture_entry_complete(entry);
        ((struct ConformInput *)c->inputs.mapped)[i] = samples[i].in;
        at += regions + CONFORM_GUARD_COUNT;
    }
    return i;
}

static void check_guards(const struct conform *c, const struct conform_sample *samples,
                         uint32_t count)
{
    const uint32_t *words = c->feedback.mapped;
    uint32_t at = 0;
    for (uint32_t i = 0; i <= count; i++) {
        uint32_t end = i < count ? samples[i].entry.feedbackOffset : CONFORM_WORDS;
        for (; at < end; at++)
            if (words[at] != CONFORM_GUARD)
                fail_msg("word %u, %u before map %u, became %u", at, end - at, i, words[at]);
        if (i < count)
            at += samples[i].entry.regionCountX * samples[i].entry.regionCountY;
    }
}

uint32_t conform_run(
    struct conform *c, enum conform_stage stage, struct conform_sample *samples, uint32_t count,
    void (*check)(void *user, const struct conform_sample *sample, const uint32_t *map), void *user)
{
    uint32_t fitting = lay_out(c, samples, count);
    struct conform_job job = {.set = &c->set,
                              .stage = stage,
                              .pipeline = c->pipelines[stage],
                              .pass = c->pass,
                              .framebuffer = c->framebuffer,
                              .count = fitting,
                              .push = &fitting,
                              .push_size = sizeof fitting};
    conform_run_job(c->h, &job);
    check_guards(c, samples, fitting);
    for (uint32_t i = 0; i < fitting; i++)
        check(user, &samples[i],
              (const uint32_t *)c->feedback.mapped + samples[i].entry.feedbackOffset);
    return fitting;
}

static bool halves_evenly(uint32_t size)
{
    while (size > 1 && size % 2 == 0)
        size /= 2;
    return size == 1;
}

struct SluiceTextureEntry conform_entry(uint32_t width, uint32_t height, uint32_t region_width,
                                        uint32_t region_height, uint32_t mode)
{
    struct SluiceTextureEntry e = {.width = width,
                                   .height = height,
                                   .mipLevelCount = 1,
                                   .regionWidth = region_width,
                                   .regionHeight = region_height,
                                   .regionCountX = (width + region_width - 1) / region_width,
                                   .regionCountY = (height + region_height - 1) / region_height,
                                   .addressModeU = mode,
                                   .addressModeV = mode};
    while ((width | height) >> e.mipLevelCount)
        e.mipLevelCount++;
    e.regularMipCount = e.mipLevelCount;
    if (!halves_evenly(width) || !halves_evenly(height))
        e.flags |= SLUICE_TEXTURE_FLAG_UNEVEN;
    slc_texture_entry_complete(&e);
    return e;
}
