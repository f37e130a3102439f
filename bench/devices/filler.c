#define _POSIX_C_SOURCE 200809L
#include "filler.h"

#include "../../tools/common/clock.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define WAIT_NANOSECONDS (60ull * 1000000000ull)
#define TIME_LIMIT 300.0 /* seconds */

static bool check(SluiceResult result, const char *what)
{
    if (result >= 0)
        return true;
    fprintf(stderr, "%s: %s\n", what, sluiceGetResultName(result));
    return false;
}

static void print_log(void *user, SluiceLogSeverity severity, const char *message)
{
    (void)user;
    if (severity != SLUICE_LOG_INFO)
        fprintf(stderr, "%s\n", message);
}

static bool create_streamer(struct filler *f)
{
    const struct gpu *gpu = f->info.gpu;
    const SluiceVulkanContextCreateInfo context = {.structSize = sizeof context,
                                                   .instance = gpu->instance,
                                                   .physicalDevice = gpu->physical_device,
                                                   .device = gpu->device,
                                                   .pfnGetInstanceProcAddr = vkGetInstanceProcAddr,
                                                   .queueFamilyIndex = gpu->family,
                                                   .sparseQueue = gpu->sparse_queue,
                                                   .sparseQueueFamilyIndex = gpu->sparse_family,
                                                   .log.pfnLog = print_log,
                                                   .loaderThreadCount =
                                                       f->info.pool ? 0 : f->info.threads,
                                                   .minStagingSize = UINT64_MAX,
                                                   .readPool = f->info.pool};
    if (!check(sluiceCreateVulkanContext(&context, &f->context), "sluiceCreateVulkanContext"))
        return false;
    const SluiceVulkanStreamerCreateInfo streamer = {.structSize = sizeof streamer,
                                                     .context = f->context,
                                                     .residencyMode = gpu->modes[0],
                                                     .framesInFlight = FILLER_FRAMES,
                                                     .maxTextureCount = f->info.source_count,
                                                     .tilesPerFrame = 256,
                                                     .ticksPerSecond = 60,
                                                     .noStandbyTiles = true};
    return check(sluiceCreateVulkanStreamer(&streamer, &f->streamer), "sluiceCreateVulkanStreamer");
}

static bool request_textures(struct filler *f)
{
    f->requests = calloc(f->info.source_count, sizeof *f->requests);
    for (uint32_t i = 0; f->requests && i < f->info.source_count; i++) {
        const SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create,
                                                      .source = f->info.sources[i],
                                                      .primaryId = SLUICE_NO_TEXTURE};
        const SluiceVulkanTextureRequest all = {.structSize = sizeof all, .until = UINT64_MAX};
        SluiceVulkanTexture texture;
        if (!check(sluiceAddVulkanTexture(f->streamer, &create, &texture),
                   "sluiceAddVulkanTexture") ||
            !check(
                sluiceRequestVulkanTexture(f->streamer, texture.textureId, &all, &f->requests[i]),
                "sluiceRequestVulkanTexture"))
            return false;
    }
    return f->requests;
}

bool filler_create(struct filler *f, const struct filler_info *info)
{
    *f = (struct filler){.info = *info};
    const VkCommandBufferAllocateInfo commands = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = info->gpu->command_pool,
        .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
        .commandBufferCount = FILLER_FRAMES};
    return create_streamer(f) && request_textures(f) &&
           gpu_check(vkAllocateCommandBuffers(info->gpu->device, &commands, f->commands),
                     "vkAllocateCommandBuffers");
}

static bool wait_for_slot(const struct filler *f, uint32_t slot)
{
    const VkSemaphoreWaitInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                      .semaphoreCount = 1,
                                      .pSemaphores = &f->semaphore,
                                      .pValues = &f->values[slot]};
    return f->values[slot] == 0 ||
           gpu_check(vkWaitSemaphores(f->info.gpu->device, &info, WAIT_NANOSECONDS),
                     "vkWaitSemaphores");
}

