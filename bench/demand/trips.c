/* Cost of a launch without misses: prepare, end, submit, wait, process. */
#include "rig.h"

#include "../../tools/common/clock.h"

#include <stdio.h>

#define TRIPS 400u
/* Bytes that resident tiles nearly fill, so that shaders report used pages. */
#define TIGHT (UINT64_C(1) << 29)

/* Measures the driver's time for an empty command buffer and the wait for its semaphore. */
static bool empty_submissions(struct rig *rig, struct samples *times)
{
    const struct gpu *gpu = &rig->bench->gpu;
    VkCommandBuffer commands = rig->slots[0].commands;
    VkSemaphoreTypeCreateInfo type = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO,
                                      .semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE};
    VkSemaphoreCreateInfo create = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO,
                                    .pNext = &type};
    VkSemaphore semaphore;
    if (!gpu_check(vkCreateSemaphore(gpu->device, &create, NULL, &semaphore), "vkCreateSemaphore"))
        return false;
    uint64_t value = 0;
    VkTimelineSemaphoreSubmitInfo values = {.sType =
                                                VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
                                            .signalSemaphoreValueCount = 1,
                                            .pSignalSemaphoreValues = &value};
    VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                           .pNext = &values,
                           .commandBufferCount = 1,
                           .pCommandBuffers = &commands,
                           .signalSemaphoreCount = 1,
                           .pSignalSemaphores = &semaphore};
    VkSemaphoreWaitInfo wait = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                .semaphoreCount = 1,
                                .pSemaphores = &semaphore,
                                .pValues = &value};
    VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    bool done = true;
    while (done && value < repetitions(TRIPS)) {
        value++;
        double start = clock_seconds();
        done = gpu_check(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer") &&
               gpu_check(vkEndCommandBuffer(commands), "vkEndCommandBuffer") &&
               gpu_check(vkQueueSubmit(gpu->queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit") &&
               gpu_check(vkWaitSemaphores(gpu->device, &wait, UINT64_MAX), "vkWaitSemaphores");
        samples_add(times, (clock_seconds() - start) * 1e9);
    }
    vkDeviceWaitIdle(gpu->device);
    vkDestroySemaphore(gpu->device, semaphore, NULL);
    return done;
}

static bool trips(struct rig *rig, struct samples *times)
{
    struct rig_outcome outcome;
    for (uint32_t i = 0; i < repetitions(TRIPS); i++) {
        double start = clock_seconds();
        if (!rig_launch(rig, DEMAND_BENCH_NOTHING, &outcome))
            return false;
        samples_add(times, (clock_seconds() - start) * 1e9);
    }
    return true;
}

/* Reports device time before and after the shaders. */
static bool report_parts(struct rig *rig, const char *name)
{
    struct samples parts[2];
    struct rig_outcome outcome;
    bool done = true;
    rig->timed = true;
    for (uint32_t i = 0; i < 2; i++)
        samples_init(&parts[i], TRIPS);
    for (uint32_t i = 0; done && i < repetitions(TRIPS); i++) {
        done = rig_launch(rig, DEMAND_BENCH_NOTHING, &outcome);
        for (uint32_t j = 0; j < 2; j++)
            samples_add(&parts[j], outcome.gpu_parts[j] * 1e9);
    }
    if (done && !rig->bench->wall) {
        figure(name, "gpu_prepare", samples_quantile(&parts[0], 0.5) * 1e-3, "us");
        figure(name, "gpu_end", samples_quantile(&parts[1], 0.5) * 1e-3, "us");
    }
    for (uint32_t i = 0; i < 2; i++)
        samples_finish(&parts[i]);
    rig->timed = false;
    return done;
}

static bool measure(const struct bench *bench, uint32_t capacity, uint64_t budget, const char *name)
{
    struct rig rig;
    struct samples times;
    samples_init(&times, TRIPS);
    SluiceDemandLoaderCreateInfo info = {
        .structSize = sizeof info, .maxRequestsPerLaunch = capacity, .memoryBudget = budget};
    bool done = rig_create(&rig, bench, &info, false) && rig_load(&rig, 1000) > 0 &&
                trips(&rig, &times) && report_parts(&rig, name);
    if (done)
        figure(name, "median", samples_quantile(&times, 0.5) * 1e-3, "us");
    samples_finish(&times);
    rig_destroy(&rig);
    return done;
}

static bool measure_floor(const struct bench *bench)
{
    struct rig rig;
    struct samples times;
    samples_init(&times, TRIPS);
    SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info, .memoryBudget = TIGHT};
    bool done = rig_create(&rig, bench, &info, false) && empty_submissions(&rig, &times);
    if (done)
        figure("trip.floor", NULL, samples_quantile(&times, 0.5) * 1e-3, "us");
    samples_finish(&times);
    rig_destroy(&rig);
    return done;
}

bool measure_trips(const struct bench *bench)
{
    return measure_floor(bench) && measure(bench, 64, 0, "trip.64") &&
           measure(bench, 512, 0, "trip.512") && measure(bench, 8192, 0, "trip.8192") &&
           measure(bench, 8192, TIGHT, "trip.8192_tracked");
}
