#include "device/probe.h"

#include "device/conform.h"
#include "support/test.h"

#include "probe_codes_comp.h"
#include "probe_comp.h"
#include "probe_hlsl.h"
#include "probe_loop_comp.h"
#include "probe_min_lod_codes_comp.h"
#include "probe_min_lod_comp.h"

#include <assert.h>

#define BUFFERS 5u
#define BINDINGS 7u

static void create_layouts(struct prober *p)
{
    struct harness *h = p->h;
    VkDescriptorSetLayoutBinding bindings[BINDINGS];
    for (uint32_t i = 0; i < BINDINGS; i++)
        bindings[i] = (VkDescriptorSetLayoutBinding){
            .binding = i,
            .descriptorType = i < BUFFERS ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
                                          : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
            .descriptorCount = 1,
            .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_FRAGMENT_BIT};
    VkDescriptorSetLayoutCreateInfo set = {.sType =
                                               VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                           .bindingCount = BINDINGS,
                                           .pBindings = bindings};
    assert_int_equal(h->CreateDescriptorSetLayout(h->device, &set, NULL, &p->set_layout),
                     VK_SUCCESS);
    VkDescriptorSetLayoutBinding page_bindings[2] = {
        {0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, bindings[0].stageFlags, NULL},
        {1, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, PROBE_PAGE_CHUNKS, bindings[0].stageFlags,
         NULL}};
    set.bindingCount = 2;
    set.pBindings = page_bindings;
    assert_int_equal(h->CreateDescriptorSetLayout(h->device, &set, NULL, &p->page_layout),
                     VK_SUCCESS);
    VkDescriptorSetLayout sets[2] = {p->set_layout, p->page_layout};
    VkPushConstantRange push = {VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                                sizeof(struct ProbeParams)};
    VkPipelineLayoutCreateInfo layout = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                         .setLayoutCount = 2,
                                         .pSetLayouts = sets,
                                         .pushConstantRangeCount = 1,
                                         .pPushConstantRanges = &push};
    assert_int_equal(h->CreatePipelineLayout(h->device, &layout, NULL, &p->layout), VK_SUCCESS);
    VkDescriptorPoolSize sizes[2] = {
        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, BUFFERS * PROBE_MAX_TEXTURES + HARNESS_FRAMES},
        {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
         (BINDINGS - BUFFERS) * PROBE_MAX_TEXTURES + PROBE_PAGE_CHUNKS * HARNESS_FRAMES}};
    VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                       .flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT,
                                       .maxSets = PROBE_MAX_TEXTURES + HARNESS_FRAMES,
                                       .poolSizeCount = 2,
                                       .pPoolSizes = sizes};
    assert_int_equal(h->CreateDescriptorPool(h->device, &pool, NULL, &p->pool), VK_SUCCESS);
}

static void create_page_sets(struct prober *p)
{
    struct harness *h = p->h;
    SluiceVulkanBuffers buffers = {.structSize = sizeof buffers};
    sluiceGetVulkanBuffers(p->streamer, &buffers);
    for (uint32_t i = 0; i < HARNESS_FRAMES; i++) {
        VkDescriptorSetAllocateInfo allocate = {.sType =
                                                    VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                                .descriptorPool = p->pool,
                                                .descriptorSetCount = 1,
                                                .pSetLayouts = &p->page_layout};
        assert_int_equal(h->AllocateDescriptorSets(h->device, &allocate, &p->pages[i].set),
                         VK_SUCCESS);
        VkDescriptorBufferInfo table = {buffers.pageTable, 0, VK_WHOLE_SIZE};
        VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                      .dstSet = p->pages[i].set,
                                      .descriptorCount = 1,
                                      .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                      .pBufferInfo = &table};
        h->UpdateDescriptorSets(h->device, 1, &write, 0, NULL);
    }
}

