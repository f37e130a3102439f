#define _POSIX_C_SOURCE 200809L

#include "bake/work_pool.h"

#include "base/alloc.h"

#include <assert.h>
#include <time.h>

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
    pthread_mutex_unlock(&jobs->mutex);
    job->run(job);
    pthread_mutex_lock(&jobs->mutex);
}

void slc_bake_jobs_help_until(struct slc_bake_jobs *jobs, bool (*is_done)(void *user), void *user)
{
    pthread_mutex_lock(&jobs->mutex);
    while (!is_done(user)) {
        struct slc_job *job = take(jobs);
        if (job)
            run_unlocked(jobs, job);
        else
            pthread_cond_wait(&jobs->changed, &jobs->mutex);
    }
    pthread_mutex_unlock(&jobs->mutex);
}

void slc_bake_jobs_help_a_while(struct slc_bake_jobs *jobs, bool (*is_done)(void *user), void *user)
{
    struct timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_nsec += A_WHILE;
    if (until.tv_nsec >= 1000000000) {
        until.tv_nsec -= 1000000000;
        until.tv_sec++;
    }
    pthread_mutex_lock(&jobs->mutex);
    struct slc_job *job = is_done(user) ? NULL : take(jobs);
    if (job)
        run_unlocked(jobs, job);
    else if (!is_done(user))
        pthread_cond_timedwait(&jobs->changed, &jobs->mutex, &until);
    pthread_mutex_unlock(&jobs->mutex);
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
    pthread_mutex_init(&jobs->mutex, NULL);
    pthread_cond_init(&jobs->changed, NULL);
    if (thread_count == 0)
        return SLUICE_SUCCESS;
    jobs->threads = slc_alloc(cb, thread_count, sizeof *jobs->threads);
    bool is_complete = jobs->threads != NULL;
    for (uint32_t i = 0; i < thread_count && is_complete; i++) {
        is_complete = pthread_create(&jobs->threads[i], NULL, work, jobs) == 0;
        jobs->thread_count += is_complete;
    }
    if (is_complete)
        return SLUICE_SUCCESS;
    slc_bake_jobs_lock(jobs);
    jobs->ends = true;
    slc_bake_jobs_unlock_and_wake(jobs);
    for (uint32_t i = 0; i < jobs->thread_count; i++)
        pthread_join(jobs->threads[i], NULL);
    slc_free(cb, jobs->threads, thread_count, sizeof *jobs->threads);
    pthread_cond_destroy(&jobs->changed);
    pthread_mutex_destroy(&jobs->mutex);
    return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

void slc_bake_jobs_finish(struct slc_bake_jobs *jobs)
{
    assert(!jobs->first);
    slc_bake_jobs_lock(jobs);
    jobs->ends = true;
    slc_bake_jobs_unlock_and_wake(jobs);
    for (uint32_t i = 0; i < jobs->thread_count; i++)
        pthread_join(jobs->threads[i], NULL);
    slc_free(&jobs->allocator, jobs->threads, jobs->thread_count, sizeof *jobs->threads);
    pthread_cond_destroy(&jobs->changed);
    pthread_mutex_destroy(&jobs->mutex);
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
    pthread_mutex_lock(&jobs->mutex);
}

void slc_bake_jobs_unlock_and_wake(struct slc_bake_jobs *jobs)
{
    pthread_cond_broadcast(&jobs->changed);
    pthread_mutex_unlock(&jobs->mutex);
}
