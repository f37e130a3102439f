#define _POSIX_C_SOURCE 200809L

#include "open/opener.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "base/log.h"
#include "base/said.h"
#include "base/shown_url.h"
#include "base/struct_size.h"
#include "image/identity.h"
#include "open/neural_file.h"
#include "platform/time_now.h"
#ifdef SLC_HAVE_BAKE
#include "open/background.h"
#endif

#include <string.h>

/* Logs errors of cached stores as warnings, because a damaged or unreadable store is baked again.
 */
static void log_cached_store(void *user, SluiceLogSeverity severity, const char *message)
{
    const SluiceImageOpener *opener = user;
    slc_log(&opener->log, severity == SLUICE_LOG_ERROR ? SLUICE_LOG_WARNING : severity, "%s",
            message);
}

SluiceResult sluiceCreateImageOpener(const SluiceImageOpenerCreateInfo *pInfo,
                                     SluiceImageOpener **pOpener)
{
    if (!pInfo || !pOpener)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceImageOpenerCreateInfo info = {.structSize = sizeof info};
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceImageOpenerCreateInfo), &info, pInfo, &pInfo->log);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!slc_allocator_is_valid(info.pAllocator) ||
        !info.pathOpener.pfnOpenPath != !info.pathOpener.pfnClosePath ||
        (info.pfnCheckPath && !info.pathOpener.pfnOpenPath))
        return SLUICE_ERROR_NULL_POINTER;
    SluiceAllocationCallbacks cb = slc_allocator(info.pAllocator);
    SluiceImageOpener *opener = slc_calloc(&cb, 1, sizeof *opener);
    if (!opener)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    opener->allocator = cb;
    opener->log = info.log;
    opener->path_opener = info.pathOpener;
    opener->check_path = info.pfnCheckPath;
    opener->cache_log = (SluiceLogCallback){opener, log_cached_store};
    opener->max_cache_size = info.maxCacheSize ? info.maxCacheSize : SLUICE_OPEN_DEFAULT_CACHE_SIZE;
    opener->max_bake_memory = info.maxBakeMemory;
    opener->bake_thread_count = info.bakeThreadCount;
    slc_mutex_init(&opener->mutex);
    slc_condition_init(&opener->opened);
    if (info.pCacheFolder) {
        opener->cache_folder = slc_strdup(&cb, info.pCacheFolder);
        result = opener->cache_folder ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    if (result == SLUICE_SUCCESS)
        result = slc_shared_files_init(&opener->files, info.maxOpenFileCount, &opener->allocator);
    if (result != SLUICE_SUCCESS) {
        sluiceDestroyImageOpener(opener);
        return result;
    }
    *pOpener = opener;
    return SLUICE_SUCCESS;
}

void sluiceDestroyImageOpener(SluiceImageOpener *opener)
{
    if (!opener)
        return;
    SluiceAllocationCallbacks cb = opener->allocator;
#ifdef SLC_HAVE_BAKE
    slc_background_destroy(opener->background);
#endif
    for (uint32_t i = 0; i < SLC_OPENER_CATALOGUES && opener->kept[i]; i++)
        slc_opener_release(opener->kept[i]);
    slc_shared_files_finish(&opener->files);
    if (opener->cache_folder)
        slc_free(&cb, opener->cache_folder, strlen(opener->cache_folder) + 1, 1);
    slc_condition_finish(&opener->opened);
    slc_mutex_finish(&opener->mutex);
    slc_free(&cb, opener, 1, sizeof *opener);
}

#ifndef SLC_HAVE_BAKE
SluiceResult slc_picture_stream_create(SluiceImageOpener *opener, const char *path,
                                       const struct slc_file_identity *identity,
                                       const SluiceBakeSettings *settings,
                                       struct slc_picture_stream **stream);

SluiceResult slc_picture_stream_create(SluiceImageOpener *opener, const char *path,
                                       const struct slc_file_identity *identity,
                                       const SluiceBakeSettings *settings,
                                       struct slc_picture_stream **stream)
{
    (void)identity, (void)settings, (void)stream;
    slc_log(&opener->log, SLUICE_LOG_ERROR,
            "%s: is no tile store, OpenEXR, DDS, KTX2 file or neural set; this build of Sluice was "
            "made without sluice-bake, which reads other pictures with libvips",
            path);
    return SLUICE_ERROR_UNSUPPORTED;
}
#endif

