#define _POSIX_C_SOURCE 200809L

#include "base/alloc.h"
#include "base/checked.h"
#include "base/log.h"
#include "image/input_file.h"
#include "open/background.h"
#include "open/store_cache.h"

#include <stdio.h>
#include <string.h>

static bool note_progress(void *user, uint64_t done, uint64_t total)
{
    struct slc_picture_stream *stream = user;
    atomic_store(&stream->total_texels, total);
    atomic_store(&stream->done_texels, done);
    return !atomic_load(&stream->is_canceled);
}

static bool keep_going(void *user, uint64_t done, uint64_t total)
{
    (void)done, (void)total;
    return !atomic_load(&((struct slc_picture_stream *)user)->is_canceled);
}

/* Reads the file at `path` and deletes it. Returns NULL after a failure. */
static void *take_file(const struct slc_picture_stream *stream, const char *path, size_t *size)
{
    const SluiceAllocationCallbacks *cb = &stream->opener->allocator;
    struct slc_input_file file;
    void *bytes = NULL;
    SluiceResult result = slc_input_file_init(&file, path, cb, &stream->opener->log);
    if (result == SLUICE_SUCCESS)
        result = slc_input_file_open(&file);
    if (result == SLUICE_SUCCESS)
        bytes = slc_alloc(cb, (size_t)file.size, 1);
    if (bytes && slc_input_file_read(&file, 0, bytes, (size_t)file.size) != SLUICE_SUCCESS) {
        slc_free(cb, bytes, (size_t)file.size, 1);
        bytes = NULL;
    }
    *size = (size_t)file.size;
    slc_input_file_finish(&file);
    slc_path_remove(path);
    return bytes;
}

bool slc_picture_is_as_described(const struct slc_picture_stream *stream, SluiceImageSource *source,
                                 uint32_t level)
{
    SluiceImageInfo info = {.structSize = sizeof info};
    return sluiceGetImageInfo(source, &info) == SLUICE_SUCCESS &&
           info.width == slc_mip_size(stream->info.width, level) &&
           info.height == slc_mip_size(stream->info.height, level) &&
           info.format == stream->info.format && info.arrayLayerCount <= 1 &&
           info.mipLevelCount == stream->info.mipLevelCount - level;
}

static bool is_unchanged(const struct slc_picture_stream *stream)
{
    struct slc_file_status status;
    if (!slc_path_get_status(stream->path, &status))
        return false;
    struct slc_file_identity now = slc_file_identity(&status);
    return now.size == stream->identity.size && now.seconds == stream->identity.seconds &&
           now.nanoseconds == stream->identity.nanoseconds;
}

/* Shows the preview, unless the store is open or the picture's file has changed. */
static void show_preview(struct slc_picture_stream *stream, void *bytes, size_t size)
{
    SluiceImageOpener *opener = stream->opener;
    SluiceInput input = {.structSize = sizeof input, .pBytes = bytes, .size = size};
    SluiceStoreImageSourceCreateInfo info = {.structSize = sizeof info,
                                             .pPath = stream->path,
                                             .pInput = &input,
                                             .pAllocator = &opener->allocator,
                                             .log = opener->log,
                                             .readPool = opener->files.read_pool};
    SluiceImageSource *preview = NULL;
    bool is_shown = false;
    SluiceResult result = sluiceCreateStoreImageSource(&info, &preview);
    bool is_right = result == SLUICE_SUCCESS &&
                    slc_picture_is_as_described(stream, preview, stream->preview_level) &&
                    is_unchanged(stream);
    slc_rw_lock_write(&stream->lock);
    if (is_right && !stream->store && !stream->preview) {
        stream->preview = preview;
        stream->preview_bytes = bytes;
        stream->preview_size = size;
        is_shown = true;
    }
    slc_rw_lock_end_write(&stream->lock);
    if (is_shown)
        return;
    sluiceDestroyImageSource(preview);
    slc_free(&opener->allocator, bytes, size, 1);
}

