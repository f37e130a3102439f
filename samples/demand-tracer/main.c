/**
 * Traces paths through a garden whose textures are loaded when rays hit them; see --help.
 *
 * device.c has what each GPU has for itself; scene and images are there once. How an application
 * launches, learns what is missing and launches again stands in launches.c, what a shader has to do
 * in shaders/textures.glsl and shaders/scene.glsl.
 */
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>

#include "../../tools/common/clock.h"
#include "../../tools/common/descriptors.h"
#include "../../tools/common/files.h"
#include "../../tools/common/log.h"
#include "../../tools/common/output_file.h"
#include "../../tools/common/progress.h"
#include "../../tools/common/text.h"
#include "../common/contact_sheet.h"
#include "../common/crew.h"
#include "../common/picture_ring.h"
#include "device.h"
#include "summary.h"

#define EXIT_USAGE 2
#define EXIT_NO_DEVICE 77

struct tracer {
    struct tracer_options options;
    struct scene scene;
    struct textures textures;
    SluiceReadPool *pool;   ///< NULL: each device reads for itself
    struct device *devices; ///< owned
    uint32_t device_count;
    bool unsupported;
    uint32_t validation_messages; ///< of all devices, once they are destroyed
    struct picture_ring ring;     ///< of pictures that all devices trace
    struct picture *picture;      ///< ... the one that they trace, or traced last
    struct contact_sheet sheet;
    struct scene_camera camera; ///< of the picture that all devices trace
    atomic_uint next_picture;   ///< of an animation whose pictures devices take in turn
    atomic_bool ends;           ///< a device failed
    double start;               ///< of the first launch, s
    pthread_mutex_t mutex;      ///< of all below
    struct progress progress;
    char progress_text[96];
};

static uint32_t picture_count(const struct tracer_options *o)
{
    return o->animation > 0 ? o->animation : 1;
}

static void name_picture(const struct tracer_options *o, uint32_t picture, char name[32])
{
    snprintf(name, 32, o->animation > 0 ? "picture-%04u" : "picture", picture + 1);
}

static bool check_outputs(const struct tracer_options *o, bool (*check)(const char *path))
{
    static const char *const endings[] = {"png", "exr"};
    char path[4096], name[32];
    bool good = !o->contact_sheet || check(o->contact_sheet);
    for (uint32_t i = 0; i < 2 * picture_count(o) && good; i++) {
        name_picture(o, i / 2, name);
        snprintf(path, sizeof path, "%s/%s.%s", o->output, name, endings[i % 2]);
        good = check(path);
    }
    snprintf(path, sizeof path, "%s/frames.csv", o->output);
    return good && check(path);
}

/* Before anything takes its time. */
static bool can_write_outputs(const struct tracer_options *o)
{
    return (!o->reference || output_add_input(o->reference)) && files_make_folders(o->output) &&
           (!o->launch_pictures || files_make_folders(o->launch_pictures)) &&
           check_outputs(o, output_can_write);
}

static bool create_device(struct tracer *t, uint32_t index, const char *name)
{
    struct device *d = &t->devices[index];
    d->tracer = t;
    d->index = index;
    const bool done = device_create(&t->options, index > 0 ? t->devices : NULL, name, d);
    t->unsupported = t->unsupported || d->unsupported;
    t->device_count += done;
    return done;
}

/** The first one has the instance. */
static bool create_devices(struct tracer *t)
{
    const struct device_list *list = &t->options.devices;
    uint32_t indices[DEVICE_LIST_MOST], count = 1;
    char name[16];
    snprintf(name, sizeof name, "%u", list->indices[0]);
    t->devices = calloc(DEVICE_LIST_MOST, sizeof *t->devices);
    if (!t->devices || !create_device(t, 0, list->count > 0 ? name : t->options.device))
        return false;
    if (list->wanted > 0 || list->count > 0)
        count = gpu_list_alike(&t->devices[0].gpu, list, indices);
    t->unsupported = t->unsupported || count == 0;
    for (uint32_t i = 1; i < count; i++) {
        snprintf(name, sizeof name, "%u", indices[i]);
        if (!create_device(t, i, name))
            return false;
    }
    return count > 0;
}

static bool open_device(void *user_data, uint32_t index)
{
    struct tracer *t = user_data;
    const bool splits = t->options.split == SPLIT_FRAME && t->device_count > 1;
    const struct film_share share = {index, t->device_count};
    t->devices[index].pool = t->pool;
    return device_open(&t->devices[index], &t->scene, &t->textures,
                       splits ? share : (struct film_share){0});
}

static bool write_picture(void *user_data, const struct picture *picture, uint32_t index)
{
    const struct tracer_options *o = user_data;
    char name[32];
    name_picture(o, index, name);
    return picture_write(picture, o->exposure, o->output, name);
}

static bool create_ring(struct tracer *t, uint32_t count, struct picture_ring *ring)
{
    return picture_ring_create(count, t->options.size, false, write_picture, &t->options, ring);
}

/** As many pictures of an animation are written at a time as devices trace. */
static uint32_t picture_slots(const struct tracer *t)
{
    const uint32_t most = t->device_count + 1, count = picture_count(&t->options);
    return count < most ? count : most;
}

