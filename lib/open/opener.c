#define _POSIX_C_SOURCE 200809L

#include "open/opener.h"

#include <sluice/bake.h>

#include "base/alloc.h"
#include "base/checked.h"
#include "base/log.h"
#include "base/said.h"
#include "base/shown_url.h"
#include "base/struct_size.h"
#include "image/identity.h"
#include "open/neural_file.h"
#ifdef SLC_HAVE_BAKE
#include "open/background.h"
#endif

#include <string.h>

/* A store that is damaged or cannot be read is baked again. */
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
        !info.pathOpener.pfnOpenPath != !info.pathOpener.pfnClosePath)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceAllocationCallbacks cb = slc_allocator(info.pAllocator);
    SluiceImageOpener *opener = slc_calloc(&cb, 1, sizeof *opener);
    if (!opener)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    opener->allocator = cb;
    opener->log = info.log;
    opener->path_opener = info.pathOpener;
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
    slc_catalogue_entry_finish(&image->entry, &cb);
    slc_free(&cb, image, 1, sizeof *image);
}

/* Not of pictures. */
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

/* Tiles of pictures get other texels when the bake is done. */
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

/* With the mutex held. */
static void add_to_bucket(struct slc_opened_image *image)
{
    struct slc_opened_image **bucket = find_bucket(image->opener, image->path);
    image->next = *bucket;
    *bucket = image;
}

/* With the mutex held. Nothing if it is in none. */
static void take_from_bucket(struct slc_opened_image *image)
{
    struct slc_opened_image **link = find_bucket(image->opener, image->path);
    while (*link && *link != image)
        link = &(*link)->next;
    if (*link)
        *link = image->next;
}

/* With the mutex held. Whether it was the last one; then the image is in no bucket. */
static bool drop_reference(struct slc_opened_image *image)
{
    bool is_last = --image->reference_count == 0;
    if (is_last)
        take_from_bucket(image);
    return is_last;
}

