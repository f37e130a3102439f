/** Rows of pictures for metrics: luma or linear RGB, in [0, 1]. */
#ifndef SLC_METRICS_PIXEL_ROWS_H
#define SLC_METRICS_PIXEL_ROWS_H

#include <sluice/metrics.h>

/** One picture of a pair, checked. */
struct slc_metric_picture {
    const unsigned char *pixels;
    size_t row_pitch; ///< bytes
    uint32_t width;
    SluicePixelFormat format;
    double peak;
    double linear[256]; ///< light of each encoded value
};

/**
 * Checks all arguments of a caller. `map` and `allocator` may be NULL. Fills both pictures, and
 * `pair` with `given` in this version's size.
 */
SluiceResult slc_picture_pair_init(struct slc_metric_picture pictures[2],
                                   const SluicePicturePair *given, SluicePicturePair *pair,
                                   const SluiceMetricMap *map,
                                   const SluiceAllocationCallbacks *allocator);

/** Encoded luma of RGBA8, else linear luma over the peak. */
void slc_picture_read_luma(const struct slc_metric_picture *picture, uint32_t y, double *luma);

/** Linear light, [width][3]. */
void slc_picture_read_rgb(const struct slc_metric_picture *picture, uint32_t y, double *rgb);

/** Tells whether row y of both pictures has the same bytes. */
bool slc_picture_row_is_equal(const struct slc_metric_picture pictures[2], uint32_t y);

/** Writes row y, converted to float. Does nothing if the map is NULL. */
void slc_metric_map_write(const SluiceMetricMap *map, uint32_t width, uint32_t y,
                          const double *values);

#endif /* SLC_METRICS_PIXEL_ROWS_H */
