/** Files that are read through a SluiceFilePool: opened when they are read, closed for others. */
#ifndef SLC_IMAGE_FILE_POOL_H
#define SLC_IMAGE_FILE_POOL_H

#include <sluice/input.h>

#include "platform/file.h"

/** Identity of a file. Differs for another file of the same name, and for changed contents. */
struct slc_file_identity {
    uint64_t device, inode, size;
    int64_t seconds, nanoseconds; ///< time of the last change of contents (not of attributes)
};

struct slc_file_identity slc_file_identity(const struct slc_file_status *status);

/** One file of a pool. The pool's mutex guards all of it. Starts as SLC_POOLED_FILE_CLOSED. */
struct slc_pooled_file {
    struct slc_pooled_file *newer, *older; ///< by last use; while it is open
    int descriptor;                        ///< -1: closed
    uint32_t user_count;                   ///< reads in progress
    bool is_opening;
    bool is_known; ///< `identity` was set by the first opening
    struct slc_file_identity identity;
};

#define SLC_POOLED_FILE_CLOSED ((struct slc_pooled_file){.descriptor = -1})

/**
 * Returns the file's descriptor, open until slc_file_pool_release, or -1 with errno set. A thread
 * holds one file at a time, because it may wait for others to release theirs.
 *
 * errno: ESTALE if another file has replaced it; EMFILE or ENFILE if no descriptor is left and no
 * file of the pool can be closed; errors of open. Any thread.
 */
int slc_file_pool_acquire(SluiceFilePool *pool, struct slc_pooled_file *file, const char *path);
void slc_file_pool_release(SluiceFilePool *pool, struct slc_pooled_file *file);

/** Closes the file and forgets its identity. No read may be in progress. */
void slc_file_pool_remove(SluiceFilePool *pool, struct slc_pooled_file *file);

#endif /* SLC_IMAGE_FILE_POOL_H */
