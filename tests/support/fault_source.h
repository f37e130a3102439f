/** Wraps an image source and fails, delays, postpones or holds its reads. Any thread. */
#ifndef TESTS_SUPPORT_FAULT_SOURCE_H
#define TESTS_SUPPORT_FAULT_SOURCE_H

#include <sluice/image.h>

#include <pthread.h>
#include <stdatomic.h>

struct fault_source {
    SluiceImageSource base;
    SluiceImageSource *inner; ///< not owned
    /** What to do; set before the first read. */
    uint64_t fail_at;           ///< the read of this number, from 1, fails; 0: none
    bool fails_on;              ///< and so do all later ones
    SluiceResult failure;       ///< with this
    bool is_short;              ///< after having written half of the rows
    uint64_t postponed;         ///< so many reads answer NOT_READY first
    const SluiceResult *script; ///< what the first reads answer, SUCCESS passing them on
    uint64_t script_length;
    int64_t unopened;  ///< so many questions for the info answer `failure` first
    uint32_t delay_us; ///< before every read
    /** What happened. */
    atomic_uint_least64_t read_count;
    atomic_int_least64_t info_count;
    atomic_uint running, most_running; ///< reads at once
    /** Reads wait while this is true; fault_source_release ends it. */
    bool holds;
    uint32_t waiting; ///< reads that wait now
    pthread_mutex_t mutex;
    pthread_cond_t changed;
};

/** All zero but for the inner source: passes everything on. */
void fault_source_init(struct fault_source *source, SluiceImageSource *inner);
void fault_source_finish(struct fault_source *source);

/** Waits until `count` reads are held. */
void fault_source_await(struct fault_source *source, uint32_t count);
/** Lets all reads go on. */
void fault_source_release(struct fault_source *source);

#endif /* TESTS_SUPPORT_FAULT_SOURCE_H */
