#include "build_batch.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../common/ray_table.h"

static PFN_vkVoidFunction function(const struct gpu *gpu, const char *name)
{
    return vkGetDeviceProcAddr(gpu->device, name);
}

static bool create_commands(const struct gpu *gpu, struct build_batch *b)
{
    const VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .queueFamilyIndex = gpu->build_family};
    if (b->pool)
        return true;
    if (!gpu_check(vkCreateCommandPool(gpu->device, &pool, NULL, &b->pool), "vkCreateCommandPool"))
        return false;
    const VkCommandBufferAllocateInfo info = {.sType =
                                                  VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                              .commandPool = b->pool,
                                              .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                              .commandBufferCount = 1};
    return gpu_check(vkAllocateCommandBuffers(gpu->device, &info, &b->commands),
                     "vkAllocateCommandBuffers");
}

static bool begin_commands(const struct gpu *gpu, struct build_batch *b)
{
    const VkCommandBufferBeginInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                           .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    return create_commands(gpu, b) &&
           gpu_check(vkResetCommandPool(gpu->device, b->pool, 0), "vkResetCommandPool") &&
           gpu_check(vkBeginCommandBuffer(b->commands, &info), "vkBeginCommandBuffer");
}

static bool submit(const struct gpu *gpu, struct structures *s, struct build_batch *b)
{
    b->value = s->ready_value + 1;
    const VkTimelineSemaphoreSubmitInfo timeline = {
        .sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
        .signalSemaphoreValueCount = 1,
        .pSignalSemaphoreValues = &b->value};
    const VkSubmitInfo info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                               .pNext = &timeline,
                               .commandBufferCount = 1,
                               .pCommandBuffers = &b->commands,
                               .signalSemaphoreCount = 1,
                               .pSignalSemaphores = &s->ready};
    return gpu_check(vkEndCommandBuffer(b->commands), "vkEndCommandBuffer") &&
           gpu_check(vkQueueSubmit(gpu->build_queue, 1, &info, VK_NULL_HANDLE), "vkQueueSubmit");
}

/** Sets `ready` if the commands have ended. */
static bool is_ready(const struct gpu *gpu, struct structures *s, const struct build_batch *b,
                     bool waits, bool *ready)
{
    const VkSemaphoreWaitInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                      .semaphoreCount = 1,
                                      .pSemaphores = &s->ready,
                                      .pValues = &b->value};
    const VkResult result = vkWaitSemaphores(gpu->device, &info, waits ? UINT64_MAX : 0);
    *ready = result == VK_SUCCESS;
    if (*ready)
        s->ready_value = b->value;
    return result == VK_TIMEOUT || gpu_check(result, "vkWaitSemaphores");
}

static bool compacts(const struct build_batch *b)
{
    return b->count > 0 && b->builds[0].compact;
}

static bool create_queries(const struct gpu *gpu, struct build_batch *b)
{
    const VkQueryPoolCreateInfo info = {.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                        .queryType =
                                            VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR,
                                        .queryCount = b->count};
    return !compacts(b) ||
           gpu_check(vkCreateQueryPool(gpu->device, &info, NULL, &b->queries), "vkCreateQueryPool");
}

static void record_builds(const struct gpu *gpu, const struct structures *s,
                          const struct build_batch *b)
{
    PFN_vkCmdWriteAccelerationStructuresPropertiesKHR write_sizes =
        (PFN_vkCmdWriteAccelerationStructuresPropertiesKHR)function(
            gpu, "vkCmdWriteAccelerationStructuresPropertiesKHR");
    structures_record(gpu, s, b->builds, b->count, &b->scratch, b->commands);
    if (!compacts(b))
        return;
    vkCmdResetQueryPool(b->commands, b->queries, 0, b->count);
    for (uint32_t i = 0; i < b->count; i++)
        write_sizes(b->commands, 1, &b->builds[i].target->handle,
                    VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR, b->queries, i);
}

static bool copy_list(struct build_batch *b, const struct structure_build *builds, uint32_t count)
{
    b->builds = calloc(count + 1u, sizeof *b->builds);
    b->smaller = calloc(count + 1u, sizeof *b->smaller);
    b->sizes = calloc(count + 1u, sizeof *b->sizes);
    b->count = count;
    if (!b->builds || !b->smaller || !b->sizes) {
        fprintf(stderr, "out of memory\n");
        return false;
    }
    if (count > 0)
        memcpy(b->builds, builds, count * sizeof *builds);
    return true;
}

