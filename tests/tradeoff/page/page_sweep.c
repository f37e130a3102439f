#define _POSIX_C_SOURCE 200809L
#include "page_sweep.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

const char page_sweep_hostile[] =
    "</script><script>document.title='taken'</script><img src=x onerror=\"document.title='taken'\">"
    "<!--<script> ' \" \\ \n \t \x01 \xff \xe2\x80\xa8 \xe2\x80\xae =1+1 &lt; @SWEEP@";

static const struct sweep_setting settings[PAGE_SWEEP_SETTINGS] = {
    {"probability", "that a pixel quad writes feedback", ""},
    {"budget", "for tiles at most; 0: no cap", "MiB"},
    {"mode", "of working", ""}};
static const struct sweep_metric metrics[PAGE_SWEEP_METRICS] = {
    {"resident_bytes_peak", "bytes", "most that was resident", SWEEP_LESS_IS_BETTER},
    {"flip_mean", "", "FLIP over frames", SWEEP_LESS_IS_BETTER},
    {"psnr_mean_db", "dB", "PSNR over frames", SWEEP_MORE_IS_BETTER},
    {"gpu_ms_median", "ms", "of the GPU", SWEEP_LESS_IS_BETTER},
    {"odd_figure", "", "of no use", SWEEP_NEITHER}};
static const char *const values[PAGE_SWEEP_POINTS][PAGE_SWEEP_SETTINGS] = {
    {"1/2", "0", "fast"},   {"1/4", "0", "fast"},  {"1/16", "0", "fast"},  {"1/64", "0", "fast"},
    {"1/256", "0", "fast"}, {"1/16", "8", "fast"}, {"1/16", "16", "fast"}, {"1/16", "0", "slow"},
    {"1/64", "16", "slow"}, {"1/16", "4", "fast"}, {"1/2", "16", "slow"}};
static const char *const labels[PAGE_SWEEP_POINTS] = {"probability 1/2",
                                                      "probability 1/4",
                                                      "",
                                                      "probability 1/64",
                                                      "probability 1/256",
                                                      "budget 8",
                                                      "budget 16",
                                                      "mode slow",
                                                      "probability 1/64, budget 16, mode slow",
                                                      "budget 4",
                                                      "probability 1/2, budget 16, mode slow"};

static void set_estimate(struct sweep_estimate *estimate, double mean)
{
    double half_width = fabs(mean) / 50.0;
    *estimate = (struct sweep_estimate){mean, half_width, mean - half_width, mean + half_width, 3};
}

/* Call after all points have estimates. */
static void set_deltas(struct page_sweep *s, uint32_t i)
{
    for (uint32_t k = 0; k < PAGE_SWEEP_METRICS; k++) {
        double change = s->estimates[i][k].mean - s->estimates[PAGE_SWEEP_BASE][k].mean;
        double half_width = k == PAGE_SWEEP_TIME ? 3.0 : 0.0;
        s->deltas[i][k] = (struct sweep_estimate){change, half_width, change - half_width,
                                                  change + half_width, 3};
    }
    s->points[i].deltas = s->deltas[i];
}

static void set_figures(struct page_sweep *s, uint32_t i)
{
    struct sweep_estimate *estimates = s->estimates[i];
    set_estimate(&estimates[PAGE_SWEEP_MEMORY], (1.0 + 5 * i % 11) * 4194304.0);
    set_estimate(&estimates[PAGE_SWEEP_FLIP], (1.0 + 7 * i % 11) / 100.0);
    set_estimate(&estimates[PAGE_SWEEP_PSNR], i == PAGE_SWEEP_EQUAL ? 999.0 : 40.0 - i);
    set_estimate(&estimates[PAGE_SWEEP_TIME], i == PAGE_SWEEP_UNKNOWN ? NAN : 2.0 + i % 4);
    set_estimate(&estimates[PAGE_SWEEP_ODD], -INFINITY);
}

static char *pick(bool hostile, const char *word)
{
    return (char *)(hostile ? page_sweep_hostile : word); /* nobody frees it */
}

static void set_point(struct page_sweep *s, uint32_t i, const char *root, bool hostile)
{
    snprintf(s->folders[i], sizeof s->folders[i], "%s/%u", root, (unsigned)i);
    for (uint32_t k = 0; k < PAGE_SWEEP_SETTINGS; k++)
        s->values[i][k] = pick(hostile && k == 2, values[i][k]);
    set_figures(s, i);
    s->points[i] = (struct sweep_point){.values = s->values[i],
                                        .label = pick(hostile, labels[i]),
                                        .command_line = pick(hostile, "program --json"),
                                        .folder = s->folders[i],
                                        .state = i < PAGE_SWEEP_DONE ? SWEEP_DONE : SWEEP_PENDING,
                                        .estimates = s->estimates[i]};
    if (i == PAGE_SWEEP_DONE) {
        s->points[i].state = SWEEP_FAILED;
        s->points[i].reason = pick(hostile, "it ended with status 1");
    }
}

