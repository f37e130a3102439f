/** Command buffers that are recorded, submitted and waited for. */
#ifndef BENCH_NEURAL_COMMANDS_H
#define BENCH_NEURAL_COMMANDS_H

#include "../../tools/common/gpu.h"

/** Begins a new command buffer. Reports errors on stderr. */
bool commands_begin(const struct gpu *gpu, VkCommandBuffer *commands);
/** Submits a command buffer, waits for it, and frees it. */
bool commands_run(const struct gpu *gpu, VkCommandBuffer commands);

#endif /* BENCH_NEURAL_COMMANDS_H */