static void free_image(struct slc_opened_image *image)
{
    SluiceAllocationCallbacks cb = image->opener->allocator;
#ifdef SLC_HAVE_BAKE
    slc_picture_stream_destroy(image->stream);
#endif
    sluiceDestroyImageSource(image->complete);
    sluiceDestroyImageSource(image->source);
    if (image->opened)
        image->opener->path_opener.pfnClosePath(image->opener->path_opener.pUserData,
                                                image->opened);
    if (image->path)
        slc_free(&cb, image->path, strlen(image->path) + 1, 1);
    if (image->shown)
        slc_free(&cb, image->shown, strlen(image->shown) + 1, 1);
    if (image->texture)
        slc_free(&cb, image->texture, strlen(image->texture) + 1, 1);
    slc_catalogue_destroy(image->catalogue, &cb);
    slc_free(&cb, image, 1, sizeof *image);
}

/* Returns the source of an image that is not a picture. */
static SluiceImageSource *source_to_read(const struct slc_opened_image *image)
{
    return image->complete ? image->complete : image->source;
}

static SluiceResult get_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    struct slc_opened_image *image = (struct slc_opened_image *)base;
#ifdef SLC_HAVE_BAKE
    if (image->stream) {
        *info = image->stream->info;
        return SLUICE_SUCCESS;
    }
#endif
    return sluiceGetImageInfo(source_to_read(image), info);
}

static SluiceResult read_region(SluiceImageSource *base, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch, SluiceImageFault *fault)
{
    struct slc_opened_image *image = (struct slc_opened_image *)base;
#ifdef SLC_HAVE_BAKE
    if (image->stream)
        return slc_picture_stream_read(image->stream, region, texels, row_pitch, fault);
#endif
    return sluiceReadImageRegionLocated(source_to_read(image), region, texels, row_pitch, fault);
}

/* Identifies a tile. Tiles of pictures have no identity: the bake changes their texels. */
static bool identify(SluiceImageSource *base, const SluiceImageRegion *region, uint64_t *identity)
{
    struct slc_opened_image *image = (struct slc_opened_image *)base;
#ifdef SLC_HAVE_BAKE
    if (image->stream)
        return false;
#endif
    return slc_identify_region(source_to_read(image), region, identity);
}

static struct slc_opened_image **find_bucket(SluiceImageOpener *opener, const char *path)
{
    return &opener->buckets[slc_said_key(path) % SLC_OPENER_BUCKETS];
}

/* Adds an image to its bucket. The mutex is held. */
static void add_to_bucket(struct slc_opened_image *image)
{
    struct slc_opened_image **bucket = find_bucket(image->opener, image->path);
    image->next = *bucket;
    *bucket = image;
}

/* Removes an image from its bucket, if any. The mutex is held. */
static void take_from_bucket(struct slc_opened_image *image)
{
    struct slc_opened_image **link = find_bucket(image->opener, image->path);
    while (*link && *link != image)
        link = &(*link)->next;
    if (*link)
        *link = image->next;
}

/* Drops a reference. True: the last one; the image then is in no bucket. The mutex is held. */
static bool drop_reference(struct slc_opened_image *image)
{
    bool is_last = --image->reference_count == 0;
    if (is_last)
        take_from_bucket(image);
    return is_last;
}

void slc_opener_forget(struct slc_opened_image *image)
{
    take_from_bucket(image);
}

void slc_opener_release(struct slc_opened_image *image)
{
    SluiceImageOpener *opener = image->opener;
    slc_mutex_lock(&opener->mutex);
    bool is_last = drop_reference(image);
    slc_mutex_unlock(&opener->mutex);
    if (is_last)
        free_image(image);
}

static void destroy(SluiceImageSource *base)
{
    slc_opener_release((struct slc_opened_image *)base);
}

static const SluiceImageSourceInterface opened_interface = {.structSize = sizeof opened_interface,
                                                            .pfnGetInfo = get_info,
                                                            .pfnDestroy = destroy,
                                                            .pfnReadRegionLocated = read_region,
                                                            .pfnIdentifyRegion = identify};

static bool is_same_name(const char *a, const char *b)
{
    return a && b ? strcmp(a, b) == 0 : !a && !b;
}

/* Tells whether an image fits a request; any request fits a catalogue. The mutex is held. */
static bool is_opened_as(const struct slc_opened_image *image, const struct slc_open_request *r)
{
    return image->kind == SLC_IMAGE_FILE_KIND_CATALOGUE ||
           (is_same_name(image->texture, r->texture) && image->settings_hash == r->settings_hash);
}

