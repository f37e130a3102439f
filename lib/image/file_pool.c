#include "image/file_pool.h"

#include "base/alloc.h"
#include "base/struct_size.h"
#include "base/system.h"
#include "platform/thread.h"

#include <string.h>

#define MAX_OPEN_FILES (1u << 20)

struct SluiceFilePool {
    SluiceAllocationCallbacks allocator;
    struct slc_mutex mutex;       ///< guards the fields below, and the pool's files
    struct slc_condition changed; ///< a file was released, closed, or its opening has ended
    struct slc_pooled_file *newest, *oldest; ///< open files, by last use
    SluiceFilePoolStatistics statistics; ///< openFileCount counts files that are being opened, too
};

struct slc_file_identity slc_file_identity(const struct slc_file_status *status)
{
    return (struct slc_file_identity){
        .device = status->device,
        .inode = status->inode,
        .size = status->size,
        .seconds = status->modified.seconds,
        .nanoseconds = status->modified.nanoseconds,
    };
}

static uint32_t default_limit(void)
{
    uint64_t quarter = slc_get_descriptor_limit() / 4;
    if (quarter > MAX_OPEN_FILES)
        return MAX_OPEN_FILES;
    return quarter < 2 ? 1 : (uint32_t)quarter;
}

SluiceResult sluiceCreateFilePool(const SluiceFilePoolCreateInfo *pInfo, SluiceFilePool **pPool)
{
    SluiceFilePoolCreateInfo info = {.structSize = sizeof info};
    if (!pPool)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result =
        pInfo ? slc_struct_read(SLC_STRUCT(SluiceFilePoolCreateInfo), &info, pInfo, NULL)
              : SLUICE_SUCCESS;
    if (result != SLUICE_SUCCESS)
        return result;
    if (!slc_allocator_is_valid(info.pAllocator))
        return SLUICE_ERROR_NULL_POINTER;
    if (info.maxOpenFileCount > MAX_OPEN_FILES)
        return SLUICE_ERROR_INVALID_ARGUMENT;
    SluiceAllocationCallbacks cb = slc_allocator(info.pAllocator);
    SluiceFilePool *pool = slc_calloc(&cb, 1, sizeof *pool);
    if (!pool)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    pool->allocator = cb;
    pool->statistics.structSize = sizeof pool->statistics;
    pool->statistics.maxOpenFileCount =
        info.maxOpenFileCount ? info.maxOpenFileCount : default_limit();
    slc_mutex_init(&pool->mutex);
    slc_condition_init(&pool->changed);
    *pPool = pool;
    return SLUICE_SUCCESS;
}

void sluiceDestroyFilePool(SluiceFilePool *pool)
{
    if (!pool)
        return;
    SluiceAllocationCallbacks cb = pool->allocator;
    slc_condition_finish(&pool->changed);
    slc_mutex_finish(&pool->mutex);
    slc_free(&cb, pool, 1, sizeof *pool);
}

SluiceResult sluiceGetFilePoolStatistics(SluiceFilePool *pool,
                                         SluiceFilePoolStatistics *pStatistics)
{
    if (!pool || !pStatistics)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_struct_check(SLC_STRUCT(SluiceFilePoolStatistics), pStatistics, NULL);
    if (result != SLUICE_SUCCESS)
        return result;
    slc_mutex_lock(&pool->mutex);
    SluiceFilePoolStatistics statistics = pool->statistics;
    slc_mutex_unlock(&pool->mutex);
    slc_struct_write(SLC_STRUCT(SluiceFilePoolStatistics), pStatistics, &statistics);
    return SLUICE_SUCCESS;
}

static void take_out(SluiceFilePool *pool, struct slc_pooled_file *file)
{
    *(file->newer ? &file->newer->older : &pool->newest) = file->older;
    *(file->older ? &file->older->newer : &pool->oldest) = file->newer;
    file->newer = file->older = NULL;
}

static void put_first(SluiceFilePool *pool, struct slc_pooled_file *file)
{
    file->older = pool->newest;
    *(pool->newest ? &pool->newest->newer : &pool->oldest) = file;
    pool->newest = file;
}

