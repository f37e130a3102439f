#define _XOPEN_SOURCE 700
#include "baked.h"

#ifdef HAVE_BAKE

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../tools/common/bake_jobs.h"
#include "../../tools/common/files.h"
#include "../../tools/common/text.h"
#include "cache.h"

/* A third of the time of the baker's own level, for files a sixth larger, because the user
 * waits. */
#define COMPRESSION_LEVEL 3

/* Returns whether to bake a store. An OpenEXR file read as bytes would have linear bytes, which are
 * too few for shadows, so it is read whole instead. */
static bool needs_store(const struct picture_path *picture, enum pixel_format pixels)
{
    return !picture->refused &&
           (picture->kind == PICTURE_OTHER ||
            (picture->kind == PICTURE_EXR_LEVEL_ZERO && pixels != PIXEL_FORMAT_RGBA8));
}

/** Makes "cache/baked/whole/path.png.store". */
static char *store_path(const char *picture, const char *cache)
{
    char folder[4096];
    char *whole = realpath(picture, NULL), *path = NULL;
    if (!whole)
        text_say("%s: %s", picture, strerror(errno));
    else if (!cache_path(cache, "baked", folder, sizeof folder))
        fprintf(stderr, "the cache folder's name is too long\n");
    else {
        size_t size = strlen(folder) + strlen(whole) + sizeof SLUICE_STORE_EXTENSION;
        path = malloc(size);
        if (path)
            snprintf(path, size, "%s%s" SLUICE_STORE_EXTENSION, folder, whole);
    }
    free(whole);
    return path;
}

/** Chooses sRGB for photographs and drawings, also gray ones, and linear light for HDR files. */
static SluiceResult choose_settings(const struct picture_path *picture, enum pixel_format pixels,
                                    SluiceBakeSettings *settings)
{
    *settings = (SluiceBakeSettings){.structSize = sizeof(SluiceBakeSettings),
                                     .format = SLUICE_FORMAT_R16G16B16A16_SFLOAT,
                                     .compressionLevel = COMPRESSION_LEVEL};
    if (picture->kind == PICTURE_EXR_LEVEL_ZERO)
        return picture_file_exr_format(picture->path, pixels, &settings->format);
    if (!files_has_suffix(picture->path, ".hdr|.pfm")) {
        settings->transfer = SLUICE_BAKE_TRANSFER_SRGB;
        if (pixels != PIXEL_FORMAT_RGBA16F)
            settings->format = SLUICE_FORMAT_R8G8B8A8_SRGB;
    }
    return SLUICE_SUCCESS;
}

static void refuse(struct picture_path *picture, SluiceResult result)
{
    picture->refused = true;
    text_say("%s: left out: %s", picture->path, sluiceGetResultName(result));
}

static const struct bake_job *find_job(const struct bake_job *jobs, size_t count,
                                       const char *output)
{
    for (size_t i = 0; i < count; i++)
        if (strcmp(jobs[i].output, output) == 0)
            return &jobs[i];
    return NULL;
}

/** Makes one job per file. Refuses pictures whose jobs cannot begin. */
static size_t make_jobs(struct picture_path *paths, size_t count, const char *cache,
                        enum pixel_format pixels, struct bake_job *jobs)
{
    size_t job_count = 0;
    for (size_t i = 0; i < count; i++) {
        struct picture_path *picture = &paths[i];
        struct bake_job job = {.input = picture->path, .size = files_size(picture->path)};
        if (!needs_store(picture, pixels))
            continue;
        picture->store = store_path(picture->path, cache);
        job.output = picture->store;
        SluiceResult result =
            picture->store ? choose_settings(picture, pixels, &job.settings) : SLUICE_ERROR_IO;
        if (result != SLUICE_SUCCESS)
            refuse(picture, result);
        else if (!find_job(jobs, job_count, job.output))
            jobs[job_count++] = job;
    }
    return job_count;
}

static SluiceResult outcome(const struct bake_job *job)
{
    return job->is_done ? job->result : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

static void report(const struct bake_job *jobs, size_t count)
{
    uint32_t baked = 0, skipped = 0;
    for (size_t i = 0; i < count; i++) {
        baked += outcome(&jobs[i]) == SLUICE_SUCCESS && !jobs[i].report.skipped;
        skipped += outcome(&jobs[i]) == SLUICE_SUCCESS && jobs[i].report.skipped;
        if (jobs[i].message[0])
            text_say("%s", jobs[i].message);
        bake_job_say_warnings(&jobs[i], "");
    }
    fprintf(stderr, "%u pictures baked, %u were up to date\n", baked, skipped);
}

static bool is_any_needed(const struct picture_path *paths, size_t count, enum pixel_format pixels)
{
    for (size_t i = 0; i < count; i++)
        if (needs_store(&paths[i], pixels))
            return true;
    return false;
}

bool baked_prepare(struct picture_path *paths, size_t count, const char *cache,
                   enum pixel_format pixels)
{
    struct bake_conditions conditions = {.speaker = ""};
    if (!is_any_needed(paths, count, pixels))
        return true;
    struct bake_job *jobs = calloc(count, sizeof *jobs);
    if (!jobs) {
        fprintf(stderr, "out of memory\n");
        return false;
    }
    size_t job_count = make_jobs(paths, count, cache, pixels, jobs);
    bool done = bake_jobs_run(jobs, job_count, &conditions);
    if (done)
        report(jobs, job_count);
    for (size_t i = 0; i < count && done; i++)
        if (paths[i].store && !paths[i].refused) {
            SluiceResult result = outcome(find_job(jobs, job_count, paths[i].store));
            if (result != SLUICE_SUCCESS)
                refuse(&paths[i], result);
        }
    free(jobs);
    return done;
}

#else

bool baked_prepare(struct picture_path *paths, size_t count, const char *cache,
                   enum pixel_format pixels)
{
    (void)paths, (void)count, (void)cache, (void)pixels;
    return true;
}

#endif /* HAVE_BAKE */
