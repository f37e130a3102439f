#define _POSIX_C_SOURCE 200809L
#include "comparison.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <sluice/metrics.h>

#include "../common/png_file.h"
#include "../../tools/common/progress.h"
#include "../../tools/common/text.h"
#include "gallery_report.h"

#define MAX_WORKERS 64

static size_t pixel_count(const struct comparison *comparison)
{
    const uint32_t *size = comparison->gallery->settings.size;
    return (size_t)size[0] * size[1];
}

bool comparison_begin(const struct gallery *gallery, struct measure *measure,
                      struct comparison *comparison)
{
    const struct settings *settings = &gallery->settings;
    *comparison =
        (struct comparison){.gallery = gallery, .measure = measure, .lowest = (double)INFINITY};
    size_t size = 4 * pixel_count(comparison);
    if (!settings->reference && settings->metrics_every == 0)
        return true;
    return frame_file_create_scratch(settings->output, size, &comparison->streamed) &&
           (settings->reference ||
            frame_file_create_scratch(settings->output, size, &comparison->truth));
}

void comparison_finish(struct comparison *comparison)
{
    frame_file_close(&comparison->streamed);
    frame_file_close(&comparison->truth);
}

static bool is_nth(const struct settings *settings, uint32_t frame)
{
    return settings->metrics_every > 0 && frame % settings->metrics_every == 0;
}

bool comparison_keep(struct comparison *comparison, uint32_t frame, const uint8_t *pixels,
                     const uint8_t *truth, bool written)
{
    const struct settings *settings = &comparison->gallery->settings;
    double psnr = comparison->measure->frames[frame].psnr;
    if (settings->reference)
        return frame_file_write(&comparison->streamed, frame, pixels);
    if (settings->metrics_every == 0)
        return true;
    bool lowest = psnr < comparison->lowest;
    if (lowest)
        comparison->lowest = psnr;
    return !(is_nth(settings, frame) || written || lowest) ||
           (frame_file_write(&comparison->streamed, frame, pixels) &&
            frame_file_write(&comparison->truth, frame, truth));
}

/** A list of frames and the work that threads do on each. */
struct pass {
    const struct comparison *comparison;
    const struct frame_file *truth;
    const uint32_t *frames; ///< borrowed
    uint32_t count;
    const bool *written; ///< by frame of the walk
    bool (*work)(const struct pass *pass, uint32_t frame, const uint8_t *pixels,
                 const uint8_t *truth, float *errors);
    atomic_uint next, done;
    atomic_bool failed;
    struct progress *progress;
    pthread_t main;
};

static void *run_worker(void *argument)
{
    struct pass *pass = argument;
    size_t count = pixel_count(pass->comparison);
    uint8_t *pixels = malloc(4 * count), *truth = malloc(4 * count);
    float *errors = malloc(count * sizeof *errors);
    bool good = pixels && truth && errors;
    if (!good)
        fprintf(stderr, "out of memory\n");
    while (good && !atomic_load(&pass->failed)) {
        uint32_t i = atomic_fetch_add(&pass->next, 1);
        if (i >= pass->count)
            break;
        uint32_t frame = pass->frames[i];
        good = frame_file_read(&pass->comparison->streamed, frame, pixels) &&
               frame_file_read(pass->truth, frame, truth) &&
               pass->work(pass, frame, pixels, truth, errors);
        uint32_t done = atomic_fetch_add(&pass->done, 1) + 1;
        if (pthread_equal(pthread_self(), pass->main))
            progress_update(pass->progress, done);
    }
    if (!good)
        atomic_store(&pass->failed, true);
    free(pixels);
    free(truth);
    free(errors);
    return NULL;
}

/** Runs on all processors, this thread included. */
static bool run_pass(struct pass *pass, const char *what)
{
    pthread_t threads[MAX_WORKERS];
    struct progress progress;
    long processors = sysconf(_SC_NPROCESSORS_ONLN);
    uint32_t wanted = processors > 1 ? (uint32_t)processors - 1 : 0, started = 0;
    atomic_init(&pass->next, 0);
    atomic_init(&pass->done, 0);
    atomic_init(&pass->failed, false);
    pass->progress = &progress;
    pass->main = pthread_self();
    progress_begin(&progress, what, "frames", pass->count);
    while (started < wanted && started < MAX_WORKERS && started + 1 < pass->count &&
           pthread_create(&threads[started], NULL, run_worker, pass) == 0)
        started++;
    run_worker(pass);
    for (uint32_t i = 0; i < started; i++)
        pthread_join(threads[i], NULL);
    if (!atomic_load(&pass->failed))
        progress_end(&progress);
    return !atomic_load(&pass->failed);
}

static bool check(SluiceResult result, uint32_t frame)
{
    if (result != SLUICE_SUCCESS)
        text_say("frame %u cannot be compared: %s", frame, sluiceGetResultName(result));
    return result == SLUICE_SUCCESS;
}

