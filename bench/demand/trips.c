/* What a launch costs that misses nothing: prepare, end, submit, wait, process. */
#include "rig.h"

#include "../../samples/common/clock.h"

#include <stdio.h>

#define TRIPS 400u

static bool empty_submissions(struct rig *rig, struct samples *times)
{
    const struct gpu *gpu = &rig->bench->gpu;
    VkSubmitInfo info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                         .commandBufferCount = 1,
                         .pCommandBuffers = &rig->slots[0].commands};
    VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    if (!gpu_check(vkBeginCommandBuffer(rig->slots[0].commands, &begin), "vkBeginCommandBuffer") ||
        !gpu_check(vkEndCommandBuffer(rig->slots[0].commands), "vkEndCommandBuffer"))
        return false;
    for (uint32_t i = 0; i < repetitions(TRIPS); i++) {
        double start = clock_seconds();
        if (!gpu_check(vkQueueSubmit(gpu->queue, 1, &info, VK_NULL_HANDLE), "vkQueueSubmit") ||
            !gpu_check(vkQueueWaitIdle(gpu->queue), "vkQueueWaitIdle"))
            return false;
        samples_add(times, (clock_seconds() - start) * 1e9);
    }
    return true;
}

static bool trips(struct rig *rig, struct samples *times)
{
    for (uint32_t i = 0; i < repetitions(TRIPS); i++) {
        struct rig_outcome outcome;
        double start = clock_seconds();
        if (!rig_launch(rig, DEMAND_BENCH_NOTHING, &outcome))
            return false;
        samples_add(times, (clock_seconds() - start) * 1e9);
    }
    return true;
}

static bool measure(const struct bench *bench, uint32_t capacity)
{
    struct rig rig;
    struct samples times, floor;
    samples_init(&times, TRIPS);
    samples_init(&floor, TRIPS);
    SluiceDemandLoaderCreateInfo info = {.maxRequestsPerLaunch = capacity,
                                         .memoryBudget = UINT64_C(1) << 29};
    bool done = rig_create(&rig, bench, &info, false) && rig_load(&rig, 1000) > 0 &&
                trips(&rig, &times) && empty_submissions(&rig, &floor);
    if (done) {
        char name[64];
        snprintf(name, sizeof name, "trip.%u", capacity);
        figure(name, "median", samples_quantile(&times, 0.5) * 1e-3, "us");
        figure(name, "least", samples_quantile(&times, 0.0) * 1e-3, "us");
        if (capacity == 8192)
            figure("trip.floor", NULL, samples_quantile(&floor, 0.5) * 1e-3, "us");
    }
    samples_finish(&times);
    samples_finish(&floor);
    rig_destroy(&rig);
    return done;
}

bool measure_trips(const struct bench *bench)
{
    return measure(bench, 64) && measure(bench, 512) && measure(bench, 8192);
}