/** Frees the batch's queries and arrays. */
static void end(const struct gpu *gpu, struct build_batch *b)
{
    vkDestroyQueryPool(gpu->device, b->queries, NULL);
    free(b->builds);
    free(b->smaller);
    free(b->sizes);
    b->queries = VK_NULL_HANDLE;
    b->builds = NULL;
    b->smaller = NULL;
    b->sizes = NULL;
    b->count = 0;
    b->stage = BATCH_IDLE;
}

bool build_batch_begin(const struct gpu *gpu, struct structures *s, struct build_batch *b,
                       const struct structure_build *builds, uint32_t count)
{
    if (!gpu->ray_tracing || count == 0)
        return true;
    bool done = copy_list(b, builds, count) &&
                structures_prepare(gpu, s, b->builds, count, &b->scratch) &&
                create_queries(gpu, b) && begin_commands(gpu, b);
    if (done)
        record_builds(gpu, s, b);
    done = done && submit(gpu, s, b);
    b->stage = BATCH_BUILDS;
    if (done)
        return true;
    for (uint32_t i = 0; i < count; i++)
        structures_give(gpu, s, builds[i].target);
    end(gpu, b);
    return false;
}

static void record_copies(const struct gpu *gpu, const struct build_batch *b)
{
    PFN_vkCmdCopyAccelerationStructureKHR copy =
        (PFN_vkCmdCopyAccelerationStructureKHR)function(gpu, "vkCmdCopyAccelerationStructureKHR");
    for (uint32_t i = 0; i < b->count; i++) {
        const VkCopyAccelerationStructureInfoKHR info = {
            .sType = VK_STRUCTURE_TYPE_COPY_ACCELERATION_STRUCTURE_INFO_KHR,
            .src = b->builds[i].target->handle,
            .dst = b->smaller[i].handle,
            .mode = VK_COPY_ACCELERATION_STRUCTURE_MODE_COMPACT_KHR};
        copy(b->commands, &info);
    }
    gpu_barrier(b->commands, VK_PIPELINE_STAGE_ACCELERATION_STRUCTURE_BUILD_BIT_KHR,
                VK_ACCESS_ACCELERATION_STRUCTURE_WRITE_BIT_KHR, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                VK_ACCESS_ACCELERATION_STRUCTURE_READ_BIT_KHR);
}

static bool begin_copies(const struct gpu *gpu, struct structures *s, struct build_batch *b)
{
    const VkDeviceSize each = sizeof *b->sizes;
    bool done = gpu_check(vkGetQueryPoolResults(gpu->device, b->queries, 0, b->count,
                                                b->count * each, b->sizes, each,
                                                VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
                          "vkGetQueryPoolResults");
    for (uint32_t i = 0; i < b->count && done; i++)
        done = structures_take(gpu, s, b->builds[i].type, b->sizes[i], &b->smaller[i]);
    done = done && begin_commands(gpu, b);
    if (done)
        record_copies(gpu, b);
    b->stage = BATCH_COPIES;
    return done && submit(gpu, s, b);
}

static void take_copies(const struct gpu *gpu, struct structures *s, struct build_batch *b)
{
    for (uint32_t i = 0; i < b->count; i++) {
        structures_give(gpu, s, b->builds[i].target);
        *b->builds[i].target = b->smaller[i];
    }
}

bool build_batch_continue(const struct gpu *gpu, struct structures *s, struct build_batch *b,
                          bool waits)
{
    bool done = true, ready = true;
    while (b->stage != BATCH_IDLE && done && ready) {
        done = is_ready(gpu, s, b, waits, &ready);
        if (!done || !ready)
            break;
        if (b->stage == BATCH_BUILDS && compacts(b)) {
            done = begin_copies(gpu, s, b);
            continue;
        }
        if (b->stage == BATCH_COPIES)
            take_copies(gpu, s, b);
        end(gpu, b);
    }
    return done;
}

void build_batch_finish(const struct gpu *gpu, struct structures *s, struct build_batch *b)
{
    if (!gpu->device)
        return;
    vkDeviceWaitIdle(gpu->device);
    for (uint32_t i = 0; i < b->count; i++) /* targets belong to the caller */
        structures_give(gpu, s, &b->smaller[i]);
    end(gpu, b);
    gpu_destroy_buffer(gpu, &b->scratch);
    vkDestroyCommandPool(gpu->device, b->pool, NULL);
    *b = (struct build_batch){0};
}
