#define _POSIX_C_SOURCE 200809L
#include "rig.h"

#include "../../tools/common/clock.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define WAIT_NANOSECONDS (60ull * 1000000000ull)
/* Frames in which nothing more arrives until it is taken as loaded. */
#define QUIET_FRAMES 12u
#define MAX_LOAD_FRAMES 100000u

static void print_log(void *user, SluiceLogSeverity severity, const char *message)
{
    (void)user;
    if (severity != SLUICE_LOG_INFO)
        fprintf(stderr, "%s\n", message);
}

static bool create_context(struct rig *rig, const struct rig_info *info)
{
    const struct gpu *gpu = &rig->bench->gpu;
    SluiceVulkanContextCreateInfo create = info->context;
    create.structSize = sizeof create;
    create.instance = gpu->instance;
    create.physicalDevice = gpu->physical_device;
    create.device = gpu->device;
    if (!create.pfnGetInstanceProcAddr)
        create.pfnGetInstanceProcAddr = vkGetInstanceProcAddr;
    create.queueFamilyIndex = gpu->family;
    create.sparseQueue = gpu->sparse_queue;
    create.sparseQueueFamilyIndex = gpu->sparse_family;
    create.log.pfnLog = print_log;
    create.loaderThreadCount = rig->bench->threads;
    create.maxPageChunkCount = BENCH_PAGE_CHUNKS;
    return check(sluiceCreateVulkanContext(&create, &rig->context), "sluiceCreateVulkanContext");
}

static bool create_streamer(struct rig *rig, const struct rig_info *info)
{
    SluiceVulkanStreamerCreateInfo create = info->streamer;
    create.structSize = sizeof create;
    create.context = rig->context;
    if (create.residencyMode == SLUICE_RESIDENCY_MODE_AUTO && !info->chooses_modes)
        create.residencyMode = rig->bench->mode;
    create.framesInFlight = RIG_FRAMES;
    create.ticksPerSecond = 60; /* frames */
    create.noStandbyTiles = create.numExtraStandbyTiles == 0;
    return check(sluiceCreateVulkanStreamer(&create, &rig->streamer),
                 "sluiceCreateVulkanStreamer") &&
           check(sluiceGetVulkanStreamerManager(rig->streamer, &rig->manager),
                 "sluiceGetVulkanStreamerManager");
}

static bool add_textures(struct rig *rig, const struct rig_info *info)
{
    rig->textures = calloc(info->texture_count, sizeof *rig->textures);
    rig->sources = calloc(info->texture_count, sizeof *rig->sources);
    if (!rig->textures || !rig->sources)
        return false;
    SluiceVulkanTextureCreateInfo create = {
        .structSize = sizeof create, .pProducer = info->producer, .primaryId = SLUICE_NO_TEXTURE};
    for (; rig->texture_count < info->texture_count; rig->texture_count++) {
        struct free_source *source = &rig->sources[rig->texture_count];
        free_source_init(source, info->format, info->texture_size);
        create.source = info->producer ? NULL : &source->base;
        if (!check(
                sluiceAddVulkanTexture(rig->streamer, &create, &rig->textures[rig->texture_count]),
                "sluiceAddVulkanTexture"))
            return false;
    }
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    if (!check(sluiceGetTextureLayout(rig->manager, rig->textures[0].textureId, &layout),
               "sluiceGetTextureLayout"))
        return false;
    rig->map_width = layout.feedbackWidth;
    rig->map_height = layout.feedbackHeight;
    return true;
}

static bool create_commands(struct rig *rig)
{
    const struct gpu *gpu = &rig->bench->gpu;
    for (uint32_t i = 0; i < RIG_FRAMES; i++) {
        VkCommandBufferAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                            .commandPool = gpu->command_pool,
                                            .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                            .commandBufferCount = 3};
        if (!gpu_check(vkAllocateCommandBuffers(gpu->device, &info, rig->slots[i].commands),
                       "vkAllocateCommandBuffers"))
            return false;
    }
    VkQueryPoolCreateInfo queries = {.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                     .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                     .queryCount = 4 * RIG_FRAMES};
    return gpu_check(vkCreateQueryPool(gpu->device, &queries, NULL, &rig->queries),
                     "vkCreateQueryPool");
}

static bool create_buffers(struct rig *rig, const struct rig_info *info)
{
    const struct gpu *gpu = &rig->bench->gpu;
    uint32_t words = info->output_words ? info->output_words : 1;
    uint32_t picture_words = info->picture_words ? info->picture_words : 1;
    /* Never where the device would have to reach it over a bus. */
    if (!gpu_create_device_buffer(gpu, (VkDeviceSize)picture_words * 4,
                                  VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, &rig->picture) ||
        !gpu_create_buffer(gpu, (VkDeviceSize)words * 4,
                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                           &rig->outputs) ||
        !gpu_create_buffer(gpu, (VkDeviceSize)rig->texture_count * 4,
                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, &rig->indices))
        return false;
    for (uint32_t i = 0; i < rig->texture_count; i++)
        ((uint32_t *)rig->indices.mapped)[i] = rig->textures[i].tableIndex;
    return true;
}

