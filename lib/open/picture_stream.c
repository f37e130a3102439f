#define _POSIX_C_SOURCE 200809L

#include "open/picture_stream.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "base/log.h"
#include "open/background.h"
#include "open/store_cache.h"

#include <string.h>

static const SluiceBakeSettings default_settings = {.structSize = sizeof default_settings};

SluiceResult slc_picture_settings_hash(const SluiceBakeSettings *settings, uint64_t *hash)
{
    uint64_t usual = 0;
    SluiceResult result = sluiceHashBakeSettings(settings, hash);
    if (result == SLUICE_SUCCESS)
        result = sluiceHashBakeSettings(&default_settings, &usual);
    if (result == SLUICE_SUCCESS && *hash == usual)
        *hash = 0;
    return result;
}

static SluiceImageAddressMode address_mode(SluiceBakeWrap wrap)
{
    return wrap == SLUICE_BAKE_WRAP_REPEAT   ? SLUICE_IMAGE_ADDRESS_MODE_REPEAT
           : wrap == SLUICE_BAKE_WRAP_MIRROR ? SLUICE_IMAGE_ADDRESS_MODE_MIRRORED_REPEAT
                                             : SLUICE_IMAGE_ADDRESS_MODE_CLAMP_TO_EDGE;
}

/* Finds size and format of a picture before its bake. */
static SluiceResult describe(struct slc_picture_stream *stream)
{
    SluiceBakeInfo info = {
        .structSize = sizeof info, .pInputPath = stream->path, .pSettings = &stream->settings};
    SluiceBakeReport report = {.structSize = sizeof report};
    SluiceResult result =
        sluiceDescribeBake(slc_background_baker(stream->background), &info, &report);
    if (result != SLUICE_SUCCESS)
        return result;
    stream->info = (SluiceImageInfo){
        .structSize = sizeof(SluiceImageInfo),
        .width = report.width,
        .height = report.height,
        .mipLevelCount = report.mipLevelCount,
        .format = report.format,
        .arrayLayerCount = 1,
        .addressModeU = address_mode(stream->settings.wrapX),
        .addressModeV = address_mode(stream->settings.wrapY),
    };
    return SLUICE_SUCCESS;
}

static uint32_t find_preview_level(const SluiceImageInfo *info)
{
    uint32_t size = slc_max_u32(info->width, info->height), level = 0;
    while (slc_mip_size(size, level) > SLC_PREVIEW_SIZE)
        level++;
    return level;
}

static void queue_jobs(struct slc_picture_stream *stream)
{
    struct slc_background *background = stream->background;
    /* The bake follows the preview; together they would compete for processors. */
    slc_background_queue(background, stream,
                         stream->preview_level > 0 ? SLC_JOB_PREVIEW : SLC_JOB_BAKE);
}

/* Starts the background threads for the opener's first stream. */
static SluiceResult need_background(struct slc_picture_stream *stream)
{
    SluiceImageOpener *opener = stream->opener;
    SluiceResult result = SLUICE_SUCCESS;
    slc_mutex_lock(&opener->mutex);
    if (!opener->background)
        result = slc_background_create(opener, &opener->background);
    stream->background = opener->background;
    slc_mutex_unlock(&opener->mutex);
    return result;
}

static SluiceResult init(struct slc_picture_stream *stream)
{
    SluiceImageOpener *opener = stream->opener;
    SluiceResult result = slc_cache_folder_make(opener->cache_folder, &opener->log);
    if (result == SLUICE_SUCCESS)
        result = slc_store_cache_path(opener->cache_folder, stream->path, stream->settings_hash,
                                      &opener->allocator, &stream->store_path);
    if (result == SLUICE_SUCCESS)
        result = need_background(stream);
    if (result != SLUICE_SUCCESS)
        return result;
    result = slc_open_picture_store(stream, &stream->store, &stream->store_identity);
    if (result == SLUICE_ERROR_OUT_OF_HOST_MEMORY || result == SLUICE_NOT_READY)
        return result;
    stream->info.structSize = sizeof stream->info;
    result = stream->store ? sluiceGetImageInfo(stream->store, &stream->info) : describe(stream);
    stream->info.pName = stream->path;
    stream->preview_level = find_preview_level(&stream->info);
    if (result == SLUICE_SUCCESS && !stream->store)
        queue_jobs(stream);
    return result;
}

SluiceResult slc_picture_stream_create(SluiceImageOpener *opener, const char *path,
                                       const struct slc_file_identity *identity,
                                       const SluiceBakeSettings *settings,
                                       struct slc_picture_stream **out)
{
    if (!opener->cache_folder) {
        slc_log(&opener->log, SLUICE_LOG_ERROR,
                "%s: is no tile store, OpenEXR, DDS or KTX2 file; if it is a picture, make a tile "
                "store of it with sluice-bake, or set pCacheFolder, where such stores are kept",
                path);
        return SLUICE_ERROR_UNSUPPORTED;
    }
    struct slc_picture_stream *stream = slc_calloc(&opener->allocator, 1, sizeof *stream);
    if (!stream)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    stream->opener = opener;
    stream->path = path;
    stream->identity = *identity;
    slc_rw_lock_init(&stream->lock);
    stream->settings = settings ? *settings : default_settings;
    SluiceResult result = slc_picture_settings_hash(&stream->settings, &stream->settings_hash);
    if (result == SLUICE_SUCCESS)
        result = init(stream);
    if (result != SLUICE_SUCCESS) {
        slc_picture_stream_destroy(stream);
        return result;
    }
    slc_mutex_lock(&opener->mutex); /* bakes of other streams check which stores are in use */
    *out = stream;
    slc_mutex_unlock(&opener->mutex);
    return SLUICE_SUCCESS;
}