static bool open_all(struct tracer *t)
{
    const struct tracer_options *o = &t->options;
    if (!can_write_outputs(o) || !scene_build(o->seed, o->texture_count, &t->scene) ||
        !textures_create(o, &t->textures) || !check_outputs(o, output_spares_inputs) ||
        !create_devices(t) ||
        !read_sharing_create(o->read_sharing, t->device_count, o->threads, &t->pool))
        return false;
    const bool done = crew_run(t->device_count, open_device, t);
    for (uint32_t i = 0; i < t->device_count; i++)
        t->unsupported = t->unsupported || t->devices[i].unsupported;
    return done && (o->split == SPLIT_ALTERNATE || create_ring(t, picture_slots(t), &t->ring));
}

static void close_all(struct tracer *t)
{
    for (uint32_t i = t->device_count; i-- > 0;)
        device_destroy(&t->devices[i]);
    sluiceDestroyReadPool(t->pool);
    textures_finish(&t->textures);
    picture_ring_destroy(&t->ring);
    contact_sheet_finish(&t->sheet);
    scene_finish(&t->scene);
    if (t->devices)
        t->validation_messages = atomic_load(&t->devices[0].gpu.validation_messages);
    free(t->devices);
}

static void show_progress(struct device *d, const struct launch_record *record,
                          const SluiceDemandStatistics *statistics)
{
    struct tracer *t = d->tracer;
    uint64_t paths = 0;
    pthread_mutex_lock(&t->mutex);
    snprintf(t->progress_text, sizeof t->progress_text,
             "launch %u, %u pages missing, %llu tiles, %llu MB read", record->index,
             record->requests.missingCount, (unsigned long long)statistics->residentTileCount,
             (unsigned long long)(statistics->bytesRead / 1000000u));
    d->path_count = d->done_count + (uint64_t)record->sample * d->film.pixel_count +
                    d->film.pixel_count - record->missing_count;
    for (uint32_t i = 0; i < t->device_count; i++)
        paths += t->devices[i].path_count;
    progress_update(&t->progress, paths);
    pthread_mutex_unlock(&t->mutex);
}

static bool add_to_sheet(struct tracer *t, const struct launch_record *record, uint64_t tiles)
{
    char caption[96];
    const double pixels = (double)t->picture->width * t->picture->height;
    const double share = 100.0 * record->missing_count / pixels;
    bool some = record->missing_count > 0;
    snprintf(caption, sizeof caption, "launch %u: %llu tiles, %.*f%% missing", record->index,
             (unsigned long long)tiles, some && share < 10.0 ? 1 : 0, share);
    return contact_sheet_add(&t->sheet, t->picture, t->options.exposure, caption);
}

static bool remember(struct device *d, const struct launch_record *record,
                     const SluiceDemandStatistics *statistics)
{
    const struct history_row row = {.launch = *record,
                                    .device = d->index,
                                    .resident_tiles = statistics->residentTileCount,
                                    .loaded_tiles = d->launches.tile_count,
                                    .bytes_read = statistics->bytesRead,
                                    .bytes_uploaded = statistics->bytesUploaded,
                                    .seconds = clock_seconds() - d->tracer->start};
    return history_add(&d->history, &row);
}

/** Pictures after launches are those of one device. */
static bool keep_picture(struct device *d, const struct launch_record *record, uint64_t tiles)
{
    struct tracer *t = d->tracer;
    const struct tracer_options *o = &t->options;
    const bool sheet =
        o->contact_sheet && (contact_sheet_has_room(&t->sheet) || record->missing_count == 0);
    if (!sheet && !o->launch_pictures)
        return true;
    char name[32];
    snprintf(name, sizeof name, "launch-%05u", record->index);
    return film_read(&d->gpu, &d->film, t->picture) && (!sheet || add_to_sheet(t, record, tiles)) &&
           (!o->launch_pictures ||
            picture_write(t->picture, o->exposure, o->launch_pictures, name));
}

static bool after_launch(void *user_data, const struct launch_record *record)
{
    struct device *d = user_data;
    SluiceDemandStatistics statistics = {.structSize = sizeof statistics};
    if (atomic_load(&d->tracer->ends) ||
        sluiceGetDemandStatistics(d->loader, &statistics) != SLUICE_SUCCESS)
        return false;
    show_progress(d, record, &statistics);
    return remember(d, record, &statistics) &&
           keep_picture(d, record, statistics.residentTileCount);
}

static struct scene_camera camera_of(const struct tracer_options *o, uint32_t picture)
{
    return scene_turn_camera(&o->view, (picture + 1.0) / picture_count(o));
}

static bool end_if_failed(struct tracer *t, bool done)
{
    if (!done)
        atomic_store(&t->ends, true);
    return done;
}

static bool preload(void *user_data, uint32_t index)
{
    struct tracer *t = user_data;
    return launches_preload(&t->devices[index].launches);
}

/** Its tiles of the picture that all devices trace. */
static bool trace_share(void *user_data, uint32_t index)
{
    struct tracer *t = user_data;
    return end_if_failed(t, device_trace(&t->devices[index], &t->camera, t->picture));
}

