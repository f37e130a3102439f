#include "device/writer.h"

#include "device/conform.h"
#include "support/test.h"

#include "writer_comp.h"
#include "writer_masks_comp.h"
#include "writer_turns_comp.h"

#define BINDINGS 5u

static void create_layouts(struct writer *w)
{
    struct harness *h = w->h;
    VkDescriptorSetLayoutBinding bindings[BINDINGS];
    for (uint32_t i = 0; i < BINDINGS; i++)
        bindings[i] =
            (VkDescriptorSetLayoutBinding){.binding = i,
                                           .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                           .descriptorCount = 1,
                                           .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT};
    VkDescriptorSetLayoutCreateInfo set = {.sType =
                                               VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                           .bindingCount = BINDINGS,
                                           .pBindings = bindings};
    assert_int_equal(h->CreateDescriptorSetLayout(h->device, &set, NULL, &w->set_layout),
                     VK_SUCCESS);
    VkPushConstantRange push = {VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(struct WriterParams)};
    VkPipelineLayoutCreateInfo layout = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                         .setLayoutCount = 1,
                                         .pSetLayouts = &w->set_layout,
                                         .pushConstantRangeCount = 1,
                                         .pPushConstantRanges = &push};
    assert_int_equal(h->CreatePipelineLayout(h->device, &layout, NULL, &w->layout), VK_SUCCESS);
}

static void create_pipeline(struct writer *w, enum writer_kind kind)
{
    const struct {
        const uint32_t *code;
        size_t size;
    } codes[] = {{writer_comp, sizeof writer_comp},
                 {writer_masks_comp, sizeof writer_masks_comp},
                 {writer_turns_comp, sizeof writer_turns_comp}};
    struct harness *h = w->h;
    w->pipeline = conform_compute_pipeline(
        h, w->layout, conform_module(h, codes[kind].code, codes[kind].size), NULL);
}

static void create_set(struct writer *w)
{
    struct harness *h = w->h;
    VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, BINDINGS};
    VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                       .maxSets = 1,
                                       .poolSizeCount = 1,
                                       .pPoolSizes = &size};
    assert_int_equal(h->CreateDescriptorPool(h->device, &pool, NULL, &w->pool), VK_SUCCESS);
    VkDescriptorSetAllocateInfo allocate = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                            .descriptorPool = w->pool,
                                            .descriptorSetCount = 1,
                                            .pSetLayouts = &w->set_layout};
    assert_int_equal(h->AllocateDescriptorSets(h->device, &allocate, &w->set), VK_SUCCESS);
    SluiceVulkanBuffers buffers = {.structSize = sizeof buffers};
    sluiceGetVulkanBuffers(w->streamer, &buffers);
    VkDescriptorBufferInfo infos[BINDINGS] = {{buffers.textureTable, 0, VK_WHOLE_SIZE},
                                              {buffers.feedback, 0, VK_WHOLE_SIZE},
                                              {buffers.feedbackTurns, 0, VK_WHOLE_SIZE},
                                              {w->inputs.buffer, 0, VK_WHOLE_SIZE},
                                              {w->outputs.buffer, 0, VK_WHOLE_SIZE}};
    VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                  .dstSet = w->set,
                                  .descriptorCount = BINDINGS,
                                  .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                  .pBufferInfo = infos};
    h->UpdateDescriptorSets(h->device, 1, &write, 0, NULL);
}

void writer_init(struct writer *w, struct harness *h, SluiceVulkanStreamer *streamer,
                 enum writer_kind kind)
{
    *w = (struct writer){.h = h, .streamer = streamer};
    harness_buffer_init(h, &w->inputs, WRITER_CAPACITY * sizeof(struct WriterInput),
                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    harness_buffer_init(h, &w->outputs, WRITER_CAPACITY * 4, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    create_layouts(w);
    create_pipeline(w, kind);
    create_set(w);
}

void writer_finish(struct writer *w)
{
    struct harness *h = w->h;
    assert_int_equal(h->DeviceWaitIdle(h->device), VK_SUCCESS);
    h->DestroyDescriptorPool(h->device, w->pool, NULL);
    h->DestroyPipeline(h->device, w->pipeline, NULL);
    h->DestroyPipelineLayout(h->device, w->layout, NULL);
    h->DestroyDescriptorSetLayout(h->device, w->set_layout, NULL);
    harness_buffer_finish(h, &w->inputs);
    harness_buffer_finish(h, &w->outputs);
}

struct WriterInput *writer_inputs(struct writer *w)
{
    return w->inputs.mapped;
}

static void dispatch(struct writer *w, VkCommandBuffer commands, struct WriterParams params)
{
    struct harness *h = w->h;
    assert_true(params.count <= WRITER_CAPACITY);
    h->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, w->pipeline);
    h->CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, w->layout, 0, 1, &w->set, 0,
                             NULL);
    h->CmdPushConstants(commands, w->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof params,
                        &params);
    h->CmdDispatch(commands, (params.count + 63) / 64, 1, 1);
}

void writer_record(void *user, VkCommandBuffer commands)
{
    struct writer *w = user;
    if (w->count)
        dispatch(w, commands, (struct WriterParams){.count = w->count});
}

struct copy {
    struct writer *writer;
    uint32_t first, count;
};

static void record_copy(void *user, VkCommandBuffer commands)
{
    struct copy *copy = user;
    dispatch(copy->writer, commands,
             (struct WriterParams){copy->first, copy->count, WRITER_COPY_WORDS, 0});
    VkMemoryBarrier barrier = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                               .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT,
                               .dstAccessMask = VK_ACCESS_HOST_READ_BIT};
    copy->writer->h->CmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                                        VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier, 0, NULL, 0,
                                        NULL);
}

const uint32_t *writer_words(struct writer *w, uint32_t first, uint32_t count)
{
    struct copy copy = {w, first, count};
    harness_run(w->h, record_copy, &copy);
    return w->outputs.mapped;
}
