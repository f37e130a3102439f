/** Job system of an application: own threads, or none; refuses or delays jobs if a test asks. */
#ifndef TESTS_SUPPORT_JOB_SYSTEM_H
#define TESTS_SUPPORT_JOB_SYSTEM_H

#include <sluice/base.h>

#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>

enum { JOB_SYSTEM_THREADS = 8, JOB_SYSTEM_ROOM = 64 };

/** Behavior of a job system. Do not change it before job_system_finish. */
struct job_system_habits {
    uint32_t thread_count; ///< 0: a job runs inside pfnSubmitJob
    uint32_t refuse_after; ///< Jobs that are taken before the first one is refused.
    uint32_t refuse_count; ///< Jobs that are refused then; UINT32_MAX: all.
    uint32_t delay_us;     ///< before a thread runs a job
};

struct job_system {
    SluiceJobSystem callbacks; ///< Give its address to a create info.
    struct job_system_habits habits;
    pthread_t threads[JOB_SYSTEM_THREADS];
    pthread_mutex_t mutex; ///< around the next ones
    pthread_cond_t changed;
    struct {
        void (*run)(void *job);
        void *job;
    } jobs[JOB_SYSTEM_ROOM];
    uint32_t first, count;
    bool ends;
    uint32_t submitted_count, refused_count;
};

void job_system_init(struct job_system *system, struct job_system_habits habits);
/** Runs the remaining jobs, and stops the threads. */
void job_system_finish(struct job_system *system);

#endif /* TESTS_SUPPORT_JOB_SYSTEM_H */
