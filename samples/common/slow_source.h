/**
 * Image sources behind a slow line, as if their files were on a disk or in a network: reads take a
 * latency and share a bandwidth. Nothing waits in them; what has not come yet answers
 * SLUICE_NOT_READY, so that any number of reads can be on their way.
 */
#ifndef SAMPLES_COMMON_SLOW_SOURCE_H
#define SAMPLES_COMMON_SLOW_SOURCE_H

#include <sluice/image.h>

#include <pthread.h>
#include <stdbool.h>

/** Microseconds; never goes back. Any thread. */
typedef uint64_t (*slow_clock)(void *user_data);

struct slow_line_info {
    double latency;   ///< microseconds, from 0 on
    double bandwidth; ///< bytes per microsecond (MB/s), above 0; 0: no limit
    slow_clock clock;
    void *user_data; ///< of the clock
};

/** What sources share. */
struct slow_line {
    struct slow_line_info info;
    pthread_mutex_t mutex; ///< around all below, and the reads that its sources know
    double free_at;        ///< when all that was asked for is through
};

/** False for want of a mutex. */
bool slow_line_init(struct slow_line *line, const struct slow_line_info *info);
/** After all its sources are destroyed. */
void slow_line_finish(struct slow_line *line);

/**
 * Wraps `inner`, which is borrowed, as is the line. A region is first put behind what other reads
 * asked for; it has gone through the line when its bytes have, and one latency later it is there.
 * Until then reads of it answer NOT_READY, then they get it from `inner`. It stays there until a
 * second has passed without a read of it: reads of several regions begin anew where one of them has
 * not come. A level that is asked for whole brings the coarser ones with it, which are read with
 * it. Any thread. Errors: OUT_OF_HOST_MEMORY, of reads also; what `inner` says.
 */
SluiceResult slow_source_create(struct slow_line *line, SluiceImageSource *inner,
                                SluiceImageSource **source);

#endif /* SAMPLES_COMMON_SLOW_SOURCE_H */
