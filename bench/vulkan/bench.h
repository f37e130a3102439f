/** What the measurements share: the device, the settings, and one line of output per figure. */
#ifndef BENCH_VULKAN_BENCH_H
#define BENCH_VULKAN_BENCH_H

#include "../../tools/common/gpu.h"
#include "../manager/figures.h"

struct bench {
    struct gpu gpu;
    SluiceResidencyMode mode;
    const char *mode_name;
    uint32_t size[2];      ///< of pictures, in pixels
    uint32_t texture_size; ///< of what scenes show, in texels; square
    uint32_t threads;      ///< that load; 0: as the library does
    bool wall;             ///< time stamps are no use: wall time, and one submission per part
};

/** Prints "mode.name value unit"; the name is printf-like. */
__attribute__((format(printf, 4, 5))) void report(const struct bench *bench, double value,
                                                  const char *unit, const char *name, ...);

/** Prints to stderr what it is about, and returns false unless `result` is a success or news. */
bool check(SluiceResult result, const char *what);

/** The first allowed memory type in device memory. */
uint32_t device_local_type(const struct gpu *gpu, uint32_t allowed);

/** Median in the unit of the samples; NaN if there are none. */
double median(struct samples *samples);
/** The same, but of wall times the least: what disturbs them only makes them longer. */
double typical(const struct bench *bench, struct samples *samples);

typedef bool measurement(const struct bench *bench);
measurement measure_sampling, measure_feedback, measure_fill, measure_produce, measure_budget,
    measure_resolve, measure_host, measure_sharp, measure_unseen, measure_small;

#endif /* BENCH_VULKAN_BENCH_H */
