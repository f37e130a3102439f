#define _POSIX_C_SOURCE 200809L

#include "support/job_system.h"

#include "support/test.h"

#include <time.h>

/* Call with the mutex held. It is unlocked while the job runs. */
static void run_first(struct job_system *system)
{
    uint32_t at = system->first;
    void (*run)(void *) = system->jobs[at].run;
    void *job = system->jobs[at].job;
    system->first = (at + 1) % JOB_SYSTEM_ROOM;
    system->count--;
    pthread_mutex_unlock(&system->mutex);
    if (system->habits.delay_us) {
        struct timespec delay = {0, (long)system->habits.delay_us * 1000};
        nanosleep(&delay, NULL);
    }
    run(job);
    pthread_mutex_lock(&system->mutex);
}

static void *run_jobs(void *user)
{
    struct job_system *system = user;
    pthread_mutex_lock(&system->mutex);
    while (system->count > 0 || !system->ends)
        if (system->count > 0)
            run_first(system);
        else
            pthread_cond_wait(&system->changed, &system->mutex);
    pthread_mutex_unlock(&system->mutex);
    return NULL;
}

static SluiceResult submit(void *user, void (*run)(void *), void *job)
{
    struct job_system *system = user;
    const struct job_system_habits *habits = &system->habits;
    pthread_mutex_lock(&system->mutex);
    bool refused = system->submitted_count >= habits->refuse_after &&
                   system->refused_count < habits->refuse_count;
    system->submitted_count += !refused;
    system->refused_count += refused;
    if (!refused) {
        uint32_t at = (system->first + system->count++) % JOB_SYSTEM_ROOM;
        system->jobs[at].run = run;
        system->jobs[at].job = job;
    }
    if (!refused && habits->thread_count == 0)
        run_first(system);
    pthread_cond_signal(&system->changed);
    pthread_mutex_unlock(&system->mutex);
    return refused ? SLUICE_ERROR_OUT_OF_HOST_MEMORY : SLUICE_SUCCESS;
}

void job_system_init(struct job_system *system, struct job_system_habits habits)
{
    *system = (struct job_system){.habits = habits, .callbacks = {system, submit}};
    pthread_mutex_init(&system->mutex, NULL);
    pthread_cond_init(&system->changed, NULL);
    for (uint32_t i = 0; i < habits.thread_count; i++)
        assert_int_equal(pthread_create(&system->threads[i], NULL, run_jobs, system), 0);
}

void job_system_finish(struct job_system *system)
{
    pthread_mutex_lock(&system->mutex);
    system->ends = true;
    pthread_cond_broadcast(&system->changed);
    pthread_mutex_unlock(&system->mutex);
    for (uint32_t i = 0; i < system->habits.thread_count; i++)
        pthread_join(system->threads[i], NULL);
    pthread_cond_destroy(&system->changed);
    pthread_mutex_destroy(&system->mutex);
}
