#include "compaction.h"

#include <stdio.h>
#include <stdlib.h>

#include "../common/one_time.h"

struct compaction {
    PFN_vkCmdWriteAccelerationStructuresPropertiesKHR write_sizes;
    PFN_vkCmdCopyAccelerationStructureKHR copy;
    const struct structure_build *builds;
    uint32_t count;
    VkQueryPool pool;
    VkDeviceSize *sizes;       ///< owned
    struct structure *smaller; ///< owned
};

static void record_sizes(void *user_data, VkCommandBuffer commands)
{
    const struct compaction *c = user_data;
    vkCmdResetQueryPool(commands, c->pool, 0, c->count);
    for (uint32_t i = 0; i < c->count; i++)
        c->write_sizes(commands, 1, &c->builds[i].target->handle,
                       VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR, c->pool, i);
}

static void record_copies(void *user_data, VkCommandBuffer commands)
{
    const struct compaction *c = user_data;
    for (uint32_t i = 0; i < c->count; i++) {
        const VkCopyAccelerationStructureInfoKHR info = {
            .sType = VK_STRUCTURE_TYPE_COPY_ACCELERATION_STRUCTURE_INFO_KHR,
            .src = c->builds[i].target->handle,
            .dst = c->smaller[i].handle,
            .mode = VK_COPY_ACCELERATION_STRUCTURE_MODE_COMPACT_KHR};
        c->copy(commands, &info);
    }
    gpu_barrier(commands, VK_PIPELINE_STAGE_ACCELERATION_STRUCTURE_BUILD_BIT_KHR,
                VK_ACCESS_ACCELERATION_STRUCTURE_WRITE_BIT_KHR, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                VK_ACCESS_ACCELERATION_STRUCTURE_READ_BIT_KHR);
}

static bool get_sizes(const struct gpu *gpu, struct compaction *c)
{
    const VkQueryPoolCreateInfo info = {.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                        .queryType =
                                            VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR,
                                        .queryCount = c->count};
    return gpu_check(vkCreateQueryPool(gpu->device, &info, NULL, &c->pool), "vkCreateQueryPool") &&
           one_time_run(gpu, record_sizes, c) &&
           gpu_check(vkGetQueryPoolResults(gpu->device, c->pool, 0, c->count,
                                           c->count * sizeof *c->sizes, c->sizes, sizeof *c->sizes,
                                           VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
                     "vkGetQueryPoolResults");
}

static bool compact(const struct gpu *gpu, struct structures *s, struct compaction *c)
{
    bool done = get_sizes(gpu, c);
    for (uint32_t i = 0; i < c->count && done; i++)
        done = structures_take(gpu, s, c->builds[i].type, c->sizes[i], &c->smaller[i]);
    done = done && one_time_run(gpu, record_copies, c);
    for (uint32_t i = 0; i < c->count; i++) {
        struct structure larger = c->smaller[i];
        if (done) {
            larger = *c->builds[i].target;
            *c->builds[i].target = c->smaller[i];
        }
        structures_give(gpu, s, &larger);
    }
    return done;
}

bool structures_compact(const struct gpu *gpu, struct structures *s,
                        const struct structure_build *builds, uint32_t count)
{
    if (!gpu->ray_tracing)
        return true;
    struct compaction c = {
        .write_sizes = (PFN_vkCmdWriteAccelerationStructuresPropertiesKHR)vkGetDeviceProcAddr(
            gpu->device, "vkCmdWriteAccelerationStructuresPropertiesKHR"),
        .copy = (PFN_vkCmdCopyAccelerationStructureKHR)vkGetDeviceProcAddr(
            gpu->device, "vkCmdCopyAccelerationStructureKHR"),
        .builds = builds,
        .count = count,
        .sizes = calloc(count + 1u, sizeof *c.sizes),
        .smaller = calloc(count + 1u, sizeof *c.smaller)};
    bool done = c.sizes && c.smaller;
    if (!done)
        fprintf(stderr, "out of memory\n");
    done = done && (count == 0 || compact(gpu, s, &c));
    vkDestroyQueryPool(gpu->device, c.pool, NULL);
    free(c.sizes);
    free(c.smaller);
    return done;
}
