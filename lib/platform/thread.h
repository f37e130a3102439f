/**
 * Threads, mutexes and conditions of the operating system.
 *
 * Structs are embedded and must not move between init and finish. Init returns false if out of
 * memory; this does not happen on Linux and Windows.
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
/** Initializes a mutex that spins before sleeping, if supported. For frequent short locks. */
bool slc_mutex_init_spinning(struct slc_mutex *mutex);
/** Destroys the mutex, which no thread may hold. */
void slc_mutex_finish(struct slc_mutex *mutex);
void slc_mutex_lock(struct slc_mutex *mutex);
void slc_mutex_unlock(struct slc_mutex *mutex);

struct slc_condition {
    slc_native_condition native;
};

bool slc_condition_init(struct slc_condition *condition);
/** Destroys the condition. No thread may wait. */
void slc_condition_finish(struct slc_condition *condition);
/** Unlocks the mutex, waits, and locks again. May return without a signal. */
void slc_condition_wait(struct slc_condition *condition, struct slc_mutex *mutex);
/** slc_condition_wait with a time limit for slc_monotonic_time(). False: the time has passed. */
bool slc_condition_wait_until(struct slc_condition *condition, struct slc_mutex *mutex,
                              uint64_t time);
/** Wakes one waiting thread. */
void slc_condition_signal(struct slc_condition *condition);
/** Wakes all waiting threads. */
void slc_condition_broadcast(struct slc_condition *condition);

/** Thread. Must not move until joined. */
struct slc_thread {
    slc_native_thread native;
    void *(*run)(void *argument);
    void *argument;
};

/** Starts a thread that calls `run` and ignores its result. False: failure. */
bool slc_thread_start(struct slc_thread *thread, void *(*run)(void *argument), void *argument);
/** Waits until `run` has returned, and frees the thread. */
void slc_thread_join(struct slc_thread *thread);

/** Returns a number, unique among running threads. */
uint64_t slc_thread_id(void);

/** Returns the number of available processors, at least 1. */
uint32_t slc_get_processor_count(void);

#endif /* SLC_PLATFORM_THREAD_H */
