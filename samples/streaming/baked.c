#define _XOPEN_SOURCE 700
#include "baked.h"

#ifdef HAVE_BAKE

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <sluice/bake.h>

#include "../common/files.h"
#include "../common/progress.h"
#include "cache.h"

/* Somebody waits: a third of the time of the baker's own level, for files a sixth larger. */
#define COMPRESSION_LEVEL 3

struct baking {
    SluiceBaker *baker;
    const char *cache;
    enum pixel_format pixels;
    struct progress progress;
    bool shown;              ///< nothing is, until there is something to bake
    uint64_t size, done;     ///< bytes of all pictures, and of those before this one
    uint64_t picture_size;   ///< bytes
    uint32_t baked, skipped; ///< pictures
};

/* Halves of an OpenEXR file that --format makes bytes of would be linear bytes: too few for
 * shadows. They are read whole instead. */
static bool needs_store(const struct picture_path *picture, enum pixel_format pixels)
{
    return !picture->refused &&
           (picture->kind == PICTURE_OTHER ||
            (picture->kind == PICTURE_EXR_LEVEL_ZERO && pixels != PIXEL_FORMAT_RGBA8));
}

static uint64_t file_size(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 ? (uint64_t)status.st_size : 0;
}

/** "cache/baked/whole/path.png.store", and the folders above it. */
static char *store_path(const char *picture, const char *cache)
{
    char folder[4096];
    char *whole = realpath(picture, NULL), *path = NULL;
    if (!whole)
        fprintf(stderr, "%s: %s\n", picture, strerror(errno));
    else if (!cache_path(cache, "baked", folder, sizeof folder))
        fprintf(stderr, "the cache folder's name is too long\n");
    else {
        size_t size = strlen(folder) + strlen(whole) + sizeof SLUICE_STORE_EXTENSION;
        path = malloc(size);
        if (path)
            snprintf(path, size, "%s%s" SLUICE_STORE_EXTENSION, folder, whole);
    }
    char *slash = path ? strrchr(path, '/') : NULL;
    if (slash)
        *slash = '\0';
    bool made = slash && files_make_folders(path);
    if (slash)
        *slash = '/';
    if (!made) {
        free(path);
        path = NULL;
    }
    free(whole);
    return path;
}

/** Of photographs and drawings colours are sRGB, also grey ones; others hold light itself. */
static SluiceResult choose_settings(const struct baking *baking, const struct picture_path *picture,
                                    SluiceBakeSettings *settings)
{
    *settings = (SluiceBakeSettings){.format = SLUICE_FORMAT_R16G16B16A16_SFLOAT,
                                     .compressionLevel = COMPRESSION_LEVEL};
    if (picture->kind == PICTURE_EXR_LEVEL_ZERO)
        return picture_file_exr_format(picture->path, baking->pixels, &settings->format);
    if (!files_has_suffix(picture->path, ".hdr|.pfm")) {
        settings->transfer = SLUICE_BAKE_TRANSFER_SRGB;
        if (baking->pixels != PIXEL_FORMAT_RGBA16F)
            settings->format = SLUICE_FORMAT_R8G8B8A8_SRGB;
    }
    return SLUICE_SUCCESS;
}

static bool note_progress(void *user_data, uint64_t done, uint64_t total)
{
    struct baking *baking = user_data;
    double share = total ? (double)done / (double)total : 1.0;
    if (!baking->shown)
        progress_begin(&baking->progress, "baking", "B", baking->size - baking->done);
    baking->shown = true;
    progress_update(&baking->progress, baking->progress.total - (baking->size - baking->done) +
                                           (uint64_t)(share * (double)baking->picture_size));
    return true;
}

static SluiceResult bake(struct baking *baking, struct picture_path *picture)
{
    SluiceBakeReport report = {0};
    SluiceBakeInfo info = {
        .pInputPath = picture->path, .pUserData = baking, .pfnProgress = note_progress};
    picture->store = store_path(picture->path, baking->cache);
    info.pOutputPath = picture->store;
    if (!picture->store)
        return SLUICE_ERROR_IO;
    SluiceResult result = choose_settings(baking, picture, &info.settings);
    if (result == SLUICE_SUCCESS)
        result = sluiceBakeFile(baking->baker, &info, &report);
    baking->skipped += result == SLUICE_SUCCESS && report.skipped;
    baking->baked += result == SLUICE_SUCCESS && !report.skipped;
    return result;
}

static void bake_all(struct baking *baking, struct picture_path *paths, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (!needs_store(&paths[i], baking->pixels))
            continue;
        baking->picture_size = file_size(paths[i].path);
        SluiceResult result = bake(baking, &paths[i]);
        paths[i].refused = result != SLUICE_SUCCESS;
        if (paths[i].refused)
            fprintf(stderr, "%s: left out: %s\n", paths[i].path, sluiceResultString(result));
        baking->done += baking->picture_size;
    }
    if (baking->shown)
        progress_end(&baking->progress);
    fprintf(stderr, "%u pictures baked, %u were up to date\n", baking->baked, baking->skipped);
}

bool baked_prepare(struct picture_path *paths, size_t count, const char *cache,
                   enum pixel_format pixels)
{
    struct baking baking = {.cache = cache, .pixels = pixels};
    SluiceBakerCreateInfo info = {.log = {NULL, picture_file_log}};
    bool needed = false;
    for (size_t i = 0; i < count; i++)
        if (needs_store(&paths[i], pixels)) {
            needed = true;
            baking.size += file_size(paths[i].path);
        }
    if (!needed)
        return true;
    SluiceResult result = sluiceCreateBaker(&info, &baking.baker);
    if (result != SLUICE_SUCCESS) {
        fprintf(stderr, "pictures cannot be baked: %s\n", sluiceResultString(result));
        return false;
    }
    bake_all(&baking, paths, count);
    sluiceDestroyBaker(baking.baker);
    return true;
}

#else

bool baked_prepare(struct picture_path *paths, size_t count, const char *cache,
                   enum pixel_format pixels)
{
    (void)paths, (void)count, (void)cache, (void)pixels;
    return true;
}

#endif /* HAVE_BAKE */
