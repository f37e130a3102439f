/** Builds of acceleration structures on a queue that runs beside launches, if the device has
 * one. */
#ifndef DEMAND_PBRT_BUILD_BATCH_H
#define DEMAND_PBRT_BUILD_BATCH_H

#include "structures.h"

enum batch_stage { BATCH_IDLE, BATCH_BUILDS, BATCH_COPIES };

/** Batch of builds. Only one may run at a time. Zeroed is empty. */
struct build_batch {
    enum batch_stage stage;
    struct structure_build *builds; ///< owned
    struct structure *smaller;      ///< owned; sizes of the copies in bytes, known after the builds
    VkDeviceSize *sizes; ///< owned; bytes of the compacted copies, known after the builds
    uint32_t count;
    struct gpu_buffer scratch;
    VkCommandPool pool;
    VkCommandBuffer commands;
    VkQueryPool queries;
    uint64_t value; ///< value of structures.ready that the submitted commands signal
};

/**
 * Begins to build. Call only when no batch is running. Copies `builds`. The targets must stay where
 * they are until the batch has ended. Reports errors on stderr; targets are empty then.
 */
bool build_batch_begin(const struct gpu *gpu, struct structures *structures,
                       struct build_batch *batch, const struct structure_build *builds,
                       uint32_t count);
/**
 * Continues with compacting copies of structures built with `compact`, then ends the batch: its
 * stage becomes BATCH_IDLE. `waits`: wait for the end. Call only while no launch uses the targets.
 * Reports errors on stderr.
 */
bool build_batch_continue(const struct gpu *gpu, struct structures *structures,
                          struct build_batch *batch, bool waits);
/** Waits for running commands, then frees the batch. */
void build_batch_finish(const struct gpu *gpu, struct structures *structures,
                        struct build_batch *batch);

#endif /* DEMAND_PBRT_BUILD_BATCH_H */
