#include "device/demand_runner.h"

#include "device/conform.h"
#include "support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "demand_runner_bytes_comp.h"
#include "demand_runner_comp.h"
#include "demand_runner_cubes_comp.h"
#include "demand_runner_cubes_hlsl.h"
#include "demand_runner_grids_comp.h"
#include "demand_runner_grids_hlsl.h"

#define BUFFERS 9u
#define BINDINGS (BUFFERS + 2)

const SluiceDemandSampler runner_nearest = {.structSize = sizeof runner_nearest,
                                            .filter = SLUICE_DEMAND_FILTER_NEAREST,
                                            .mipmapFilter = SLUICE_DEMAND_FILTER_NEAREST};

static void create_layouts(struct runner *r)
{
    struct harness *h = r->h;
    VkDescriptorSetLayoutBinding bindings[BINDINGS];
    for (uint32_t i = 0; i <= BUFFERS; i++)
        bindings[i] = (VkDescriptorSetLayoutBinding){
            .binding = i,
            .descriptorType = i < BUFFERS ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
                                          : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
            .descriptorCount = i < BUFFERS ? 1 : RUNNER_CHUNKS,
            .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT};
    bindings[BUFFERS + 1] =
        (VkDescriptorSetLayoutBinding){.binding = BUFFERS + 1,
                                       .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                       .descriptorCount = SLUICE_DEMAND_BYTE_CHUNKS,
                                       .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT};
    VkDescriptorSetLayoutCreateInfo set = {.sType =
                                               VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                           .bindingCount = r->reads_bytes ? BINDINGS : BINDINGS - 1,
                                           .pBindings = bindings};
    assert_int_equal(h->CreateDescriptorSetLayout(h->device, &set, NULL, &r->set_layout),
                     VK_SUCCESS);
    VkPushConstantRange push = {VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(uint32_t)};
    VkPipelineLayoutCreateInfo layout = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                         .setLayoutCount = 1,
                                         .pSetLayouts = &r->set_layout,
                                         .pushConstantRangeCount = 1,
                                         .pPushConstantRanges = &push};
    assert_int_equal(h->CreatePipelineLayout(h->device, &layout, NULL, &r->layout), VK_SUCCESS);
}

static void create_pipeline(struct runner *r)
{
    struct harness *h = r->h;
    r->pipeline = conform_compute_pipeline(
        h, r->layout,
        conform_module(h, r->reads_bytes ? demand_runner_bytes_comp : demand_runner_comp,
                       r->reads_bytes ? sizeof demand_runner_bytes_comp
                                      : sizeof demand_runner_comp),
        NULL);
}

static void write_buffers(struct runner *r, VkDescriptorSet set)
{
    SluiceDemandBuffers b = {.structSize = sizeof b};
    sluiceGetDemandBuffers(r->loader, &b);
    const VkBuffer buffers[BUFFERS] = {b.textures, b.levels,         b.directory,
                                       b.blocks,   b.masks,          b.requests,
                                       b.sections, r->inputs.buffer, r->outputs.buffer};
    VkDescriptorBufferInfo infos[BUFFERS];
    for (uint32_t i = 0; i < BUFFERS; i++)
        infos[i] = (VkDescriptorBufferInfo){buffers[i], 0, VK_WHOLE_SIZE};
    VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                  .dstSet = set,
                                  .descriptorCount = BUFFERS,
                                  .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                  .pBufferInfo = infos};
    r->h->UpdateDescriptorSets(r->h->device, 1, &write, 0, NULL);
}

static void create_sets(struct runner *r)
{
    struct harness *h = r->h;
    VkDescriptorPoolSize sizes[2] = {
        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
         (BUFFERS + SLUICE_DEMAND_BYTE_CHUNKS) * RUNNER_LAUNCHES},
        {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, RUNNER_CHUNKS * RUNNER_LAUNCHES}};
    VkDescriptorPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                       .maxSets = RUNNER_LAUNCHES,
                                       .poolSizeCount = 2,
                                       .pPoolSizes = sizes};
    assert_int_equal(h->CreateDescriptorPool(h->device, &pool, NULL, &r->pool), VK_SUCCESS);
    for (uint32_t i = 0; i < RUNNER_LAUNCHES; i++) {
        VkDescriptorSetAllocateInfo allocate = {.sType =
                                                    VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                                .descriptorPool = r->pool,
                                                .descriptorSetCount = 1,
                                                .pSetLayouts = &r->set_layout};
        assert_int_equal(h->AllocateDescriptorSets(h->device, &allocate, &r->sets[i]), VK_SUCCESS);
        write_buffers(r, r->sets[i]);
    }
}

