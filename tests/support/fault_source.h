/** Wraps an image source, and lets its reads fail, delay, postpone or wait. Thread-safe. */
#ifndef TESTS_SUPPORT_FAULT_SOURCE_H
#define TESTS_SUPPORT_FAULT_SOURCE_H

#include <sluice/image.h>

#include <pthread.h>
#include <stdatomic.h>

struct fault_source {
    SluiceImageSource base;
    SluiceImageSource *inner; ///< not owned
    /** Settings. Set them before the first read. */
    uint64_t fail_at;           ///< number, from 1, of the read to fail; 0: none
    bool fails_on;              ///< true: later reads fail too
    SluiceResult failure;       ///< result of a failing read
    bool is_short;              ///< true: a failing read has written half of the rows
    uint64_t postponed;         ///< number of first reads that return NOT_READY
    const SluiceResult *script; ///< results of the first reads; SUCCESS passes the read on
    uint64_t script_length;
    int64_t unopened;  ///< number of first info queries that return `failure`
    uint32_t delay_us; ///< before every read
    /** Results. */
    atomic_uint_least64_t read_count;
    atomic_int_least64_t info_count;
    atomic_uint running, most_running; ///< reads at once
    /** Reads wait while true. fault_source_release ends it. */
    bool holds;
    uint32_t waiting; ///< reads that wait now
    pthread_mutex_t mutex;
    pthread_cond_t changed;
};

/** Initializes all fields to 0, except the inner source: passes everything on. */
void fault_source_init(struct fault_source *source, SluiceImageSource *inner);
void fault_source_finish(struct fault_source *source);

/** Waits until `count` reads are held. */
void fault_source_await(struct fault_source *source, uint32_t count);
/** Lets all reads continue. */
void fault_source_release(struct fault_source *source);

#endif /* TESTS_SUPPORT_FAULT_SOURCE_H */
