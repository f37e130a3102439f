#include "device/crowd.h"

#include "support/test.h"

#include <sluice/shared/texture_table.h>

#include <math.h>
#include <stdlib.h>

#include "crowd_comp.h"

/* Red and green are the same in all levels and say which texture it is; blue says where. */
static void paint(void *user, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
                  uint32_t height, float rgba[4])
{
    const struct crowd_member *member = user;
    (void)y, (void)height;
    rgba[0] = (float)(member->number % 251 + 2) / 255.0f;
    rgba[1] = (float)(member->number / 251) / 255.0f;
    rgba[2] = level == 0 && x == width / 2 ? 1.0f : 0.0f;
    rgba[3] = 1.0f;
}

SluiceImageSource *crowd_source(struct crowd_member *member, uint32_t number, uint32_t size)
{
    *member = (struct crowd_member){.number = number, .size = size};
    const SluiceProceduralImage image = {member, paint};
    const SluiceImageInfo info = {.structSize = sizeof info,
                                  .width = size,
                                  .height = size,
                                  .format = SLUICE_FORMAT_R8G8B8A8_UNORM};
    CHECK_OK(sluiceCreateProceduralImageSource(&image, &info, NULL, &member->source));
    return member->source;
}

static void create_set(struct crowd *c)
{
    struct harness *h = c->h;
    const VkDescriptorSetLayoutBinding binding = {0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1,
                                                  VK_SHADER_STAGE_COMPUTE_BIT, NULL};
    const VkDescriptorSetLayoutCreateInfo layout = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = 1,
        .pBindings = &binding};
    assert_int_equal(h->CreateDescriptorSetLayout(h->device, &layout, NULL, &c->layout),
                     VK_SUCCESS);
    const VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
    const VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = 1,
                                             .poolSizeCount = 1,
                                             .pPoolSizes = &size};
    assert_int_equal(h->CreateDescriptorPool(h->device, &pool, NULL, &c->pool), VK_SUCCESS);
    const VkDescriptorSetAllocateInfo allocate = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
        .descriptorPool = c->pool,
        .descriptorSetCount = 1,
        .pSetLayouts = &c->layout};
    assert_int_equal(h->AllocateDescriptorSets(h->device, &allocate, &c->set), VK_SUCCESS);
    const VkDescriptorBufferInfo buffer = {c->outputs.buffer, 0, VK_WHOLE_SIZE};
    const VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                        .dstSet = c->set,
                                        .descriptorCount = 1,
                                        .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                        .pBufferInfo = &buffer};
    h->UpdateDescriptorSets(h->device, 1, &write, 0, NULL);
}

static void create_pipeline(struct crowd *c)
{
    struct harness *h = c->h;
    VkDescriptorSetLayout layouts[2] = {VK_NULL_HANDLE, c->layout};
    CHECK_OK(sluiceGetVulkanDescriptorSetLayout(c->streamer, &layouts[0]));
    const VkPushConstantRange range = {VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(struct CrowdParams)};
    const VkPipelineLayoutCreateInfo layout = {.sType =
                                                   VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                               .setLayoutCount = 2,
                                               .pSetLayouts = layouts,
                                               .pushConstantRangeCount = 1,
                                               .pPushConstantRanges = &range};
    assert_int_equal(h->CreatePipelineLayout(h->device, &layout, NULL, &c->pipeline_layout),
                     VK_SUCCESS);
    SluiceResidencyMode mode;
    CHECK_OK(sluiceGetVulkanResidencyMode(c->streamer, &mode));
    const VkBool32 paged = mode == SLUICE_RESIDENCY_MODE_PAGED;
    const VkSpecializationMapEntry entry = {0, 0, sizeof paged};
    const VkSpecializationInfo constants = {1, &entry, sizeof paged, &paged};
    const VkShaderModuleCreateInfo code = {.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                           .codeSize = sizeof crowd_comp,
                                           .pCode = crowd_comp};
    VkComputePipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .pName = "main",
                  .pSpecializationInfo = &constants},
        .layout = c->pipeline_layout};
    assert_int_equal(h->CreateShaderModule(h->device, &code, NULL, &info.stage.module), VK_SUCCESS);
    assert_int_equal(
        h->CreateComputePipelines(h->device, VK_NULL_HANDLE, 1, &info, NULL, &c->pipeline),
        VK_SUCCESS);
    h->DestroyShaderModule(h->device, info.stage.module, NULL);
}