/** Whole pictures, the next one that no device has begun. */
static bool trace_pictures(void *user_data, uint32_t index)
{
    struct tracer *t = user_data;
    const struct tracer_options *o = &t->options;
    struct picture_ring ring = {0};
    bool done = create_ring(t, 2, &ring);
    for (uint32_t i; done && (i = atomic_fetch_add(&t->next_picture, 1)) < picture_count(o);) {
        const struct scene_camera camera = camera_of(o, i);
        done = device_trace(&t->devices[index], &camera, picture_ring_next(&ring)) &&
               picture_ring_write(&ring, i);
    }
    done = picture_ring_wait(&ring) && done;
    picture_ring_destroy(&ring);
    return end_if_failed(t, done);
}

static bool trace_all(struct tracer *t)
{
    const struct tracer_options *o = &t->options;
    bool done = true;
    if (o->split == SPLIT_ALTERNATE)
        return crew_run(t->device_count, trace_pictures, t);
    for (uint32_t i = 0; i < picture_count(o) && done; i++) {
        t->camera = camera_of(o, i);
        t->picture = picture_ring_next(&t->ring);
        done = crew_run(t->device_count, trace_share, t) && picture_ring_write(&t->ring, i);
    }
    return picture_ring_wait(&t->ring) && done;
}

static bool write_histories(const struct tracer *t)
{
    const struct history *histories[DEVICE_LIST_MOST];
    for (uint32_t i = 0; i < t->device_count; i++)
        histories[i] = &t->devices[i].history;
    return history_write(histories, t->device_count, t->options.output);
}

static bool count_needs(const struct tracer *t, double *tiles)
{
    uint64_t sum = 0;
    bool done = true;
    for (uint32_t i = 0; i < t->device_count && t->options.needs && done; i++) {
        uint64_t count = 0;
        done = needs_count(&t->devices[i].gpu, &t->devices[i].renderer.needs, &count);
        sum += count;
    }
    if (t->options.needs)
        *tiles = (double)sum;
    return done;
}

static bool print_summary(struct tracer *t)
{
    const struct tracer_options *o = &t->options;
    struct summary summary = {.devices = t->devices,
                              .device_count = t->device_count,
                              .textures = &t->textures,
                              .pool = t->pool,
                              .start = t->start,
                              .difference = {NAN, NAN, NAN},
                              .needed_tiles = NAN};
    const struct picture_place place = {o->output, t->devices[0].launches.count};
    if ((o->reference &&
         !picture_compare(t->picture, o->exposure, o->reference, &place, &summary.difference)) ||
        !count_needs(t, &summary.needed_tiles))
        return false;
    if (o->json)
        gpu_print_json(&t->devices[0].gpu);
    if (!summary_print(&summary, o->json))
        return false;
    if (!o->json) {
        fputs(o->animation > 0 ? "the pictures are in " : "picture.png and picture.exr are in ",
              stdout);
        text_write(stdout, o->output);
        putchar('\n');
    }
    return text_flush("");
}

static bool trace(struct tracer *t)
{
    const struct tracer_options *o = &t->options;
    uint64_t missing = 0;
    for (uint32_t i = 0; i < t->device_count; i++)
        t->devices[i].launches.after_launch = after_launch;
    if (o->preload && !crew_run(t->device_count, preload, t))
        return false;
    t->start = clock_seconds();
    progress_begin(&t->progress, t->progress_text, "paths",
                   (uint64_t)picture_count(o) * o->samples * o->size[0] * o->size[1]);
    if (!trace_all(t))
        return false;
    progress_end(&t->progress);
    for (uint32_t i = 0; i < t->device_count; i++)
        missing += t->devices[i].missing_count;
    if (missing > 0)
        fprintf(stderr, "%llu pixels are still missing after %u launches\n",
                (unsigned long long)missing, t->devices[0].launches.count);
    return write_histories(t) &&
           (!o->contact_sheet || contact_sheet_write(&t->sheet, o->contact_sheet)) &&
           print_summary(t) && missing == 0;
}

int main(int argc, char **argv)
{
    struct tracer tracer = {.mutex = PTHREAD_MUTEX_INITIALIZER};
    switch (tracer_options_parse(argc, argv, &tracer.options)) {
    case OPTIONS_HELP: return text_exit_status(EXIT_SUCCESS);
    case OPTIONS_ERROR: return EXIT_USAGE;
    case OPTIONS_RUN: break;
    }
    descriptors_raise();
    if (tracer.options.list_devices)
        return text_exit_status(gpu_list_devices() > 0 ? EXIT_SUCCESS : EXIT_NO_DEVICE);
    tracer.sheet.marks_missing = !tracer.options.preview;
    bool opened = open_all(&tracer);
    bool done = opened && trace(&tracer);
    close_all(&tracer);
    log_finish();
    const uint32_t messages = tracer.validation_messages;
    if (messages > 0)
        fprintf(stderr, "the validation layers had %u messages\n", messages);
    if (!opened && tracer.unsupported)
        return EXIT_NO_DEVICE;
    return done && messages == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
