/* strdup */
#define _XOPEN_SOURCE 700

#include "scene_images.h"

#include "linear_source.h"
#include "scene_catalogue.h"

#include "../../samples/streaming/cache.h"
#include "../common/clock.h"
#include "../common/files.h"
#include "../common/log.h"
#include "../common/text.h"

#include <sluice/bake.h>

#include <vulkan/vulkan_core.h>

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
    /* Leaves a processor to frames. */
    const long processors = sysconf(_SC_NPROCESSORS_ONLN);
    SluiceImageOpenerCreateInfo info = {.structSize = sizeof info,
                                        .pCacheFolder = folder,
                                        .bakeThreadCount =
                                            processors > 2 ? (uint32_t)processors - 1 : 1,
                                        .log = {NULL, log_say}};
    remote_serve_opener(&scene->remote, &info);
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
            image->content == r->content && strcmp(image->path, r->path) == 0)
            return i;
    }
    return SCENE_NO_IMAGE;
}

/* Finds the '#' after the name of a file with several pictures; NULL: none. */
static const char *find_name(const char *path)
{
    const char *set = strstr(path, ".ntc#"), *list = strstr(path, CATALOGUE "#");
    const char *query = remote_is_url(path) ? strstr(path, CATALOGUE "?") : NULL;
    if (set || list)
        return (set ? set : list) + strlen(CATALOGUE);
    return query ? strchr(query, '#') : NULL;
}

/* Opens a path. "set.ntc#name" is a texture of a neural set, "list.tsv#name" a store of a
 * catalogue, unless a file has this name. */
static SluiceResult open_path(SluiceImageOpener *opener, const char *path,
                              const SluiceBakeSettings *settings, SluiceImageSource **source)
{
    char set[4096];
    const char *name = find_name(path);
    if (!name || access(path, F_OK) == 0)
        return sluiceOpenBakedImageSource(opener, path, settings, source);
    if (snprintf(set, sizeof set, "%.*s", (int)(name - path), path) >= (int)sizeof set)
        return SLUICE_ERROR_FILE_NOT_FOUND;
    return sluiceOpenNamedImageSource(opener, set, name + 1, source);
}

static SluiceBakeWrap wrap_of(int mode)
{
    return mode == VK_SAMPLER_ADDRESS_MODE_REPEAT            ? SLUICE_BAKE_WRAP_REPEAT
           : mode == VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT ? SLUICE_BAKE_WRAP_MIRROR
                                                             : SLUICE_BAKE_WRAP_CLAMP;
}

/* Opens the source of an image. Bake settings apply to pictures. Other files have finished levels,
 * so only their format changes. */
static SluiceResult open_source(struct scene_data *scene, const struct scene_image_request *r,
                                SluiceImageSource **source)
{
    SluiceImageSource *outer = NULL;
    const SluiceBakeSettings settings = {.structSize = sizeof settings,
                                         .transfer = r->content == CONTENT_NUMBERS
                                                         ? SLUICE_BAKE_TRANSFER_LINEAR
                                                         : SLUICE_BAKE_TRANSFER_AUTO,
                                         .wrapX = wrap_of(r->wrap_u),
                                         .wrapY = wrap_of(r->wrap_v),
                                         .normalMap = r->content == CONTENT_NORMALS};
    SluiceResult result = open_path(scene->opener, r->path, &settings, source);
    if (result != SLUICE_SUCCESS || (r->content == CONTENT_COLORS && !r->is_srgb))
        return result;
    result = r->content == CONTENT_COLORS ? linear_source_create_srgb(*source, &outer)
                                          : linear_source_create(*source, &outer);
    if (result == SLUICE_SUCCESS)
        *source = outer;
    else
        sluiceDestroyImageSource(*source);
    return result;
}

/* Returns why a source cannot be shown; NULL: it can. Views and picks need single pictures, filters
 * need numbers that can be mixed. */
