#define _POSIX_C_SOURCE 200809L
#include "progress.h"

#include <stdio.h>
#include <unistd.h>

#include "clock.h"

#define BAR_WIDTH 30

void progress_begin(struct progress *progress, const char *what, const char *unit, uint64_t total)
{
    *progress = (struct progress){.what = what, .unit = unit, .total = total ? total : 1};
    progress->start = clock_seconds();
    progress->last_shown = progress->start;
    progress->terminal = isatty(STDERR_FILENO);
}

static const char *metric_prefix(double *value)
{
    static const char *const prefixes[] = {"", "k", "M", "G"};
    int i = 0;
    for (; *value >= 1000.0 && i < 3; i++)
        *value /= 1000.0;
    return prefixes[i];
}

/* Writes "42 ktexels/s  3 s left", or nothing before the first progress. */
static void write_estimate(const struct progress *progress, uint64_t done, double seconds,
                           char *text, size_t size)
{
    text[0] = '\0';
    if (done == 0)
        return;
    double rate = (double)done / seconds;
    double left = (double)(progress->total - done) / rate;
    const char *prefix = metric_prefix(&rate);
    snprintf(text, size, "%.3g %s%s/s  %.0f s left", rate, prefix, progress->unit, left);
}

void progress_update(struct progress *progress, uint64_t done)
{
    double now = clock_seconds();
    if (now - progress->last_shown < (progress->terminal ? 0.1 : 5.0))
        return;
    progress->last_shown = now;
    if (done > progress->total)
        done = progress->total;

    double share = (double)done / (double)progress->total;
    char estimate[64];
    write_estimate(progress, done, now - progress->start, estimate, sizeof estimate);
    char bar[BAR_WIDTH + 1];
    for (int i = 0; i < BAR_WIDTH; i++)
        bar[i] = i < (int)(share * BAR_WIDTH) ? '#' : '.';
    bar[BAR_WIDTH] = '\0';
    fprintf(stderr, "%s%s [%s] %3.0f %%  %s   %s", progress->terminal ? "\r" : "", progress->what,
            bar, 100.0 * share, estimate, progress->terminal ? "" : "\n");
    fflush(stderr);
}

void progress_end(struct progress *progress)
{
    double seconds = clock_seconds() - progress->start;
    double count = (double)progress->total, rate = seconds > 0.0 ? count / seconds : 0.0;
    const char *count_prefix = metric_prefix(&count), *rate_prefix = metric_prefix(&rate);
    fprintf(stderr, "%s%s: %.4g %s%s in %.1f s, %.3g %s%s/s%s\n", progress->terminal ? "\r" : "",
            progress->what, count, count_prefix, progress->unit, seconds, rate, rate_prefix,
            progress->unit, progress->terminal ? "                              " : "");
}