void page_sweep_init(struct page_sweep *s, const char *root, bool hostile)
{
    memset(s, 0, sizeof *s);
    s->sweep = (struct sweep){.title = pick(hostile, "Formulas"),
                              .scene = pick(hostile, "nothing is drawn"),
                              .machine = pick(hostile, "a test"),
                              .command_line = pick(hostile, "sluice-tradeoff formulas"),
                              .settings = settings,
                              .metrics = metrics,
                              .setting_count = PAGE_SWEEP_SETTINGS,
                              .metric_count = PAGE_SWEEP_METRICS,
                              .point_count = PAGE_SWEEP_POINTS,
                              .base = PAGE_SWEEP_BASE,
                              .repeats = 3,
                              .points = s->points};
    for (uint32_t i = 0; i < PAGE_SWEEP_POINTS; i++)
        set_point(s, i, root, hostile);
    for (uint32_t i = 0; i < PAGE_SWEEP_POINTS; i++)
        set_deltas(s, i);
    s->recommendations[0] =
        (struct sweep_recommendation){pick(hostile, "quality"), pick(hostile, "the best"), 0};
    s->recommendations[1] = (struct sweep_recommendation){"balanced", "between", 8};
    s->recommendations[2] = (struct sweep_recommendation){"small memory", "the least", -1};
}

static FILE *open_in_folder(const struct page_sweep *s, uint32_t point, const char *name)
{
    char path[600];
    mkdir(s->points[point].folder, 0777);
    snprintf(path, sizeof path, "%s/%s", s->points[point].folder, name);
    FILE *file = fopen(path, "wb");
    if (!file) {
        perror(path);
        abort();
    }
    return file;
}

void page_sweep_add_file(const struct page_sweep *s, uint32_t point, const char *name,
                         const void *bytes, size_t size)
{
    FILE *file = open_in_folder(s, point, name);
    fwrite(bytes, 1, size, file);
    fclose(file);
}

void page_sweep_add_frames(const struct page_sweep *s, uint32_t point, uint32_t frames)
{
    FILE *file = open_in_folder(s, point, "frames.csv");
    fputs("frame,at_rest,psnr_db,missing_pixels,sampled_pixels,bytes_read\n", file);
    for (uint32_t i = 0; i < frames; i++)
        fprintf(file, "%u,%d,%u,%d,1000,%s\n", (unsigned)i, i > frames * 3 / 4,
                i == 1 ? 999u : (unsigned)(20 + (7 * i + point) % 30), i == 0 ? 100 : 0,
                i == 2 ? "" : "65536");
    fclose(file);
}

static const uint8_t png[] = {
    0x89, 0x50, 0x4E, 0x47, 0x0D, 0x0A, 0x1A, 0x0A, 0x00, 0x00, 0x00, 0x0D, 0x49, 0x48,
    0x44, 0x52, 0x00, 0x00, 0x00, 0x04, 0x00, 0x00, 0x00, 0x02, 0x08, 0x02, 0x00, 0x00,
    0x00, 0xF0, 0xCA, 0xEA, 0x34, 0x00, 0x00, 0x00, 0x18, 0x49, 0x44, 0x41, 0x54, 0x78,
    0x9C, 0x63, 0xD0, 0x88, 0x3A, 0x91, 0x12, 0xB5, 0x60, 0x41, 0x54, 0xC5, 0x9D, 0xA8,
    0x00, 0x06, 0x64, 0x0E, 0x00, 0x8F, 0xB2, 0x0B, 0x41, 0x70, 0x96, 0xDE, 0xE6, 0x00,
    0x00, 0x00, 0x00, 0x49, 0x45, 0x4E, 0x44, 0xAE, 0x42, 0x60, 0x82};

void page_sweep_add_picture(const struct page_sweep *s, uint32_t point, const char *kind,
                            uint32_t frame, uint8_t id, size_t filler_size)
{
    char name[32];
    snprintf(name, sizeof name, "%s-%04u.png", kind, (unsigned)frame);
    FILE *file = open_in_folder(s, point, name);
    fwrite(png, 1, sizeof png, file);
    for (size_t i = 0; i < filler_size; i++)
        fputc(id, file);
    fclose(file);
}
