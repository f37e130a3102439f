/*
 * Shaders that choose a texture by a number that varies by pixel. The oracle samples each texture
 * by itself, as an ordinary sampler2D, in the same frame.
 */
#include "device/harness.h"

#include "support/test.h"

#include <math.h>
#include <string.h>

#include "bindless_alone_comp.h"
#include "bindless_alone_frag.h"
#include "bindless_comp.h"
#include "bindless_frag.h"
#include "bindless_separate_comp.h"
#include "bindless_separate_frag.h"
#include "bindless_shared.h"
#include "picture_vert.h"

enum { TEXTURES = 6, PIXELS = BINDLESS_SIZE * BINDLESS_SIZE, FRAMES = 24 };
enum { BINDLESS, ALONE, KINDS };

#define STAGES (VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_FRAGMENT_BIT)

struct picture {
    struct harness *h;
    SluiceVulkanStreamer *streamer;
    SluiceTextureArray array;
    bool draws; ///< true: draws; false: computes
    bool anisotropic;
    bool mixes;    ///< true: textures are sparse, paged and dense in turn
    bool compares; ///< true: compares in this frame
    SluiceImageSource *sources[TEXTURES];
    float shades[TEXTURES]; ///< red of all texels
    SluiceVulkanTexture textures[TEXTURES];
    struct harness_buffer outputs[KINDS], list;
    VkDescriptorSetLayout layout;
    VkDescriptorPool pool;
    VkDescriptorSet sets[1 + TEXTURES]; ///< set of bindless shaders; then a set per texture
    VkPipelineLayout pipeline_layout;
    VkPipeline pipelines[KINDS];
    VkRenderPass pass;
    VkFramebuffer framebuffer;
    struct BindlessParams params;
};

/* Red identifies the texture, green varies smoothly, blue identifies the level. */
static void paint(void *user, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
                  uint32_t height, float rgba[4])
{
    float u = ((float)x + 0.5f) / (float)width, v = ((float)y + 0.5f) / (float)height;
    rgba[0] = *(const float *)user;
    rgba[1] = 0.5f + 0.25f * sinf(6.2831853f * u) + 0.25f * sinf(6.2831853f * v);
    rgba[2] = (float)level / 16.0f;
    rgba[3] = 1.0f;
}

static SluiceResidencyMode mode_of(const struct picture *p, uint32_t number)
{
    static const SluiceResidencyMode modes[] = {
        SLUICE_RESIDENCY_MODE_SPARSE, SLUICE_RESIDENCY_MODE_PAGED, SLUICE_RESIDENCY_MODE_DENSE};
    return p->mixes ? modes[number % 3] : SLUICE_RESIDENCY_MODE_AUTO;
}

static void add_texture(struct picture *p, uint32_t i, uint32_t number)
{
    static const uint32_t sizes[][2] = {{1024, 512}, {512, 512},   {300, 200}, {64, 64},
                                        {2048, 256}, {1024, 1024}, {16, 16},   {512, 2048}};
    static const VkSamplerAddressMode modes[] = {VK_SAMPLER_ADDRESS_MODE_REPEAT,
                                                 VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                                 VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT};
    p->shades[i] = (float)(number + 1) / 16.0f;
    const SluiceProceduralImage image = {&p->shades[i], paint};
    const SluiceImageInfo info = {.structSize = sizeof info,
                                  .width = sizes[number % 8][0],
                                  .height = sizes[number % 8][1],
                                  .format = SLUICE_FORMAT_R8G8B8A8_UNORM};
    CHECK_OK(sluiceCreateProceduralImageSource(&image, &info, NULL, &p->sources[i]));
    const SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create,
                                                  .source = p->sources[i],
                                                  .residencyMode = mode_of(p, number),
                                                  .addressModeU = modes[number % 3],
                                                  .addressModeV = modes[number / 3 % 3],
                                                  .maxAnisotropy =
                                                      p->anisotropic && number % 2 ? 4.0f : 0.0f};
    CHECK_OK(sluiceAddVulkanTexture(p->streamer, &create, &p->textures[i]));
    assert_float_equal(p->textures[i].maxAnisotropy, create.maxAnisotropy > 1 ? 4 : 1, 0);
    /* Scale all textures equally for lavapipe, which uses one pixel's derivatives for the whole
     * quad with anisotropy. */
    const bool alike = p->anisotropic && harness_level_error(p->h) == 0;
    ((struct BindlessTexture *)p->list.mapped)[i] =
        (struct BindlessTexture){.tableIndex = p->textures[i].tableIndex,
                                 .lastLevel = p->textures[i].mipLevelCount - 1,
                                 .maxAnisotropy = p->textures[i].maxAnisotropy,
                                 .scale = 1.0f / (float)(60 + (alike ? 0 : 200 * (i % 3)))};
    VkSampler sampler;
    CHECK_OK(sluiceGetVulkanSampler(p->streamer, p->textures[i].textureId, &sampler));
    const VkDescriptorImageInfo alone = {sampler, p->textures[i].imageView,
                                         VK_IMAGE_LAYOUT_GENERAL};
    const VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                        .dstSet = p->sets[1 + i],
                                        .dstBinding = 2,
                                        .descriptorCount = 1,
                                        .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                        .pImageInfo = &alone};
    p->h->UpdateDescriptorSets(p->h->device, 1, &write, 0, NULL);
}