void runner_fill(struct harness *h, SluiceDemandLoaderCreateInfo *info)
{
    info->context = h->context;
}

void runner_init_with(struct runner *r, struct harness *h, SluiceDemandLoader *loader)
{
    *r = (struct runner){.h = h,
                         .loader = loader,
                         .reads_bytes = h->runs_bytes && h->reads_bytes,
                         .launch = {.structSize = sizeof r->launch},
                         .requests = {.structSize = sizeof r->requests}};
    harness_buffer_init(h, &r->inputs, RUNNER_SAMPLES * sizeof(struct RunnerInput),
                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    harness_buffer_init(h, &r->outputs, RUNNER_SAMPLES * sizeof(struct RunnerOutput),
                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    create_layouts(r);
    create_pipeline(r);
    create_sets(r);
}

void runner_init(struct runner *r, struct harness *h, const SluiceDemandLoaderCreateInfo *info)
{
    SluiceDemandLoaderCreateInfo create = {.structSize = sizeof create};
    SluiceDemandLoader *loader;
    if (info)
        create = *info;
    runner_fill(h, &create);
    if (create.memoryBudget == 0)
        create.memoryBudget = 64u << 20;
    if (create.maxTextureCount == 0)
        create.maxTextureCount = 4096;
    if (create.pageCapacity == 0)
        create.pageCapacity = 1u << 20;
    CHECK_OK(sluiceCreateDemandLoader(&create, &loader));
    runner_init_with(r, h, loader);
}

void runner_sample_grids(struct runner *r)
{
    struct harness *h = r->h;
    h->DestroyPipeline(h->device, r->pipeline, NULL);
    r->pipeline = conform_compute_pipeline(
        h, r->layout, conform_module(h, demand_runner_grids_comp, sizeof demand_runner_grids_comp),
        NULL);
}

void runner_sample_cubes(struct runner *r)
{
    struct harness *h = r->h;
    h->DestroyPipeline(h->device, r->pipeline, NULL);
    r->pipeline = conform_compute_pipeline(
        h, r->layout, conform_module(h, demand_runner_cubes_comp, sizeof demand_runner_cubes_comp),
        NULL);
}

void runner_sample_in_hlsl(struct runner *r, bool cubes)
{
    struct harness *h = r->h;
    h->DestroyPipeline(h->device, r->pipeline, NULL);
    r->pipeline = conform_compute_pipeline(
        h, r->layout,
        cubes ? conform_module(h, demand_runner_cubes_hlsl, sizeof demand_runner_cubes_hlsl)
              : conform_module(h, demand_runner_grids_hlsl, sizeof demand_runner_grids_hlsl),
        NULL);
}

void runner_finish(struct runner *r)
{
    struct harness *h = r->h;
    assert_int_equal(h->DeviceWaitIdle(h->device), VK_SUCCESS);
    sluiceDestroyDemandLoader(r->loader);
    h->DestroyDescriptorPool(h->device, r->pool, NULL);
    h->DestroyPipeline(h->device, r->pipeline, NULL);
    h->DestroyPipelineLayout(h->device, r->layout, NULL);
    h->DestroyDescriptorSetLayout(h->device, r->set_layout, NULL);
    harness_buffer_finish(h, &r->inputs);
    harness_buffer_finish(h, &r->outputs);
    harness_check_silence(h);
}

void runner_clear(struct runner *r)
{
    assert_int_equal(r->h->DeviceWaitIdle(r->h->device), VK_SUCCESS);
    r->count = 0;
}

void runner_add(struct runner *r, struct RunnerInput input)
{
    assert_true(r->count < RUNNER_SAMPLES);
    ((struct RunnerInput *)r->inputs.mapped)[r->count++] = input;
}

static uint32_t level_size(uint32_t size, uint32_t level)
{
    return size >> level ? size >> level : 1;
}

void runner_add_texel(struct runner *r, SluiceDemandTextureId id, uint32_t width, uint32_t height,
                      uint32_t level, uint32_t x, uint32_t y)
{
    runner_add(r, (struct RunnerInput){.kind = RUNNER_LOD,
                                       .index = (uint32_t)id,
                                       .uv = {((float)x + 0.5f) / (float)level_size(width, level),
                                              ((float)y + 0.5f) / (float)level_size(height, level)},
                                       .dx = {(float)level}});
}

void runner_add_tiles(struct runner *r, SluiceDemandTextureId id, uint32_t size, uint32_t first,
                      uint32_t row_count)
{
    for (uint32_t y = first; y < first + row_count; y++)
        for (uint32_t x = 0; x < size / 128; x++)
            runner_add_texel(r, id, size, size, 0, x * 128 + 7, y * 128 + 9);
}

void runner_add_page(struct runner *r, uint32_t page)
{
    runner_add(r, (struct RunnerInput){.kind = RUNNER_MAP, .index = page});
}

static void write_pages(struct runner *r, uint32_t at)
{
    SluiceVulkanPages pages = {.structSize = sizeof pages};
    sluiceGetDemandPages(r->loader, &pages);
    if (r->generations[at] == pages.generation)
        return;
    VkDescriptorImageInfo infos[RUNNER_CHUNKS];
    for (uint32_t i = 0; i < RUNNER_CHUNKS; i++)
        infos[i] = (VkDescriptorImageInfo){pages.sampler, pages.pViews[i % pages.viewCount],
                                           VK_IMAGE_LAYOUT_GENERAL};
    VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                  .dstSet = r->sets[at],
                                  .dstBinding = BUFFERS,
                                  .descriptorCount = RUNNER_CHUNKS,
                                  .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                  .pImageInfo = infos};
    r->h->UpdateDescriptorSets(r->h->device, 1, &write, 0, NULL);
    r->generations[at] = pages.generation;
}

static void write_chunks(struct runner *r, uint32_t at)
{
    SluiceDemandByteBuffers bytes = {.structSize = sizeof bytes};
    CHECK_OK(sluiceGetDemandByteBuffers(r->loader, &bytes));
    if (!r->reads_bytes || r->byte_generations[at] == bytes.generation)
        return;
    VkDescriptorBufferInfo infos[SLUICE_DEMAND_BYTE_CHUNKS];
    assert_int_equal(bytes.bufferCount, SLUICE_DEMAND_BYTE_CHUNKS);
    for (uint32_t i = 0; i < SLUICE_DEMAND_BYTE_CHUNKS; i++)
        infos[i] = (VkDescriptorBufferInfo){bytes.pBuffers[i], 0, VK_WHOLE_SIZE};
    VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                  .dstSet = r->sets[at],
                                  .dstBinding = BUFFERS + 1,
                                  .descriptorCount = SLUICE_DEMAND_BYTE_CHUNKS,
                                  .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                  .pBufferInfo = infos};
    r->h->UpdateDescriptorSets(r->h->device, 1, &write, 0, NULL);
    r->byte_generations[at] = bytes.generation;
}