/* Finds an image, also one that may prove to be a catalogue. The mutex is held. */
static struct slc_opened_image *find_image(SluiceImageOpener *opener,
                                           const struct slc_open_request *r)
{
    const struct slc_file_identity *identity = &r->identity;
    struct slc_opened_image *image = *find_bucket(opener, r->path);
    while (image && (strcmp(image->path, r->path) != 0 ||
                     (image->is_kind_known && !is_opened_as(image, r)) ||
                     memcmp(&image->identity, identity, sizeof *identity) != 0))
        image = image->next;
    return image;
}

/* Adds missing levels. Compressed formats keep a partial chain, because levels cannot be made. */
static SluiceResult complete_chain(struct slc_opened_image *image)
{
    const SluiceImageOpener *opener = image->opener;
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceResult result = sluiceGetImageInfo(image->source, &info);
    if (result != SLUICE_SUCCESS || sluiceGetFormatTexelSize(info.format) == 0 ||
        info.mipLevelCount == slc_mip_count(slc_max_u32(info.width, info.height)))
        return result;
    const SluiceCompleteChainSourceCreateInfo complete = {.structSize = sizeof complete,
                                                          .source = image->source,
                                                          .pAllocator = &opener->allocator,
                                                          .log = opener->log};
    result = sluiceCreateCompleteChainSource(&complete, &image->complete);
    return result == SLUICE_SUCCESS ? sluiceGetImageInfo(image->complete, &info) : result;
}

bool slc_opener_owns_path(const SluiceImageOpener *opener, const char *path)
{
    return opener->path_opener.pfnOpenPath && strstr(path, "://");
}

/* Creates an image. NULL: out of memory. */
static struct slc_opened_image *create_image(SluiceImageOpener *opener,
                                             const struct slc_open_request *r)
{
    const char *path = r->path, *texture = r->texture;
    struct slc_opened_image *image = slc_calloc(&opener->allocator, 1, sizeof *image);
    if (!image)
        return NULL;
    image->base.pInterface = &opened_interface;
    image->opener = opener;
    image->reference_count = 1;
    image->is_opening = true;
    image->is_kind_known = !slc_opener_owns_path(opener, path);
    image->kind = r->kind;
    image->checked = slc_monotonic_time();
    image->identity = r->identity;
    image->settings_hash = r->settings_hash;
    image->path = slc_strdup(&opener->allocator, path);
    if (slc_opener_owns_path(opener, path))
        image->shown = slc_shown_url(&opener->allocator, path);
    if (texture)
        image->texture = slc_strdup(&opener->allocator, texture);
    if (image->path && (image->shown || !slc_opener_owns_path(opener, path)) &&
        (image->texture || !texture))
        return image;
    free_image(image);
    return NULL;
}

/* Opens a path with the path opener. Errors: errors of opener and input; UNSUPPORTED, logged. */
static SluiceResult open_path(struct slc_opened_image *image)
{
    SluiceImageOpener *opener = image->opener;
    const SluicePathOpener *by = &opener->path_opener;
    image->input.structSize = sizeof image->input;
    SluiceResult result =
        by->pfnOpenPath(by->pUserData, image->path, &image->input, &image->opened);
    if (result != SLUICE_SUCCESS) {
        image->opened = NULL;
        return result;
    }
    SluiceImageFileKind kind;
    result = slc_input_kind_find(&image->input, image->shown, &opener->log, &kind);
    if (result != SLUICE_SUCCESS)
        return result;
    slc_mutex_lock(&opener->mutex);
    image->kind = kind;
    image->is_kind_known = true;
    slc_condition_broadcast(&opener->opened); /* wakes requests for other textures of the file */
    slc_mutex_unlock(&opener->mutex);
    if (image->kind != SLUICE_IMAGE_FILE_KIND_PICTURE)
        return result;
    slc_log(&opener->log, SLUICE_LOG_ERROR,
            "%s: is no tile store, OpenEXR, DDS, KTX2 file or neural set; make a tile store of it "
            "with sluice-bake, and put that there",
            image->shown);
    return SLUICE_ERROR_UNSUPPORTED;
}

static SluiceResult check_texture(const SluiceImageOpener *opener, const char *path,
                                  const char *texture, SluiceImageFileKind kind)
{
    if (!texture || kind == SLUICE_IMAGE_FILE_KIND_NEURAL || kind == SLC_IMAGE_FILE_KIND_CATALOGUE)
        return SLUICE_SUCCESS;
    return slc_log_refusal(&opener->log,
                           "%s: is no neural set, so it has no texture of a name; open it with "
                           "sluiceOpenImageSource",
                           path);
}

