/** Driver's rate for the bytes of a fill: a lower bound of its time. */
#ifndef BENCH_VULKAN_FLOORS_H
#define BENCH_VULKAN_FLOORS_H

#include "bench.h"

struct floors {
    double copy;      ///< tiles per second from a host-visible buffer to an ordinary image
    double bind;      ///< tiles per second, bound one by one; NaN without sparse residency
    double bind_runs; ///< tiles per second, bound in rows of 16
};

bool measure_floors(const struct bench *bench, uint32_t tile_count, struct floors *floors);

#endif /* BENCH_VULKAN_FLOORS_H */
