/** What the driver alone reaches with the bytes of a fill: the floor under its time. */
#ifndef BENCH_VULKAN_FLOORS_H
#define BENCH_VULKAN_FLOORS_H

#include "bench.h"

struct floors {
    double copy;      ///< tiles per second, from a host-visible buffer to an ordinary image
    double bind;      ///< tile by tile; NaN without sparse residency
    double bind_runs; ///< rows of 16 tiles
};

bool measure_floors(const struct bench *bench, uint32_t tile_count, struct floors *floors);

#endif /* BENCH_VULKAN_FLOORS_H */
