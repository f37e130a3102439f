#include "launches.h"

#include <stdio.h>

#include "../../tools/common/clock.h"
#include "../../tools/common/progress.h"
#include "../../tools/common/text.h"

/* Nanoseconds that a preview waits for tiles before it shows the picture without them. */
#define PATIENCE 20000000u

static bool check(SluiceResult result, const char *what)
{
    if (result != SLUICE_SUCCESS)
        text_say("%s: %s", what, sluiceGetResultName(result));
    return result == SLUICE_SUCCESS;
}

static bool submit(struct launches *l, const SluiceDemandLaunch *launch)
{
    VkTimelineSemaphoreSubmitInfo timeline = {.sType =
                                                  VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
                                              .signalSemaphoreValueCount = 1,
                                              .pSignalSemaphoreValues = &launch->signalValue};
    VkSubmitInfo info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                         .pNext = &timeline,
                         .commandBufferCount = 1,
                         .pCommandBuffers = &l->commands,
                         .signalSemaphoreCount = 1,
                         .pSignalSemaphores = &launch->semaphore};
    return gpu_check(vkEndCommandBuffer(l->commands), "vkEndCommandBuffer") &&
           gpu_check(vkQueueSubmit(l->gpu->queue, 1, &info, VK_NULL_HANDLE), "vkQueueSubmit");
}

/** Runs one launch, from preparation to requests. The film chooses the traced pixels. */
static bool launch_once(struct launches *l, uint32_t sample, SluiceDemandRequests *requests,
                        SluiceDemandTicket *ticket)
{
    VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                      .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    SluiceDemandLaunch launch = {.structSize = sizeof launch};
    if (!gpu_check(vkBeginCommandBuffer(l->commands, &begin), "vkBeginCommandBuffer") ||
        !check(sluiceBeginDemandLaunch(l->loader, l->commands, &launch),
               "a launch cannot be prepared"))
        return false;
    l->tile_count += launch.tileCount;
    if (l->film->missing_count > 0)
        renderer_record(l->renderer, launch.descriptorSet, l->film, sample, l->commands);
    if (!check(sluiceEndDemandLaunch(l->loader, l->commands), "a launch cannot be ended") ||
        !submit(l, &launch)) {
        sluiceAbandonDemandLaunch(l->loader, &launch); /* the next launch copies its tiles */
        return false;
    }
    requests->structSize = sizeof *requests;
    return check(sluiceProcessDemandRequests(l->loader, &launch, UINT64_MAX, requests, ticket),
                 "requests cannot be served");
}

/** Waits at most `patience` nanoseconds. Returns true also if the time runs out. */
static bool wait_for_tiles(struct launches *l, SluiceDemandTicket ticket, uint64_t patience)
{
    SluiceResult result = sluiceWaitDemandTicket(l->loader, ticket, patience, NULL);
    return result == SLUICE_NOT_READY || check(result, "tiles cannot be waited for");
}

static bool trace_sample(struct launches *l, uint32_t sample)
{
    const uint64_t patience = l->options->preview ? PATIENCE : UINT64_MAX;
    film_begin_sample(l->film);
    while (l->film->missing_count > 0 && l->count - l->first < l->options->max_launches) {
        struct launch_record record = {
            .index = l->count + 1, .sample = sample, .traced_count = l->film->missing_count};
        SluiceDemandTicket ticket;
        film_begin_launch(l->film);
        if (!launch_once(l, sample, &record.requests, &ticket))
            return false;
        film_end_launch(l->film);
        l->count++;
        l->ray_count += record.traced_count;
        record.missing_count = l->film->missing_count;
        if (!l->after_launch(l->user_data, &record) ||
            (record.missing_count > 0 && !wait_for_tiles(l, ticket, patience)))
            return false;
    }
    return true;
}

static bool allocate_commands(struct launches *l)
{
    VkCommandBufferAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                        .commandPool = l->gpu->command_pool,
                                        .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                        .commandBufferCount = 1};
    return l->commands || gpu_check(vkAllocateCommandBuffers(l->gpu->device, &info, &l->commands),
                                    "vkAllocateCommandBuffers");
}

static void note_fill(struct launches *l)
{
    if (l->fill_end > 0.0)
        return;
    l->fill_end = clock_seconds();
    l->fill_count = l->tile_count;
    l->fill_paths = l->path_count;
}

bool launches_run(struct launches *l)
{
    if (!allocate_commands(l))
        return false;
    l->first = l->count;
    l->complete_count = 0;
    for (uint32_t sample = 0; sample < l->options->samples; sample++) {
        if (!trace_sample(l, sample))
            return false;
        l->path_count += l->film->pixel_count - l->film->missing_count;
        if (l->film->missing_count > 0)
            break;
        l->complete_count++;
        note_fill(l);
    }
    return true;
}

/* Waits for a ticket. Launches that trace nothing open textures further and copy loaded texels. */
static bool finish_ticket(struct launches *l, SluiceDemandTicket ticket)
{
    SluiceDemandRequests requests = {.structSize = sizeof requests};
    SluiceDemandTicketStatus status = {.structSize = sizeof status};
    do {
        SluiceResult result = sluiceWaitDemandTicket(l->loader, ticket, PATIENCE, &status);
        if (result != SLUICE_NOT_READY && !check(result, "a texture cannot be loaded"))
            return false;
        if (!launch_once(l, 0, &requests, NULL))
            return false;
        l->preload_count++;
    } while (status.remainingCount > 0);
    return true;
}

bool launches_preload(struct launches *l)
{
    struct progress progress;
    if (!allocate_commands(l))
        return false;
    if (!l->quiet)
        progress_begin(&progress, "loading everything", "textures", l->texture_count);
    for (uint32_t i = 0; i < l->texture_count; i++) {
        SluiceDemandTicket ticket;
        SluiceResult result = sluicePreloadDemandTexture(l->loader, l->texture_ids[i], 0, &ticket);
        if (!check(result, "a texture cannot be loaded") || !finish_ticket(l, ticket))
            return false;
        if (!l->quiet)
            progress_update(&progress, i + 1);
    }
    if (!l->quiet)
        progress_end(&progress);
    return true;
}
