/**
 * Traces paths through a garden, and loads textures when rays hit them. See --help.
 *
 * device.c has the objects of each GPU; scene and images exist once. launches.c shows the
 * application's loop: launch, find missing tiles, launch again. shaders/textures.glsl and
 * shaders/scene.glsl show the shader's part.
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
#include "../common/device_crew.h"
#include "device.h"
#include "summary.h"

#define EXIT_USAGE 2
#define EXIT_NO_DEVICE 77

struct tracer {
    struct tracer_options options;
    struct scene scene;
    struct textures textures;
    SluiceReadPool *pool;    ///< NULL: each device reads for itself
    struct device *devices;  ///< owned
    struct device_crew crew; ///< devices as crew members
    bool unsupported;
    uint32_t validation_messages; ///< sum over all devices, read after their destruction
    struct contact_sheet sheet;
    double start;          ///< clock_seconds() at the first launch
    pthread_mutex_t mutex; ///< guards all fields below
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

/* Checks all output paths before any long work. */
static bool can_write_outputs(const struct tracer_options *o)
{
    return (!o->reference || output_add_input(o->reference)) && files_make_folders(o->output) &&
           (!o->launch_pictures || files_make_folders(o->launch_pictures)) &&
           check_outputs(o, output_can_write);
}

static bool create_device(void *user_data, uint32_t index, const char *name, bool *exists)
{
    struct tracer *t = user_data;
    struct device *d = &t->devices[index];
    d->tracer = t;
    d->index = index;
    *exists = device_create(&t->options, index > 0 ? t->devices : NULL, name, d);
    t->unsupported = t->unsupported || d->unsupported;
    return *exists;
}

/** Creates all devices. The first one owns the instance. */
static bool create_devices(struct tracer *t)
{
    const struct tracer_options *o = &t->options;
    bool none = false;
    t->devices = calloc(DEVICE_LIST_MOST, sizeof *t->devices);
    const bool done = t->devices && device_crew_create(&t->crew, &o->devices, o->device,
                                                       &t->devices[0].gpu, &none);
    t->unsupported = t->unsupported || none;
    return done;
}

static bool open_device(void *user_data, uint32_t index)
{
    struct tracer *t = user_data;
    t->devices[index].pool = t->pool;
    return device_open(&t->devices[index], &t->scene, &t->textures,
                       device_crew_share(&t->crew, index));
}

static bool write_picture(void *user_data, const struct picture *picture, uint32_t index)
{
    const struct tracer *t = user_data;
    const struct tracer_options *o = &t->options;
    char name[32];
    name_picture(o, index, name);
    return picture_write(picture, o->exposure, o->output, name);
}

static struct scene_camera camera_of(const struct tracer_options *o, uint32_t picture)
{
    return scene_turn_camera(&o->view, (picture + 1.0) / picture_count(o));
}

static bool trace_picture(void *user_data, uint32_t device, uint32_t index, struct picture *picture)
{
    struct tracer *t = user_data;
    const struct scene_camera camera = camera_of(&t->options, index);
    return device_trace(&t->devices[device], &camera, picture);
}

static void set_up_crew(struct tracer *t)
{
    static const struct device_crew_calls calls = {create_device, trace_picture, write_picture};
    const struct tracer_options *o = &t->options;
    t->crew = (struct device_crew){.calls = &calls,
                                   .user_data = t,
                                   .split = o->split,
                                   .end_of_pictures = picture_count(o),
                                   .size = {o->size[0], o->size[1]}};
}

static bool open_all(struct tracer *t)
{
    const struct tracer_options *o = &t->options;
    set_up_crew(t);
    if (!can_write_outputs(o) || !scene_build(o->seed, o->texture_count, &t->scene) ||
        !textures_create(o, &t->textures) || !check_outputs(o, output_spares_inputs) ||
        !create_devices(t) ||
        !read_sharing_create(o->read_sharing, t->crew.device_count, o->threads, &t->pool))
        return false;
    const bool done = crew_run(t->crew.device_count, open_device, t);
    for (uint32_t i = 0; i < t->crew.device_count; i++)
        t->unsupported = t->unsupported || t->devices[i].unsupported;
    return done && device_crew_create_pictures(&t->crew);
}

