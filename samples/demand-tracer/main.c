/**
 * Traces paths through a garden whose textures are loaded when rays hit them; see --help.
 *
 * How an application launches, learns what is missing and launches again stands in launches.c, what
 * a shader has to do in shaders/textures.glsl and shaders/scene.glsl.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "../../tools/common/clock.h"
#include "../../tools/common/descriptors.h"
#include "../../tools/common/files.h"
#include "../../tools/common/log.h"
#include "../../tools/common/output_file.h"
#include "../../tools/common/progress.h"
#include "../common/contact_sheet.h"
#include "history.h"
#include "summary.h"
#include "../../tools/common/text.h"

#define EXIT_USAGE 2
#define EXIT_NO_DEVICE 77

struct tracer {
    struct tracer_options options;
    struct gpu gpu;
    bool unsupported;
    struct scene scene;
    SluiceVulkanContext *context;
    SluiceDemandLoader *loader;
    struct textures textures;
    struct film film;
    struct renderer renderer;
    struct picture picture;
    struct contact_sheet sheet;
    struct launches launches;
    struct history history;
    double start; ///< of the first launch, s
    struct progress progress;
    char progress_text[96];
};

static bool create_loader(struct tracer *t)
{
    const struct tracer_options *o = &t->options;
    const SluiceVulkanContextCreateInfo context = {
        .structSize = sizeof context,
        .queueFamilyIndex = t->gpu.family,
        .instance = t->gpu.instance,
        .physicalDevice = t->gpu.physical_device,
        .device = t->gpu.device,
        .pfnGetInstanceProcAddr = vkGetInstanceProcAddr,
        .log = {.pfnLog = log_say},
        .loaderThreadCount = o->threads,
    };
    SluiceDemandLoaderCreateInfo info = {
        .structSize = sizeof info,
        .pageCapacity = TRACER_PAGE_CAPACITY,
        .maxRequestsPerLaunch = o->requests,
        .memoryBudget = o->budget,
    };
    SluiceResult result = sluiceCreateVulkanContext(&context, &t->context);
    info.context = t->context;
    if (result == SLUICE_SUCCESS)
        result = sluiceCreateDemandLoader(&info, &t->loader);
    if (result == SLUICE_SUCCESS)
        return true;
    text_say("textures cannot be loaded on demand: %s", sluiceGetResultName(result));
    t->unsupported = result == SLUICE_ERROR_UNSUPPORTED;
    return false;
}

static bool check_outputs(const struct tracer_options *o, bool (*check)(const char *path))
{
    static const char *const names[] = {"picture.png", "picture.exr", "frames.csv"};
    char path[4096];
    bool good = !o->contact_sheet || check(o->contact_sheet);
    for (size_t i = 0; i < sizeof names / sizeof *names && good; i++) {
        snprintf(path, sizeof path, "%s/%s", o->output, names[i]);
        good = check(path);
    }
    return good;
}

/* Before anything takes its time. */
static bool can_write_outputs(const struct tracer_options *o)
{
    return (!o->reference || output_add_input(o->reference)) && files_make_folders(o->output) &&
           (!o->launch_pictures || files_make_folders(o->launch_pictures)) &&
           check_outputs(o, output_can_write);
}

static bool open_all(struct tracer *t)
{
    const struct tracer_options *o = &t->options;
    const struct gpu_request request = {
        .device = o->device,
        .validation = o->validation,
        .modes = {SLUICE_RESIDENCY_MODE_PAGED, SLUICE_RESIDENCY_MODE_PAGED},
        .ray_tracing = o->path != PATH_COMPUTE};
    if (!can_write_outputs(o) || !scene_build(o->seed, o->texture_count, &t->scene) ||
        !gpu_create(&request, &t->gpu, &t->unsupported))
        return false;
    if (o->path == PATH_PIPELINE && !t->gpu.ray_tracing)
        t->unsupported = true;
    return create_loader(t) && textures_create(o, t->loader, &t->textures) &&
           check_outputs(o, output_spares_inputs) &&
           film_create(&t->gpu, o->size[0], o->size[1], &t->film) &&
           picture_create(o->size[0], o->size[1], &t->picture) &&
           renderer_create(&t->gpu, o, &t->scene, &t->textures, t->loader, &t->film, &t->renderer);
}

static void close_all(struct tracer *t)
{
    if (t->gpu.device) {
        vkDeviceWaitIdle(t->gpu.device);
        renderer_destroy(&t->gpu, &t->renderer);
        film_destroy(&t->gpu, &t->film);
    }
    sluiceDestroyDemandLoader(t->loader);
    sluiceDestroyVulkanContext(t->context);
    textures_finish(&t->textures);
    gpu_destroy(&t->gpu);
    picture_destroy(&t->picture);
    contact_sheet_finish(&t->sheet);
    history_finish(&t->history);
    scene_finish(&t->scene);
}

static void show_progress(struct tracer *t, const struct launch_record *record,
                          const SluiceDemandStatistics *statistics)
{
    const uint64_t pixels = (uint64_t)t->film.width * t->film.height;
    snprintf(t->progress_text, sizeof t->progress_text,
             "launch %u, %u pages missing, %llu tiles, %llu MB read", record->index,
             record->requests.missingCount, (unsigned long long)statistics->residentTileCount,
             (unsigned long long)(statistics->bytesRead / 1000000u));
    progress_update(&t->progress, record->sample * pixels + pixels - record->missing_count);
}