/* Makes the preview as a temporary store file, which is then read. Failures are harmless. */
void slc_make_preview(struct slc_background *background, struct slc_picture_stream *stream)
{
    char path[1024];
    size_t size;
    if (!slc_store_cache_preview_path(stream->store_path, stream, path, sizeof path))
        return;
    SluiceBakeInfo info = {.structSize = sizeof info,
                           .pInputPath = stream->path,
                           .pOutputPath = path,
                           .pSettings = &stream->settings,
                           .pUserData = stream,
                           .pfnProgress = keep_going,
                           .firstLevel = stream->preview_level};
    SluiceResult result = sluiceBakeFile(slc_background_baker(background), &info, NULL);
    if (result != SLUICE_SUCCESS)
        return;
    void *bytes = take_file(stream, path, &size);
    if (bytes)
        show_preview(stream, bytes, size);
}

bool slc_picture_store_is_replaced(const struct slc_picture_stream *stream,
                                   const struct slc_file_identity *identity, bool *is_there)
{
    struct slc_file_status status;
    *is_there = slc_path_get_status(stream->store_path, &status);
    if (!*is_there)
        return false;
    struct slc_file_identity now = slc_file_identity(&status);
    return memcmp(&now, identity, sizeof now) != 0;
}

SluiceResult slc_open_picture_store(struct slc_picture_stream *stream, SluiceImageSource **store,
                                    struct slc_file_identity *identity)
{
    SluiceImageOpener *opener = stream->opener;
    SluiceStoreImageSourceCreateInfo info = {.structSize = sizeof info,
                                             .pPath = stream->store_path,
                                             .pAllocator = &opener->allocator,
                                             .log = opener->cache_log,
                                             .readPool = opener->files.read_pool,
                                             .filePool = opener->files.pool};
    SluiceStoreInfo found = {.structSize = sizeof found};
    uint64_t hash = 0;
    struct slc_file_status status;
    *store = NULL;
    /* Taken before the opening: a replacement in between only causes one more opening. */
    if (!slc_path_get_status(stream->store_path, &status))
        return SLUICE_ERROR_FILE_NOT_FOUND;
    *identity = slc_file_identity(&status);
    SluiceResult result = sluiceHashBakeSettings(&stream->settings, &hash);
    if (result == SLUICE_SUCCESS)
        result = sluiceCreateStoreImageSource(&info, store);
    if (result == SLUICE_SUCCESS)
        result = sluiceGetStoreInfo(*store, &found);
    const struct slc_file_identity *picture = &stream->identity;
    bool is_same =
        found.sourceSize == picture->size && found.settingsHash == hash &&
        found.sourceModifiedTimeNs == picture->seconds * INT64_C(1000000000) + picture->nanoseconds;
    if (result == SLUICE_SUCCESS && is_same) {
        slc_store_cache_touch(stream->store_path);
        return SLUICE_SUCCESS;
    }
    sluiceDestroyImageSource(*store);
    *store = NULL;
    return result == SLUICE_SUCCESS ? SLUICE_ERROR_CORRUPT_DATA : result;
}

static bool reads(const struct slc_opened_image *image, const struct slc_cache_entry *store)
{
    const char *path = image->stream ? strrchr(image->stream->store_path, '/') : NULL;
    return (path && strcmp(path + 1, store->name) == 0) ||
           (image->identity.device == store->device && image->identity.inode == store->inode);
}

/* Tells whether a source of the opener reads the store. */
static bool is_in_use(void *user, const struct slc_cache_entry *store)
{
    SluiceImageOpener *opener = user;
    bool is_used = false;
    slc_mutex_lock(&opener->mutex);
    for (uint32_t b = 0; b < SLC_OPENER_BUCKETS && !is_used; b++)
        for (struct slc_opened_image *i = opener->buckets[b]; i && !is_used; i = i->next)
            is_used = reads(i, store);
    slc_mutex_unlock(&opener->mutex);
    return is_used;
}