static SluiceResult open_image(struct slc_opened_image *image, const SluiceBakeSettings *settings)
{
    SluiceImageOpener *opener = image->opener;
    const SluiceInput *input = NULL;
    SluiceResult result = SLUICE_SUCCESS;
    if (slc_opener_owns_path(opener, image->path)) {
        result = open_path(image);
        input = &image->input;
        if (result == SLUICE_SUCCESS)
            result = check_texture(opener, image->shown, image->texture, image->kind);
    }
    if (result != SLUICE_SUCCESS)
        return result;
    if (image->kind == SLC_IMAGE_FILE_KIND_CATALOGUE)
        return slc_opener_read_catalogue(image);
    if (image->kind == SLUICE_IMAGE_FILE_KIND_PICTURE)
        return slc_picture_stream_create(opener, image->path, &image->identity, settings,
                                         &image->stream);
    if (image->kind == SLUICE_IMAGE_FILE_KIND_NEURAL)
        result = slc_neural_file_open(input ? image->shown : image->path, input, image->texture,
                                      opener->files.pool, &opener->allocator, &opener->log,
                                      &image->source);
    else
        result =
            slc_file_kind_open(image->kind, input ? image->shown : image->path, input,
                               &opener->files, &opener->allocator, &opener->log, &image->source);
    return result == SLUICE_SUCCESS ? complete_chain(image) : result;
}

/* Opens an image for all waiting threads. The mutex is held, but unlocked while the file is opened.
 * Returns NULL, or a catalogue to release without the mutex. */
static struct slc_opened_image *open_for_all(struct slc_opened_image *image,
                                             const SluiceBakeSettings *settings)
{
    SluiceImageOpener *opener = image->opener;
    struct slc_opened_image *dropped = NULL;
    add_to_bucket(image);
    slc_mutex_unlock(&opener->mutex);
    SluiceResult result = open_image(image, settings);
    slc_mutex_lock(&opener->mutex);
    image->result = result;
    image->is_opening = false;
    if (result != SLUICE_SUCCESS)
        take_from_bucket(image); /* the next open call tries again */
    else if (image->catalogue)
        dropped = slc_opener_keep(image);
    slc_condition_broadcast(&opener->opened);
    return dropped;
}

/* Counts a reference and waits for the opening. False: another texture. The mutex is held. */
static bool wait_until_open(struct slc_opened_image *image, const struct slc_open_request *r)
{
    image->reference_count++;
    while (image->is_opening && (!image->is_kind_known || is_opened_as(image, r)))
        slc_condition_wait(&image->opener->opened, &image->opener->mutex);
    return is_opened_as(image, r);
}

/* Returns an open image with a counted reference. */
static SluiceResult get_image(SluiceImageOpener *opener, const struct slc_open_request *r,
                              struct slc_opened_image **opened)
{
    struct slc_opened_image *image, *dropped = NULL, *other = NULL;
    slc_mutex_lock(&opener->mutex);
    while ((image = find_image(opener, r)) && !wait_until_open(image, r)) {
        slc_mutex_unlock(&opener->mutex);
        slc_opener_release(image);
        slc_mutex_lock(&opener->mutex);
    }
    if (!image && (image = create_image(opener, r)))
        dropped = open_for_all(image, r->settings);
    SluiceResult result = image ? image->result : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (image && result != SLUICE_SUCCESS && drop_reference(image))
        other = image;
    slc_mutex_unlock(&opener->mutex);
    if (other)
        free_image(other);
    if (dropped)
        slc_opener_release(dropped);
    *opened = image;
    return result;
}

/* Hashes the bake settings. Settings for files other than pictures are ignored. */
static SluiceResult find_settings(struct slc_open_request *r)
{
#ifdef SLC_HAVE_BAKE
    if (r->settings && r->kind == SLUICE_IMAGE_FILE_KIND_PICTURE)
        return slc_picture_settings_hash(r->settings, &r->settings_hash);
#endif
    r->settings = NULL;
    return SLUICE_SUCCESS;
}