static void record_samples(struct runner *r, VkCommandBuffer commands, uint32_t at)
{
    struct harness *h = r->h;
    write_pages(r, at);
    write_chunks(r, at);
    h->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, r->pipeline);
    h->CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, r->layout, 0, 1,
                             &r->sets[at], 0, NULL);
    h->CmdPushConstants(commands, r->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof r->count,
                        &r->count);
    if (r->count)
        h->CmdDispatch(commands, (r->count + 63) / 64, 1, 1);
    VkMemoryBarrier barrier = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                               .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT,
                               .dstAccessMask =
                                   VK_ACCESS_HOST_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT};
    h->CmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                          VK_PIPELINE_STAGE_HOST_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, 1,
                          &barrier, 0, NULL, 0, NULL);
}

/* Abandons a launch after its preparation, its samples or its end. Returns false if no launch can
 * be prepared. */
static bool abandon_launch(struct runner *r, VkCommandBuffer commands, uint32_t at)
{
    struct harness *h = r->h;
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    uint32_t length = h->abandoned_count % 3;
    SluiceDemandLaunch launch = {.structSize = sizeof launch};
    if (sluiceBeginDemandLaunch(r->loader, commands, &launch) != SLUICE_SUCCESS)
        return false;
    if (length > 0)
        record_samples(r, commands, at);
    if (length > 1)
        CHECK_OK(sluiceEndDemandLaunch(r->loader, commands));
    CHECK_OK(sluiceAbandonDemandLaunch(r->loader, &launch));
    assert_int_equal(h->ResetCommandBuffer(commands, 0), VK_SUCCESS);
    assert_int_equal(h->BeginCommandBuffer(commands, &begin), VK_SUCCESS);
    return true;
}