static void create_sets(struct picture *p)
{
    struct harness *h = p->h;
    VkDescriptorSetLayoutBinding bindings[3];
    for (uint32_t i = 0; i < 3; i++)
        bindings[i] = (VkDescriptorSetLayoutBinding){
            i,
            i < 2 ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
            1, STAGES, NULL};
    const VkDescriptorSetLayoutCreateInfo layout = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = 3,
        .pBindings = bindings};
    assert_int_equal(h->CreateDescriptorSetLayout(h->device, &layout, NULL, &p->layout),
                     VK_SUCCESS);
    const VkDescriptorPoolSize sizes[] = {
        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 2 * (1 + TEXTURES)},
        {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1 + TEXTURES}};
    const VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = 1 + TEXTURES,
                                             .poolSizeCount = 2,
                                             .pPoolSizes = sizes};
    assert_int_equal(h->CreateDescriptorPool(h->device, &pool, NULL, &p->pool), VK_SUCCESS);
    for (uint32_t i = 0; i < 1 + TEXTURES; i++) {
        const VkDescriptorSetAllocateInfo allocate = {
            .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
            .descriptorPool = p->pool,
            .descriptorSetCount = 1,
            .pSetLayouts = &p->layout};
        assert_int_equal(h->AllocateDescriptorSets(h->device, &allocate, &p->sets[i]), VK_SUCCESS);
        const VkDescriptorBufferInfo buffers[] = {
            {p->outputs[i == 0 ? BINDLESS : ALONE].buffer, 0, VK_WHOLE_SIZE},
            {p->list.buffer, 0, VK_WHOLE_SIZE}};
        const VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                            .dstSet = p->sets[i],
                                            .descriptorCount = 2,
                                            .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                            .pBufferInfo = buffers};
        h->UpdateDescriptorSets(h->device, 1, &write, 0, NULL);
    }
}

static VkShaderModule module(struct harness *h, const uint32_t *code, size_t size)
{
    const VkShaderModuleCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = size, .pCode = code};
    VkShaderModule result;
    assert_int_equal(h->CreateShaderModule(h->device, &info, NULL, &result), VK_SUCCESS);
    return result;
}

static VkShaderModule shader(const struct picture *p, uint32_t kind)
{
    struct harness *h = p->h;
    bool separate = p->array == SLUICE_TEXTURE_ARRAY_SEPARATE;
    if (kind == ALONE)
        return p->draws ? module(h, bindless_alone_frag, sizeof bindless_alone_frag)
                        : module(h, bindless_alone_comp, sizeof bindless_alone_comp);
    if (separate)
        return p->draws ? module(h, bindless_separate_frag, sizeof bindless_separate_frag)
                        : module(h, bindless_separate_comp, sizeof bindless_separate_comp);
    return p->draws ? module(h, bindless_frag, sizeof bindless_frag)
                    : module(h, bindless_comp, sizeof bindless_comp);
}