static const char *find_refusal(SluiceImageSource *source)
{
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceFormatInfo format = {.structSize = sizeof format};
    if (sluiceGetImageInfo(source, &info) != SLUICE_SUCCESS ||
        sluiceGetFormatInfo(info.format, &format) != SLUICE_SUCCESS)
        return "its format is unknown";
    if (info.arrayLayerCount > 1)
        return "it has several layers";
    return format.integer ? "its texels are integers" : NULL;
}

uint32_t scene_images_add(struct scene_data *scene, const struct scene_image_request *r)
{
    if (scene->progress)
        atomic_fetch_add(&scene->progress->done, 1);
    if (scene_data_canceled(scene))
        return SCENE_NO_IMAGE;
    const uint32_t known = find(scene, r);
    if (known != SCENE_NO_IMAGE)
        return known;
    struct scene_image *image = &scene->images[scene->image_count];
    *image = (struct scene_image){
        .wrap_u = r->wrap_u, .wrap_v = r->wrap_v, .content = r->content, .primary = SCENE_NO_IMAGE};
    const SluiceResult result = open_source(scene, r, &image->source);
    if (result != SLUICE_SUCCESS) {
        scene_data_note(scene, "%s: cannot be shown: %s",
                        remote_is_url(r->path) ? r->name : r->path, sluiceGetResultName(result));
        return SCENE_NO_IMAGE;
    }
    const char *refusal = find_refusal(image->source);
    if (refusal) {
        sluiceDestroyImageSource(image->source);
        scene_data_note(scene, "%s: cannot be shown: %s", r->path, refusal);
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

static void paint_gray(void *user_data, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
                       uint32_t height, float rgba[4])
{
    (void)user_data, (void)level, (void)x, (void)y, (void)width, (void)height;
    rgba[0] = rgba[1] = rgba[2] = 0.5f;
    rgba[3] = 1.0f;
}

bool scene_images_replace(struct scene_data *scene, uint32_t index, SluiceResult why)
{
    struct scene_image *image = &scene->images[index];
    const SluiceProceduralImage gray = {NULL, paint_gray};
    const SluiceImageInfo info = {
        .structSize = sizeof info, .width = 64, .height = 64, .format = SLUICE_FORMAT_R8_UNORM};
    SluiceImageSource *source;
    scene_data_note(scene, "%s: cannot be shown: %s", image->path[0] ? image->path : image->name,
                    sluiceGetResultName(why));
    if (sluiceCreateProceduralImageSource(&gray, &info, NULL, &source) != SLUICE_SUCCESS)
        return false;
    sluiceDestroyImageSource(image->source);
    image->source = source;
    for (uint32_t i = 0; i < scene->material_count; i++)
        if (scene->materials[i].slots[SLOT_COLOR].image == index)
            scene->materials[i].missing = true;
    return true;
}

uint32_t scene_images_baking(const struct scene_data *scene)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->image_count; i++) {
        SluiceImageSource *source = linear_source_inner(scene->images[i].source);
        SluiceOpenedImageInfo info = {.structSize = sizeof info};
        count += sluiceGetOpenedImageInfo(source, &info) == SLUICE_SUCCESS && !info.ready &&
                 info.failure == SLUICE_SUCCESS;
    }
    return count;
}

void scene_images_wait(const struct scene_data *scene)
{
    const double end = clock_seconds() + BAKE_SECONDS;
    for (uint32_t i = 0; i < scene->image_count; i++) {
        SluiceImageSource *source = linear_source_inner(scene->images[i].source);
        SluiceOpenedImageInfo info = {.structSize = sizeof info};
        while (sluiceGetOpenedImageInfo(source, &info) == SLUICE_SUCCESS && !info.ready &&
               info.failure == SLUICE_SUCCESS && clock_seconds() < end &&
               !scene_data_canceled(scene))
            clock_sleep_until(clock_seconds() + 0.01);
    }
}