void slc_picture_stream_destroy(struct slc_picture_stream *stream)
{
    if (!stream)
        return;
    SluiceAllocationCallbacks cb = stream->opener->allocator;
    if (stream->background)
        slc_background_cancel(stream->background, stream);
    sluiceDestroyImageSource(stream->store);
    sluiceDestroyImageSource(stream->preview);
    slc_free(&cb, stream->preview_bytes, stream->preview_size, 1);
    slc_free(&cb, stream->store_path, stream->store_path ? strlen(stream->store_path) + 1 : 0, 1);
    slc_rw_lock_finish(&stream->lock);
    slc_free(&cb, stream, 1, sizeof *stream);
}

/* Tells whether another bake may repair a failed read. */
static bool is_lost(SluiceResult result)
{
    return result == SLUICE_ERROR_CORRUPT_DATA || result == SLUICE_ERROR_FILE_NOT_FOUND ||
           result == SLUICE_ERROR_IO;
}

/* Opens the new file of a store that another opener or process replaced. The lock is held for
 * writing. NOT_READY and OUT_OF_HOST_MEMORY: the next read tries again. */
static SluiceResult take_replacement(struct slc_picture_stream *stream)
{
    SluiceImageSource *store;
    struct slc_file_identity identity;
    SluiceResult result = slc_open_picture_store(stream, &store, &identity);
    if (result == SLUICE_SUCCESS && !slc_picture_is_as_described(stream, store, 0)) {
        sluiceDestroyImageSource(store);
        result = SLUICE_ERROR_CORRUPT_DATA;
    }
    if (result == SLUICE_SUCCESS) {
        sluiceDestroyImageSource(stream->store);
        stream->store = store;
        stream->store_identity = identity;
    }
    return result;
}

/* Counts a rebuild of a missing or damaged store. False: too many. The lock is held for writing. */
static bool count_rebuild(struct slc_picture_stream *stream, bool is_there)
{
    bool is_allowed = is_there ? stream->damaged_count < SLC_MOST_REBUILDS
                               : atomic_load(&stream->vanished_count) < SLC_MOST_REBUILDS;
    if (is_allowed && is_there)
        stream->damaged_count++;
    else if (is_allowed)
        atomic_fetch_add(&stream->vanished_count, 1);
    return is_allowed;
}

enum recovery { RECOVERY_LATER, RECOVERY_BAKE, RECOVERY_NONE };

/* Chooses a recovery; destroys the store if there is one. The lock is held for writing. */
static enum recovery recover(struct slc_picture_stream *stream)
{
    bool is_there;
    if (slc_picture_store_is_replaced(stream, &stream->store_identity, &is_there)) {
        SluiceResult result = take_replacement(stream);
        if (result == SLUICE_SUCCESS || result == SLUICE_NOT_READY ||
            result == SLUICE_ERROR_OUT_OF_HOST_MEMORY)
            return RECOVERY_LATER;
    }
    if (!count_rebuild(stream, is_there))
        return RECOVERY_NONE;
    stream->is_damaged = is_there;
    sluiceDestroyImageSource(stream->store);
    stream->store = NULL;
    return RECOVERY_BAKE;
}

/* Opens or bakes the store again. False: too many attempts. */
static bool rebuild(struct slc_picture_stream *stream, const SluiceImageSource *failed)
{
    enum recovery recovery = RECOVERY_LATER;
    slc_rw_lock_write(&stream->lock);
    if (stream->store == failed) /* otherwise another reader has recovered already */
        recovery = recover(stream);
    slc_rw_lock_end_write(&stream->lock);
    if (recovery != RECOVERY_BAKE)
        return recovery == RECOVERY_LATER;
    slc_log(&stream->opener->log, SLUICE_LOG_WARNING,
            "%s: its store %s cannot be read; baking it again", stream->path, stream->store_path);
    queue_jobs(stream);
    return true;
}

SluiceResult slc_picture_stream_read(struct slc_picture_stream *stream,
                                     const SluiceImageRegion *region, void *texels,
                                     size_t row_pitch, SluiceImageFault *fault)
{
    SluiceImageRegion part = *region;
    SluiceResult result = (SluiceResult)atomic_load(&stream->failure);
    slc_rw_lock_read(&stream->lock);
    const SluiceImageSource *store = stream->store;
    if (store) {
        result = sluiceReadImageRegionLocated(stream->store, region, texels, row_pitch, fault);
    } else if (stream->preview && region->mipLevel >= stream->preview_level) {
        part.mipLevel -= stream->preview_level;
        result = sluiceReadImageRegionLocated(stream->preview, &part, texels, row_pitch, fault);
    } else if (result == SLUICE_SUCCESS) {
        result = SLUICE_NOT_READY;
    }
    fault->pName = stream->path; /* replaces the name of the inner source, which may be destroyed */
    slc_rw_lock_end_read(&stream->lock);
    if (store && result == SLUICE_SUCCESS && atomic_load(&stream->vanished_count) > 0)
        atomic_store(&stream->vanished_count, 0);
    if (store && is_lost(result) && rebuild(stream, store))
        return SLUICE_NOT_READY;
    return result;
}

void slc_picture_stream_describe(struct slc_picture_stream *stream, SluiceOpenedImageInfo *info)
{
    slc_rw_lock_read(&stream->lock);
    info->ready = stream->store != NULL;
    info->previewReady = stream->store || stream->preview;
    slc_rw_lock_end_read(&stream->lock);
    info->failure = (SluiceResult)atomic_load(&stream->failure);
    info->totalTexels = atomic_load(&stream->total_texels);
    info->doneTexels = atomic_load(&stream->done_texels);
}