static VkPipeline create_compute(struct picture *p, const VkPipelineShaderStageCreateInfo *stage)
{
    const VkComputePipelineCreateInfo info = {.sType =
                                                  VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                                              .stage = *stage,
                                              .layout = p->pipeline_layout};
    VkPipeline pipeline;
    assert_int_equal(
        p->h->CreateComputePipelines(p->h->device, VK_NULL_HANDLE, 1, &info, NULL, &pipeline),
        VK_SUCCESS);
    return pipeline;
}

static VkPipeline create_graphics(struct picture *p, const VkPipelineShaderStageCreateInfo *stage)
{
    struct harness *h = p->h;
    const VkPipelineShaderStageCreateInfo stages[2] = {
        {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
         .stage = VK_SHADER_STAGE_VERTEX_BIT,
         .module = module(h, picture_vert, sizeof picture_vert),
         .pName = "main"},
        *stage};
    const VkPipelineVertexInputStateCreateInfo input = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    const VkPipelineInputAssemblyStateCreateInfo assembly = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
        .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
    const VkViewport viewport = {0, 0, BINDLESS_SIZE, BINDLESS_SIZE, 0, 1};
    const VkRect2D scissor = {{0, 0}, {BINDLESS_SIZE, BINDLESS_SIZE}};
    const VkPipelineViewportStateCreateInfo viewports = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
        .viewportCount = 1,
        .pViewports = &viewport,
        .scissorCount = 1,
        .pScissors = &scissor};
    const VkPipelineRasterizationStateCreateInfo raster = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO, .lineWidth = 1};
    const VkPipelineMultisampleStateCreateInfo samples = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
        .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
    const VkGraphicsPipelineCreateInfo info = {.sType =
                                                   VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                               .stageCount = 2,
                                               .pStages = stages,
                                               .pVertexInputState = &input,
                                               .pInputAssemblyState = &assembly,
                                               .pViewportState = &viewports,
                                               .pRasterizationState = &raster,
                                               .pMultisampleState = &samples,
                                               .layout = p->pipeline_layout,
                                               .renderPass = p->pass};
    VkPipeline pipeline;
    assert_int_equal(
        h->CreateGraphicsPipelines(h->device, VK_NULL_HANDLE, 1, &info, NULL, &pipeline),
        VK_SUCCESS);
    h->DestroyShaderModule(h->device, stages[0].module, NULL);
    return pipeline;
}

/* Creates a target without attachments: fragments only write to buffers. */
static void create_target(struct picture *p)
{
    const VkSubpassDescription subpass = {.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS};
    const VkRenderPassCreateInfo pass = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                         .subpassCount = 1,
                                         .pSubpasses = &subpass};
    assert_int_equal(p->h->CreateRenderPass(p->h->device, &pass, NULL, &p->pass), VK_SUCCESS);
    const VkFramebufferCreateInfo framebuffer = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                                 .renderPass = p->pass,
                                                 .width = BINDLESS_SIZE,
                                                 .height = BINDLESS_SIZE,
                                                 .layers = 1};
    assert_int_equal(p->h->CreateFramebuffer(p->h->device, &framebuffer, NULL, &p->framebuffer),
                     VK_SUCCESS);
}

static void create_pipelines(struct picture *p)
{
    struct harness *h = p->h;
    VkDescriptorSetLayout layouts[2] = {VK_NULL_HANDLE, p->layout};
    CHECK_OK(sluiceGetVulkanDescriptorSetLayout(p->streamer, &layouts[0]));
    const VkPushConstantRange range = {STAGES, 0, sizeof p->params};
    const VkPipelineLayoutCreateInfo layout = {.sType =
                                                   VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                               .setLayoutCount = 2,
                                               .pSetLayouts = layouts,
                                               .pushConstantRangeCount = 1,
                                               .pPushConstantRanges = &range};
    assert_int_equal(h->CreatePipelineLayout(h->device, &layout, NULL, &p->pipeline_layout),
                     VK_SUCCESS);
    SluiceResidencyMode resolved;
    CHECK_OK(sluiceGetVulkanResidencyMode(p->streamer, &resolved));
    const VkBool32 values[] = {resolved == SLUICE_RESIDENCY_MODE_PAGED || p->mixes, p->mixes};
    const VkSpecializationMapEntry entries[] = {{0, 0, sizeof values[0]},
                                                {1, sizeof values[0], sizeof values[0]}};
    const VkSpecializationInfo constants = {2, entries, sizeof values, values};
    for (uint32_t kind = 0; kind < KINDS; kind++) {
        const VkPipelineShaderStageCreateInfo stage = {
            .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
            .stage = p->draws ? VK_SHADER_STAGE_FRAGMENT_BIT : VK_SHADER_STAGE_COMPUTE_BIT,
            .module = shader(p, kind),
            .pName = "main",
            .pSpecializationInfo = &constants};
        p->pipelines[kind] = p->draws ? create_graphics(p, &stage) : create_compute(p, &stage);
        h->DestroyShaderModule(h->device, stage.module, NULL);
    }
}