SluiceResult runner_submit(struct runner *r)
{
    struct harness *h = r->h;
    uint32_t at = (uint32_t)((r->launch.launchIndex + 1) % RUNNER_LAUNCHES);
    VkCommandBuffer commands = h->commands[at];
    VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    assert_int_equal(h->ResetCommandBuffer(commands, 0), VK_SUCCESS);
    assert_int_equal(h->BeginCommandBuffer(commands, &begin), VK_SUCCESS);
    SluiceDemandLaunch launch = {.structSize = sizeof launch};
    while (harness_abandons(h))
        if (!abandon_launch(r, commands, at))
            break;
    SluiceResult result = sluiceBeginDemandLaunch(r->loader, commands, &launch);
    if (result == SLUICE_SUCCESS) {
        record_samples(r, commands, at);
        CHECK_OK(sluiceEndDemandLaunch(r->loader, commands));
        r->launch = launch;
    }
    assert_int_equal(h->EndCommandBuffer(commands), VK_SUCCESS);
    if (result != SLUICE_SUCCESS)
        return result;
    VkTimelineSemaphoreSubmitInfo timeline = {.sType =
                                                  VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
                                              .signalSemaphoreValueCount = 1,
                                              .pSignalSemaphoreValues = &launch.signalValue};
    VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                           .pNext = &timeline,
                           .commandBufferCount = 1,
                           .pCommandBuffers = &commands,
                           .signalSemaphoreCount = 1,
                           .pSignalSemaphores = &launch.semaphore};
    assert_int_equal(h->QueueSubmit(h->queue, 1, &submit, VK_NULL_HANDLE), VK_SUCCESS);
    return SLUICE_SUCCESS;
}

void runner_launch(struct runner *r)
{
    CHECK_OK(runner_submit(r));
    CHECK_OK(
        sluiceProcessDemandRequests(r->loader, &r->launch, UINT64_MAX, &r->requests, &r->ticket));
}

uint32_t runner_load(struct runner *r, uint32_t limit)
{
    for (uint32_t count = 1;; count++) {
        runner_launch(r);
        if (r->requests.missingCount == 0 || count == limit)
            return count;
        CHECK_OK(sluiceWaitDemandTicket(r->loader, r->ticket, UINT64_MAX, NULL));
    }
}

struct RunnerOutput runner_output(const struct runner *r, uint32_t sample)
{
    return ((const struct RunnerOutput *)r->outputs.mapped)[sample];
}

bool runner_all_resident(const struct runner *r)
{
    for (uint32_t i = 0; i < r->count; i++)
        if (!runner_output(r, i).resident)
            return false;
    return true;
}

SluiceDemandStatistics runner_statistics(const struct runner *r)
{
    SluiceDemandStatistics statistics = {.structSize = sizeof statistics};
    CHECK_OK(sluiceGetDemandStatistics(r->loader, &statistics));
    return statistics;
}

