/* strdup, getpid */
#define _XOPEN_SOURCE 700

#include "scene_images.h"

#include "linear_source.h"

#include "../../samples/streaming/cache.h"
#include "../common/clock.h"
#include "../common/files.h"
#include "../common/log.h"
#include "../common/text.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define BAKE_SECONDS 600.0

bool scene_images_create_opener(const char *cache, struct scene_data *scene)
{
    char folder[4096];
    if (!cache_path(cache, "pictures", folder, sizeof folder) || !files_make_folders(folder))
        return false;
    const SluiceImageOpenerCreateInfo info = {
        .structSize = sizeof info, .pCacheFolder = folder, .log = {NULL, log_say}};
    const SluiceResult result = sluiceCreateImageOpener(&info, &scene->opener);
    if (result != SLUICE_SUCCESS)
        text_say("sluice-view: %s", sluiceGetResultName(result));
    return result == SLUICE_SUCCESS;
}

static uint32_t find(const struct scene_data *scene, const struct scene_image_request *r)
{
    for (uint32_t i = 0; i < scene->image_count; i++) {
        const struct scene_image *image = &scene->images[i];
        if (image->wrap_u == r->wrap_u && image->wrap_v == r->wrap_v &&
            image->linear == r->linear && strcmp(image->path, r->path) == 0)
            return i;
    }
    return SCENE_NO_IMAGE;
}

static SluiceResult open_source(struct scene_data *scene, const struct scene_image_request *r,
                                SluiceImageSource **source)
{
    SluiceImageSource *linear = NULL;
    SluiceResult result = sluiceOpenImageSource(scene->opener, r->path, source);
    if (result != SLUICE_SUCCESS || !r->linear)
        return result;
    result = linear_source_create(*source, &linear);
    if (result == SLUICE_SUCCESS)
        *source = linear;
    else
        sluiceDestroyImageSource(*source);
    return result;
}

uint32_t scene_images_add(struct scene_data *scene, const struct scene_image_request *r)
{
    const uint32_t known = find(scene, r);
    if (known != SCENE_NO_IMAGE)
        return known;
    struct scene_image *image = &scene->images[scene->image_count];
    *image = (struct scene_image){
        .wrap_u = r->wrap_u, .wrap_v = r->wrap_v, .linear = r->linear, .primary = SCENE_NO_IMAGE};
    const SluiceResult result = open_source(scene, r, &image->source);
    if (result != SLUICE_SUCCESS) {
        scene_data_note(scene, "%s: cannot be shown: %s", r->path, sluiceGetResultName(result));
        return SCENE_NO_IMAGE;
    }
    image->name = strdup(r->name);
    image->path = strdup(r->path);
    if (image->name && image->path)
        return scene->image_count++;
    sluiceDestroyImageSource(image->source);
    free(image->name);
    free(image->path);
    scene_data_note(scene, "%s: out of memory", r->path);
    return SCENE_NO_IMAGE;
}

/* FNV-1a. */
static uint64_t hash(const uint8_t *bytes, size_t size)
{
    uint64_t value = 0xcbf29ce484222325u;
    for (size_t i = 0; i < size; i++)
        value = (value ^ bytes[i]) * 0x100000001b3u;
    return value;
}

static bool write_whole(const char *path, const void *bytes, size_t size)
{
    char part[4200];
    snprintf(part, sizeof part, "%s.%ld.part", path, (long)getpid());
    FILE *file = fopen(part, "wb");
    bool written = file && fwrite(bytes, 1, size, file) == size;
    written = file && fclose(file) == 0 && written && rename(part, path) == 0;
    if (!written)
        remove(part);
    return written;
}

bool scene_images_keep(const char *cache, const void *bytes, size_t size, char *path,
                       size_t path_size)
{
    char name[64];
    snprintf(name, sizeof name, "embedded/%016" PRIx64 "-%zx", hash(bytes, size), size);
    if (!cache_path(cache, name, path, path_size) || !files_make_folders_of(path)) {
        text_say("sluice-view: cannot make the folder of %s", path);
        return false;
    }
    if (files_size(path) == size || write_whole(path, bytes, size))
        return true;
    text_say("sluice-view: %s: cannot be written", path);
    return false;
}

void scene_images_wait(const struct scene_data *scene)
{
    const double end = clock_seconds() + BAKE_SECONDS;
    for (uint32_t i = 0; i < scene->image_count; i++) {
        SluiceImageSource *source = linear_source_inner(scene->images[i].source);
        SluiceOpenedImageInfo info = {.structSize = sizeof info};
        while (sluiceGetOpenedImageInfo(source, &info) == SLUICE_SUCCESS && !info.ready &&
               info.failure == SLUICE_SUCCESS && clock_seconds() < end)
            clock_sleep_until(clock_seconds() + 0.01);
    }
}