void prober_bind_pages(struct prober *p, VkCommandBuffer commands, VkPipelineBindPoint point)
{
    struct harness *h = p->h;
    uint32_t at = (h->frame_count + HARNESS_FRAMES - 1) % HARNESS_FRAMES; /* slot of this frame */
    SluiceVulkanPages pages = {.structSize = sizeof pages};
    sluiceGetVulkanPages(p->streamer, &pages);
    assert_in_range(pages.viewCount, 1, PROBE_PAGE_CHUNKS);
    if (p->pages[at].generation != pages.generation) {
        VkDescriptorImageInfo infos[PROBE_PAGE_CHUNKS];
        for (uint32_t i = 0; i < PROBE_PAGE_CHUNKS; i++)
            infos[i] = (VkDescriptorImageInfo){pages.sampler, pages.pViews[i % pages.viewCount],
                                               VK_IMAGE_LAYOUT_GENERAL};
        VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                      .dstSet = p->pages[at].set,
                                      .dstBinding = 1,
                                      .descriptorCount = PROBE_PAGE_CHUNKS,
                                      .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                      .pImageInfo = infos};
        h->UpdateDescriptorSets(h->device, 1, &write, 0, NULL);
        p->pages[at].generation = pages.generation;
    }
    h->CmdBindDescriptorSets(commands, point, p->layout, 1, 1, &p->pages[at].set, 0, NULL);
}

const VkSpecializationInfo *prober_specialize(const struct prober *p,
                                              struct prober_specialization *s)
{
    s->values[0] = p->paged;
    s->values[1] = p->h->cubic;
    s->values[2] = p->h->mixes;
    for (uint32_t i = 0; i < 3; i++)
        s->entries[i] =
            (VkSpecializationMapEntry){i, i * (uint32_t)sizeof s->values[0], sizeof s->values[0]};
    s->info = (VkSpecializationInfo){3, s->entries, sizeof s->values, s->values};
    return &s->info;
}

static VkPipeline create_pipeline(const struct prober *p)
{
    struct prober_specialization specialization;
    struct harness *h = p->h;
    bool codes = p->codes;
    VkShaderModuleCreateInfo module_info = {.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                            .codeSize =
                                                codes ? sizeof probe_codes_comp : sizeof probe_comp,
                                            .pCode = codes ? probe_codes_comp : probe_comp};
    if (h->page_loop) {
        module_info.codeSize = sizeof probe_loop_comp;
        module_info.pCode = probe_loop_comp;
    }
    if (h->min_lod) {
        module_info.codeSize = codes ? sizeof probe_min_lod_codes_comp : sizeof probe_min_lod_comp;
        module_info.pCode = codes ? probe_min_lod_codes_comp : probe_min_lod_comp;
    }
    if (h->hlsl) {
        module_info.codeSize = sizeof probe_hlsl;
        module_info.pCode = probe_hlsl;
    }
    VkShaderModule module;
    assert_int_equal(h->CreateShaderModule(h->device, &module_info, NULL, &module), VK_SUCCESS);
    return conform_compute_pipeline(h, p->layout, module, prober_specialize(p, &specialization));
}

/* The layout that created it may be destroyed: layouts of all probers are defined alike. */
static VkPipeline shared_pipeline(const struct prober *p)
{
    const struct harness *h = p->h;
    uint32_t kind =
        (p->paged ? 1 : 0) | (p->codes ? 2 : 0) | (h->page_loop ? 4 : 0) | (h->min_lod ? 8 : 0);
    kind += h->cubic ? HARNESS_CUBIC_KINDS : 0;
    if (h->hlsl)
        kind = HARNESS_HLSL_KINDS + (p->paged ? 1u : 0) + (h->cubic ? 2u : 0);
    static_assert(HARNESS_PROBE_KINDS >= HARNESS_CUBIC_KINDS + 16, "four switches");
    if (!h->probe_pipelines[kind])
        p->h->probe_pipelines[kind] = create_pipeline(p);
    return h->probe_pipelines[kind];
}

void prober_choose_pipeline(struct prober *p)
{
    p->pipeline = shared_pipeline(p);
}

