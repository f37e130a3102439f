#define _POSIX_C_SOURCE 200809L
/**
 * Walks through a room of pictures with streamed textures. See --help.
 *
 * record_frame in view.c shows the application's part of a frame. This file runs the frames,
 * measures them, and writes the results.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <sluice/metrics.h>

#include "../../tools/common/clock.h"
#include "../../tools/common/descriptors.h"
#include "../../tools/common/files.h"
#include "../../tools/common/output_file.h"
#include "../common/png_file.h"
#include "../../tools/common/log.h"
#include "../../tools/common/progress.h"
#include "../../tools/common/text.h"
#include "comparison.h"
#include "gallery.h"
#include "gallery_report.h"
#include "measure.h"
#include "material_files.h"
#include "needs_trace.h"

#define EXIT_USAGE 2
#define EXIT_NO_DEVICE 77
#define MATERIAL_SIZE 512 ///< texels along a side of --neural-material
#define SOME_FRAMES 8     ///< pictures of the way that --write-frames some writes

struct walk {
    struct gallery *gallery;
    struct measure *measure;
    struct written_frames written; ///< owned
    struct comparison comparison;
    struct needs needs; ///< requirements of the collected frames, if counted
    struct needs_trace trace;
    uint64_t tiles_mapped; ///< counter of mapped tiles when residency was last looked up
};

/** Returns whether a frame's picture is written. WRITE_FRAMES_SOME: frames along the way, the
 * camera's stop, 10 frames later, and the last frame. */
static bool is_written(const struct walk *walk, uint32_t frame)
{
    uint32_t count = walk->measure->frame_count, rest = walk->measure->rest_frame;
    uint32_t step = rest / SOME_FRAMES ? rest / SOME_FRAMES : 1;
    switch (walk->gallery->settings.write_frames) {
    case WRITE_FRAMES_NONE: return false;
    case WRITE_FRAMES_ALL: return true;
    default:
        return frame + 1 == count || frame == rest || frame == rest + 10 ||
               (frame < rest && frame % step == step / 2);
    }
}

static bool write_picture(const struct walk *walk, const uint8_t *pixels, bool truth,
                          uint32_t frame)
{
    const struct settings *settings = &walk->gallery->settings;
    char path[4096];
    gallery_report_picture_path(settings->output, truth ? "truth" : "frame", frame, path,
                                sizeof path);
    return png_file_write(path, pixels, settings->size[0], settings->size[1]);
}

/** Derives time stamps from frames, not from the clock: slow machines stream alike. */
static uint64_t time_stamp_of(const struct settings *settings, uint32_t frame)
{
    return ((uint64_t)settings->warm_up + frame + 1) * 1000000u / settings->frames_per_second;
}

/** Records the required tiles and the missing pixels of a frame. */
static bool collect_needs(struct walk *walk, uint32_t frame)
{
    struct view *view = &walk->gallery->streamed;
    struct frame_record *record = &walk->measure->frames[frame];
    uint64_t missing = record->counts.missingPixels, sampled = record->counts.sampled;
    if (view->request.needs) {
        if (!view_needs(view, frame % VIEW_FRAMES_IN_FLIGHT, &walk->needs, &record->needs)) {
            fprintf(stderr, "out of memory\n");
            return false;
        }
        needs_trace_add_frame(&walk->trace, &walk->needs,
                              time_stamp_of(&walk->gallery->settings, frame));
        missing = record->needs.missing_pixels;
        sampled = record->needs.sampled_pixels;
    } else if (!view->request.counting) {
        record->missing_percent = NAN;
        return true;
    }
    record->missing_percent = sampled ? 100.0 * (double)missing / (double)sampled : 0.0;
    return true;
}