static bool add_to_sheet(struct tracer *t, const struct launch_record *record, uint64_t tiles)
{
    char caption[96];
    double share = 100.0 * record->missing_count / ((double)t->film.width * t->film.height);
    bool some = record->missing_count > 0;
    snprintf(caption, sizeof caption, "launch %u: %llu tiles, %.*f%% missing", record->index,
             (unsigned long long)tiles, some && share < 10.0 ? 1 : 0, share);
    return contact_sheet_add(&t->sheet, &t->picture, t->options.exposure, caption);
}

static bool remember(struct tracer *t, const struct launch_record *record,
                     const SluiceDemandStatistics *statistics)
{
    const struct history_row row = {.launch = *record,
                                    .resident_tiles = statistics->residentTileCount,
                                    .loaded_tiles = t->launches.tile_count,
                                    .bytes_read = statistics->bytesRead,
                                    .bytes_uploaded = statistics->bytesUploaded,
                                    .seconds = clock_seconds() - t->start};
    return history_add(&t->history, &row);
}

static bool after_launch(void *user_data, const struct launch_record *record)
{
    struct tracer *t = user_data;
    SluiceDemandStatistics statistics = {.structSize = sizeof statistics};
    if (sluiceGetDemandStatistics(t->loader, &statistics) != SLUICE_SUCCESS)
        return false;
    show_progress(t, record, &statistics);
    if (!remember(t, record, &statistics))
        return false;
    bool sheet = t->options.contact_sheet &&
                 (contact_sheet_has_room(&t->sheet) || record->missing_count == 0);
    if (!sheet && !t->options.launch_pictures)
        return true;
    char name[32];
    snprintf(name, sizeof name, "launch-%05u", record->index);
    return film_read(&t->gpu, &t->film, &t->picture) &&
           (!sheet || add_to_sheet(t, record, statistics.residentTileCount)) &&
           (!t->options.launch_pictures ||
            picture_write(&t->picture, t->options.exposure, t->options.launch_pictures, name));
}

static bool write_files(struct tracer *t)
{
    const struct tracer_options *o = &t->options;
    return film_read(&t->gpu, &t->film, &t->picture) &&
           picture_write(&t->picture, o->exposure, o->output, "picture") &&
           history_write(&t->history, o->output) &&
           (!o->contact_sheet || contact_sheet_write(&t->sheet, o->contact_sheet));
}

static bool count_needs(struct tracer *t, double *tiles)
{
    uint64_t count = 0;
    if (!t->options.needs)
        return true;
    bool done = needs_count(&t->gpu, &t->renderer.needs, &count);
    *tiles = (double)count;
    return done;
}

static bool print_summary(struct tracer *t, double seconds)
{
    const struct tracer_options *o = &t->options;
    struct summary summary = {.statistics = {.structSize = sizeof summary.statistics},
                              .launches = &t->launches,
                              .seconds = seconds,
                              .difference = {NAN, NAN, NAN},
                              .needed_tiles = NAN,
                              .resident_peak = t->history.resident_peak};
    const struct picture_place place = {o->output, t->launches.count};
    if ((o->reference &&
         !picture_compare(&t->picture, o->exposure, o->reference, &place, &summary.difference)) ||
        !count_needs(t, &summary.needed_tiles) ||
        sluiceGetDemandStatistics(t->loader, &summary.statistics) != SLUICE_SUCCESS)
        return false;
    if (o->json)
        gpu_print_json(&t->gpu);
    summary_print(&summary, o->json);
    if (!o->json) {
        fputs("picture.png and picture.exr are in ", stdout);
        text_write(stdout, o->output);
        putchar('\n');
    }
    return text_flush("");
}

static bool trace(struct tracer *t)
{
    const struct tracer_options *o = &t->options;
    t->launches = (struct launches){.gpu = &t->gpu,
                                    .options = o,
                                    .loader = t->loader,
                                    .renderer = &t->renderer,
                                    .film = &t->film,
                                    .textures = &t->textures,
                                    .user_data = t,
                                    .after_launch = after_launch};
    if (o->preload && !launches_preload(&t->launches))
        return false;
    t->start = clock_seconds();
    progress_begin(&t->progress, t->progress_text, "paths",
                   (uint64_t)o->samples * o->size[0] * o->size[1]);
    if (!launches_run(&t->launches))
        return false;
    double seconds = clock_seconds() - t->start;
    progress_end(&t->progress);
    if (t->film.missing_count > 0)
        fprintf(stderr, "%u pixels are still missing after %u launches\n", t->film.missing_count,
                t->launches.count);
    return write_files(t) && print_summary(t, seconds) && t->film.missing_count == 0;
}

int main(int argc, char **argv)
{
    struct tracer tracer = {0};
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
    uint32_t messages = atomic_load(&tracer.gpu.validation_messages);
    if (messages > 0)
        fprintf(stderr, "the validation layers had %u messages\n", messages);
    if (!opened && tracer.unsupported)
        return EXIT_NO_DEVICE;
    return done && messages == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
