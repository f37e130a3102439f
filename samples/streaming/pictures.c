#define _POSIX_C_SOURCE 200809L
#include "pictures.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../../tools/common/files.h"
#include "../../tools/common/log.h"
#include "../../tools/common/text.h"
#include "baked.h"
#include "cache.h"
#include "exposure.h"
#include "neural_files.h"

static bool is_compressed(SluiceFormat format)
{
    SluiceFormatInfo info = {.structSize = sizeof info};
    return sluiceGetFormatInfo(format, &info) == SLUICE_SUCCESS && info.blockWidth > 1;
}

static bool refuse(const char *path, const SluiceImageInfo *info, const char *why)
{
    text_say("%s: %u x %u texels of %s: %s", path, info->width, info->height,
             sluiceGetFormatName(info->format), why);
    return false;
}

static bool fits(const char *path, const SluiceImageInfo *info, const struct picture_limits *limits)
{
    uint64_t bytes = sluiceGetFormatRegionSize(info->format, info->width, info->height);
    if (info->width > limits->max_size || info->height > limits->max_size ||
        bytes > limits->max_bytes - limits->max_bytes / 4)
        return refuse(path, info, "more than the device can address");
    if (is_compressed(info->format) && !limits->takes_blocks)
        return refuse(path, info, "the device has no textureCompressionBC");
    if (info->arrayLayerCount > 1)
        return refuse(path, info, "several layers, and only single pictures hang here");
    return true;
}

static bool is_gray(SluiceFormat format)
{
    SluiceFormatInfo info = {.structSize = sizeof info};
    return sluiceGetFormatInfo(format, &info) == SLUICE_SUCCESS && info.channelCount == 1;
}

static SluiceResult open_picture(const struct picture_path *path, struct picture_opening opening,
                                 struct remote_session *session,
                                 const struct picture_limits *limits, struct picture *picture)
{
    const SluiceLogCallback to_stderr = {NULL, log_say};
    *picture = (struct picture){.path = strdup(path->path)};
    if (!picture->path)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (remote_is_url(path->path) &&
        !remote_open(&picture->remote, session, path->path, &to_stderr))
        return SLUICE_ERROR_IO;
    opening.input = remote_input(&picture->remote);
    SluiceResult result = picture_file_open(path->store ? path->store : path->path,
                                            path->store ? PICTURE_STORE : path->kind, &opening,
                                            &picture->color, &picture->info);
    if (result == SLUICE_SUCCESS && !fits(path->path, &picture->info, limits))
        result = SLUICE_ERROR_UNSUPPORTED;
    if (result == SLUICE_SUCCESS)
        result = exposure_measure(picture->color, &picture->info, &picture->exposure);
    picture->gray = is_gray(picture->info.format);
    return result;
}

static void close_picture(struct picture *picture)
{
    sluiceDestroyImageSource(picture->color);
    remote_close(&picture->remote);
    sluiceDestroyImageSource(picture->relief);
    if (picture->neural)
        sluiceDestroyImageSource(picture->neural->original);
    free(picture->neural);
    free(picture->path);
}

/* Call when the list is complete, because the patterns must not move afterwards. */
static bool create_reliefs(struct picture_list *list)
{
    for (uint32_t i = 0; i < list->count; i++) {
        struct picture *picture = &list->pictures[i];
        picture->relief_pattern = (struct pattern_image){
            .name = "relief",
            .width = (picture->info.width + 1) / 2,
            .height = (picture->info.height + 1) / 2,
            .pattern = pattern_canvas,
            .supersamples = 1,
        };
        SluiceResult result = pattern_create_source(&picture->relief_pattern,
                                                    SLUICE_FORMAT_R8_UNORM, &picture->relief);
        if (result != SLUICE_SUCCESS) {
            text_say("%s: no relief: %s", picture->path, sluiceGetResultName(result));
            return false;
        }
    }
    return true;
}

static const char *reason(SluiceResult result)
{
    return result == SLUICE_NOT_READY ? "too few file descriptors; ulimit -n allows more"
                                      : sluiceGetResultName(result);
}

static bool open_all(const struct picture_path *paths, size_t count, enum pixel_format pixels,
                     const struct picture_limits *limits, struct picture_list *list)
{
    struct picture_opening opening = {.pixels = pixels, .pool = list->pool, .memory = list->memory};
    for (size_t i = 0; i < count; i++) {
        struct picture *picture = &list->pictures[list->count];
        SluiceResult result = SLUICE_ERROR_IO;
        if (!paths[i].refused) {
            result = open_picture(&paths[i], opening, &list->session, limits, picture);
            if (result == SLUICE_SUCCESS) {
                list->count++;
                continue;
            }
            text_say("%s: left out: %s", paths[i].path, reason(result));
            close_picture(picture);
        }
        list->refused++;
    }
    if (list->count == 0)
        fprintf(stderr, "there is no picture to hang\n");
    return list->count > 0 && create_reliefs(list);
}

