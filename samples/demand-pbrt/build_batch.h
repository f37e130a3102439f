/** Builds of structures that a queue runs beside launches, where the device has such a queue. */
#ifndef DEMAND_PBRT_BUILD_BATCH_H
#define DEMAND_PBRT_BUILD_BATCH_H

#include "structures.h"

enum batch_stage { BATCH_IDLE, BATCH_BUILDS, BATCH_COPIES };

/** One batch at a time. Zeroed is empty. */
struct build_batch {
    enum batch_stage stage;
    struct structure_build *builds; ///< owned
    struct structure *smaller;      ///< owned; copies that take the memory they need
    VkDeviceSize *sizes;            ///< owned; ... which is known after the builds
    uint32_t count;
    struct gpu_buffer scratch;
    VkCommandPool pool;
    VkCommandBuffer commands;
    VkQueryPool queries;
    uint64_t value; ///< of structures.ready: what the commands under way signal
};

/**
 * Begins to build; no batch is under way. `builds` is copied, and its targets stay where they are
 * until the batch has ended. Says on stderr why it failed: then targets are empty.
 */
bool build_batch_begin(const struct gpu *gpu, struct structures *structures,
                       struct build_batch *batch, const struct structure_build *builds,
                       uint32_t count);
/**
 * Goes on to the copies of structures that were built with `compact`, and ends the batch after
 * them: its stage is BATCH_IDLE then. `waits` until that is so. No launch is under way that uses
 * the targets. Says on stderr why it failed.
 */
bool build_batch_continue(const struct gpu *gpu, struct structures *structures,
                          struct build_batch *batch, bool waits);
/** Waits for commands under way. */
void build_batch_finish(const struct gpu *gpu, struct structures *structures,
                        struct build_batch *batch);

#endif /* DEMAND_PBRT_BUILD_BATCH_H */
