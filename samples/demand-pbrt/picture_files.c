#include "picture_files.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../tools/common/clock.h"
#include "../../tools/common/log.h"
#include "../../tools/common/output_file.h"
#include "../../tools/common/text.h"

#define POLL_SECONDS 0.002

/* Waits for the baked store. A preview differs from it in a few texels, which would make pictures
 * depend on time. */
static SluiceResult wait_for_bake(SluiceImageSource *source)
{
    for (;;) {
        SluiceOpenedImageInfo info = {.structSize = sizeof info};
        SluiceResult result = sluiceGetOpenedImageInfo(source, &info);
        if (result != SLUICE_SUCCESS || info.ready)
            return result;
        if (info.failure != SLUICE_SUCCESS)
            return info.failure;
        clock_sleep_until(clock_seconds() + POLL_SECONDS);
    }
}

static SluiceResult open_source(struct picture_file *file, SluiceImageSource **source,
                                SluiceImageInfo *info)
{
    SluiceResult result = sluiceOpenImageSource(file->opener, file->path, source);
    if (result != SLUICE_SUCCESS)
        return result;
    result = wait_for_bake(*source);
    if (result == SLUICE_SUCCESS)
        result = sluiceGetImageInfo(*source, info);
    if (result == SLUICE_SUCCESS)
        return result;
    sluiceDestroyImageSource(*source);
    *source = NULL;
    return result;
}

/* Called on a thread of a loader, never twice at the same time. */
static SluiceResult open_file(void *user_data, SluiceImageSource **source)
{
    struct picture_file *file = user_data;
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceResult result = open_source(file, source, &info);
    if (result != SLUICE_SUCCESS) {
        if (result != SLUICE_NOT_READY && !file->has_failed)
            text_say("%s:%u: %s: cannot be read: %s; the texture becomes gray", file->file,
                     file->line, file->path, sluiceGetResultName(result));
        file->has_failed = file->has_failed || result != SLUICE_NOT_READY;
        return result;
    }
    if (file->says_what_it_reads)
        text_say("picture %s: %u x %u", file->path, info.width, info.height);
    return SLUICE_SUCCESS;
}

bool picture_files_create(const char *cache, uint32_t thread_count, struct picture_files *f)
{
    const SluiceImageOpenerCreateInfo info = {.structSize = sizeof info,
                                              .pCacheFolder = cache,
                                              .bakeThreadCount = thread_count,
                                              .log = {.pfnLog = log_say}};
    *f = (struct picture_files){0};
    SluiceResult result = sluiceCreateImageOpener(&info, &f->opener);
    if (result != SLUICE_SUCCESS)
        text_say("pictures cannot be opened: %s", sluiceGetResultName(result));
    return result == SLUICE_SUCCESS && pthread_mutex_init(&f->mutex, NULL) == 0;
}

void picture_files_finish(struct picture_files *f)
{
    for (uint32_t i = 0; i < f->count; i++) {
        shared_source_finish(&f->items[i]->shared);
        free(f->items[i]);
    }
    free(f->items);
    if (f->opener)
        pthread_mutex_destroy(&f->mutex);
    sluiceDestroyImageOpener(f->opener);
    *f = (struct picture_files){0};
}

static struct picture_file *create_file(const struct picture_files *f,
                                        const SluicePbrtTexture *texture)
{
    struct picture_file *file = calloc(1, sizeof *file);
    if (!file || !shared_source_init(&file->shared, open_file, file)) {
        fprintf(stderr, "out of memory\n");
        free(file);
        return NULL;
    }
    file->path = texture->pImagePath;
    file->file = texture->pFile;
    file->line = texture->line;
    file->opener = f->opener;
    file->says_what_it_reads = f->says_what_it_reads;
    return file;
}

/** Call with the mutex held. */
static struct picture_file *add_file(struct picture_files *f, const SluicePbrtTexture *texture)
{
    if (!output_add_input(texture->pImagePath))
        return NULL;
    if (f->count == f->room) {
        const uint32_t room = f->room ? 2 * f->room : 16;
        struct picture_file **items = realloc(f->items, room * sizeof *items);
        if (!items) {
            fprintf(stderr, "out of memory\n");
            return NULL;
        }
        f->items = items;
        f->room = room;
    }
    struct picture_file *file = create_file(f, texture);
    if (file)
        f->items[f->count++] = file;
    return file;
}

struct picture_file *picture_files_find(struct picture_files *f, const SluicePbrtTexture *texture)
{
    struct picture_file *found = NULL;
    pthread_mutex_lock(&f->mutex);
    for (uint32_t i = 0; i < f->count && !found; i++)
        if (strcmp(f->items[i]->path, texture->pImagePath) == 0)
            found = f->items[i];
    if (!found)
        found = add_file(f, texture);
    pthread_mutex_unlock(&f->mutex);
    return found;
}