static void picture_init(struct picture *p, struct harness *h, SluiceTextureArray array, bool draws,
                         bool anisotropic, bool mixes)
{
    *p = (struct picture){
        .h = h, .array = array, .draws = draws, .anisotropic = anisotropic, .mixes = mixes};
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                           .textureArray = array,
                                           .pagedTextures = mixes,
                                           .maxTextureCount = 4 * TEXTURES,
                                           .maxRegionCount = 1 << 12,
                                           .feedbackTimeoutTicks = 1000};
    harness_fill(h, &info);
    CHECK_OK(sluiceCreateVulkanStreamer(&info, &p->streamer));
    for (uint32_t kind = 0; kind < KINDS; kind++)
        harness_buffer_init(h, &p->outputs[kind], PIXELS * sizeof(struct BindlessOutput),
                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    harness_buffer_init(h, &p->list, TEXTURES * sizeof(struct BindlessTexture),
                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    create_sets(p);
    create_target(p);
    create_pipelines(p);
    for (uint32_t i = 0; i < TEXTURES; i++)
        add_texture(p, i, i);
}

static void picture_finish(struct picture *p)
{
    struct harness *h = p->h;
    harness_destroy(h, p->streamer);
    for (uint32_t i = 0; i < TEXTURES; i++)
        sluiceDestroyImageSource(p->sources[i]);
    for (uint32_t kind = 0; kind < KINDS; kind++) {
        harness_buffer_finish(h, &p->outputs[kind]);
        h->DestroyPipeline(h->device, p->pipelines[kind], NULL);
    }
    harness_buffer_finish(h, &p->list);
    h->DestroyPipelineLayout(h->device, p->pipeline_layout, NULL);
    h->DestroyDescriptorPool(h->device, p->pool, NULL);
    h->DestroyDescriptorSetLayout(h->device, p->layout, NULL);
    h->DestroyFramebuffer(h->device, p->framebuffer, NULL);
    h->DestroyRenderPass(h->device, p->pass, NULL);
    harness_check_silence(h);
}

static void barrier(struct picture *p, VkCommandBuffer commands, VkPipelineStageFlags to,
                    VkAccessFlags accesses)
{
    const VkPipelineStageFlags from =
        p->draws ? VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT : VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
    const VkMemoryBarrier memory = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                    .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT,
                                    .dstAccessMask = accesses};
    p->h->CmdPipelineBarrier(commands, from, to ? to : from, 0, 1, &memory, 0, NULL, 0, NULL);
}

