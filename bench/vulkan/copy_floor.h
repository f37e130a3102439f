/** The driver's copies alone: what no cold fill of tiles can beat. */
#ifndef BENCH_VULKAN_COPY_FLOOR_H
#define BENCH_VULKAN_COPY_FLOOR_H

#include "../../tools/common/gpu.h"

/** Tiles of 64 KiB per second, from host memory to an RGBA8 image. */
bool measure_copy_floor(const struct gpu *gpu, uint32_t tile_count, double *rate);

#endif /* BENCH_VULKAN_COPY_FLOOR_H */
