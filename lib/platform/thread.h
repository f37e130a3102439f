/**
 * Threads, mutexes and conditions of the operating system.
 *
 * Embedded structs that do not move between init and finish. Init returns false for want of memory,
 * which Linux and Windows never do.
 */
#ifndef SLC_PLATFORM_THREAD_H
#define SLC_PLATFORM_THREAD_H

#include <stdbool.h>
#include <stdint.h>

#ifdef _WIN32
/* SRWLOCK and CONDITION_VARIABLE hold one pointer each; windows.h stays out of headers. */
typedef void *slc_native_mutex;
typedef void *slc_native_condition;
typedef void *slc_native_thread;
#define SLC_MUTEX_INITIALIZER                                                                      \
    {                                                                                              \
        0                                                                                          \
    }
#else
#include <pthread.h>
typedef pthread_mutex_t slc_native_mutex;
typedef pthread_cond_t slc_native_condition;
typedef pthread_t slc_native_thread;
#define SLC_MUTEX_INITIALIZER                                                                      \
    {                                                                                              \
        PTHREAD_MUTEX_INITIALIZER                                                                  \
    }
#endif

struct slc_mutex {
    slc_native_mutex native;
};

bool slc_mutex_init(struct slc_mutex *mutex);
/** Spins before it sleeps if the system can. For mutexes that are held for a moment, often. */
bool slc_mutex_init_spinning(struct slc_mutex *mutex);
/** Nobody holds it. */
void slc_mutex_finish(struct slc_mutex *mutex);
void slc_mutex_lock(struct slc_mutex *mutex);
void slc_mutex_unlock(struct slc_mutex *mutex);

struct slc_condition {
    slc_native_condition native;
};

bool slc_condition_init(struct slc_condition *condition);
/** Nobody waits. */
void slc_condition_finish(struct slc_condition *condition);
/** Waits with the mutex held, which is given up meanwhile. May return without a signal. */
void slc_condition_wait(struct slc_condition *condition, struct slc_mutex *mutex);
/** As slc_condition_wait, until slc_monotonic_time() is `time` at the latest. False: it is. */
bool slc_condition_wait_until(struct slc_condition *condition, struct slc_mutex *mutex,
                              uint64_t time);
/** Wakes one of the threads that wait. */
void slc_condition_signal(struct slc_condition *condition);
/** Wakes all threads that wait. */
void slc_condition_broadcast(struct slc_condition *condition);

/** Stays where it is until it is joined. */
struct slc_thread {
    slc_native_thread native;
    void *(*run)(void *argument);
    void *argument;
};

/** Starts a thread that calls `run`, whose result is not looked at. False: the system cannot. */
bool slc_thread_start(struct slc_thread *thread, void *(*run)(void *argument), void *argument);
/** Waits until `run` has returned, and frees the thread. */
void slc_thread_join(struct slc_thread *thread);

/** A number that no other running thread has. */
uint64_t slc_thread_id(void);

/** Processors that run threads now, at least 1. */
uint32_t slc_get_processor_count(void);

#endif /* SLC_PLATFORM_THREAD_H */