void prober_init(struct prober *p, struct harness *h, SluiceVulkanStreamer *streamer)
{
    SluiceResidencyMode mode;
    CHECK_OK(sluiceGetVulkanResidencyMode(streamer, &mode));
    *p = (struct prober){.h = h,
                         .streamer = streamer,
                         .paged = mode == SLUICE_RESIDENCY_MODE_PAGED || h->mixes,
                         .codes = mode == SLUICE_RESIDENCY_MODE_SPARSE &&
                                  h->caps.shaderResourceResidency};
    harness_buffer_init(h, &p->inputs, PROBE_CAPACITY * sizeof(struct ProbeInput),
                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    harness_buffer_init(h, &p->outputs, PROBE_CAPACITY * sizeof(struct ProbeOutput),
                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    create_layouts(p);
    create_page_sets(p);
    prober_choose_pipeline(p);
}

void prober_finish(struct prober *p)
{
    struct harness *h = p->h;
    for (uint32_t i = 0; i < p->sampler_count; i++)
        h->DestroySampler(h->device, p->samplers[i], NULL);
    h->DestroyDescriptorPool(h->device, p->pool, NULL);
    h->DestroyPipelineLayout(h->device, p->layout, NULL);
    h->DestroyDescriptorSetLayout(h->device, p->set_layout, NULL);
    h->DestroyDescriptorSetLayout(h->device, p->page_layout, NULL);
    harness_buffer_finish(h, &p->inputs);
    harness_buffer_finish(h, &p->outputs);
}

void prober_release(struct prober *p, struct probe_texture texture)
{
    assert_int_equal(p->h->DeviceWaitIdle(p->h->device), VK_SUCCESS);
    assert_int_equal(p->h->FreeDescriptorSets(p->h->device, p->pool, 1, &texture.set), VK_SUCCESS);
}

VkSampler prober_sampler(struct prober *p, VkSamplerAddressMode u, VkSamplerAddressMode v,
                         float anisotropy, bool nearest_mip)
{
    for (uint32_t i = 0; i < p->sampler_count; i++)
        if (p->sampler_keys[i].u == (uint32_t)u && p->sampler_keys[i].v == (uint32_t)v &&
            p->sampler_keys[i].anisotropy == (uint32_t)anisotropy &&
            p->sampler_keys[i].nearest_mip == nearest_mip)
            return p->samplers[i];
    assert_true(p->sampler_count < PROBE_MAX_SAMPLERS);
    VkSamplerCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                .magFilter = VK_FILTER_LINEAR,
                                .minFilter = VK_FILTER_LINEAR,
                                .mipmapMode = nearest_mip ? VK_SAMPLER_MIPMAP_MODE_NEAREST
                                                          : VK_SAMPLER_MIPMAP_MODE_LINEAR,
                                .addressModeU = u,
                                .addressModeV = v,
                                .anisotropyEnable = anisotropy > 1.0f,
                                .maxAnisotropy = anisotropy,
                                .maxLod = VK_LOD_CLAMP_NONE};
    uint32_t at = p->sampler_count++;
    assert_int_equal(p->h->CreateSampler(p->h->device, &info, NULL, &p->samplers[at]), VK_SUCCESS);
    p->sampler_keys[at].u = (uint32_t)u;
    p->sampler_keys[at].v = (uint32_t)v;
    p->sampler_keys[at].anisotropy = (uint32_t)anisotropy;
    p->sampler_keys[at].nearest_mip = nearest_mip;
    return p->samplers[at];
}

static struct probe_texture create_set(struct prober *p, uint32_t table_index,
                                       const VkDescriptorImageInfo images[2])
{
    struct harness *h = p->h;
    struct probe_texture result = {.table_index = table_index};
    VkDescriptorSetAllocateInfo allocate = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                            .descriptorPool = p->pool,
                                            .descriptorSetCount = 1,
                                            .pSetLayouts = &p->set_layout};
    assert_int_equal(h->AllocateDescriptorSets(h->device, &allocate, &result.set), VK_SUCCESS);
    SluiceVulkanBuffers buffers = {.structSize = sizeof buffers};
    sluiceGetVulkanBuffers(p->streamer, &buffers);
    VkDescriptorBufferInfo infos[BUFFERS] = {{buffers.textureTable, 0, VK_WHOLE_SIZE},
                                             {buffers.minMip, 0, VK_WHOLE_SIZE},
                                             {buffers.feedback, 0, VK_WHOLE_SIZE},
                                             {p->inputs.buffer, 0, VK_WHOLE_SIZE},
                                             {p->outputs.buffer, 0, VK_WHOLE_SIZE}};
    VkWriteDescriptorSet writes[2] = {{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                       .dstSet = result.set,
                                       .descriptorCount = BUFFERS,
                                       .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                       .pBufferInfo = infos},
                                      {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                       .dstSet = result.set,
                                       .dstBinding = BUFFERS,
                                       .descriptorCount = 2,
                                       .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                       .pImageInfo = images}};
    h->UpdateDescriptorSets(h->device, 2, writes, 0, NULL);
    return result;
}

