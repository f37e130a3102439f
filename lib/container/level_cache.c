#include "container/level_cache.h"

#include "base/alloc.h"

#if SLC_HAVE_ZSTD
#include <zstd.h>
#endif

void slc_level_cache_init(struct slc_level_cache *cache, const struct slc_input_file *file,
                          uint64_t max_size)
{
    *cache = (struct slc_level_cache){.file = file, .max_size = max_size};
    slc_mutex_init(&cache->mutex);
    slc_condition_init(&cache->changed);
}

static void forget(struct slc_level_cache *cache, struct slc_cached_level *level)
{
    slc_free(&cache->file->allocator, level->bytes, 1, level->size);
    cache->size -= level->size;
    level->bytes = NULL;
}

void slc_level_cache_finish(struct slc_level_cache *cache)
{
    for (uint32_t i = 0; i < SLC_MAX_MIP_LEVELS; i++)
        if (cache->levels[i].bytes)
            forget(cache, &cache->levels[i]);
    slc_mutex_finish(&cache->mutex);
    slc_condition_finish(&cache->changed);
}

static SluiceResult check_level(const struct slc_level_cache *cache,
                                const struct slc_level_layout *level, uint32_t index)
{
    unsigned long long size = level->size, stored = level->stored_size;
    /* Zstandard's strongest compression: a block of 4 bytes yields 2^17 bytes. */
    if (level->size / 65536 > level->stored_size || level->stored_size / 2 > level->size + 65536)
        return slc_input_fail(cache->file, SLUICE_ERROR_CORRUPT_DATA,
                              "level %u cannot have %llu bytes, compressed %llu", index, size,
                              stored);
    if (level->size > cache->max_size || level->size > SIZE_MAX / 4)
        return slc_input_fail(cache->file, SLUICE_ERROR_UNSUPPORTED,
                              "level %u has %llu bytes and is compressed as a whole; "
                              "maxCacheSize is %llu; write it without supercompression",
                              index, size, (unsigned long long)cache->max_size);
    return SLUICE_SUCCESS;
}

SluiceResult slc_level_cache_check(const struct slc_level_cache *cache,
                                   const struct slc_container_layout *layout)
{
#if !SLC_HAVE_ZSTD
    if (layout->levels_are_compressed)
        return slc_input_fail(cache->file, SLUICE_ERROR_UNSUPPORTED,
                              "is compressed with Zstandard, which this build does not have; "
                              "write it without supercompression");
#endif
    SluiceResult result = SLUICE_SUCCESS;
    for (uint32_t i = 0; i < layout->level_count && result == SLUICE_SUCCESS; i++)
        if (layout->levels_are_compressed)
            result = check_level(cache, &layout->levels[i], i);
    return result;
}

#if SLC_HAVE_ZSTD
static SluiceResult decompress(const struct slc_input_file *file,
                               const struct slc_level_layout *level, uint32_t index,
                               const char *stored, char *bytes)
{
    ZSTD_DCtx *context = ZSTD_createDCtx();
    if (!context)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    size_t got = ZSTD_decompressDCtx(context, bytes, (size_t)level->size, stored,
                                     (size_t)level->stored_size);
    ZSTD_freeDCtx(context);
    if (ZSTD_isError(got))
        return slc_input_fail(file, SLUICE_ERROR_CORRUPT_DATA, "level %u, %llu bytes at %llu: %s",
                              index, (unsigned long long)level->stored_size,
                              (unsigned long long)level->offset, ZSTD_getErrorName(got));
    if (got != level->size)
        return slc_input_fail(file, SLUICE_ERROR_CORRUPT_DATA,
                              "level %u decompresses to %zu bytes, not %llu", index, got,
                              (unsigned long long)level->size);
    return SLUICE_SUCCESS;
}
#else
static SluiceResult decompress(const struct slc_input_file *file,
                               const struct slc_level_layout *level, uint32_t index,
                               const char *stored, char *bytes)
{
    (void)file, (void)level, (void)index, (void)stored, (void)bytes;
    return SLUICE_ERROR_UNSUPPORTED; /* such files are not opened */
}
#endif

/* Reads and decompresses a level. After an error, `*bytes` is NULL. */
static SluiceResult load(const struct slc_input_file *file, const struct slc_level_layout *level,
                         uint32_t index, char **bytes)
{
    const SluiceAllocationCallbacks *cb = &file->allocator;
    char *stored = slc_alloc(cb, 1, (size_t)level->stored_size);
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    *bytes = slc_alloc(cb, 1, (size_t)level->size);
    if (stored && *bytes)
        result = slc_input_file_read(file, level->offset, stored, (size_t)level->stored_size);
    if (result == SLUICE_SUCCESS)
        result = decompress(file, level, index, stored, *bytes);
    slc_free(cb, stored, 1, (size_t)level->stored_size);
    if (result == SLUICE_SUCCESS)
        return result;
    slc_free(cb, *bytes, 1, (size_t)level->size);
    *bytes = NULL;
    if (result == SLUICE_ERROR_OUT_OF_HOST_MEMORY)
        slc_input_fail(file, result, "no memory for level %u, %llu bytes", index,
                       (unsigned long long)level->size);
    return result;
}

/* Makes room for `size` more bytes: frees unused levels, least recently used first. */
static bool make_room(struct slc_level_cache *cache, uint64_t size)
{
    while (cache->size > cache->max_size - size) {
        struct slc_cached_level *oldest = NULL;
        for (uint32_t i = 0; i < SLC_MAX_MIP_LEVELS; i++) {
            struct slc_cached_level *level = &cache->levels[i];
            if (level->bytes && level->user_count == 0 &&
                (!oldest || level->last_use < oldest->last_use))
                oldest = level;
        }
        if (!oldest)
            return false;
        forget(cache, oldest);
    }
    return true;
}

/* Loads a level. Called with the mutex held; unlocks it during the load. */
static SluiceResult load_unlocked(struct slc_level_cache *cache,
                                  const struct slc_level_layout *layout, uint32_t index)
{
    struct slc_cached_level *level = &cache->levels[index];
    char *bytes;
    level->is_loading = true;
    level->size = layout->size;
    cache->size += level->size;
    slc_mutex_unlock(&cache->mutex);
    SluiceResult result = load(cache->file, layout, index, &bytes);
    slc_mutex_lock(&cache->mutex);
    level->is_loading = false;
    level->bytes = bytes;
    if (!bytes)
        cache->size -= level->size;
    slc_condition_broadcast(&cache->changed);
    return result;
}

SluiceResult slc_level_cache_acquire(struct slc_level_cache *cache,
                                     const struct slc_container_layout *layout, uint32_t level,
                                     const char **bytes)
{
    struct slc_cached_level *cached = &cache->levels[level];
    SluiceResult result = SLUICE_SUCCESS;
    slc_mutex_lock(&cache->mutex);
    while (!cached->bytes && result == SLUICE_SUCCESS) {
        if (cached->is_loading || !make_room(cache, layout->levels[level].size))
            slc_condition_wait(&cache->changed, &cache->mutex);
        else
            result = load_unlocked(cache, &layout->levels[level], level);
    }
    if (result == SLUICE_SUCCESS) {
        cached->user_count++;
        cached->last_use = ++cache->acquisitions;
        *bytes = cached->bytes;
    }
    slc_mutex_unlock(&cache->mutex);
    return result;
}

void slc_level_cache_release(struct slc_level_cache *cache, uint32_t level)
{
    slc_mutex_lock(&cache->mutex);
    if (--cache->levels[level].user_count == 0)
        slc_condition_broadcast(&cache->changed);
    slc_mutex_unlock(&cache->mutex);
}