static void destroy(SluiceImageSource *base)
{
    struct slc_opened_image *image = (struct slc_opened_image *)base;
    SluiceImageOpener *opener = image->opener;
    slc_mutex_lock(&opener->mutex);
    bool is_last = drop_reference(image);
    slc_mutex_unlock(&opener->mutex);
    if (is_last)
        free_image(image);
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

/** One call. */
struct request {
    const char *path, *texture;         ///< texture NULL: none
    const SluiceBakeSettings *settings; ///< NULL: default
    uint64_t settings_hash;             ///< 0: default, or of no picture
    SluiceImageFileKind kind;
    struct slc_file_identity identity;
    bool is_entry; ///< a catalogue names it
};

/* With the mutex held. */
static struct slc_opened_image *find_image(SluiceImageOpener *opener, const struct request *r)
{
    const struct slc_file_identity *identity = &r->identity;
    struct slc_opened_image *image = *find_bucket(opener, r->path);
    while (image &&
           (strcmp(image->path, r->path) != 0 || !is_same_name(image->texture, r->texture) ||
            image->settings_hash != r->settings_hash ||
            memcmp(&image->identity, identity, sizeof *identity) != 0))
        image = image->next;
    return image;
}

/* Compressed levels cannot be built; what a chain without them is good for, its user decides. */
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

static bool is_own_path(const SluiceImageOpener *opener, const char *path)
{
    return opener->path_opener.pfnOpenPath && strstr(path, "://");
}

/* NULL: no memory. */
static struct slc_opened_image *create_image(SluiceImageOpener *opener, const struct request *r)
{
    const char *path = r->path, *texture = r->texture;
    struct slc_opened_image *image = slc_calloc(&opener->allocator, 1, sizeof *image);
    if (!image)
        return NULL;
    image->base.pInterface = &opened_interface;
    image->opener = opener;
    image->reference_count = 1;
    image->is_opening = true;
    image->kind = r->kind;
    image->identity = r->identity;
    image->settings_hash = r->settings_hash;
    image->path = slc_strdup(&opener->allocator, path);
    if (is_own_path(opener, path))
        image->shown = slc_shown_url(&opener->allocator, path);
    if (texture)
        image->texture = slc_strdup(&opener->allocator, texture);
    if (image->path && (image->shown || !is_own_path(opener, path)) && (image->texture || !texture))
        return image;
    free_image(image);
    return NULL;
}

/* Errors: of a path opener, of what it opened; UNSUPPORTED, logged. */
static SluiceResult open_path(struct slc_opened_image *image)
{
    const SluiceImageOpener *opener = image->opener;
    const SluicePathOpener *by = &opener->path_opener;
    image->input.structSize = sizeof image->input;
    SluiceResult result =
        by->pfnOpenPath(by->pUserData, image->path, &image->input, &image->opened);
    if (result != SLUICE_SUCCESS) {
        image->opened = NULL;
        return result;
    }
    result = slc_input_kind_find(&image->input, image->shown, &opener->log, &image->kind);
    if (result != SLUICE_SUCCESS || image->kind != SLUICE_IMAGE_FILE_KIND_PICTURE)
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

static SluiceResult find_entry(SluiceImageOpener *opener, const char *path, const char *shown,
                               const char *name, const SluiceInput *input,
                               struct slc_catalogue_entry *entry)
{
    const struct slc_catalogue_query query = {.path = path,
                                              .shown = shown,
                                              .name = name,
                                              .input = input,
                                              .pool = opener->files.pool,
                                              .allocator = &opener->allocator,
                                              .log = &opener->log};
    return slc_catalogue_find(&query, entry);
}

static SluiceResult open_image(struct slc_opened_image *image, const SluiceBakeSettings *settings)
{
    SluiceImageOpener *opener = image->opener;
    const SluiceInput *input = NULL;
    SluiceResult result = SLUICE_SUCCESS;
    if (is_own_path(opener, image->path)) {
        result = open_path(image);
        input = &image->input;
        if (result == SLUICE_SUCCESS)
            result = check_texture(opener, image->shown, image->texture, image->kind);
    }
    if (result != SLUICE_SUCCESS)
        return result;
    if (image->kind == SLC_IMAGE_FILE_KIND_CATALOGUE) {
        result =
            find_entry(opener, image->path, image->shown, image->texture, input, &image->entry);
        return result == SLUICE_SUCCESS ? SLUICE_ERROR_UNSUPPORTED : result; /* as itself */
    }
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

/* With the mutex held, but not while the file is opened. Other threads that open it wait. */
static void open_for_all(struct slc_opened_image *image, const SluiceBakeSettings *settings)
{
    SluiceImageOpener *opener = image->opener;
    add_to_bucket(image);
    slc_mutex_unlock(&opener->mutex);
    SluiceResult result = open_image(image, settings);
    slc_mutex_lock(&opener->mutex);
    image->result = result;
    image->is_opening = false;
    if (result != SLUICE_SUCCESS)
        take_from_bucket(image); /* who opens it next tries again */
    slc_condition_broadcast(&opener->opened);
}

/* With the mutex held, but not while it waits. Counts the image. */
static void wait_until_open(struct slc_opened_image *image)
{
    image->reference_count++;
    while (image->is_opening)
        slc_condition_wait(&image->opener->opened, &image->opener->mutex);
}

/* Settings that are no picture's make no other source. */
static SluiceResult find_settings(struct request *r)
{
#ifdef SLC_HAVE_BAKE
    if (r->settings && r->kind == SLUICE_IMAGE_FILE_KIND_PICTURE)
        return slc_picture_settings_hash(r->settings, &r->settings_hash);
#endif
    r->settings = NULL;
    return SLUICE_SUCCESS;
}

static SluiceResult open_request(SluiceImageOpener *opener, struct request *r,
                                 SluiceImageSource **source);

static bool is_named_store(const struct slc_opened_image *image, uint64_t hash)
{
#ifdef SLC_HAVE_STORE
    uint64_t found;
    return image->kind == SLUICE_IMAGE_FILE_KIND_STORE &&
           sluiceHashStore(image->source, &found) == SLUICE_SUCCESS && found == hash;
#else
    (void)image, (void)hash;
    return false;
#endif
}

/* Opens the store that a catalogue names, and ends the entry. `by`: the request for the catalogue.
 * Errors: CORRUPT_DATA if another file is there. */
static SluiceResult open_entry(SluiceImageOpener *opener, const struct request *by,
                               struct slc_catalogue_entry *entry, SluiceImageSource **source)
{
    struct request request = {.path = entry->store, .is_entry = true};
    SluiceImageSource *store = NULL;
    SluiceResult result = by->is_entry ? SLUICE_ERROR_CORRUPT_DATA : SLUICE_SUCCESS;
    if (result == SLUICE_SUCCESS)
        result = open_request(opener, &request, &store);
    if (result == SLUICE_SUCCESS &&
        !is_named_store((const struct slc_opened_image *)store, entry->hash)) {
        const char *shown = ((const struct slc_opened_image *)store)->shown;
        slc_log(&opener->log, SLUICE_LOG_ERROR, "%s: is not the store that the catalogue names",
                shown ? shown : entry->store);
        sluiceDestroyImageSource(store);
        result = SLUICE_ERROR_CORRUPT_DATA;
    }
    if (result == SLUICE_SUCCESS)
        *source = store;
    slc_catalogue_entry_finish(entry, &opener->allocator);
    return result;
}

static SluiceResult open_request(SluiceImageOpener *opener, struct request *r,
                                 SluiceImageSource **source)
{
    struct slc_catalogue_entry entry = {0};
    SluiceResult result = SLUICE_SUCCESS;
    r->kind = SLUICE_IMAGE_FILE_KIND_PICTURE;
    if (!is_own_path(opener, r->path)) {
        result =
            slc_file_kind_find(opener->files.pool, r->path, &opener->log, &r->kind, &r->identity);
        if (result == SLUICE_SUCCESS)
            result = check_texture(opener, r->path, r->texture, r->kind);
        if (result == SLUICE_SUCCESS)
            result = find_settings(r);
        if (result == SLUICE_SUCCESS && r->is_entry && r->kind != SLUICE_IMAGE_FILE_KIND_STORE &&
            r->kind != SLC_IMAGE_FILE_KIND_CATALOGUE) { /* is never parsed or baked */
            slc_log(&opener->log, SLUICE_LOG_ERROR, "%s: is not the store that the catalogue names",
                    r->path);
            result = SLUICE_ERROR_CORRUPT_DATA;
        }
        if (result == SLUICE_SUCCESS && r->kind == SLC_IMAGE_FILE_KIND_CATALOGUE) {
            result = find_entry(opener, r->path, r->path, r->texture, NULL, &entry);
            return result == SLUICE_SUCCESS ? open_entry(opener, r, &entry, source) : result;
        }
    }
    if (result != SLUICE_SUCCESS)
        return result;
    slc_mutex_lock(&opener->mutex);
    struct slc_opened_image *image = find_image(opener, r);
    if (image)
        wait_until_open(image);
    else if ((image = create_image(opener, r)))
        open_for_all(image, r->settings);
    result = image ? image->result : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (image && image->entry.store) {
        entry = image->entry;
        entry.store = slc_strdup(&opener->allocator, image->entry.store);
        result = entry.store ? result : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    bool is_unused = image && result != SLUICE_SUCCESS && drop_reference(image);
    slc_mutex_unlock(&opener->mutex);
    if (is_unused)
        free_image(image);
    if (entry.store)
        return open_entry(opener, r, &entry, source);
    if (result == SLUICE_SUCCESS)
        *source = &image->base;
    return result;
}

SluiceResult sluiceOpenImageSource(SluiceImageOpener *opener, const char *path,
                                   SluiceImageSource **pSource)
{
    struct request request = {.path = path};
    return !opener || !path || !pSource ? SLUICE_ERROR_NULL_POINTER
                                        : open_request(opener, &request, pSource);
}

SluiceResult sluiceOpenNamedImageSource(SluiceImageOpener *opener, const char *path,
                                        const char *texture, SluiceImageSource **pSource)
{
    struct request request = {.path = path, .texture = texture};
    return !opener || !path || !texture || !pSource ? SLUICE_ERROR_NULL_POINTER
                                                    : open_request(opener, &request, pSource);
}

SluiceResult sluiceOpenBakedImageSource(SluiceImageOpener *opener, const char *path,
                                        const struct SluiceBakeSettings *pSettings,
                                        SluiceImageSource **pSource)
{
    SluiceBakeSettings settings = {.structSize = sizeof settings};
    struct request request = {.path = path, .settings = &settings};
    if (!opener || !path || !pSettings || !pSource)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceBakeSettings), &settings, pSettings, NULL);
    return result == SLUICE_SUCCESS ? open_request(opener, &request, pSource) : result;
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
