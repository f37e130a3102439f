/**
 * Cache of decompressed levels, for levels that are compressed as a whole. Least recently used
 * levels are freed. Thread safety: any thread.
 */
#ifndef SLC_CONTAINER_LEVEL_CACHE_H
#define SLC_CONTAINER_LEVEL_CACHE_H

#include "container/container_layout.h"
#include "platform/thread.h"

struct slc_cached_level {
    char *bytes; ///< owned; NULL: not loaded
    uint64_t size;
    uint64_t last_use; ///< number of the last acquisition
    uint32_t user_count;
    bool is_loading;
};

struct slc_level_cache {
    const struct slc_input_file *file;
    uint64_t max_size; ///< limit in bytes for levels that are loaded or loading
    struct slc_mutex mutex;
    struct slc_condition changed; ///< a level was loaded, or became unused
    uint64_t size;
    uint64_t acquisitions;
    struct slc_cached_level levels[SLC_MAX_MIP_LEVELS];
};

void slc_level_cache_init(struct slc_level_cache *cache, const struct slc_input_file *file,
                          uint64_t max_size);
void slc_level_cache_finish(struct slc_level_cache *cache);

/** Checks sizes of all levels before the first load. Errors, logged: CORRUPT_DATA, UNSUPPORTED. */
SluiceResult slc_level_cache_check(const struct slc_level_cache *cache,
                                   const struct slc_container_layout *layout);

/**
 * Acquires the decompressed bytes of a level, valid until the release. Waits for a level that
 * another thread loads. Waits for room while other levels are in use, so a thread must hold at most
 * one level. Errors, logged: IO, CORRUPT_DATA, OUT_OF_HOST_MEMORY.
 */
SluiceResult slc_level_cache_acquire(struct slc_level_cache *cache,
                                     const struct slc_container_layout *layout, uint32_t level,
                                     const char **bytes);
void slc_level_cache_release(struct slc_level_cache *cache, uint32_t level);

#endif /* SLC_CONTAINER_LEVEL_CACHE_H */
