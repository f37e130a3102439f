/** A cold fill: everything that textures want is loaded as fast as it can be. */
#ifndef BENCH_VULKAN_FILL_H
#define BENCH_VULKAN_FILL_H

#include "rig.h"

struct fill_times {
    double seconds, host_seconds, host_cpu_seconds, gpu_seconds;
    uint64_t frames, binds;
};

/** RGBA8 textures, 437 MB of which are wanted. */
struct rig_info fill_info(const struct bench *bench, uint32_t tiles_per_frame);
/** The best of three. `*tile_count`: regular and packed tiles of all textures. */
bool fill_best(const struct rig_info *info, struct fill_times *times, uint64_t *tile_count);

#endif /* BENCH_VULKAN_FILL_H */