static bool find_psnr(const struct pass *pass, uint32_t frame, const uint8_t *pixels,
                      const uint8_t *truth, float *errors)
{
    const uint32_t *size = pass->comparison->gallery->settings.size;
    (void)errors;
    return check(sluiceComputePsnr8(pixels, truth, size[0], size[1], 4,
                                    &pass->comparison->measure->frames[frame].psnr),
                 frame);
}

static bool write_picture(const struct settings *settings, const char *kind, uint32_t frame,
                          const uint8_t *pixels)
{
    char path[4096];
    gallery_report_picture_path(settings->output, kind, frame, path, sizeof path);
    return png_file_write(path, pixels, settings->size[0], settings->size[1]);
}

static bool write_errors(const struct pass *pass, uint32_t frame, const float *errors)
{
    size_t count = pixel_count(pass->comparison);
    uint8_t *colors = malloc(4 * count);
    bool written = colors && check(sluiceColorMagma(errors, count, colors), frame) &&
                   write_picture(&pass->comparison->gallery->settings, "flip", frame, colors);
    free(colors);
    return written;
}

static bool find_metrics(const struct pass *pass, uint32_t frame, const uint8_t *pixels,
                         const uint8_t *truth, float *errors)
{
    const struct settings *settings = &pass->comparison->gallery->settings;
    struct frame_record *record = &pass->comparison->measure->frames[frame];
    SluicePicturePair pair = {.structSize = sizeof pair,
                              .pA = pixels,
                              .pB = truth,
                              .width = settings->size[0],
                              .height = settings->size[1],
                              .format = SLUICE_PIXEL_FORMAT_RGBA8_SRGB};
    SluiceMetricMap map = {.pValues = errors};
    bool written = pass->written[frame];
    if (written && (!write_picture(settings, "frame", frame, pixels) ||
                    !write_picture(settings, "truth", frame, truth)))
        return false;
    if (settings->metrics_every == 0)
        return true;
    return check(sluiceComputeSsim(&pair, NULL, NULL, &record->ssim), frame) &&
           check(sluiceComputeFlip(&pair, 0, &map, NULL, &record->flip), frame) &&
           (!written || write_errors(pass, frame, errors));
}

/** Returns the frame with the lowest PSNR, or frame_count if all frames equal the truth. */
static uint32_t find_worst(const struct measure *measure)
{
    uint32_t worst = measure->frame_count;
    double lowest = (double)INFINITY;
    for (uint32_t i = measure->first_frame; i < measure->frame_count; i++)
        if (measure->frames[i].psnr < lowest) {
            lowest = measure->frames[i].psnr;
            worst = i;
        }
    return worst;
}

/** Chooses the frames to measure, fills `pass->frames` and completes `written`. */
static void choose(struct pass *pass, uint32_t *frames, bool *is_written,
                   struct written_frames *written)
{
    const struct settings *settings = &pass->comparison->gallery->settings;
    const struct measure *measure = pass->comparison->measure;
    uint32_t worst = find_worst(measure);
    for (uint32_t i = 0; i < written->count; i++)
        is_written[written->frames[i]] = true;
    if (settings->write_frames == WRITE_FRAMES_SOME && worst < measure->frame_count)
        is_written[worst] = true;
    written->count = 0;
    for (uint32_t i = measure->first_frame; i < measure->frame_count; i++) {
        if (is_written[i])
            written->frames[written->count++] = i;
        if (is_written[i] || is_nth(settings, i) || (i == worst && settings->metrics_every > 0))
            frames[pass->count++] = i;
    }
}

/** Computes the PSNR of all frames. */
static bool compare_all(struct pass *pass, uint32_t *frames)
{
    pass->count = pass->comparison->measure->frame_count;
    for (uint32_t i = 0; i < pass->count; i++)
        frames[i] = i;
    pass->work = find_psnr;
    bool done = run_pass(pass, "comparing");
    pass->count = 0;
    return done;
}

bool comparison_run(const struct comparison *comparison, struct written_frames *written)
{
    const struct settings *settings = &comparison->gallery->settings;
    struct pass pass = {.comparison = comparison,
                        .truth = settings->reference ? &comparison->gallery->reference.frames
                                                     : &comparison->truth};
    if (!comparison->streamed.is_open)
        return true;
    uint32_t *frames = calloc(settings->frames, sizeof *frames);
    bool *is_written = calloc(settings->frames, sizeof *is_written);
    bool done = frames && is_written;
    if (!done)
        fprintf(stderr, "out of memory\n");
    pass.frames = frames;
    pass.written = is_written;
    done = done && (!settings->reference || compare_all(&pass, frames));
    if (done) {
        choose(&pass, frames, is_written, written);
        pass.work = find_metrics;
        const char *what = settings->metrics_every > 0 ? "SSIM and FLIP" : "writing pictures";
        done = pass.count == 0 || run_pass(&pass, what);
    }
    free(frames);
    free(is_written);
    return done;
}