/** Waits for a submitted frame, and measures it. */
static bool collect_frame(struct walk *walk, uint32_t frame)
{
    struct gallery *gallery = walk->gallery;
    const struct view *streamed = &gallery->streamed, *truth = &gallery->truth;
    struct frame_record *record = &walk->measure->frames[frame];
    uint32_t slot = frame % VIEW_FRAMES_IN_FLIGHT;
    if (!view_wait(streamed, slot))
        return false;
    record->gpu_seconds = view_gpu_seconds(streamed, slot);
    record->counts = view_counts(streamed, slot);
    record->psnr = NAN;
    if (!collect_needs(walk, frame))
        return false;
    const uint8_t *pixels = view_pixels(streamed, slot), *truth_pixels = NULL;
    if (gallery->settings.compare) {
        /* The truth has drawn more frames: the ones that filled it. */
        uint32_t ago = streamed->frame_index - frame;
        uint32_t truth_slot = (truth->frame_index - ago) % VIEW_FRAMES_IN_FLIGHT;
        truth_pixels = view_pixels(truth, truth_slot);
        if (!view_wait(truth, truth_slot) ||
            sluiceComputePsnr8(pixels, truth_pixels, gallery->target.width, gallery->target.height,
                               4, &record->psnr) != SLUICE_SUCCESS)
            return false;
    }
    bool written = is_written(walk, frame);
    if (written)
        walk->written.frames[walk->written.count++] = frame;
    if (!comparison_keep(&walk->comparison, frame, pixels, truth_pixels, written))
        return false;
    if (!written || gallery->settings.reference) /* with --reference, comparison_run writes them */
        return true;
    return write_picture(walk, pixels, false, frame) &&
           (!truth_pixels || write_picture(walk, truth_pixels, true, frame));
}

/** Draws one frame; with --compare in both views. */
static bool draw_frame(struct walk *walk, uint32_t frame, uint64_t time_stamp)
{
    struct gallery *gallery = walk->gallery;
    struct camera camera = gallery_camera(&gallery->settings, &gallery->room, frame);
    struct view_frame drawn, truth;
    if (!view_draw(&gallery->streamed, &camera, time_stamp, &drawn))
        return false;
    if (gallery->streamed.request.needs && drawn.statistics.tilesMapped != walk->tiles_mapped)
        needs_add_loaded(&walk->needs, gallery->streamed.manager);
    walk->tiles_mapped = drawn.statistics.tilesMapped;
    walk->measure->frames[frame].host_seconds = drawn.host_seconds;
    walk->measure->frames[frame].statistics = drawn.statistics;
    walk->measure->frames[frame].neural_bytes = drawn.neural_bytes;
    return frame < gallery->settings.range.first || !gallery->settings.compare ||
           view_draw(&gallery->truth, &camera, time_stamp, &truth);
}

static bool settle(struct walk *walk, uint32_t frame)
{
    struct view *view = &walk->gallery->streamed;
    return view_wait(view, frame % VIEW_FRAMES_IN_FLIGHT) && view_settle(view);
}

/** Draws the frames before the range for their loads. Slots are numbered as in a whole walk. */
static bool play_in(struct walk *walk)
{
    const struct settings *settings = &walk->gallery->settings;
    const uint32_t first = settings->range.first;
    uint32_t begin = first - settings->play_in;
    struct progress progress;
    begin -= begin % VIEW_FRAMES_IN_FLIGHT;
    walk->measure->begin_frame = begin;
    walk->gallery->streamed.frame_index = begin;
    if (begin == first)
        return true;
    progress_begin(&progress, "playing", "frames", first - begin);
    for (uint32_t frame = begin; frame < first; frame++) {
        if (!draw_frame(walk, frame, time_stamp_of(settings, frame)) || !settle(walk, frame))
            return false;
        progress_update(&progress, frame + 1 - begin);
    }
    progress_end(&progress);
    return true;
}