void crowd_init(struct crowd *c, struct harness *h, SluiceVulkanStreamerCreateInfo info)
{
    *c = (struct crowd){.h = h};
    info.structSize = sizeof info;
    info.textureArray = SLUICE_TEXTURE_ARRAY_COMBINED;
    info.texturesPerFrame = info.maxTextureCount;
    harness_fill(h, &info);
    CHECK_OK(sluiceCreateVulkanStreamer(&info, &c->streamer));
    c->members = calloc(info.maxTextureCount, sizeof *c->members);
    assert_non_null(c->members);
    harness_buffer_init(h, &c->outputs, info.maxTextureCount * sizeof(struct CrowdOutput),
                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    create_set(c);
    create_pipeline(c);
}

void crowd_finish(struct crowd *c)
{
    struct harness *h = c->h;
    harness_destroy(h, c->streamer);
    for (uint32_t i = 0; i < c->count; i++)
        sluiceDestroyImageSource(c->members[i].source);
    harness_buffer_finish(h, &c->outputs);
    h->DestroyPipeline(h->device, c->pipeline, NULL);
    h->DestroyPipelineLayout(h->device, c->pipeline_layout, NULL);
    h->DestroyDescriptorPool(h->device, c->pool, NULL);
    h->DestroyDescriptorSetLayout(h->device, c->layout, NULL);
    free(c->members);
    harness_check_silence(h);
}

SluiceResult crowd_add(struct crowd *c, uint32_t size, SluiceImageSource *wrapped)
{
    struct crowd_member *member = &c->members[c->count];
    SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create, .source = wrapped};
    if (!wrapped)
        create.source = crowd_source(member, c->count, size);
    SluiceResult result = sluiceAddVulkanTexture(c->streamer, &create, &member->texture);
    if (result == SLUICE_SUCCESS) {
        assert_int_equal(member->texture.tableIndex, c->count);
        c->count++;
    } else if (!wrapped) {
        sluiceDestroyImageSource(member->source);
    }
    return result;
}

static void record(void *user, VkCommandBuffer commands)
{
    struct crowd *c = user;
    struct harness *h = c->h;
    const VkDescriptorSet sets[] = {h->set, c->set};
    uint32_t place = 0;
    h->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, c->pipeline);
    h->CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, c->pipeline_layout, 0, 2,
                             sets, 0, NULL);
    for (uint32_t i = 0; i < 2; i++) {
        const struct CrowdParams params = {c->ranges[i].first, c->ranges[i].count, place, 0};
        place += params.count;
        h->CmdPushConstants(commands, c->pipeline_layout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                            sizeof params, &params);
        if (params.count)
            h->CmdDispatch(commands, (params.count + CROWD_GROUP - 1) / CROWD_GROUP, 1, 1);
    }
    const VkMemoryBarrier memory = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                    .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT,
                                    .dstAccessMask =
                                        VK_ACCESS_HOST_READ_BIT | VK_ACCESS_SHADER_READ_BIT};
    h->CmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                          VK_PIPELINE_STAGE_HOST_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, 1,
                          &memory, 0, NULL, 0, NULL);
}

static void check_sample(const struct crowd_member *member, const struct CrowdOutput *found)
{
    float expected[4] = {0.5f, 0.5f, 0.5f, 1.0f};
    if (found->missing != SLUICE_MIP_UNTOUCHED)
        paint((void *)member, 0, member->size / 2, 0, member->size, member->size, expected);
    for (uint32_t c = 0; c < 4; c++)
        if ((c != 2 || found->missing == 0 || found->missing == SLUICE_MIP_UNTOUCHED) &&
            !(fabsf(found->color[c] - expected[c]) <= 0.003f))
            fail_msg("texture %u, channel %u: %g, not %g; %u levels are missing", member->number, c,
                     (double)found->color[c], (double)expected[c], found->missing);
}

uint32_t crowd_frame(struct crowd *c)
{
    const struct CrowdOutput *found = c->outputs.mapped;
    uint32_t missing = 0;
    CHECK_OK(sluiceWaitVulkanStreamerIdle(c->streamer));
    harness_frame(c->h, c->streamer, true, record, c);
    for (uint32_t r = 0; r < 2; r++)
        for (uint32_t i = 0; i < c->ranges[r].count; i++, found++) {
            check_sample(&c->members[c->ranges[r].first + i], found);
            missing += found->missing != 0;
        }
    SluiceVulkanContextStatistics s = {.structSize = sizeof s};
    CHECK_OK(sluiceGetVulkanContextStatistics(c->h->context, &s));
    assert_true(c->budget == 0 || s.tileMemorySize <= c->budget);
    return missing;
}

uint32_t crowd_sharpen(struct crowd *c, uint32_t most)
{
    uint32_t missing = crowd_frame(c);
    for (uint32_t i = 1; i < most && missing; i++)
        missing = crowd_frame(c);
    return missing;
}

void crowd_rest(struct crowd *c, uint32_t frames)
{
    const struct crowd_range ranges[2] = {c->ranges[0], c->ranges[1]};
    c->ranges[0].count = c->ranges[1].count = 0;
    for (uint32_t i = 0; i < frames; i++)
        crowd_frame(c);
    c->ranges[0] = ranges[0];
    c->ranges[1] = ranges[1];
}

SluiceVulkanStreamerStatistics crowd_statistics(const struct crowd *c)
{
    SluiceVulkanStreamerStatistics s = {.structSize = sizeof s};
    CHECK_OK(sluiceGetVulkanStreamerStatistics(c->streamer, &s));
    return s;
}