struct probe_texture prober_texture(struct prober *p, const SluiceVulkanTexture *texture,
                                    VkSamplerAddressMode u, VkSamplerAddressMode v,
                                    float anisotropy)
{
    const VkDescriptorImageInfo images[2] = {
        {prober_sampler(p, u, v, anisotropy, false), texture->imageView, VK_IMAGE_LAYOUT_GENERAL},
        {prober_sampler(p, u, v, 1.0f, true), texture->imageView, VK_IMAGE_LAYOUT_GENERAL}};
    return create_set(p, texture->tableIndex, images);
}

struct probe_texture prober_layer(struct prober *p, const SluiceVulkanTexture *layer,
                                  VkSamplerAddressMode u, VkSamplerAddressMode v, float anisotropy)
{
    VkSampler sampler = prober_sampler(p, u, v, anisotropy, false);
    const VkDescriptorImageInfo images[2] = {{sampler, layer->arrayView, VK_IMAGE_LAYOUT_GENERAL},
                                             {sampler, layer->imageView, VK_IMAGE_LAYOUT_GENERAL}};
    return create_set(p, layer->tableIndex, images);
}

struct probe_texture prober_cube(struct prober *p, const SluiceVulkanTexture *face,
                                 float anisotropy)
{
    const VkSamplerAddressMode repeat = VK_SAMPLER_ADDRESS_MODE_REPEAT; /* cubes ignore it */
    VkSampler sampler = prober_sampler(p, repeat, repeat, anisotropy, false);
    const VkDescriptorImageInfo images[2] = {
        {sampler, face->cubeView, VK_IMAGE_LAYOUT_GENERAL},
        {sampler, face->cubeArrayView, VK_IMAGE_LAYOUT_GENERAL}};
    return create_set(p, face->tableIndex, images);
}

/* Creates a sampler with a key that no other one has. */
static VkSampler nearest_sampler(struct prober *p)
{
    for (uint32_t i = 0; i < p->sampler_count; i++)
        if (p->sampler_keys[i].anisotropy == 0)
            return p->samplers[i];
    assert_true(p->sampler_count < PROBE_MAX_SAMPLERS);
    const VkSamplerCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                      .maxLod = VK_LOD_CLAMP_NONE}; /* NEAREST, REPEAT */
    uint32_t at = p->sampler_count++;
    assert_int_equal(p->h->CreateSampler(p->h->device, &info, NULL, &p->samplers[at]), VK_SUCCESS);
    p->sampler_keys[at].anisotropy = 0;
    return p->samplers[at];
}

struct probe_texture prober_nearest(struct prober *p, const SluiceVulkanTexture *texture)
{
    const VkDescriptorImageInfo image = {nearest_sampler(p), texture->imageView,
                                         VK_IMAGE_LAYOUT_GENERAL};
    const VkDescriptorImageInfo images[2] = {image, image};
    return create_set(p, texture->tableIndex, images);
}

struct ProbeInput *prober_inputs(struct prober *p)
{
    return p->inputs.mapped;
}

const struct ProbeOutput *prober_outputs(const struct prober *p)
{
    return p->outputs.mapped;
}

void prober_record(struct prober *p, VkCommandBuffer commands, struct probe_texture texture,
                   uint32_t first, uint32_t count, uint32_t flags)
{
    struct harness *h = p->h;
    assert_true(first + count <= PROBE_CAPACITY);
    VkMemoryBarrier barrier = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                               .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT,
                               .dstAccessMask =
                                   VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT};
    h->CmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                          VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, 1, &barrier, 0, NULL, 0, NULL);
    struct ProbeParams params = {texture.table_index, first, count, flags};
    h->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, p->pipeline);
    h->CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, p->layout, 0, 1,
                             &texture.set, 0, NULL);
    prober_bind_pages(p, commands, VK_PIPELINE_BIND_POINT_COMPUTE);
    h->CmdPushConstants(commands, p->layout,
                        VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                        sizeof params, &params);
    h->CmdDispatch(commands, (count + 63) / 64, 1, 1);
    barrier.dstAccessMask |= VK_ACCESS_HOST_READ_BIT;
    h->CmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                          VK_PIPELINE_STAGE_HOST_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, 1,
                          &barrier, 0, NULL, 0, NULL);
}
