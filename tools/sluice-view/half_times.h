/** Times of one of the two pictures of a comparison, on the GPU and on the host. */
#ifndef SLUICE_VIEW_HALF_TIMES_H
#define SLUICE_VIEW_HALF_TIMES_H

#include <stdint.h>

#define HALF_TIMES_MOST 1024u
#define HALF_TIMES_SHOWN 64u

/** A ring of the last frames. A zeroed struct is empty. */
struct half_series {
    float values[HALF_TIMES_MOST]; ///< milliseconds
    uint64_t count;                ///< number of frames so far
};

struct half_times {
    struct half_series gpu, host;
};

void half_series_add(struct half_series *series, double seconds);
/** Number of known frames among the last `most`. */
uint32_t half_series_count(const struct half_series *series, uint32_t most);
/** Returns the median over the last `most` frames, in milliseconds. Negative: no frame is known. */
double half_series_median(const struct half_series *series, uint32_t most);

#endif /* SLUICE_VIEW_HALF_TIMES_H */
