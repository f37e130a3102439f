/** Thread pool with a queue of small jobs. Waiting threads run jobs, too. */
#ifndef SLC_BAKE_WORK_POOL_H
#define SLC_BAKE_WORK_POOL_H

#include <sluice/base.h>

#include "platform/thread.h"

/** Job, embedded in the caller's struct. The pool does not access the job after calling `run`. */
struct slc_job {
    struct slc_job *next;
    void (*run)(struct slc_job *job);
};

struct slc_bake_jobs {
    SluiceAllocationCallbacks allocator;
    struct slc_mutex mutex;
    struct slc_condition changed; ///< a job was added or ended, or `ends` is set
    struct slc_job *first, *last;
    bool ends;
    uint32_t thread_count;
    struct slc_thread *threads;
};

/** Starts threads. `thread_count` 0: waiting threads run all jobs. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_bake_jobs_init(struct slc_bake_jobs *jobs, const SluiceAllocationCallbacks *cb,
                                uint32_t thread_count);
/** Ends the threads. The queue must be empty. */
void slc_bake_jobs_finish(struct slc_bake_jobs *jobs);

void slc_bake_jobs_submit(struct slc_bake_jobs *jobs, struct slc_job *job);

/** Wakes waiting threads. Call it after changing their condition under the mutex. */
void slc_bake_jobs_lock(struct slc_bake_jobs *jobs);
void slc_bake_jobs_unlock_and_wake(struct slc_bake_jobs *jobs);

/** Runs a job, or waits some milliseconds at most for a change. Returns at once if `is_done`, which
 * is called under the mutex. */
void slc_bake_jobs_help_a_while(struct slc_bake_jobs *jobs, bool (*is_done)(void *user),
                                void *user);
/** Runs jobs until `is_done`, which is called under the mutex. */
void slc_bake_jobs_help_until(struct slc_bake_jobs *jobs, bool (*is_done)(void *user), void *user);

#endif /* SLC_BAKE_WORK_POOL_H */
