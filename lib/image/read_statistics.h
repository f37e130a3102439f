/** Statistics of one source, or of all sources of a loader. Not synchronized. */
#ifndef SLC_IMAGE_READ_STATISTICS_H
#define SLC_IMAGE_READ_STATISTICS_H

#include <sluice/loader.h>

#define SLC_LATENCY_BUCKETS 48

struct slc_read_statistics {
    SluiceTileLoaderStatistics counts; ///< its latencies are made when they are asked for
    uint64_t latency_sum;              ///< ns; saturates
    /** Bucket b: attempts of [2^b, 2^(b + 1)) ns; 0 and 1 ns in the first, all longer in the last.
     */
    uint64_t latencies[SLC_LATENCY_BUCKETS];
};

/** An attempt that took `latency` ns ended with `result`, an error at `offset`. */
void slc_read_statistics_add_attempt(struct slc_read_statistics *statistics, SluiceResult result,
                                     uint64_t offset, uint64_t latency);

/** A read ended for good, with `size` bytes if it succeeded. */
void slc_read_statistics_add_end(struct slc_read_statistics *statistics, SluiceResult result,
                                 uint64_t size);

/** The counts with the latencies. */
void slc_read_statistics_write(const struct slc_read_statistics *statistics,
                               SluiceTileLoaderStatistics *out);

#endif /* SLC_IMAGE_READ_STATISTICS_H */
