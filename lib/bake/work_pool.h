/** A pool of threads and a queue of small pieces of work, which those who wait help with. */
#ifndef SLC_BAKE_WORK_POOL_H
#define SLC_BAKE_WORK_POOL_H

#include <sluice/base.h>

#include "platform/thread.h"

/** Embedded in what it works on; not touched any more once `run` is called. */
struct slc_job {
    struct slc_job *next;
    void (*run)(struct slc_job *job);
};

struct slc_bake_jobs {
    SluiceAllocationCallbacks allocator;
    struct slc_mutex mutex;
    struct slc_condition changed; ///< a job came or ended, or `ends`
    struct slc_job *first, *last;
    bool ends;
    uint32_t thread_count;
    struct slc_thread *threads;
};

/** `thread_count` may be 0: then waiters do everything. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_bake_jobs_init(struct slc_bake_jobs *jobs, const SluiceAllocationCallbacks *cb,
                                uint32_t thread_count);
/** Nothing is queued. */
void slc_bake_jobs_finish(struct slc_bake_jobs *jobs);

void slc_bake_jobs_submit(struct slc_bake_jobs *jobs, struct slc_job *job);

/** Wakes those who wait, after what they wait for has changed under the mutex. */
void slc_bake_jobs_lock(struct slc_bake_jobs *jobs);
void slc_bake_jobs_unlock_and_wake(struct slc_bake_jobs *jobs);

/** Runs a job, or waits for a change, some milliseconds at most; does neither if `is_done`, which
 *  is called under the mutex. */
void slc_bake_jobs_help_a_while(struct slc_bake_jobs *jobs, bool (*is_done)(void *user),
                                void *user);
/** Returns when `is_done`, which is called under the mutex; runs jobs until then. */
void slc_bake_jobs_help_until(struct slc_bake_jobs *jobs, bool (*is_done)(void *user), void *user);

#endif /* SLC_BAKE_WORK_POOL_H */
