#include "rig.h"

#include "../../tools/common/clock.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Level 2 of 16 textures of 8192 x 8192, and finer levels in a patch: 437 MB of tiles, as in the
 * figures of others. */
#define LOD 2.25f
#define FINE_LOD 1.25f
#define FINE_EDGE (9.5f / 32)

/* Time stamps of a launch: before and after prepare, dispatch, end. */
#define QUERIES 6u

static void print_log(void *user, SluiceLogSeverity severity, const char *message)
{
    (void)user;
    if (severity != SLUICE_LOG_INFO)
        fprintf(stderr, "%s\n", message);
}

static bool create_loader(struct rig *rig, const SluiceDemandLoaderCreateInfo *given)
{
    const struct gpu *gpu = &rig->bench->gpu;
    const SluiceVulkanContextCreateInfo context = {.structSize = sizeof context,
                                                   .queueFamilyIndex = gpu->family,
                                                   .instance = gpu->instance,
                                                   .physicalDevice = gpu->physical_device,
                                                   .device = gpu->device,
                                                   .pfnGetInstanceProcAddr = vkGetInstanceProcAddr,
                                                   .log = {.pfnLog = print_log},
                                                   .pAllocator = rig->bench->allocator,
                                                   .loaderThreadCount = rig->bench->threads,
                                                   .maxPageChunkCount = DEMAND_BENCH_CHUNKS,
                                                   .minStagingSize = rig->bench->min_staging_size,
                                                   .minTileMemorySize =
                                                       rig->bench->min_tile_memory_size};
    if (!check(sluiceCreateVulkanContext(&context, &rig->context), "sluiceCreateVulkanContext"))
        return false;
    SluiceDemandLoaderCreateInfo info = *given;
    info.context = rig->context;
    info.launchesInFlight = RIG_SLOTS;
    return check(sluiceCreateDemandLoader(&info, &rig->loader), "sluiceCreateDemandLoader");
}

static bool create_textures(struct rig *rig)
{
    const struct bench *bench = rig->bench;
    SluiceDemandSampler sampler = {.structSize = sizeof sampler, .filter = bench->filter};
    SluiceDemandTextureCreateInfo info = {.structSize = sizeof info, .pSampler = &sampler};
    uint32_t count = bench->columns * bench->columns;
    for (uint32_t i = 0; i <= DEMAND_BENCH_TEXTURES; i++)
        free_source_init(&rig->sources[i], SLUICE_FORMAT_R8G8B8A8_UNORM, bench->texture_size);
    for (; rig->texture_count < count; rig->texture_count++) {
        info.image.source = &rig->sources[rig->texture_count].base;
        SluiceDemandTextureId *id = &rig->ids[rig->texture_count];
        if (!check(sluiceAddDemandTexture(rig->loader, &info, id), "sluiceAddDemandTexture"))
            return false;
        rig->params.textures[rig->texture_count] = (uint32_t)*id;
    }
    return true;
}

static bool create_commands(struct rig *rig)
{
    const struct gpu *gpu = &rig->bench->gpu;
    for (uint32_t i = 0; i < RIG_SLOTS; i++) {
        VkCommandBufferAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                            .commandPool = gpu->command_pool,
                                            .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                            .commandBufferCount = 1};
        if (!gpu_check(vkAllocateCommandBuffers(gpu->device, &info, &rig->slots[i].commands),
                       "vkAllocateCommandBuffers"))
            return false;
    }
    VkQueryPoolCreateInfo queries = {.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                     .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                     .queryCount = QUERIES * RIG_SLOTS};
    return gpu_check(vkCreateQueryPool(gpu->device, &queries, NULL, &rig->queries),
                     "vkCreateQueryPool");
}

static bool create_buffers(struct rig *rig)
{
    const struct bench *bench = rig->bench;

    return gpu_create_buffer(&bench->gpu, 4 * DEMAND_BENCH_WORDS,
                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                             &rig->outputs) &&
           gpu_create_device_buffer(&bench->gpu, (VkDeviceSize)bench->edge * bench->edge * 4,
                                    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, &rig->picture);
}

bool rig_create(struct rig *rig, const struct bench *bench,
                const SluiceDemandLoaderCreateInfo *info, bool plain)
{
    *rig = (struct rig){.bench = bench,
                        .params = {.edge = bench->edge,
                                   .columns = bench->columns,
                                   .textureSize = (float)bench->texture_size,
                                   .lod = LOD,
                                   .fineLod = FINE_LOD,
                                   .fineEdge = FINE_EDGE}};
    return create_loader(rig, info) && create_textures(rig) && create_commands(rig) &&
           create_buffers(rig) && (!plain || rig_create_plain(rig)) && rig_create_descriptors(rig);
}

