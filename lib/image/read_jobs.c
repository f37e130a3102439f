#include "image/read_jobs.h"

#include "image/read_pool.h"
#include "platform/time_now.h"

bool slc_uses_jobs(const struct slc_read_pool *pool)
{
    return pool->jobs.system.pfnSubmitJob;
}

static bool can_start(const struct slc_read_pool *pool)
{
    return slc_read_pool_has_startable(pool) ||
           slc_read_pool_next_due(pool) <= slc_monotonic_time();
}

static bool is_running(const struct slc_read_jobs *jobs)
{
    return jobs->count > jobs->pending_count;
}

static void wake_waiters(struct slc_read_pool *pool)
{
    if (pool->jobs.waiter_count > 0)
        slc_condition_broadcast(&pool->idle);
}

void slc_read_jobs_want(struct slc_read_pool *pool)
{
    struct slc_read_jobs *jobs = &pool->jobs;
    if (!can_start(pool))
        return;
    if (!is_running(jobs))
        wake_waiters(pool);
    if (jobs->pending_count == 0 && jobs->count < jobs->max_count)
        jobs->wanted_count = 1;
}

/* True if another thread will submit the wanted job, perhaps not soon. */
static bool others_submit(const struct slc_read_jobs *jobs)
{
    return jobs->submitting && jobs->submitter != slc_thread_id();
}

static void run_job(void *argument)
{
    struct slc_read_pool *pool = argument;
    struct slc_read_jobs *jobs = &pool->jobs;
    bool has_read;
    slc_mutex_lock(&pool->mutex);
    jobs->pending_count--;
    do {
        do {
            has_read = slc_read_pool_read(pool);
        } while (has_read && others_submit(jobs));
        jobs->count--;
        slc_read_jobs_want(pool);
        slc_read_jobs_submit(pool);
        has_read &= jobs->refused && slc_read_pool_has_startable(pool);
        jobs->count += has_read; /* in place of the job that was refused */
    } while (has_read);
    if (jobs->count == 0)
        slc_condition_broadcast(&pool->idle);
    else
        wake_waiters(pool);
    slc_mutex_unlock(&pool->mutex);
}

void slc_read_jobs_submit(struct slc_read_pool *pool)
{
    struct slc_read_jobs *jobs = &pool->jobs;
    if (jobs->submitting || jobs->wanted_count == 0)
        return;
    jobs->submitting = true;
    jobs->submitter = slc_thread_id();
    while (jobs->wanted_count > 0) {
        jobs->wanted_count = 0;
        jobs->count++;
        jobs->pending_count++;
        slc_mutex_unlock(&pool->mutex);
        SluiceResult result = jobs->system.pfnSubmitJob(jobs->system.pUserData, run_job, pool);
        slc_mutex_lock(&pool->mutex);
        jobs->refused = result != SLUICE_SUCCESS;
        if (jobs->refused) {
            jobs->count--;
            jobs->pending_count--;
            jobs->wanted_count = 0;
        }
    }
    jobs->submitting = false;
    slc_condition_broadcast(&pool->idle);
}

bool slc_read_jobs_help(struct slc_read_pool *pool)
{
    if (is_running(&pool->jobs) || !slc_read_pool_read(pool))
        return false;
    slc_read_jobs_want(pool);
    slc_read_jobs_submit(pool);
    return true;
}

void slc_read_jobs_wait(struct slc_read_pool *pool, uint64_t until)
{
    if (slc_read_jobs_help(pool))
        return;
    /* The mutex was held until here: the caller's condition has not changed. */
    uint64_t due = slc_read_pool_next_due(pool);
    due = due < until ? due : until;
    pool->jobs.waiter_count++;
    if (due == UINT64_MAX)
        slc_condition_wait(&pool->idle, &pool->mutex);
    else
        slc_condition_wait_until(&pool->idle, &pool->mutex, due);
    pool->jobs.waiter_count--;
}

void slc_read_jobs_finish(struct slc_read_pool *pool)
{
    while (pool->jobs.count > 0 || pool->jobs.submitting)
        slc_condition_wait(&pool->idle, &pool->mutex);
}