bool rig_create(struct rig *rig, const struct rig_info *info)
{
    *rig = (struct rig){.bench = info->bench};
    return create_context(rig, info) && create_streamer(rig, info) && add_textures(rig, info) &&
           create_commands(rig) && create_buffers(rig, info) && rig_create_descriptors(rig, info);
}

void rig_destroy(struct rig *rig)
{
    const struct gpu *gpu = &rig->bench->gpu;
    if (!rig->streamer) {
        sluiceDestroyVulkanContext(rig->context);
        return;
    }
    vkDeviceWaitIdle(gpu->device);
    for (uint32_t i = 0; i < rig->pipeline_count; i++)
        vkDestroyPipeline(gpu->device, rig->pipelines[i], NULL);
    rig_destroy_descriptors(rig);
    gpu_destroy_buffer(gpu, &rig->outputs);
    gpu_destroy_buffer(gpu, &rig->indices);
    gpu_destroy_buffer(gpu, &rig->picture);
    vkDestroyQueryPool(gpu->device, rig->queries, NULL);
    for (uint32_t i = 0; i < RIG_FRAMES; i++)
        if (rig->slots[i].commands[0])
            vkFreeCommandBuffers(gpu->device, gpu->command_pool, 3, rig->slots[i].commands);
    sluiceDestroyVulkanStreamer(rig->streamer);
    sluiceDestroyVulkanContext(rig->context);
    free(rig->textures);
    free(rig->sources);
    *rig = (struct rig){.bench = rig->bench};
}

static double thread_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void add_sample(struct samples *samples, double seconds)
{
    if (samples)
        samples_add(samples, seconds * 1e9);
}

/* Waits for the frame that used a slot, and takes down its times. */
static bool reap(struct rig *rig, struct rig_slot *slot)
{
    const struct gpu *gpu = &rig->bench->gpu;
    if (slot->signal_value == 0)
        return true;
    VkSemaphoreWaitInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                .semaphoreCount = 1,
                                .pSemaphores = &rig->semaphore,
                                .pValues = &slot->signal_value};
    if (!gpu_check(vkWaitSemaphores(gpu->device, &info, WAIT_NANOSECONDS), "vkWaitSemaphores"))
        return false;
    slot->signal_value = 0;
    const struct rig_samples *s = &slot->samples;
    if (rig->bench->wall || (!s->begin && !s->work && !s->end))
        return true;
    uint64_t ticks[4];
    uint32_t first = 4 * (uint32_t)(slot - rig->slots);
    if (!gpu_check(vkGetQueryPoolResults(gpu->device, rig->queries, first, 4, sizeof ticks, ticks,
                                         sizeof *ticks, VK_QUERY_RESULT_64_BIT),
                   "vkGetQueryPoolResults"))
        return false;
    double tick = 1e-9 * (double)gpu->properties.limits.timestampPeriod;
    add_sample(s->begin, (double)(ticks[1] - ticks[0]) * tick);
    add_sample(s->work, (double)(ticks[2] - ticks[1]) * tick);
    add_sample(s->end, (double)(ticks[3] - ticks[2]) * tick);
    return true;
}

/* Takes a time stamp after all earlier commands. */
static void stamp(struct rig *rig, VkCommandBuffer commands, uint32_t query)
{
    vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, rig->queries, query);
}

static bool begin_commands(VkCommandBuffer commands)
{
    VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                      .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    return gpu_check(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
}

static void whole_barrier(VkCommandBuffer commands)
{
    VkMemoryBarrier memory = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                              .srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT,
                              .dstAccessMask =
                                  VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                         VK_PIPELINE_STAGE_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_HOST_BIT, 0, 1,
                         &memory, 0, NULL, 0, NULL);
}

static bool record_begin(struct rig *rig, struct rig_slot *slot, const struct rig_work *work,
                         SluiceStreamingFrame *frame)
{
    VkCommandBuffer commands = slot->commands[0];
    uint32_t query = 4 * (uint32_t)(slot - rig->slots);
    if (!begin_commands(commands))
        return false;
    vkCmdResetQueryPool(commands, rig->queries, query, 4);
    stamp(rig, commands, query);
    double start = clock_seconds();
    SluiceResult result = sluiceBeginStreamingFrame(rig->streamer, commands, rig->frame + 1, frame);
    rig->host_seconds = clock_seconds() - start;
    if (!check(result, "sluiceBeginStreamingFrame") || result == SLUICE_NOT_READY)
        return false;
    rig->frame++;
    rig->semaphore = frame->semaphore;
    rig_write_pages(rig, slot);
    if (work->warm_up) {
        work->warm_up(rig, commands, work->user);
        whole_barrier(commands);
    }
    stamp(rig, commands, query + 1);
    return gpu_check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
}

