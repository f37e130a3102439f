/**
 * Image sources that simulate a slow disk or network. Reads take a latency, and all sources share a
 * bandwidth. No call blocks: a read whose data has not arrived returns SLUICE_NOT_READY. Any number
 * of reads may be pending.
 */
#ifndef SAMPLES_COMMON_SLOW_SOURCE_H
#define SAMPLES_COMMON_SLOW_SOURCE_H

#include <sluice/image.h>

#include <pthread.h>
#include <stdbool.h>

/** Returns microseconds. Never decreases. Thread-safe. */
typedef uint64_t (*slow_clock)(void *user_data);

struct slow_line_info {
    double latency;   ///< microseconds; 0 or more
    double bandwidth; ///< bytes per microsecond (MB/s), above 0; 0: no limit
    slow_clock clock;
    void *user_data; ///< argument of the clock
};

/** State that all sources of a line share. */
struct slow_line {
    struct slow_line_info info;
    pthread_mutex_t mutex; ///< guards all fields below and the sources' lists of reads
    double free_at;        ///< time when all requested bytes have been transferred
};

/** Returns false if no mutex can be created. */
bool slow_line_init(struct slow_line *line, const struct slow_line_info *info);
/** Call after all sources of the line are destroyed. */
void slow_line_finish(struct slow_line *line);

/**
 * Creates a source that delays the reads of `inner`. `line` and `inner` must outlive it.
 *
 * The first read of a region queues its bytes behind all earlier reads. The region arrives one
 * latency after its last byte. Until then reads of it return SLUICE_NOT_READY; afterwards they read
 * from `inner`. A region is forgotten one second after its last read. A read of several regions
 * starts again if one of them has not arrived. A read of a whole level also brings the coarser
 * levels that are read with it.
 *
 * Thread-safe. Errors: SLUICE_ERROR_OUT_OF_HOST_MEMORY, also from reads; errors of `inner`.
 */
SluiceResult slow_source_create(struct slow_line *line, SluiceImageSource *inner,
                                SluiceImageSource **source);

#endif /* SAMPLES_COMMON_SLOW_SOURCE_H */
