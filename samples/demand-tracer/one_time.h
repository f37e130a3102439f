/** Commands that run once while the host waits. */
#ifndef TRACER_ONE_TIME_H
#define TRACER_ONE_TIME_H

#include "../../tools/common/gpu.h"

/** Says on stderr why it failed. */
bool one_time_run(const struct gpu *gpu, void (*record)(void *user_data, VkCommandBuffer commands),
                  void *user_data);

#endif /* TRACER_ONE_TIME_H */