void rig_destroy(struct rig *rig)
{
    const struct gpu *gpu = &rig->bench->gpu;
    if (!rig->loader) {
        sluiceDestroyVulkanContext(rig->context);
        return;
    }
    vkDeviceWaitIdle(gpu->device);
    rig_destroy_descriptors(rig);
    rig_destroy_plain(rig);
    gpu_destroy_buffer(gpu, &rig->outputs);
    gpu_destroy_buffer(gpu, &rig->picture);
    vkDestroyQueryPool(gpu->device, rig->queries, NULL);
    for (uint32_t i = 0; i < RIG_SLOTS; i++)
        if (rig->slots[i].commands)
            vkFreeCommandBuffers(gpu->device, gpu->command_pool, 1, &rig->slots[i].commands);
    sluiceDestroyDemandLoader(rig->loader);
    sluiceDestroyVulkanContext(rig->context);
    *rig = (struct rig){.bench = rig->bench};
}

static uint32_t first_query(const struct rig *rig, const struct rig_slot *slot)
{
    return (uint32_t)(slot - rig->slots) * QUERIES;
}

static void stamp(const struct rig *rig, const struct rig_slot *slot, uint32_t which)
{
    if (rig->timed)
        vkCmdWriteTimestamp(slot->commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, rig->queries,
                            first_query(rig, slot) + which);
}

static void record_dispatch(struct rig *rig, struct rig_slot *slot)
{
    uint32_t groups = (rig->params.edge + 7) / 8;
    VkDescriptorSet sets[2] = {rig->set, slot->pages};
    vkCmdBindPipeline(slot->commands, VK_PIPELINE_BIND_POINT_COMPUTE,
                      rig_pipeline(rig, slot->kind));
    vkCmdBindDescriptorSets(slot->commands, VK_PIPELINE_BIND_POINT_COMPUTE, rig->layout, 0, 2, sets,
                            0, NULL);
    vkCmdPushConstants(slot->commands, rig->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                       sizeof rig->params, &rig->params);
    stamp(rig, slot, 2);
    vkCmdDispatch(slot->commands, groups, groups, 1);
    stamp(rig, slot, 3);
    VkMemoryBarrier barrier = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                               .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT,
                               .dstAccessMask = VK_ACCESS_HOST_READ_BIT};
    vkCmdPipelineBarrier(slot->commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                         VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier, 0, NULL, 0, NULL);
}

static bool submit(struct rig *rig, struct rig_slot *slot)
{
    VkTimelineSemaphoreSubmitInfo values = {.sType =
                                                VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
                                            .signalSemaphoreValueCount = 1,
                                            .pSignalSemaphoreValues = &slot->launch.signalValue};
    VkSubmitInfo info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                         .pNext = &values,
                         .commandBufferCount = 1,
                         .pCommandBuffers = &slot->commands,
                         .signalSemaphoreCount = 1,
                         .pSignalSemaphores = &slot->launch.semaphore};
    return gpu_check(vkQueueSubmit(rig->bench->gpu.queue, 1, &info, VK_NULL_HANDLE),
                     "vkQueueSubmit");
}

static double seconds_between(const struct rig *rig, const struct rig_slot *slot, uint32_t which)
{
    uint64_t ticks[2];
    if (rig->bench->wall || !rig->timed ||
        !gpu_check(vkGetQueryPoolResults(rig->bench->gpu.device, rig->queries,
                                         first_query(rig, slot) + which, 2, sizeof ticks, ticks,
                                         sizeof *ticks, VK_QUERY_RESULT_64_BIT),
                   "vkGetQueryPoolResults"))
        return NAN;
    return (double)(ticks[1] - ticks[0]) * rig->bench->gpu.capabilities.timestampPeriod * 1e-9;
}