static bool walk_through(struct walk *walk)
{
    const struct settings *settings = &walk->gallery->settings;
    const uint32_t first = settings->range.first, end = settings->range.last + 1;
    const double step = 1.0 / settings->frames_per_second;
    struct progress progress;
    if (!play_in(walk))
        return false;
    progress_begin(&progress, "walking", "frames", end - first);
    double due = clock_seconds(), submitted = due;
    for (uint32_t frame = first; frame < end; frame++) {
        if (frame - first >= VIEW_FRAMES_IN_FLIGHT &&
            !collect_frame(walk, frame - VIEW_FRAMES_IN_FLIGHT))
            return false;
        if (!settings->deterministic)
            clock_sleep_until(due);
        due = fmax(due + step, clock_seconds());

        if (!draw_frame(walk, frame, time_stamp_of(settings, frame)))
            return false;
        double now = clock_seconds();
        walk->measure->frames[frame].frame_seconds = now - submitted;
        submitted = now;
        if (settings->deterministic && !settle(walk, frame))
            return false;
        progress_update(&progress, frame + 1 - first);
    }
    uint32_t left = end - first < VIEW_FRAMES_IN_FLIGHT ? end - first : VIEW_FRAMES_IN_FLIGHT;
    for (uint32_t frame = end - left; frame < end; frame++)
        if (!collect_frame(walk, frame))
            return false;
    progress_end(&progress);
    return true;
}

static char *join_arguments(int argc, char *const *argv)
{
    size_t size = 1;
    for (int i = 0; i < argc; i++)
        size += strlen(argv[i]) + 1;
    char *line = calloc(size, 1);
    for (int i = 0; line && i < argc; i++) {
        strcat(line, argv[i]);
        strcat(line, i + 1 < argc ? " " : "");
    }
    return line;
}

static void print_line(const char *words, const char *name)
{
    fputs(words, stdout);
    text_write(stdout, name);
    putchar('\n');
}

static bool write_results(const struct walk *walk, int argc, char *const *argv)
{
    const struct gallery *gallery = walk->gallery;
    const struct settings *settings = &gallery->settings;
    struct figure figures[MEASURE_MAX_FIGURES];
    uint32_t figure_count = measure_figures(walk->measure, figures);
    char csv_path[4096];
    settings_report_path(settings, "frames", ".csv", csv_path, sizeof csv_path);
    char *command_line = join_arguments(argc, argv);
    struct gallery_report_info report = {
        .folder = settings->output,
        .command_line = command_line ? command_line : "",
        .device_name = gallery->gpu.properties.deviceName,
        .pictures = &gallery->pictures,
        .written_frames = walk->written.frames,
        .written_count = walk->written.count,
        .compared = settings->compare || settings->reference,
    };
    bool written =
        measure_write_csv(walk->measure, csv_path) && gallery_report_write(&report, walk->measure);
    free(command_line);
    if (settings->json)
        gpu_print_json(&gallery->gpu);
    if (settings->json)
        measure_print_json(figures, figure_count);
    else
        measure_print_text(figures, figure_count);
    if (written && !settings->json)
        print_line("pictures, frames.csv and report.html are in ", settings->output);
    return text_flush("") && written;
}

static bool begin_needs(struct walk *walk)
{
    const struct gallery *gallery = walk->gallery;
    const struct settings *settings = &gallery->settings;
    if (!gallery->streamed.request.needs)
        return true;
    walk->measure->needs = &walk->needs;
    if (!view_needs_begin(&gallery->streamed, &walk->needs)) {
        fprintf(stderr, "out of memory\n");
        return false;
    }
    return !settings->needs_trace ||
           needs_trace_begin(&walk->trace, settings->needs_trace, &walk->needs, settings->frames,
                             1000000u / settings->frames_per_second);
}