/* Finds kind and identity of a file. A file named by a catalogue must be a store. */
static SluiceResult look_at_file(SluiceImageOpener *opener, struct slc_open_request *r)
{
    SluiceResult result =
        slc_file_kind_find(opener->files.pool, r->path, &opener->log, &r->kind, &r->identity);
    if (result == SLUICE_SUCCESS)
        result = check_texture(opener, r->path, r->texture, r->kind);
    if (result == SLUICE_SUCCESS)
        result = find_settings(r);
    if (result != SLUICE_SUCCESS || !r->is_entry || r->kind == SLUICE_IMAGE_FILE_KIND_STORE)
        return result;
    slc_log(&opener->log, SLUICE_LOG_ERROR, "%s: is not the store that the catalogue names",
            r->path);
    return SLUICE_ERROR_CORRUPT_DATA;
}

/* Opens an image. A catalogue of a server may be outdated. After an error that an outdated
 * catalogue may cause, the catalogue is checked again before the error is returned. */
SluiceResult slc_opener_open(SluiceImageOpener *opener, struct slc_open_request *r,
                             SluiceImageSource **source)
{
    const uint64_t began = slc_monotonic_time();
    const bool is_file = !slc_opener_owns_path(opener, r->path);
    bool is_sure = is_file;
    r->kind = SLUICE_IMAGE_FILE_KIND_PICTURE;
    SluiceResult result = is_file ? look_at_file(opener, r) : SLUICE_SUCCESS;
    while (result == SLUICE_SUCCESS) {
        struct slc_opened_image *image;
        result = get_image(opener, r, &image);
        if (result == SLUICE_SUCCESS && !image->catalogue)
            *source = &image->base;
        if (result != SLUICE_SUCCESS || !image->catalogue)
            return result;
        bool is_current = slc_opener_is_current(image, began, &is_sure);
        if (is_current)
            result = slc_opener_open_row(image, r, is_sure, source);
        slc_opener_release(image);
        if (is_current && (is_sure || result == SLUICE_SUCCESS))
            return result;
        result = SLUICE_SUCCESS;
        is_sure = true;
    }
    return result;
}

SluiceResult sluiceOpenImageSource(SluiceImageOpener *opener, const char *path,
                                   SluiceImageSource **pSource)
{
    struct slc_open_request request = {.path = path};
    return !opener || !path || !pSource ? SLUICE_ERROR_NULL_POINTER
                                        : slc_opener_open(opener, &request, pSource);
}

SluiceResult sluiceOpenNamedImageSource(SluiceImageOpener *opener, const char *path,
                                        const char *texture, SluiceImageSource **pSource)
{
    struct slc_open_request request = {.path = path, .texture = texture};
    return !opener || !path || !texture || !pSource ? SLUICE_ERROR_NULL_POINTER
                                                    : slc_opener_open(opener, &request, pSource);
}

SluiceResult sluiceOpenBakedImageSource(SluiceImageOpener *opener, const char *path,
                                        const struct SluiceBakeSettings *pSettings,
                                        SluiceImageSource **pSource)
{
    SluiceBakeSettings settings = {.structSize = sizeof settings};
    struct slc_open_request request = {.path = path, .settings = &settings};
    if (!opener || !path || !pSettings || !pSource)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceBakeSettings), &settings, pSettings, NULL);
    return result == SLUICE_SUCCESS ? slc_opener_open(opener, &request, pSource) : result;
}

SluiceResult sluiceGetOpenedImageInfo(SluiceImageSource *source, SluiceOpenedImageInfo *pInfo)
{
    if (!source || !pInfo)
        return SLUICE_ERROR_NULL_POINTER;
    if (source->pInterface != &opened_interface)
        return SLUICE_ERROR_INVALID_ARGUMENT;
    SluiceResult result = slc_struct_check(SLC_STRUCT(SluiceOpenedImageInfo), pInfo, NULL);
    if (result != SLUICE_SUCCESS)
        return result;
    struct slc_opened_image *image = (struct slc_opened_image *)source;
    SluiceOpenedImageInfo info = {.structSize = sizeof info,
                                  .kind = image->kind,
                                  .source = image->source,
                                  .previewReady = true,
                                  .ready = true};
    slc_mutex_lock(&image->opener->mutex);
    info.openCount = image->reference_count;
    slc_mutex_unlock(&image->opener->mutex);
#ifdef SLC_HAVE_BAKE
    if (image->stream)
        slc_picture_stream_describe(image->stream, &info);
#endif
    slc_struct_write(SLC_STRUCT(SluiceOpenedImageInfo), pInfo, &info);
    return SLUICE_SUCCESS;
}
