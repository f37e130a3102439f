/** The filters of FLIP: contrast sensitivity, edges and points; all are separable. */
#ifndef SLC_METRICS_FLIP_KERNELS_H
#define SLC_METRICS_FLIP_KERNELS_H

#include "metrics/window.h"

enum slc_flip_filter {
    SLC_FLIP_LUMINANCE,
    SLC_FLIP_RED_GREEN,
    SLC_FLIP_BLUE_YELLOW_NARROW,
    SLC_FLIP_BLUE_YELLOW_WIDE,
    SLC_FLIP_SMOOTH, ///< across the direction of EDGE and POINT
    SLC_FLIP_EDGE,   ///< first derivative of SMOOTH, its halves of sum -1 and 1
    SLC_FLIP_POINT,  ///< second derivative, its negative and its positive part of sum -1 and 1
    SLC_FLIP_FILTER_COUNT
};

struct slc_flip_kernels {
    struct slc_kernel filters[SLC_FLIP_FILTER_COUNT];
    double share_narrow; ///< share of the narrow term in blue-yellow; the wide term has the rest
    uint32_t radius;     ///< largest radius of all filters
    double *weights;     ///< weights of all filters
    size_t count;
};

/** `pixels_per_degree` in [1, 4096]. False if there is no memory. */
bool slc_flip_kernels_init(struct slc_flip_kernels *kernels,
                           const SluiceAllocationCallbacks *allocator, double pixels_per_degree);
void slc_flip_kernels_finish(struct slc_flip_kernels *kernels,
                             const SluiceAllocationCallbacks *allocator);

#endif /* SLC_METRICS_FLIP_KERNELS_H */
