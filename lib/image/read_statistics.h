/** Statistics of one source, or of all sources of a loader. Not synchronized. */
#ifndef SLC_IMAGE_READ_STATISTICS_H
#define SLC_IMAGE_READ_STATISTICS_H

#include <sluice/loader.h>

#define SLC_LATENCY_BUCKETS 48

struct slc_read_statistics {
    SluiceTileLoaderStatistics counts; ///< latencies are computed on request
    uint64_t latency_sum;              ///< ns; saturates
    /** Bucket b: attempts of [2^b, 2^(b + 1)) ns. 0 ns is in the first, all longer ones in the
     * last.
     */
    uint64_t latencies[SLC_LATENCY_BUCKETS];
};

/** Counts an attempt of `latency` ns that ended with `result`, an error at `offset`. */
void slc_read_statistics_add_attempt(struct slc_read_statistics *statistics, SluiceResult result,
                                     uint64_t offset, uint64_t latency);

/** Counts the end of a read, with `size` bytes if it succeeded. */
void slc_read_statistics_add_end(struct slc_read_statistics *statistics, SluiceResult result,
                                 uint64_t size);

/** Writes counts and latencies. */
void slc_read_statistics_write(const struct slc_read_statistics *statistics,
                               SluiceTileLoaderStatistics *out);

#endif /* SLC_IMAGE_READ_STATISTICS_H */