static void paint_once(struct picture *p, VkCommandBuffer commands, uint32_t kind, uint32_t only)
{
    struct harness *h = p->h;
    const VkPipelineBindPoint point =
        p->draws ? VK_PIPELINE_BIND_POINT_GRAPHICS : VK_PIPELINE_BIND_POINT_COMPUTE;
    const VkDescriptorSet sets[] = {h->set, p->sets[kind == ALONE ? 1 + only : 0]};
    struct BindlessParams params = p->params;
    params.only = kind == ALONE ? only : BINDLESS_NO_TEXTURE;
    h->CmdBindPipeline(commands, point, p->pipelines[kind]);
    h->CmdBindDescriptorSets(commands, point, p->pipeline_layout, 0, 2, sets, 0, NULL);
    h->CmdPushConstants(commands, p->pipeline_layout, STAGES, 0, sizeof params, &params);
    if (p->draws) {
        const VkRenderPassBeginInfo begin = {
            .sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
            .renderPass = p->pass,
            .framebuffer = p->framebuffer,
            .renderArea = {{0, 0}, {BINDLESS_SIZE, BINDLESS_SIZE}}};
        h->CmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
        h->CmdDraw(commands, 3, 1, 0, 0);
        h->CmdEndRenderPass(commands);
    } else {
        h->CmdDispatch(commands, BINDLESS_SIZE / BINDLESS_GROUP, BINDLESS_SIZE / BINDLESS_GROUP, 1);
    }
    barrier(p, commands, 0, VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
}

static void record(void *user, VkCommandBuffer commands)
{
    struct picture *p = user;
    paint_once(p, commands, BINDLESS, 0);
    for (uint32_t i = 0; p->compares && i < TEXTURES; i++)
        paint_once(p, commands, ALONE, i);
    barrier(p, commands, VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
}

/* Explicit derivatives give the result of implicit ones, except for rounding by the device. */
static void check_pixel(const struct picture *p, uint32_t i)
{
    const struct BindlessOutput *found = (const struct BindlessOutput *)p->outputs[BINDLESS].mapped;
    const struct BindlessOutput *truth = (const struct BindlessOutput *)p->outputs[ALONE].mapped;
    found += i;
    truth += i;
    const float tolerance = p->draws ? 0.02f : 0.002f;
    assert_int_equal(found->texture, truth->texture);
    assert_int_equal(found->missing, truth->missing);
    for (uint32_t c = 0; c < 4; c++) {
        if (!(fabsf(found->color[c] - truth->color[c]) <= tolerance))
            fail_msg("pixel %u of texture %u, channel %u: %g, alone %g; %u levels are missing", i,
                     found->texture, c, (double)found->color[c], (double)truth->color[c],
                     found->missing);
        if (found->missing != SLUICE_MIP_UNTOUCHED)
            assert_float_equal(found->texel[c], truth->texel[c], 0.002);
    }
    if (found->missing != SLUICE_MIP_UNTOUCHED) {
        assert_float_equal(found->color[0], p->shades[found->texture], 0.005);
        assert_float_equal(found->texel[0], p->shades[found->texture], 0.005);
    }
}

/* Runs a frame whose pixels choose alone or in squares. Returns the number of pixels that are not
 * sharp yet. */
static uint32_t check_frame(struct picture *p, uint32_t seed)
{
    p->params = (struct BindlessParams){.count = TEXTURES, .seed = seed, .shift = seed % 3};
    p->compares = seed % 4 == 3;
    CHECK_OK(sluiceWaitVulkanStreamerIdle(p->streamer));
    harness_frame(p->h, p->streamer, true, record, p);
    uint32_t missing = 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        if (p->compares)
            check_pixel(p, i);
        missing += ((const struct BindlessOutput *)p->outputs[BINDLESS].mapped)[i].missing != 0;
    }
    return missing;
}

static void check_all(struct harness *h, SluiceTextureArray array, bool draws, bool anisotropic,
                      bool mixes)
{
    static struct picture picture;
    struct picture *p = &picture;
    picture_init(p, h, array, draws, anisotropic, mixes);
    uint32_t blurry = 0, missing = 0;
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        missing = check_frame(p, frame);
        blurry += missing;
    }
    assert_true(blurry > 0); /* they are streamed, requested by these pixels only */
    assert_int_equal(missing, 0);

    for (uint32_t i = 0; i < 3; i++) { /* others take their slots in the array */
        CHECK_OK(sluiceRemoveVulkanTexture(p->streamer, p->textures[i].textureId));
        CHECK_OK(sluiceWaitVulkanStreamerIdle(p->streamer));
        sluiceDestroyImageSource(p->sources[i]);
        add_texture(p, i, TEXTURES + i);
    }
    for (uint32_t frame = 0; frame < FRAMES; frame++)
        missing = check_frame(p, frame);
    assert_int_equal(missing, 0);
    SluiceVulkanStreamerStatistics statistics = {.structSize = sizeof statistics};
    CHECK_OK(sluiceGetVulkanStreamerStatistics(p->streamer, &statistics));
    assert_in_range(statistics.mappedTileCount, 1, statistics.tileCount - 1);
    picture_finish(p);
}

