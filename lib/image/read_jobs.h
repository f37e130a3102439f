/**
 * Jobs of the application that read in place of the threads of a pool.
 *
 * A job is submitted when a read may have become startable. It reads once, submits its successor
 * and returns. One thread submits at a time, so that jobs that run inside pfnSubmitJob do not nest.
 */
#ifndef SLC_IMAGE_READ_JOBS_H
#define SLC_IMAGE_READ_JOBS_H

#include <sluice/base.h>

#include <stdbool.h>
#include <stdint.h>

struct slc_read_pool;

/** Guarded by the pool's mutex. */
struct slc_read_jobs {
    SluiceJobSystem system; ///< Without a function: the pool has threads.
    uint32_t max_count;     ///< Jobs that read at the same time.
    uint32_t count;         ///< Jobs that are submitted and have not ended.
    uint32_t pending_count; ///< Jobs of `count` that have not begun.
    uint32_t wanted_count;  ///< Jobs to submit before the mutex is unlocked, 0 or 1.
    uint32_t waiter_count;  ///< Threads in slc_read_jobs_wait.
    bool refused;           ///< The last job was refused.
    bool submitting;        ///< `submitter` calls pfnSubmitJob.
    uint64_t submitter;     ///< slc_thread_id()
};

/** True if the pool reads in jobs. */
bool slc_uses_jobs(const struct slc_read_pool *pool);

/* All with the mutex held, for pools that read in jobs. */

/** Notes that a job is needed if a read can be started now. */
void slc_read_jobs_want(struct slc_read_pool *pool);
/** Submits the jobs that are needed. Releases the mutex in between. */
void slc_read_jobs_submit(struct slc_read_pool *pool);
/** Reads once if no job runs. False, at once, if there is nothing to read. */
bool slc_read_jobs_help(struct slc_read_pool *pool);
/** Waits for a change, or reads once if no job runs. Returns at slc_monotonic_time() `until` at the
 *  latest, or after that read. */
void slc_read_jobs_wait(struct slc_read_pool *pool, uint64_t until);
/** Waits until all submitted jobs have ended. No read is left. */
void slc_read_jobs_finish(struct slc_read_pool *pool);

#endif /* SLC_IMAGE_READ_JOBS_H */