static bool submit(struct filler *f, uint32_t slot)
{
    const VkTimelineSemaphoreSubmitInfo timeline = {
        .sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
        .signalSemaphoreValueCount = 1,
        .pSignalSemaphoreValues = &f->values[slot]};
    const VkSubmitInfo info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                               .pNext = &timeline,
                               .commandBufferCount = 1,
                               .pCommandBuffers = &f->commands[slot],
                               .signalSemaphoreCount = 1,
                               .pSignalSemaphores = &f->semaphore};
    return gpu_check(vkQueueSubmit(f->info.gpu->queue, 1, &info, VK_NULL_HANDLE), "vkQueueSubmit");
}

static bool run_frame(struct filler *f)
{
    uint32_t slot = (uint32_t)(++f->frame % FILLER_FRAMES);
    VkCommandBuffer commands = f->commands[slot];
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                            .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    SluiceStreamingFrame frame = {.structSize = sizeof frame};
    if (!wait_for_slot(f, slot) ||
        !gpu_check(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer"))
        return false;
    SluiceResult result = sluiceBeginStreamingFrame(f->streamer, commands, f->frame, &frame);
    if (!check(result, "sluiceBeginStreamingFrame") || result == SLUICE_NOT_READY)
        return false;
    f->semaphore = frame.semaphore;
    f->values[slot] = frame.signalValue;
    return check(sluiceEndStreamingFrame(f->streamer, commands), "sluiceEndStreamingFrame") &&
           gpu_check(vkEndCommandBuffer(commands), "vkEndCommandBuffer") && submit(f, slot);
}

/* Requests before `*first` are ready. */
static bool is_ready(struct filler *f, uint32_t *first)
{
    for (; *first < f->info.source_count; ++*first) {
        SluiceVulkanRequestProgress progress = {.structSize = sizeof progress};
        if (!check(sluiceGetVulkanRequestProgress(f->streamer, f->requests[*first], &progress),
                   "sluiceGetVulkanRequestProgress") ||
            !progress.ready)
            return false;
        f->tile_count += progress.tileCount;
    }
    return true;
}

static void *fill(void *argument)
{
    struct filler *f = argument;
    const double limit = clock_seconds() + TIME_LIMIT;
    uint64_t mapped = 0;
    uint32_t first = 0;
    do {
        SluiceVulkanStreamerStatistics now = {.structSize = sizeof now};
        f->failed = !run_frame(f) || clock_seconds() > limit ||
                    !check(sluiceGetVulkanStreamerStatistics(f->streamer, &now),
                           "sluiceGetVulkanStreamerStatistics");
        if (now.tilesMapped == mapped) /* reads are slower than frames */
            nanosleep(&(struct timespec){0, 100000}, NULL);
        mapped = now.tilesMapped;
    } while (!f->failed && !is_ready(f, &first));
    f->end = clock_seconds();
    return NULL;
}

bool filler_start(struct filler *f)
{
    f->runs = pthread_create(&f->thread, NULL, fill, f) == 0;
    return f->runs;
}

bool filler_wait(struct filler *f)
{
    if (!f->runs)
        return false;
    pthread_join(f->thread, NULL);
    f->runs = false;
    if (f->failed)
        fprintf(stderr, "a device did not load what was requested\n");
    return !f->failed;
}

void filler_destroy(struct filler *f)
{
    if (f->runs)
        filler_wait(f);
    if (f->context) {
        const struct gpu *gpu = f->info.gpu;
        vkDeviceWaitIdle(gpu->device);
        sluiceDestroyVulkanStreamer(f->streamer);
        sluiceDestroyVulkanContext(f->context);
        if (f->commands[0])
            vkFreeCommandBuffers(gpu->device, gpu->command_pool, FILLER_FRAMES, f->commands);
    }
    free(f->requests);
    *f = (struct filler){0};
}
