#include "platform/thread.h"

#include "platform/time_now.h"
#include "platform/rw_lock.h"

#include <process.h>
#include <windows.h>

#define SECOND 1000000000u /* nanoseconds */

uint64_t slc_monotonic_time(void)
{
    LARGE_INTEGER count, frequency;
    QueryPerformanceCounter(&count);
    QueryPerformanceFrequency(&frequency);
    uint64_t ticks = (uint64_t)count.QuadPart, rate = (uint64_t)frequency.QuadPart;
    return ticks / rate * SECOND + ticks % rate * SECOND / rate;
}

static SRWLOCK *lock_of(struct slc_mutex *mutex)
{
    return (SRWLOCK *)&mutex->native;
}

static CONDITION_VARIABLE *variable_of(struct slc_condition *condition)
{
    return (CONDITION_VARIABLE *)&condition->native;
}

bool slc_mutex_init(struct slc_mutex *mutex)
{
    InitializeSRWLock(lock_of(mutex));
    return true;
}

bool slc_mutex_init_spinning(struct slc_mutex *mutex)
{
    return slc_mutex_init(mutex); /* SRW locks spin */
}

void slc_mutex_finish(struct slc_mutex *mutex)
{
    (void)mutex;
}

void slc_mutex_lock(struct slc_mutex *mutex)
{
    AcquireSRWLockExclusive(lock_of(mutex));
}

void slc_mutex_unlock(struct slc_mutex *mutex)
{
    ReleaseSRWLockExclusive(lock_of(mutex));
}

bool slc_condition_init(struct slc_condition *condition)
{
    InitializeConditionVariable(variable_of(condition));
    return true;
}

void slc_condition_finish(struct slc_condition *condition)
{
    (void)condition;
}

void slc_condition_wait(struct slc_condition *condition, struct slc_mutex *mutex)
{
    SleepConditionVariableSRW(variable_of(condition), lock_of(mutex), INFINITE, 0);
}

/* Waits in whole milliseconds, rounded up. A long wait ends early, which counts as a spurious wake.
 */
bool slc_condition_wait_until(struct slc_condition *condition, struct slc_mutex *mutex,
                              uint64_t time)
{
    uint64_t now = slc_monotonic_time(), rest = time > now ? time - now : 0;
    uint64_t milliseconds = rest / 1000000u + (rest % 1000000u != 0);
    DWORD step = milliseconds < 1000000u ? (DWORD)milliseconds : 1000000u;
    SleepConditionVariableSRW(variable_of(condition), lock_of(mutex), step, 0);
    return slc_monotonic_time() < time;
}

void slc_condition_signal(struct slc_condition *condition)
{
    WakeConditionVariable(variable_of(condition));
}

void slc_condition_broadcast(struct slc_condition *condition)
{
    WakeAllConditionVariable(variable_of(condition));
}

bool slc_rw_lock_init(struct slc_rw_lock *lock)
{
    InitializeSRWLock((SRWLOCK *)&lock->native);
    return true;
}

void slc_rw_lock_finish(struct slc_rw_lock *lock)
{
    (void)lock;
}

void slc_rw_lock_read(struct slc_rw_lock *lock)
{
    AcquireSRWLockShared((SRWLOCK *)&lock->native);
}

void slc_rw_lock_end_read(struct slc_rw_lock *lock)
{
    ReleaseSRWLockShared((SRWLOCK *)&lock->native);
}

void slc_rw_lock_write(struct slc_rw_lock *lock)
{
    AcquireSRWLockExclusive((SRWLOCK *)&lock->native);
}

void slc_rw_lock_end_write(struct slc_rw_lock *lock)
{
    ReleaseSRWLockExclusive((SRWLOCK *)&lock->native);
}

static unsigned __stdcall thread_main(void *user)
{
    struct slc_thread *thread = user;
    thread->run(thread->argument);
    return 0;
}

bool slc_thread_start(struct slc_thread *thread, void *(*run)(void *argument), void *argument)
{
    thread->run = run;
    thread->argument = argument;
    thread->native = (HANDLE)_beginthreadex(NULL, 0, thread_main, thread, 0, NULL);
    return thread->native != NULL;
}

void slc_thread_join(struct slc_thread *thread)
{
    WaitForSingleObject(thread->native, INFINITE);
    CloseHandle(thread->native);
}

uint64_t slc_thread_id(void)
{
    return GetCurrentThreadId();
}

uint32_t slc_get_processor_count(void)
{
    SYSTEM_INFO info;
    GetSystemInfo(&info);
    return info.dwNumberOfProcessors > 0 ? info.dwNumberOfProcessors : 1;
}
