#define _POSIX_C_SOURCE 199309L
#include "figures.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

struct options options;

uint64_t now_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (uint64_t)t.tv_sec * 1000000000u + (uint64_t)t.tv_nsec;
}

/* Does not read statm, whose counts the kernel may keep back per thread and core. */
uint64_t resident_size(void)
{
    FILE *file = fopen("/proc/self/smaps_rollup", "r");
    if (!file)
        return 0;
    char line[256];
    unsigned long long kib = 0;
    while (fgets(line, sizeof line, file) && sscanf(line, "Rss: %llu kB", &kib) != 1)
        ;
    fclose(file);
    return kib * 1024;
}

uint32_t repetitions(uint32_t full)
{
    uint32_t quick = full / 10 < 4 ? 4 : full / 10;
    return options.quick && quick < full ? quick : full;
}

void samples_init(struct samples *samples, uint32_t room)
{
    *samples = (struct samples){.ns = malloc(room * sizeof *samples->ns), .room = room};
    if (!samples->ns)
        abort();
    /* Touch the memory now, so that no page fault falls into the timed part. */
    for (uint32_t i = 0; i < room; i++)
        samples->ns[i] = -1;
}

void samples_add(struct samples *samples, double ns)
{
    if (samples->count == samples->room)
        abort();
    samples->ns[samples->count++] = ns;
}

void samples_finish(struct samples *samples)
{
    free(samples->ns);
    *samples = (struct samples){0};
}

double samples_mean(const struct samples *samples)
{
    double sum = 0;
    for (uint32_t i = 0; i < samples->count; i++)
        sum += samples->ns[i];
    return sum / samples->count;
}

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

double samples_quantile(struct samples *samples, double share)
{
    qsort(samples->ns, samples->count, sizeof *samples->ns, by_size);
    uint32_t i = (uint32_t)(samples->count * share);
    return samples->ns[i < samples->count ? i : samples->count - 1];
}

void figure(const char *name, const char *part, double value, const char *unit)
{
    char whole[128];
    snprintf(whole, sizeof whole, "%s%s%s", name, part ? "." : "", part ? part : "");
    if (options.json)
        printf("{\"name\": \"%s\", \"value\": %.6g, \"unit\": \"%s\"}\n", whole, value, unit);
    else
        printf("%-44s %14.6g %s\n", whole, value, unit);
}

void figure_times(const char *name, struct samples *samples)
{
    figure(name, "median", samples_quantile(samples, 0.5) / 1e3, "us");
    figure(name, "min", samples_quantile(samples, 0) / 1e3, "us");
}

void figure_frames(const char *name, struct samples *samples)
{
    figure(name, "median", samples_quantile(samples, 0.5) / 1e3, "us");
    figure(name, "mean", samples_mean(samples) / 1e3, "us");
    figure(name, "p99", samples_quantile(samples, 0.99) / 1e3, "us");
}