static bool record_rest(struct rig *rig, struct rig_slot *slot, const struct rig_work *work)
{
    uint32_t query = 4 * (uint32_t)(slot - rig->slots);
    if (!begin_commands(slot->commands[1]))
        return false;
    if (work->record)
        work->record(rig, slot->commands[1], work->user);
    whole_barrier(slot->commands[1]);
    stamp(rig, slot->commands[1], query + 2);
    if (!gpu_check(vkEndCommandBuffer(slot->commands[1]), "vkEndCommandBuffer") ||
        !begin_commands(slot->commands[2]))
        return false;
    double cpu = thread_seconds(), start = clock_seconds();
    SluiceResult result = sluiceEndStreamingFrame(rig->streamer, slot->commands[2]);
    rig->host_seconds += clock_seconds() - start;
    rig->host_cpu_seconds += thread_seconds() - cpu;
    stamp(rig, slot->commands[2], query + 3);
    return check(result, "sluiceEndStreamingFrame") &&
           gpu_check(vkEndCommandBuffer(slot->commands[2]), "vkEndCommandBuffer");
}

/* Command buffers first to end - 1; the last of a frame signals. */
static bool submit(struct rig *rig, struct rig_slot *slot, uint32_t first, uint32_t end)
{
    VkTimelineSemaphoreSubmitInfo timeline = {.sType =
                                                  VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
                                              .signalSemaphoreValueCount = 1,
                                              .pSignalSemaphoreValues = &slot->signal_value};
    VkSubmitInfo info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                         .pNext = &timeline,
                         .commandBufferCount = end - first,
                         .pCommandBuffers = &slot->commands[first],
                         .signalSemaphoreCount = end == 3 ? 1 : 0,
                         .pSignalSemaphores = &rig->semaphore};
    return gpu_check(vkQueueSubmit(rig->bench->gpu.queue, 1, &info, VK_NULL_HANDLE),
                     "vkQueueSubmit");
}

/* Submits each part by itself, and times it until the device is idle. */
static bool submit_timed(struct rig *rig, struct rig_slot *slot)
{
    struct samples *const samples[3] = {slot->samples.begin, slot->samples.work, slot->samples.end};
    for (uint32_t i = 0; i < 3; i++) {
        double start = clock_seconds();
        if (!submit(rig, slot, i, i + 1) ||
            !gpu_check(vkQueueWaitIdle(rig->bench->gpu.queue), "vkQueueWaitIdle"))
            return false;
        add_sample(samples[i], clock_seconds() - start);
    }
    return true;
}

bool rig_frame(struct rig *rig, const struct rig_work *work)
{
    struct rig_slot *slot = &rig->slots[(rig->frame + 1) % RIG_FRAMES];
    SluiceStreamingFrame frame = {.structSize = sizeof frame};
    if (!reap(rig, slot) || !record_begin(rig, slot, work, &frame) || !record_rest(rig, slot, work))
        return false;
    slot->samples = work->samples;
    slot->signal_value = frame.signalValue;
    bool timed = work->samples.begin || work->samples.work || work->samples.end;
    return timed && rig->bench->wall ? submit_timed(rig, slot) : submit(rig, slot, 0, 3);
}

bool rig_finish(struct rig *rig)
{
    for (uint32_t i = 1; i <= RIG_FRAMES; i++)
        if (!reap(rig, &rig->slots[(rig->frame + i) % RIG_FRAMES]))
            return false;
    return true;
}

bool rig_settle(struct rig *rig)
{
    return rig_finish(rig) &&
           check(sluiceWaitVulkanStreamerIdle(rig->streamer), "sluiceWaitVulkanStreamerIdle");
}

SluiceVulkanStreamerStatistics rig_statistics(const struct rig *rig)
{
    SluiceVulkanStreamerStatistics statistics = {.structSize = sizeof statistics};
    sluiceGetVulkanStreamerStatistics(rig->streamer, &statistics);
    return statistics;
}

bool rig_load(struct rig *rig, struct rig_wants *wants)
{
    struct rig_work work = {.record = wants ? rig_record_wants : NULL, .user = wants};
    uint64_t mapped = 0;
    uint32_t quiet = 0;
    for (uint32_t i = 0; quiet < QUIET_FRAMES; i++) {
        if (i == MAX_LOAD_FRAMES) {
            fprintf(stderr, "what is wanted does not arrive\n");
            return false;
        }
        if (!rig_frame(rig, &work) || !rig_settle(rig))
            return false;
        SluiceVulkanStreamerStatistics s = rig_statistics(rig);
        quiet = s.tilesMapped == mapped && s.loadsInFlight == 0 ? quiet + 1 : 0;
        mapped = s.tilesMapped;
    }
    return true;
}
