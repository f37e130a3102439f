#include "play_figures.h"

#include "../common/text.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "../common/output_file.h"

#define TILE 65536.0

void play_print_figure(const struct play_printer *p, const char *name, double value,
                       const char *unit)
{
    char text[32] = "null";
    if (isfinite(value))
        snprintf(text, sizeof text, value == floor(value) && fabs(value) < 1e15 ? "%.0f" : "%.9g",
                 value);
    if (p->json)
        fprintf(p->out, "{\"name\": \"%s\", \"value\": %s, \"unit\": \"%s\"}\n", name, text, unit);
    else if (isfinite(value))
        fprintf(p->out, "%-38s %16s %s\n", name, text, unit);
}

/** Sums over all frames. */
struct sums {
    double touched, missing, levels, wrong, loaded, stale, unmapped, canceled;
    double resident_peak, heaps_peak;
};

static struct sums sum_up(const struct play_loop *l)
{
    struct sums s = {0};
    for (uint32_t i = 0; i < l->trace->frame_count; i++) {
        const struct play_frame *f = &l->frames[i];
        s.touched += (double)f->view.touched_regions;
        s.missing += (double)f->view.missing_regions;
        s.levels += (double)f->view.missing_levels;
        s.wrong += (double)f->view.wrong_evictions;
        s.loaded += f->loaded_tiles;
        s.stale += f->stale_tiles;
        s.unmapped += f->unmapped_tiles;
        s.canceled += f->canceled_tiles;
        s.resident_peak = fmax(s.resident_peak, f->resident_tiles);
        s.heaps_peak = fmax(s.heaps_peak, f->heaps);
    }
    return s;
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static bool print_times(const struct play_printer *p, const struct play_loop *l)
{
    const uint32_t count = l->trace->frame_count;
    double *times = malloc((count ? count : 1) * sizeof *times);
    if (!times) {
        fprintf(stderr, "out of memory\n");
        return false;
    }
    for (uint32_t i = 0; i < count; i++)
        times[i] = l->frames[i].core_us;
    qsort(times, count, sizeof *times, compare);
    play_print_figure(p, "core_us_per_frame", count ? times[count / 2] : NAN, "us");
    play_print_figure(p, "core_us_per_frame_p99", count ? times[(uint64_t)count * 99 / 100] : NAN,
                      "us");
    free(times);
    return true;
}

static void print_textures(const struct play_printer *p, const struct play_loop *l)
{
    const struct feedback_trace *t = l->trace;
    double never = 0;
    for (uint32_t i = 0; i < t->texture_count; i++)
        never += l->view.textures[t->textures[i].primary].asked == NULL;
    play_print_figure(p, "textures", t->texture_count, "");
    play_print_figure(p, "textures_never_sampled", never, "");
    play_print_figure(p, "virtual_bytes", (double)l->statistics.tileCount * TILE, "B");
}

static void print_tiles(const struct play_printer *p, const struct play_loop *l,
                        const struct sums *s)
{
    const double needed = (double)l->view.needed_tiles;
    play_print_figure(p, "tiles_needed", needed, "tiles");
    play_print_figure(p, "needed_bytes", needed * TILE, "B");
    play_print_figure(p, "tiles_loaded", s->loaded, "tiles");
    play_print_figure(p, "loaded_bytes", s->loaded * TILE, "B");
    play_print_figure(p, "loaded_per_needed", needed > 0 ? s->loaded / needed : NAN, "");
    play_print_figure(p, "stale_percent", s->loaded > 0 ? 100 * s->stale / s->loaded : 0, "%");
    play_print_figure(p, "tiles_unmapped", s->unmapped, "tiles");
    play_print_figure(p, "tiles_canceled", s->canceled, "tiles");
}

static void print_quality(const struct play_printer *p, const struct play_loop *l,
                          const struct sums *s)
{
    const double touched = s->touched > 0 ? s->touched : 1;
    play_print_figure(p, "touched_regions", s->touched, "regions");
    play_print_figure(p, "levels_too_coarse", s->levels / touched, "levels");
    play_print_figure(p, "regions_too_coarse_percent", 100 * s->missing / touched, "%");
    play_print_figure(p, "wrong_evictions", s->wrong, "regions");
    play_print_figure(p, "wrong_evictions_percent", 100 * s->wrong / touched, "%");
    play_print_figure(p, "frames_until_sharp_p50", view_wait(&l->view, 0.5), "frames");
    play_print_figure(p, "frames_until_sharp_p99", view_wait(&l->view, 0.99), "frames");
}

static void print_memory(const struct play_printer *p, const struct play_loop *l,
                         const struct sums *s)
{
    const uint32_t count = l->trace->frame_count;
    const double last = count ? l->frames[count - 1].resident_tiles : 0;
    play_print_figure(p, "resident_bytes", last * TILE, "B");
    play_print_figure(p, "resident_bytes_peak", s->resident_peak * TILE, "B");
    play_print_figure(p, "heap_bytes_peak", s->heaps_peak * l->options->heap_tiles * TILE, "B");
    play_print_figure(p, "host_bytes", (double)l->statistics.hostMemorySize, "B");
}

/** Frames per second from the time stamps. */
static double frame_rate(const struct play_loop *l)
{
    const uint32_t count = l->trace->frame_count;
    const double span = count > 1 ? (double)(l->frames[count - 1].time - l->frames[0].time) : 0;
    return span > 0 ? (count - 1) * 1e6 / span : 1;
}

bool play_print_figures(const struct play_printer *p, const struct play_loop *l)
{
    const struct sums sums = sum_up(l);
    play_print_figure(p, "frames", l->trace->frame_count, "");
    print_textures(p, l);
    print_tiles(p, l, &sums);
    print_quality(p, l, &sums);
    play_print_figure(p, "predicted_miss", play_feedback_predict_miss(&l->feedback, frame_rate(l)),
                      "");
    print_memory(p, l, &sums);
    return print_times(p, l);
}

/** Creates the folder and its parents. */
static bool make_folders(const char *folder)
{
    char path[4096];
    size_t length = strlen(folder);
    if (length >= sizeof path) {
        errno = ENAMETOOLONG;
        return false;
    }
    for (size_t i = 1; i <= length; i++) {
        if (folder[i] != '/' && folder[i] != '\0')
            continue;
        memcpy(path, folder, i);
        path[i] = '\0';
        if (mkdir(path, 0777) != 0 && errno != EEXIST)
            return false;
    }
    return true;
}

static void write_rows(const struct play_loop *l, FILE *file)
{
    fputs("frame,time_us,maps,touched_regions,missing_regions,levels_too_coarse,wrong_evictions,"
          "needed_tiles,loaded_tiles,stale_tiles,unmapped_tiles,canceled_tiles,requested_tiles,"
          "tiles_in_flight,resident_tiles,heaps,core_us\n",
          file);
    for (uint32_t i = 0; i < l->trace->frame_count; i++) {
        const struct play_frame *f = &l->frames[i];
        const double touched = f->view.touched_regions ? (double)f->view.touched_regions : 1;
        fprintf(
            file, "%u,%llu,%u,%llu,%llu,%.6g,%llu,%llu", i, (unsigned long long)f->time,
            f->map_count, (unsigned long long)f->view.touched_regions,
            (unsigned long long)f->view.missing_regions, (double)f->view.missing_levels / touched,
            (unsigned long long)f->view.wrong_evictions, (unsigned long long)f->view.needed_tiles);
        fprintf(file, ",%u,%u,%u,%u,%u,%u,%u,%u,%.2f\n", f->loaded_tiles, f->stale_tiles,
                f->unmapped_tiles, f->canceled_tiles, f->requested_tiles, f->tiles_in_flight,
                f->resident_tiles, f->heaps, f->core_us);
    }
}

bool play_write_frames(const struct play_loop *l, const char *folder)
{
    char path[4200];
    snprintf(path, sizeof path, "%s/frames.csv", folder);
    if (!make_folders(folder)) {
        text_say("%s: %s", folder, strerror(errno));
        return false;
    }
    struct output_file *output = output_file_begin(path);
    if (output)
        write_rows(l, output_file_stream(output));
    return output_file_end(output, true);
}