static bool create_pool(struct picture_list *list)
{
    if (sluiceCreateExrMemoryBudget(0, NULL, &list->memory) != SLUICE_SUCCESS)
        return false;
#ifdef HAVE_STORE
    return sluiceCreateStoreReadPool(NULL, &list->pool) == SLUICE_SUCCESS;
#else
    return true;
#endif
}

/* Copies a picture to the cache, because image libraries read only files. */
static SluiceResult copy_picture(const char *url, const char *cache, struct remote_session *session,
                                 char **copy)
{
    const SluiceLogCallback to_stderr = {NULL, log_say};
    struct remote_file remote;
    char name[256], path[4096];
    if (!remote_open(&remote, session, url, &to_stderr))
        return SLUICE_ERROR_IO;
    remote_name(url, name, sizeof name);
    bool kept = cache_keep_input(cache, name, &remote.input, path, sizeof path);
    remote_close(&remote);
    *copy = kept ? strdup(path) : NULL;
    return *copy ? SLUICE_SUCCESS : SLUICE_ERROR_IO;
}

/* Finds the kind of a picture. Tile stores on servers are read in place. */
static SluiceResult find_kind(struct picture_path *path, const char *cache,
                              struct remote_session *session)
{
    char name[256];
    if (!remote_is_url(path->path))
        return picture_file_kind(path->path, &path->kind);
    remote_name(path->path, name, sizeof name);
    path->kind = PICTURE_STORE; /* opening refuses other files */
    if (!files_has_suffix(name, PICTURE_SUFFIXES))
        return SLUICE_SUCCESS;
    SluiceResult result = copy_picture(path->path, cache, session, &path->copy);
    if (result != SLUICE_SUCCESS)
        return result;
    path->path = path->copy;
    return picture_file_kind(path->path, &path->kind);
}

static bool open_files(const struct file_list *files, const struct settings *settings,
                       const struct picture_limits *limits, struct picture_list *list)
{
    enum pixel_format pixels = (enum pixel_format)settings->format;
    size_t count = files->count;
    struct picture_path *paths = calloc(count ? count : 1, sizeof *paths);
    list->pictures = calloc(count ? count : 1, sizeof *list->pictures);
    bool opened = paths && list->pictures && create_pool(list);
    if (!opened)
        fprintf(stderr, "out of memory\n");
    for (size_t i = 0; opened && i < count; i++) {
        paths[i].path = files->paths[i];
        SluiceResult result = find_kind(&paths[i], settings->cache, &list->session);
        paths[i].refused = result != SLUICE_SUCCESS;
        if (result == SLUICE_NOT_READY)
            text_say("%s: left out: %s", paths[i].path, reason(result));
    }
    opened = opened && baked_prepare(paths, count, settings->cache, pixels) &&
             open_all(paths, count, pixels, limits, list);
    for (size_t i = 0; paths && i < count; i++) {
        free(paths[i].store);
        free(paths[i].copy);
    }
    free(paths);
    return opened;
}

static bool collect_generated(const struct settings *settings, struct file_list *files)
{
    char folder[4000], paths[GENERATED_COUNT][4096];
    long processors = sysconf(_SC_NPROCESSORS_ONLN);
    if (!generate_folder(settings->cache, settings->generate_scale, folder, sizeof folder) ||
        !generate_pictures(folder, settings->generate_scale,
                           processors > 1 ? (uint32_t)processors : 1, paths))
        return false;
    for (uint32_t i = 0; i < GENERATED_COUNT; i++)
        if (!files_collect(paths[i], HANGABLE_SUFFIXES, files))
            return false;
    return true;
}

bool pictures_open(const struct settings *settings, const struct picture_limits *limits,
                   struct picture_list *list)
{
    struct file_list files = {0};
    if (settings->neural) {
        *list = (struct picture_list){0};
        bool hung = neural_files_open(settings, limits, list);
        if (!hung)
            pictures_close(list);
        return hung;
    }
    bool collected = settings->images.count > 0 || collect_generated(settings, &files);
    for (size_t i = 0; collected && i < settings->images.count; i++) {
        const char *name = settings->images.items[i];
        collected = remote_is_url(name) ? files_add(name, &files)
                                        : files_collect(name, HANGABLE_SUFFIXES, &files);
    }
    *list = (struct picture_list){.refused = (uint32_t)files.unreadable_count};
    bool opened = collected && open_files(&files, settings, limits, list);
    files_finish(&files);
    if (!opened)
        pictures_close(list);
    return opened;
}

void pictures_close(struct picture_list *list)
{
    for (uint32_t i = 0; i < list->count; i++)
        close_picture(&list->pictures[i]);
    free(list->pictures);
    neural_files_close(list->neural);
#ifdef HAVE_STORE
    sluiceDestroyStoreReadPool(list->pool);
#endif
    sluiceDestroyExrMemoryBudget(list->memory);
    remote_end(&list->session);
    *list = (struct picture_list){0};
}