/* Integer steps of 1/255, which all formats here have exactly or to half a step. */
static void texel(void *user, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
                  uint32_t height, float rgba[4])
{
    const struct runner_image *image = user;
    (void)width, (void)height;
    uint32_t hash = (x * 2654435761u) ^ (y * 2246822519u) ^ (level * 3266489917u) ^ image->seed;
    for (uint32_t i = 0; i < 4; i++) {
        hash = (hash ^ hash >> 15) * 2654435769u;
        rgba[i] = (float)(hash >> 24) / 255;
    }
}

static SluiceResult open_image(void *user, SluiceImageSource **source)
{
    struct runner_image *image = user;
    uint64_t number = atomic_fetch_add(&image->opened, 1);
    if (number < image->open_failures)
        return SLUICE_NOT_READY;
    *source = &image->source.base;
    return image->open_result;
}

static void close_image(void *user, SluiceImageSource *source)
{
    struct runner_image *image = user;
    (void)source;
    atomic_fetch_add(&image->closed, 1);
}

void runner_image_init(struct runner_image *image, SluiceFormat format, uint32_t width,
                       uint32_t height, uint32_t seed)
{
    runner_image_init_as(image,
                         &(SluiceImageInfo){.structSize = sizeof(SluiceImageInfo),
                                            .width = width,
                                            .height = height,
                                            .format = format},
                         seed);
}

void runner_image_init_as(struct runner_image *image, const SluiceImageInfo *info, uint32_t seed)
{
    *image = (struct runner_image){.seed = seed * 40503u};
    snprintf(image->name, sizeof image->name, "image %u", seed);
    SluiceProceduralImage procedural = {image, texel};
    SluiceImageInfo named = *info;
    named.pName = image->name;
    CHECK_OK(sluiceCreateProceduralImageSource(&procedural, &named, NULL, &image->inner));
    fault_source_init(&image->source, image->inner);
    image->info.structSize = sizeof image->info;
    CHECK_OK(sluiceGetImageInfo(image->inner, &image->info));
}

void runner_image_finish(struct runner_image *image)
{
    fault_source_finish(&image->source);
    sluiceDestroyImageSource(image->inner);
}

SluiceDemandImage runner_image_desc(struct runner_image *image)
{
    return (SluiceDemandImage){.pUserData = image, .pfnOpen = open_image, .pfnClose = close_image};
}

SluiceDemandTextureId runner_add_texture(struct runner *r, struct runner_image *image)
{
    SluiceDemandTextureId id;
    const SluiceDemandTextureCreateInfo info = {.structSize = sizeof info,
                                                .image = runner_image_desc(image),
                                                .pSampler = &runner_nearest,
                                                .failureColor = {1, 0, 1, 1}};
    CHECK_OK(sluiceAddDemandTexture(r->loader, &info, &id));
    return id;
}

void runner_image_texel(struct runner_image *image, uint32_t level, uint32_t x, uint32_t y,
                        float rgba[4])
{
    uint8_t bytes[16];
    const SluiceImageRegion region = {level, x, y, 1, 1};
    CHECK_OK(sluiceReadImageRegion(image->inner, &region, bytes, sizeof bytes));
    if (image->info.format == SLUICE_FORMAT_R32G32B32A32_SFLOAT) {
        memcpy(rgba, bytes, 16);
        return;
    }
    assert_int_equal(image->info.format, SLUICE_FORMAT_R8G8B8A8_UNORM);
    for (uint32_t i = 0; i < 4; i++)
        rgba[i] = (float)bytes[i] / 255;
}

void runner_check_texel(const struct runner *r, uint32_t sample, struct runner_image *image,
                        uint32_t level, uint32_t x, uint32_t y)
{
    struct RunnerOutput out = runner_output(r, sample);
    float rgba[4];
    runner_image_texel(image, level, x, y, rgba);
    for (uint32_t i = 0; i < 4; i++)
        if (!out.resident || fabsf(out.color[i] - rgba[i]) > 1e-6f)
            fail_msg("%s: level %u (%u, %u), channel %u: %s, %g instead of %g", image->name, level,
                     x, y, i, out.resident ? "resident" : "missing", (double)out.color[i],
                     (double)rgba[i]);
}
