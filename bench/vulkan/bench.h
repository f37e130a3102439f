/** Shared by the measurements: the device, the settings, and one line of output per figure. */
#ifndef BENCH_VULKAN_BENCH_H
#define BENCH_VULKAN_BENCH_H

#include "../../tools/common/gpu.h"
#include "../manager/figures.h"

struct bench {
    struct gpu gpu;
    SluiceResidencyMode mode;
    const char *mode_name;
    uint32_t size[2];      ///< picture size in pixels
    uint32_t texture_size; ///< size of the scenes' square texture in texels
    uint32_t threads;      ///< loader threads; 0: the library's default
    bool wall;             ///< time stamps are unusable: wall time, with one submission per part
};

/** Prints "mode.name value unit". The name takes printf arguments. */
__attribute__((format(printf, 4, 5))) void report(const struct bench *bench, double value,
                                                  const char *unit, const char *name, ...);

/** Returns whether `result` is SLUICE_SUCCESS or a positive code. Otherwise reports it on
 * stderr. */
bool check(SluiceResult result, const char *what);

/** Returns the first allowed memory type in device memory. */
uint32_t device_local_type(const struct gpu *gpu, uint32_t allowed);

/** Returns the median in the unit of the samples; NaN without samples. */
double median(struct samples *samples);
/** Returns the median, or the minimum of wall times, which disturbances only lengthen. */
double typical(const struct bench *bench, struct samples *samples);

typedef bool measurement(const struct bench *bench);
measurement measure_sampling, measure_feedback, measure_fill, measure_produce, measure_budget,
    measure_resolve, measure_host, measure_sharp, measure_unseen, measure_small;

#endif /* BENCH_VULKAN_BENCH_H */