static bool run_walk(struct gallery *gallery, int argc, char *const *argv)
{
    struct measure measure;
    struct walk walk = {.gallery = gallery, .measure = &measure};
    walk.written.frames = calloc(gallery->settings.frames, sizeof *walk.written.frames);
    bool done = measure_begin(&measure, &gallery->settings) && walk.written.frames;
    if (!done)
        fprintf(stderr, "out of memory\n");
    done = done && comparison_begin(gallery, &measure, &walk.comparison);
    measure.start.structSize = sizeof measure.start;
    sluiceGetVulkanStreamerStatistics(gallery->streamed.streamer, &measure.start);
    measure.counting = gallery->streamed.request.counting;
    measure.tile_count = view_tile_count(&gallery->streamed);
    measure.picture_count = gallery->pictures.count;
    measure.refused_count = gallery->pictures.refused;
    if (gallery->settings.compare) {
        SluiceVulkanStreamerStatistics truth = {.structSize = sizeof truth};
        sluiceGetVulkanStreamerStatistics(gallery->truth.streamer, &truth);
        measure.truth_bytes = truth.tileMemorySize;
    } else if (gallery->settings.reference) {
        measure.truth_bytes = gallery->reference.device_memory;
    }
    measure.texture_count = gallery->streamed.texture_count;
    done = done && begin_needs(&walk) && walk_through(&walk) && needs_wait_end(&walk.needs.wait);
    measure.reads = view_reads(&gallery->streamed);
    if (gallery->pictures.neural)
        measure.file_bytes = (double)atomic_load(&gallery->pictures.neural->bytes_read);
    done = needs_trace_end(&walk.trace, done) && done &&
           comparison_run(&walk.comparison, &walk.written) && write_results(&walk, argc, argv);
    needs_finish(&walk.needs);
    comparison_finish(&walk.comparison);
    free(walk.written.frames);
    measure_finish(&measure);
    return done;
}

/* Checks all output paths before any long work. */
static bool can_write_outputs(const struct settings *settings)
{
    char report[4096], csv[4096];
    settings_report_path(settings, "report", ".html", report, sizeof report);
    settings_report_path(settings, "frames", ".csv", csv, sizeof csv);
    return files_make_folders(settings->output) && output_can_write(report) &&
           output_can_write(csv) &&
           (!settings->needs_trace || output_can_write(settings->needs_trace)) &&
           (!settings->record || output_claim(settings->record));
}

static int generate_only(const struct settings *settings)
{
    struct picture_limits limits = {UINT32_MAX, UINT64_MAX, true};
    struct picture_list pictures;
    if (!pictures_open(settings, &limits, &pictures))
        return EXIT_FAILURE;
    for (uint32_t i = 0; i < pictures.count; i++)
        print_line("", pictures.pictures[i].path);
    pictures_close(&pictures);
    return EXIT_SUCCESS;
}

int main(int argc, char **argv)
{
    struct gallery gallery = {0};
    switch (settings_parse(argc, argv, &gallery.settings)) {
    case OPTIONS_HELP: return text_exit_status(EXIT_SUCCESS);
    case OPTIONS_ERROR: return EXIT_USAGE;
    case OPTIONS_RUN: break;
    }
    descriptors_raise();
    if (gallery.settings.list_devices)
        return text_exit_status(gpu_list_devices() > 0 ? EXIT_SUCCESS : EXIT_NO_DEVICE);
    if (gallery.settings.material)
        return text_exit_status(material_files_write(gallery.settings.material, MATERIAL_SIZE)
                                    ? EXIT_SUCCESS
                                    : EXIT_FAILURE);
    if (gallery.settings.generate_only)
        return text_exit_status(generate_only(&gallery.settings));
    if (!can_write_outputs(&gallery.settings))
        return EXIT_FAILURE;

    enum gallery_outcome opened = gallery_open(&gallery);
    bool done = opened == GALLERY_READY && run_walk(&gallery, argc, argv);
    done = gallery_close(&gallery) && done;
    log_finish();
    uint32_t messages = atomic_load(&gallery.gpu.validation_messages);
    if (messages > 0)
        fprintf(stderr, "the validation layers had %u messages\n", messages);
    if (opened == GALLERY_NO_DEVICE)
        return EXIT_NO_DEVICE;
    return done && messages == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