static void check_both(struct harness *h, SluiceTextureArray array)
{
    check_all(h, array, false, false, false);
    check_all(h, array, true, false, false);
    if (h->anisotropy && array == SLUICE_TEXTURE_ARRAY_COMBINED)
        check_all(h, array, false, true, false);
}

static bool has_features(const struct harness *h)
{
    return h->caps.nonUniformIndexing && h->caps.runtimeDescriptorArrays;
}

static void divergent_numbers_sample_as_each_texture_alone(void **state)
{
    if (!has_features(*state))
        SKIP_TEST("the device has no arrays that are indexed non-uniformly");
    check_both(*state, SLUICE_TEXTURE_ARRAY_COMBINED);
}

static void separate_images_and_samplers_sample_alike(void **state)
{
    if (!has_features(*state))
        SKIP_TEST("the device has no arrays that are indexed non-uniformly");
    check_both(*state, SLUICE_TEXTURE_ARRAY_SEPARATE);
}

static void sparse_paged_and_dense_textures_stand_in_one_draw(void **state)
{
    struct harness *h = *state;
    if (!has_features(h) || h->mode != SLUICE_RESIDENCY_MODE_SPARSE)
        SKIP_TEST("only sparse streamers have textures of all modes, numbers need array features");
    check_all(h, SLUICE_TEXTURE_ARRAY_COMBINED, true, false, true);
    check_all(h, SLUICE_TEXTURE_ARRAY_COMBINED, false, h->anisotropy, true);
}

static void textures_of_a_kind_share_a_sampler(void **state)
{
    struct harness *h = *state;
    static struct picture picture;
    if (!has_features(h))
        SKIP_TEST("the device has no arrays that are indexed non-uniformly");
    picture_init(&picture, h, SLUICE_TEXTURE_ARRAY_COMBINED, false, h->anisotropy, false);
    VkSampler samplers[TEXTURES];
    for (uint32_t i = 0; i < TEXTURES; i++)
        CHECK_OK(
            sluiceGetVulkanSampler(picture.streamer, picture.textures[i].textureId, &samplers[i]));
    for (uint32_t i = 0; i < TEXTURES; i++)
        for (uint32_t j = 0; j < TEXTURES; j++) {
            const SluiceVulkanTexture *a = &picture.textures[i], *b = &picture.textures[j];
            bool alike = a->addressModeU == b->addressModeU && a->addressModeV == b->addressModeV &&
                         a->maxAnisotropy == b->maxAnisotropy;
            assert_int_equal(samplers[i] == samplers[j], alike);
        }
    VkSampler sampler;
    CHECK_RESULT(sluiceGetVulkanSampler(picture.streamer, SLUICE_NO_TEXTURE, &sampler),
                 SLUICE_ERROR_UNKNOWN_TEXTURE);
    SluiceVulkanTexture none;
    h->quiet = true;
    const float wrong[] = {-1.0f, 16.5f, NAN};
    for (uint32_t i = 0; i < 3; i++)
        CHECK_RESULT(sluiceAddVulkanTexture(picture.streamer,
                                            &(SluiceVulkanTextureCreateInfo){
                                                .structSize = sizeof(SluiceVulkanTextureCreateInfo),
                                                .source = picture.sources[0],
                                                .maxAnisotropy = wrong[i]},
                                            &none),
                     SLUICE_ERROR_INVALID_ARGUMENT);
    h->quiet = false;
    picture_finish(&picture);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(divergent_numbers_sample_as_each_texture_alone),
        cmocka_unit_test(separate_images_and_samplers_sample_alike),
        cmocka_unit_test(sparse_paged_and_dense_textures_stand_in_one_draw),
        cmocka_unit_test(textures_of_a_kind_share_a_sampler),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    CHECK_OK(harness_set_context(&h, &(SluiceVulkanContextCreateInfo){.maxPageChunkCount = 8}));
    return harness_finish(&h, RUN_TESTS(tests));
}
