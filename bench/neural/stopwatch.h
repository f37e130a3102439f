/** Times commands: with time stamps of the device, or with the clock around the submission. */
#ifndef BENCH_NEURAL_STOPWATCH_H
#define BENCH_NEURAL_STOPWATCH_H

#include "commands.h"

struct stopwatch {
    VkQueryPool queries;
    bool wall; ///< time stamps are no use
};

bool stopwatch_create(const struct gpu *gpu, bool wall, struct stopwatch *stopwatch);
void stopwatch_destroy(const struct gpu *gpu, struct stopwatch *stopwatch);

/** Call around the measured commands, in one command buffer. */
void stopwatch_start(const struct stopwatch *stopwatch, VkCommandBuffer commands);
void stopwatch_stop(const struct stopwatch *stopwatch, VkCommandBuffer commands);

/** Runs and frees the commands, as commands_run. */
bool stopwatch_run(const struct stopwatch *stopwatch, const struct gpu *gpu,
                   VkCommandBuffer commands, double *seconds);

#endif /* BENCH_NEURAL_STOPWATCH_H */
