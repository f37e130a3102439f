#define _GNU_SOURCE /* mutexes that spin before they sleep */

#include "platform/thread.h"

#include "platform/time_now.h"
#include "platform/rw_lock.h"

#include <errno.h>
#include <time.h>
#include <unistd.h>

#define SECOND 1000000000u /* nanoseconds */

uint64_t slc_monotonic_time(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * SECOND + (uint64_t)now.tv_nsec;
}

bool slc_mutex_init(struct slc_mutex *mutex)
{
    return pthread_mutex_init(&mutex->native, NULL) == 0;
}

bool slc_mutex_init_spinning(struct slc_mutex *mutex)
{
#ifdef PTHREAD_ADAPTIVE_MUTEX_INITIALIZER_NP
    pthread_mutexattr_t attributes;
    pthread_mutexattr_init(&attributes);
    pthread_mutexattr_settype(&attributes, PTHREAD_MUTEX_ADAPTIVE_NP);
    bool is_made = pthread_mutex_init(&mutex->native, &attributes) == 0;
    pthread_mutexattr_destroy(&attributes);
    return is_made;
#else
    return slc_mutex_init(mutex);
#endif
}

void slc_mutex_finish(struct slc_mutex *mutex)
{
    pthread_mutex_destroy(&mutex->native);
}

void slc_mutex_lock(struct slc_mutex *mutex)
{
    pthread_mutex_lock(&mutex->native);
}

void slc_mutex_unlock(struct slc_mutex *mutex)
{
    pthread_mutex_unlock(&mutex->native);
}

/* macOS: conditions cannot select a clock, so waits use a duration. */
#ifdef __APPLE__
bool slc_condition_init(struct slc_condition *condition)
{
    return pthread_cond_init(&condition->native, NULL) == 0;
}

bool slc_condition_wait_until(struct slc_condition *condition, struct slc_mutex *mutex,
                              uint64_t time)
{
    uint64_t now = slc_monotonic_time(), rest = time > now ? time - now : 0;
    struct timespec duration = {(time_t)(rest / SECOND), (long)(rest % SECOND)};
    return pthread_cond_timedwait_relative_np(&condition->native, &mutex->native, &duration) !=
           ETIMEDOUT;
}
#else
bool slc_condition_init(struct slc_condition *condition)
{
    pthread_condattr_t attributes;
    if (pthread_condattr_init(&attributes) != 0)
        return false;
    bool is_made = pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC) == 0 &&
                   pthread_cond_init(&condition->native, &attributes) == 0;
    pthread_condattr_destroy(&attributes);
    return is_made;
}

bool slc_condition_wait_until(struct slc_condition *condition, struct slc_mutex *mutex,
                              uint64_t time)
{
    struct timespec until = {(time_t)(time / SECOND), (long)(time % SECOND)};
    return pthread_cond_timedwait(&condition->native, &mutex->native, &until) != ETIMEDOUT;
}
#endif

void slc_condition_finish(struct slc_condition *condition)
{
    pthread_cond_destroy(&condition->native);
}

void slc_condition_wait(struct slc_condition *condition, struct slc_mutex *mutex)
{
    pthread_cond_wait(&condition->native, &mutex->native);
}

void slc_condition_signal(struct slc_condition *condition)
{
    pthread_cond_signal(&condition->native);
}

void slc_condition_broadcast(struct slc_condition *condition)
{
    pthread_cond_broadcast(&condition->native);
}

bool slc_rw_lock_init(struct slc_rw_lock *lock)
{
    return pthread_rwlock_init(&lock->native, NULL) == 0;
}

void slc_rw_lock_finish(struct slc_rw_lock *lock)
{
    pthread_rwlock_destroy(&lock->native);
}

void slc_rw_lock_read(struct slc_rw_lock *lock)
{
    pthread_rwlock_rdlock(&lock->native);
}

void slc_rw_lock_end_read(struct slc_rw_lock *lock)
{
    pthread_rwlock_unlock(&lock->native);
}

void slc_rw_lock_write(struct slc_rw_lock *lock)
{
    pthread_rwlock_wrlock(&lock->native);
}

void slc_rw_lock_end_write(struct slc_rw_lock *lock)
{
    pthread_rwlock_unlock(&lock->native);
}

bool slc_thread_start(struct slc_thread *thread, void *(*run)(void *argument), void *argument)
{
    thread->run = run;
    thread->argument = argument;
    return pthread_create(&thread->native, NULL, run, argument) == 0;
}

void slc_thread_join(struct slc_thread *thread)
{
    pthread_join(thread->native, NULL);
}

uint64_t slc_thread_id(void)
{
    return (uint64_t)(uintptr_t)pthread_self();
}

uint32_t slc_get_processor_count(void)
{
    long count = sysconf(_SC_NPROCESSORS_ONLN);
    return count > 0 ? (uint32_t)count : 1;
}
