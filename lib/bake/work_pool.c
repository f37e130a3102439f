#include "bake/work_pool.h"

#include "base/alloc.h"
#include "platform/time_now.h"

#include <assert.h>

#define A_WHILE 20000000 /* nanoseconds */

static struct slc_job *take(struct slc_bake_jobs *jobs)
{
    struct slc_job *job = jobs->first;
    if (job) {
        jobs->first = job->next;
        if (!jobs->first)
            jobs->last = NULL;
    }
    return job;
}

static void run_unlocked(struct slc_bake_jobs *jobs, struct slc_job *job)
{
    slc_mutex_unlock(&jobs->mutex);
    job->run(job);
    slc_mutex_lock(&jobs->mutex);
}

void slc_bake_jobs_help_until(struct slc_bake_jobs *jobs, bool (*is_done)(void *user), void *user)
{
    slc_mutex_lock(&jobs->mutex);
    while (!is_done(user)) {
        struct slc_job *job = take(jobs);
        if (job)
            run_unlocked(jobs, job);
        else
            slc_condition_wait(&jobs->changed, &jobs->mutex);
    }
    slc_mutex_unlock(&jobs->mutex);
}

void slc_bake_jobs_help_a_while(struct slc_bake_jobs *jobs, bool (*is_done)(void *user), void *user)
{
    uint64_t until = slc_monotonic_time() + A_WHILE;
    slc_mutex_lock(&jobs->mutex);
    struct slc_job *job = is_done(user) ? NULL : take(jobs);
    if (job)
        run_unlocked(jobs, job);
    else if (!is_done(user))
        slc_condition_wait_until(&jobs->changed, &jobs->mutex, until);
    slc_mutex_unlock(&jobs->mutex);
}

static bool ends(void *user)
{
    const struct slc_bake_jobs *jobs = user;
    return jobs->ends;
}

static void *work(void *user)
{
    slc_bake_jobs_help_until(user, ends, user);
    return NULL;
}

SluiceResult slc_bake_jobs_init(struct slc_bake_jobs *jobs, const SluiceAllocationCallbacks *cb,
                                uint32_t thread_count)
{
    *jobs = (struct slc_bake_jobs){.allocator = *cb};
    slc_mutex_init(&jobs->mutex);
    slc_condition_init(&jobs->changed);
    if (thread_count == 0)
        return SLUICE_SUCCESS;
    jobs->threads = slc_alloc(cb, thread_count, sizeof *jobs->threads);
    bool is_complete = jobs->threads != NULL;
    for (uint32_t i = 0; i < thread_count && is_complete; i++) {
        is_complete = slc_thread_start(&jobs->threads[i], work, jobs);
        jobs->thread_count += is_complete;
    }
    if (is_complete)
        return SLUICE_SUCCESS;
    slc_bake_jobs_lock(jobs);
    jobs->ends = true;
    slc_bake_jobs_unlock_and_wake(jobs);
    for (uint32_t i = 0; i < jobs->thread_count; i++)
        slc_thread_join(&jobs->threads[i]);
    slc_free(cb, jobs->threads, thread_count, sizeof *jobs->threads);
    slc_condition_finish(&jobs->changed);
    slc_mutex_finish(&jobs->mutex);
    return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

void slc_bake_jobs_finish(struct slc_bake_jobs *jobs)
{
    assert(!jobs->first);
    slc_bake_jobs_lock(jobs);
    jobs->ends = true;
    slc_bake_jobs_unlock_and_wake(jobs);
    for (uint32_t i = 0; i < jobs->thread_count; i++)
        slc_thread_join(&jobs->threads[i]);
    slc_free(&jobs->allocator, jobs->threads, jobs->thread_count, sizeof *jobs->threads);
    slc_condition_finish(&jobs->changed);
    slc_mutex_finish(&jobs->mutex);
}

void slc_bake_jobs_submit(struct slc_bake_jobs *jobs, struct slc_job *job)
{
    job->next = NULL;
    slc_bake_jobs_lock(jobs);
    if (jobs->last)
        jobs->last->next = job;
    else
        jobs->first = job;
    jobs->last = job;
    slc_bake_jobs_unlock_and_wake(jobs);
}

void slc_bake_jobs_lock(struct slc_bake_jobs *jobs)
{
    slc_mutex_lock(&jobs->mutex);
}

void slc_bake_jobs_unlock_and_wake(struct slc_bake_jobs *jobs)
{
    slc_condition_broadcast(&jobs->changed);
    slc_mutex_unlock(&jobs->mutex);
}
