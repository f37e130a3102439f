/** Read-write lock, held by any number of readers or by one writer. */
#ifndef SLC_PLATFORM_RW_LOCK_H
#define SLC_PLATFORM_RW_LOCK_H

#include <stdbool.h>

/* Apart from thread.h: POSIX headers hide the type unless the source asks for POSIX. */
#ifdef _WIN32
typedef void *slc_native_rw_lock;
#else
#include <pthread.h>
typedef pthread_rwlock_t slc_native_rw_lock;
#endif

struct slc_rw_lock {
    slc_native_rw_lock native;
};

/** Initializes. False: out of memory; does not happen on Linux and Windows. */
bool slc_rw_lock_init(struct slc_rw_lock *lock);
/** Destroys the lock, which no thread may hold. */
void slc_rw_lock_finish(struct slc_rw_lock *lock);
void slc_rw_lock_read(struct slc_rw_lock *lock);
void slc_rw_lock_end_read(struct slc_rw_lock *lock);
void slc_rw_lock_write(struct slc_rw_lock *lock);
void slc_rw_lock_end_write(struct slc_rw_lock *lock);

#endif /* SLC_PLATFORM_RW_LOCK_H */