static void close_file(SluiceFilePool *pool, struct slc_pooled_file *file)
{
    take_out(pool, file);
    slc_file_close(file->descriptor);
    file->descriptor = -1;
    pool->statistics.openFileCount--;
}

/* Closes the least recently read file that is not being read. False: there is none. */
static bool make_room(SluiceFilePool *pool)
{
    struct slc_pooled_file *file = pool->oldest;
    while (file && file->user_count > 0)
        file = file->newer;
    if (!file)
        return false;
    close_file(pool, file);
    pool->statistics.closedTotal++;
    return true;
}

/* Opens a file and compares its identity. Without the mutex, because network files may take long.
 * Returns -1 and sets errno after an error. */
static int open_known(struct slc_pooled_file *file, const char *path)
{
    struct slc_file_status status;
    int descriptor = slc_open_input(path);
    if (descriptor < 0)
        return -1;
    int error = slc_file_get_status(descriptor, &status) ? 0 : errno;
    if (error == 0) {
        struct slc_file_identity identity = slc_file_identity(&status);
        if (!file->is_known)
            file->identity = identity;
        else if (memcmp(&identity, &file->identity, sizeof identity) != 0)
            error = ESTALE;
    }
    if (error == 0)
        return descriptor;
    slc_file_close(descriptor);
    errno = error;
    return -1;
}

/* Opens one more file, after making room. Returns 0, or errno. */
static int open_file(SluiceFilePool *pool, struct slc_pooled_file *file, const char *path)
{
    SluiceFilePoolStatistics *statistics = &pool->statistics;
    file->is_opening = true;
    statistics->openFileCount++;
    slc_mutex_unlock(&pool->mutex);
    int descriptor = open_known(file, path);
    int error = descriptor < 0 ? errno : 0;
    slc_mutex_lock(&pool->mutex);
    file->is_opening = false;
    slc_condition_broadcast(&pool->changed);
    if (error) {
        statistics->openFileCount--;
        statistics->replacedTotal += error == ESTALE;
        return error;
    }
    file->descriptor = descriptor;
    file->is_known = true;
    put_first(pool, file);
    statistics->openTotal++;
    if (statistics->openFileCount > statistics->openFilePeak)
        statistics->openFilePeak = statistics->openFileCount;
    return 0;
}

/* Opens the file unless it is open, with the mutex held. Returns 0, or errno. */
static int ensure_open(SluiceFilePool *pool, struct slc_pooled_file *file, const char *path)
{
    while (file->descriptor < 0) {
        bool has_room = pool->statistics.openFileCount < pool->statistics.maxOpenFileCount;
        if (file->is_opening || (!has_room && !make_room(pool))) {
            slc_condition_wait(&pool->changed, &pool->mutex);
            continue;
        }
        int error = open_file(pool, file, path);
        bool is_shortage = error == EMFILE || error == ENFILE;
        pool->statistics.shortageTotal += is_shortage;
        if (error && !(is_shortage && make_room(pool)))
            return error;
    }
    return 0;
}

int slc_file_pool_acquire(SluiceFilePool *pool, struct slc_pooled_file *file, const char *path)
{
    slc_mutex_lock(&pool->mutex);
    int error = ensure_open(pool, file, path);
    if (error == 0) {
        file->user_count++;
        take_out(pool, file);
        put_first(pool, file);
    }
    int descriptor = file->descriptor;
    slc_mutex_unlock(&pool->mutex);
    if (error == 0)
        return descriptor;
    errno = error;
    return -1;
}

void slc_file_pool_release(SluiceFilePool *pool, struct slc_pooled_file *file)
{
    slc_mutex_lock(&pool->mutex);
    file->user_count--;
    slc_condition_broadcast(&pool->changed);
    slc_mutex_unlock(&pool->mutex);
}

void slc_file_pool_remove(SluiceFilePool *pool, struct slc_pooled_file *file)
{
    slc_mutex_lock(&pool->mutex);
    if (file->descriptor >= 0)
        close_file(pool, file);
    slc_condition_broadcast(&pool->changed);
    slc_mutex_unlock(&pool->mutex);
    *file = SLC_POOLED_FILE_CLOSED;
}
