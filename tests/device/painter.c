#include "device/painter.h"

#include "support/test.h"

#include "array_frag.h"
#include "array_min_lod_frag.h"
#include "picture_codes_frag.h"
#include "picture_frag.h"
#include "picture_min_lod_codes_frag.h"
#include "picture_min_lod_frag.h"
#include "picture_query_frag.h"
#include "picture_query_late_frag.h"
#include "picture_vert.h"

static VkShaderModule module(struct harness *h, const uint32_t *code, size_t size)
{
    VkShaderModuleCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = size, .pCode = code};
    VkShaderModule result;
    assert_int_equal(h->CreateShaderModule(h->device, &info, NULL, &result), VK_SUCCESS);
    return result;
}

/* Creates a target without attachments, because fragments only write to buffers. */
static void create_target(struct painter *p)
{
    struct harness *h = p->prober->h;
    VkSubpassDescription subpass = {.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS};
    VkRenderPassCreateInfo pass = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                   .subpassCount = 1,
                                   .pSubpasses = &subpass};
    assert_int_equal(h->CreateRenderPass(h->device, &pass, NULL, &p->pass), VK_SUCCESS);
    VkFramebufferCreateInfo framebuffer = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                           .renderPass = p->pass,
                                           .width = PICTURE_SIZE,
                                           .height = PICTURE_SIZE,
                                           .layers = 1};
    assert_int_equal(h->CreateFramebuffer(h->device, &framebuffer, NULL, &p->framebuffer),
                     VK_SUCCESS);
}

static VkShaderModule fragment_module(const struct painter *p, enum painter_feedback feedback)
{
    struct harness *h = p->prober->h;
    switch (feedback) {
    case PAINTER_QUERY: return module(h, picture_query_frag, sizeof picture_query_frag);
    case PAINTER_QUERY_LATE:
        return module(h, picture_query_late_frag, sizeof picture_query_late_frag);
    case PAINTER_LAYER:
        return h->min_lod ? module(h, array_min_lod_frag, sizeof array_min_lod_frag)
                          : module(h, array_frag, sizeof array_frag);
    case PAINTER_COMPUTE: break;
    }
    if (h->min_lod && p->prober->codes)
        return module(h, picture_min_lod_codes_frag, sizeof picture_min_lod_codes_frag);
    if (h->min_lod)
        return module(h, picture_min_lod_frag, sizeof picture_min_lod_frag);
    if (p->prober->codes)
        return module(h, picture_codes_frag, sizeof picture_codes_frag);
    return module(h, picture_frag, sizeof picture_frag);
}

static VkPipeline create_pipeline(const struct painter *p, enum painter_feedback feedback)
{
    struct harness *h = p->prober->h;
    struct prober_specialization specialization;
    const VkSpecializationInfo *constants = prober_specialize(p->prober, &specialization);
    VkPipelineShaderStageCreateInfo stages[2] = {
        {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
         .stage = VK_SHADER_STAGE_VERTEX_BIT,
         .module = module(h, picture_vert, sizeof picture_vert),
         .pName = "main"},
        {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
         .stage = VK_SHADER_STAGE_FRAGMENT_BIT,
         .module = fragment_module(p, feedback),
         .pName = "main",
         .pSpecializationInfo = constants}};
    VkPipelineVertexInputStateCreateInfo input = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    VkPipelineInputAssemblyStateCreateInfo assembly = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
    VkViewport viewport = {0, 0, PICTURE_SIZE, PICTURE_SIZE, 0, 1};
    VkRect2D scissor = {{0, 0}, {PICTURE_SIZE, PICTURE_SIZE}};
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
    VkGraphicsPipelineCreateInfo info = {.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                         .stageCount = 2,
                                         .pStages = stages,
                                         .pVertexInputState = &input,
                                         .pInputAssemblyState = &assembly,
                                         .pViewportState = &viewports,
                                         .pRasterizationState = &raster,
                                         .pMultisampleState = &samples,
                                         .layout = p->prober->layout,
                                         .renderPass = p->pass};
    VkPipeline pipeline;
    assert_int_equal(
        h->CreateGraphicsPipelines(h->device, VK_NULL_HANDLE, 1, &info, NULL, &pipeline),
        VK_SUCCESS);
    h->DestroyShaderModule(h->device, stages[0].module, NULL);
    h->DestroyShaderModule(h->device, stages[1].module, NULL);
    return pipeline;
}

/* Returns a pipeline that painters share. It stays valid after the layout and render pass of its
 * creation are gone, because those of all painters are compatible. */
static VkPipeline shared_pipeline(const struct painter *p, enum painter_feedback feedback)
{
    struct harness *h = p->prober->h;
    uint32_t kind = (uint32_t)feedback << 3 | (p->prober->paged ? 1 : 0) |
                    (p->prober->codes ? 2 : 0) | (h->min_lod ? 4 : 0);
    assert_true(kind < HARNESS_PAINT_KINDS);
    if (!h->paint_pipelines[kind])
        h->paint_pipelines[kind] = create_pipeline(p, feedback);
    return h->paint_pipelines[kind];
}

void painter_init_as(struct painter *p, struct prober *prober, struct probe_texture texture,
                     enum painter_feedback feedback)
{
    *p = (struct painter){.prober = prober, .texture = texture};
    create_target(p);
    p->pipeline = shared_pipeline(p, feedback);
}

void painter_init(struct painter *p, struct prober *prober, struct probe_texture texture)
{
    painter_init_as(p, prober, texture, PAINTER_COMPUTE);
}

void painter_finish(struct painter *p)
{
    struct harness *h = p->prober->h;
    assert_int_equal(h->DeviceWaitIdle(h->device), VK_SUCCESS);
    h->DestroyFramebuffer(h->device, p->framebuffer, NULL);
    h->DestroyRenderPass(h->device, p->pass, NULL);
}

static void output_barrier(struct painter *p, VkCommandBuffer commands, VkPipelineStageFlags from,
                           VkPipelineStageFlags to, VkAccessFlags accesses)
{
    VkMemoryBarrier barrier = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                               .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT,
                               .dstAccessMask = accesses};
    p->prober->h->CmdPipelineBarrier(commands, from, to, 0, 1, &barrier, 0, NULL, 0, NULL);
}

void painter_record(void *user, VkCommandBuffer commands)
{
    struct painter *p = user;
    struct harness *h = p->prober->h;
    struct ProbeParams params = {p->texture.table_index, p->frame++, 0,
                                 p->lattice ? PICTURE_LATTICE : p->layer};
    VkRenderPassBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                   .renderPass = p->pass,
                                   .framebuffer = p->framebuffer,
                                   .renderArea = {{0, 0}, {PICTURE_SIZE, PICTURE_SIZE}}};
    output_barrier(p, commands, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                   VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                   VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
    h->CmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    h->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, p->pipeline);
    h->CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, p->prober->layout, 0, 1,
                             &p->texture.set, 0, NULL);
    prober_bind_pages(p->prober, commands, VK_PIPELINE_BIND_POINT_GRAPHICS);
    h->CmdPushConstants(commands, p->prober->layout,
                        VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                        sizeof params, &params);
    h->CmdDraw(commands, 3, 1, 0, 0);
    h->CmdEndRenderPass(commands);
    output_barrier(p, commands, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                   VK_ACCESS_HOST_READ_BIT);
}