static void close_all(struct tracer *t)
{
    for (uint32_t i = t->crew.device_count; i-- > 0;)
        device_destroy(&t->devices[i]);
    sluiceDestroyReadPool(t->pool);
    textures_finish(&t->textures);
    device_crew_finish(&t->crew);
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
    for (uint32_t i = 0; i < t->crew.device_count; i++)
        paths += t->devices[i].path_count;
    progress_update(&t->progress, paths);
    pthread_mutex_unlock(&t->mutex);
}

static bool add_to_sheet(struct tracer *t, const struct launch_record *record, uint64_t tiles)
{
    char caption[96];
    const double pixels = (double)t->crew.picture->width * t->crew.picture->height;
    const double share = 100.0 * record->missing_count / pixels;
    bool some = record->missing_count > 0;
    snprintf(caption, sizeof caption, "launch %u: %llu tiles, %.*f%% missing", record->index,
             (unsigned long long)tiles, some && share < 10.0 ? 1 : 0, share);
    return contact_sheet_add(&t->sheet, t->crew.picture, t->options.exposure, caption);
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

/** Writes the picture after a launch. Used with a single device only. */
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
    return film_read(&d->gpu, &d->film, t->crew.picture) &&
           (!sheet || add_to_sheet(t, record, tiles)) &&
           (!o->launch_pictures ||
            picture_write(t->crew.picture, o->exposure, o->launch_pictures, name));
}

static bool after_launch(void *user_data, const struct launch_record *record)
{
    struct device *d = user_data;
    SluiceDemandStatistics statistics = {.structSize = sizeof statistics};
    if (atomic_load(&d->tracer->crew.ends) ||
        sluiceGetDemandStatistics(d->loader, &statistics) != SLUICE_SUCCESS)
        return false;
    show_progress(d, record, &statistics);
    return remember(d, record, &statistics) &&
           keep_picture(d, record, statistics.residentTileCount);
}

static bool preload(void *user_data, uint32_t index)
{
    struct tracer *t = user_data;
    return launches_preload(&t->devices[index].launches);
}

static bool write_histories(const struct tracer *t)
{
    const struct history *histories[DEVICE_LIST_MOST];
    for (uint32_t i = 0; i < t->crew.device_count; i++)
        histories[i] = &t->devices[i].history;
    return history_write(histories, t->crew.device_count, t->options.output);
}

static bool count_needs(const struct tracer *t, double *tiles)
{
    uint64_t sum = 0;
    bool done = true;
    for (uint32_t i = 0; i < t->crew.device_count && t->options.needs && done; i++) {
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
                              .device_count = t->crew.device_count,
                              .textures = &t->textures,
                              .pool = t->pool,
                              .start = t->start,
                              .difference = {NAN, NAN, NAN},
                              .needed_tiles = NAN};
    const struct picture_place place = {o->output, t->devices[0].launches.count};
    if ((o->reference && !picture_compare(t->crew.picture, o->exposure, o->reference, &place,
                                          &summary.difference)) ||
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
    for (uint32_t i = 0; i < t->crew.device_count; i++)
        t->devices[i].launches.after_launch = after_launch;
    if (o->preload && !crew_run(t->crew.device_count, preload, t))
        return false;
    t->start = clock_seconds();
    progress_begin(&t->progress, t->progress_text, "paths",
                   (uint64_t)picture_count(o) * o->samples * o->size[0] * o->size[1]);
    if (!device_crew_trace(&t->crew))
        return false;
    progress_end(&t->progress);
    for (uint32_t i = 0; i < t->crew.device_count; i++)
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