/* Bakes the store. NOT_READY: try again later; another process may be writing the same store. */
static SluiceResult bake_store(struct slc_background *background, struct slc_picture_stream *stream,
                               bool force)
{
    SluiceBakeInfo info = {.structSize = sizeof info,
                           .pInputPath = stream->path,
                           .pOutputPath = stream->store_path,
                           .pSettings = &stream->settings,
                           .force = force,
                           .pUserData = stream,
                           .pfnProgress = note_progress};
    if (slc_store_cache_is_busy(stream->store_path, &stream->opener->allocator)) {
        if (!stream->has_said_busy)
            slc_log(&stream->opener->log, SLUICE_LOG_INFO,
                    "%s: another process bakes it; waiting for its store", stream->path);
        stream->has_said_busy = true;
        return SLUICE_NOT_READY;
    }
    SluiceResult result = sluiceBakeFile(slc_background_baker(background), &info, NULL);
    return result == SLUICE_ERROR_BUSY ? SLUICE_NOT_READY : result;
}

static SluiceResult open_baked(struct slc_picture_stream *stream, SluiceImageSource **store,
                               struct slc_file_identity *identity)
{
    SluiceResult result = slc_open_picture_store(stream, store, identity);
    bool is_another = result == SLUICE_ERROR_CORRUPT_DATA ||
                      (result == SLUICE_SUCCESS && !slc_picture_is_as_described(stream, *store, 0));
    if (!is_another)
        return result;
    sluiceDestroyImageSource(*store);
    *store = NULL;
    slc_log(&stream->opener->log, SLUICE_LOG_ERROR,
            "%s: has changed while it was baked; open it again", stream->path);
    return SLUICE_ERROR_IO;
}

enum { MAX_OPEN_TRIES = 10 };

/* Bakes and opens the store. Both are tried again later if another process deletes the store in
 * between, or memory or descriptors are short. A repeated bake keeps an existing store. */
static SluiceResult bake_and_open(struct slc_background *background,
                                  struct slc_picture_stream *stream, bool force,
                                  SluiceImageSource **store, struct slc_file_identity *identity)
{
    SluiceResult result = bake_store(background, stream, force);
    if (result != SLUICE_SUCCESS)
        return result;
    result = open_baked(stream, store, identity);
    bool is_momentary =
        result == SLUICE_ERROR_OUT_OF_HOST_MEMORY || result == SLUICE_ERROR_FILE_NOT_FOUND;
    return is_momentary && ++stream->open_tries < MAX_OPEN_TRIES ? SLUICE_NOT_READY : result;
}

static void show_store(struct slc_picture_stream *stream, SluiceImageSource *store,
                       const struct slc_file_identity *identity)
{
    slc_rw_lock_write(&stream->lock);
    SluiceImageSource *preview = stream->preview;
    void *bytes = stream->preview_bytes;
    size_t size = stream->preview_size;
    stream->store = store;
    stream->store_identity = *identity;
    stream->preview = NULL;
    stream->preview_bytes = NULL;
    slc_rw_lock_end_write(&stream->lock);
    sluiceDestroyImageSource(preview);
    slc_free(&stream->opener->allocator, bytes, size, 1);
}

bool slc_make_store(struct slc_background *background, struct slc_picture_stream *stream)
{
    SluiceImageOpener *opener = stream->opener;
    SluiceImageSource *store = NULL;
    struct slc_file_identity identity = {0};
    bool is_there, is_damaged = stream->is_damaged;
    /* Another opener or process may have replaced the damaged store meanwhile. */
    if (is_damaged)
        is_damaged =
            !slc_picture_store_is_replaced(stream, &stream->store_identity, &is_there) && is_there;
    SluiceResult result = bake_and_open(background, stream, is_damaged, &store, &identity);
    if (atomic_load(&stream->is_canceled)) {
        sluiceDestroyImageSource(store);
        return true;
    }
    if (result == SLUICE_NOT_READY)
        return false;
    stream->open_tries = 0;
    stream->has_said_busy = false;
    if (result == SLUICE_SUCCESS)
        show_store(stream, store, &identity);
    else
        atomic_store(&stream->failure, result);
    /* Trim after a failure, too: the part file takes room. */
    slc_store_cache_trim(opener->cache_folder, opener->max_cache_size, &opener->allocator,
                         is_in_use, opener);
    return true;
}