static bool record(struct rig *rig, struct rig_slot *slot)
{
    VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                      .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    if (!gpu_check(vkBeginCommandBuffer(slot->commands, &begin), "vkBeginCommandBuffer"))
        return false;
    if (rig->timed)
        vkCmdResetQueryPool(slot->commands, rig->queries, first_query(rig, slot), QUERIES);
    stamp(rig, slot, 0);
    slot->launch.structSize = sizeof slot->launch;
    if (!check(sluiceBeginDemandLaunch(rig->loader, slot->commands, &slot->launch),
               "sluiceBeginDemandLaunch"))
        return false;
    stamp(rig, slot, 1);
    rig_write_pages(rig, slot);
    if (slot->kind != DEMAND_BENCH_NOTHING)
        record_dispatch(rig, slot);
    stamp(rig, slot, 4);
    bool done = check(sluiceEndDemandLaunch(rig->loader, slot->commands), "sluiceEndDemandLaunch");
    stamp(rig, slot, 5);
    return done && gpu_check(vkEndCommandBuffer(slot->commands), "vkEndCommandBuffer");
}

bool rig_begin(struct rig *rig, uint32_t kind)
{
    struct rig_slot *slot = &rig->slots[rig->begun % RIG_SLOTS];
    if (kind != DEMAND_BENCH_NOTHING && !rig_pipeline(rig, kind))
        return false;
    slot->kind = kind;
    slot->start = clock_seconds();
    if (!record(rig, slot) || !submit(rig, slot))
        return false;
    slot->submitted = clock_seconds();
    rig->begun++;
    return true;
}

bool rig_end(struct rig *rig, struct rig_outcome *outcome)
{
    struct rig_slot *slot = &rig->slots[rig->ended % RIG_SLOTS];
    VkSemaphoreWaitInfo wait = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                .semaphoreCount = 1,
                                .pSemaphores = &slot->launch.semaphore,
                                .pValues = &slot->launch.signalValue};
    double start = clock_seconds();
    if (!gpu_check(vkWaitSemaphores(rig->bench->gpu.device, &wait, UINT64_MAX), "vkWaitSemaphores"))
        return false;
    double waited = clock_seconds();
    outcome->requests.structSize = sizeof outcome->requests;
    if (!check(sluiceProcessDemandRequests(rig->loader, &slot->launch, 0, &outcome->requests,
                                           &outcome->ticket),
               "sluiceProcessDemandRequests"))
        return false;
    rig->ended++;
    outcome->host_parts[0] = slot->submitted - slot->start;
    outcome->host_parts[1] = waited - start;
    outcome->host_parts[2] = clock_seconds() - waited;
    outcome->gpu_seconds = NAN;
    if (slot->kind != DEMAND_BENCH_NOTHING)
        outcome->gpu_seconds =
            rig->bench->wall ? clock_seconds() - slot->start : seconds_between(rig, slot, 2);
    outcome->gpu_parts[0] = seconds_between(rig, slot, 0);
    outcome->gpu_parts[1] = seconds_between(rig, slot, 4);
    outcome->missing = ((const uint32_t *)rig->outputs.mapped)[DEMAND_BENCH_MISSING];
    return true;
}

bool rig_launch(struct rig *rig, uint32_t kind, struct rig_outcome *outcome)
{
    memset(rig->outputs.mapped, 0, (size_t)rig->outputs.size);
    return rig_begin(rig, kind) && rig_end(rig, outcome);
}

bool rig_warm_up(struct rig *rig)
{
    struct DemandBenchParams params = rig->params;
    SluiceDemandSampler sampler = {.structSize = sizeof sampler, .filter = rig->bench->filter};
    SluiceDemandTextureCreateInfo info = {.structSize = sizeof info,
                                          .image.source = &rig->sources[DEMAND_BENCH_TEXTURES].base,
                                          .pSampler = &sampler};
    SluiceDemandTextureId id;
    if (!check(sluiceAddDemandTexture(rig->loader, &info, &id), "sluiceAddDemandTexture"))
        return false;
    rig->params.edge = 8;
    rig->params.columns = 1;
    rig->params.textures[0] = (uint32_t)id;
    bool done = rig_load(rig, 1000) > 0;
    rig->params = params;
    return done;
}

uint32_t rig_load(struct rig *rig, uint32_t limit)
{
    for (uint32_t i = 1; i <= limit; i++) {
        struct rig_outcome outcome;
        if (!rig_launch(rig, DEMAND_BENCH_SAMPLED, &outcome))
            return 0;
        if (outcome.requests.missingCount == 0)
            return i;
        if (!check(sluiceWaitDemandTicket(rig->loader, outcome.ticket, UINT64_MAX, NULL),
                   "sluiceWaitDemandTicket"))
            return 0;
    }
    return 0;
}
