#include "stopwatch.h"

#include "../../tools/common/clock.h"

bool stopwatch_create(const struct gpu *gpu, bool wall, struct stopwatch *stopwatch)
{
    const VkQueryPoolCreateInfo info = {.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                        .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                        .queryCount = 2};
    *stopwatch = (struct stopwatch){.wall = wall};
    return gpu_check(vkCreateQueryPool(gpu->device, &info, NULL, &stopwatch->queries),
                     "vkCreateQueryPool");
}

void stopwatch_destroy(const struct gpu *gpu, struct stopwatch *stopwatch)
{
    vkDestroyQueryPool(gpu->device, stopwatch->queries, NULL);
    stopwatch->queries = VK_NULL_HANDLE;
}

void stopwatch_start(const struct stopwatch *stopwatch, VkCommandBuffer commands)
{
    vkCmdResetQueryPool(commands, stopwatch->queries, 0, 2);
    vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, stopwatch->queries, 0);
}

void stopwatch_stop(const struct stopwatch *stopwatch, VkCommandBuffer commands)
{
    vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, stopwatch->queries, 1);
}

bool stopwatch_run(const struct stopwatch *stopwatch, const struct gpu *gpu,
                   VkCommandBuffer commands, double *seconds)
{
    uint64_t ticks[2];
    double start = clock_seconds();
    if (!commands_run(gpu, commands))
        return false;
    *seconds = clock_seconds() - start;
    if (stopwatch->wall)
        return true;
    if (!gpu_check(vkGetQueryPoolResults(gpu->device, stopwatch->queries, 0, 2, sizeof ticks, ticks,
                                         sizeof *ticks, VK_QUERY_RESULT_64_BIT),
                   "vkGetQueryPoolResults"))
        return false;
    *seconds =
        1e-9 * (double)gpu->properties.limits.timestampPeriod * (double)(ticks[1] - ticks[0]);
    return true;
}
