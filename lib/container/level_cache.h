/**
 * Levels that are compressed as a whole, decompressed once and kept while there is room. Any
 * thread.
 */
#ifndef SLC_CONTAINER_LEVEL_CACHE_H
#define SLC_CONTAINER_LEVEL_CACHE_H

#include "container/container_layout.h"
#include "platform/thread.h"

struct slc_cached_level {
    char *bytes; ///< owned; NULL: not there
    uint64_t size;
    uint64_t last_use; ///< number of the acquisition
    uint32_t user_count;
    bool is_loading;
};

struct slc_level_cache {
    const struct slc_input_file *file;
    uint64_t max_size; ///< bytes of all levels that are there or on their way
    struct slc_mutex mutex;
    struct slc_condition changed; ///< a level came, or nobody uses it any more
    uint64_t size;
    uint64_t acquisitions;
    struct slc_cached_level levels[SLC_MAX_MIP_LEVELS];
};

void slc_level_cache_init(struct slc_level_cache *cache, const struct slc_input_file *file,
                          uint64_t max_size);
void slc_level_cache_finish(struct slc_level_cache *cache);

/** Whether levels as these can be had, before any is. Errors: CORRUPT_DATA, UNSUPPORTED; logged. */
SluiceResult slc_level_cache_check(const struct slc_level_cache *cache,
                                   const struct slc_container_layout *layout);

/**
 * A level's decompressed bytes, until it is released; whoever asks for one that is on its way
 * waits, and so does who finds no room because others are in use: hold one at a time. Errors: IO,
 * CORRUPT_DATA, OUT_OF_HOST_MEMORY; logged.
 */
SluiceResult slc_level_cache_acquire(struct slc_level_cache *cache,
                                     const struct slc_container_layout *layout, uint32_t level,
                                     const char **bytes);
void slc_level_cache_release(struct slc_level_cache *cache, uint32_t level);

#endif /* SLC_CONTAINER_LEVEL_CACHE_H */
