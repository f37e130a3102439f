#include "summary.h"

#include <stdio.h>
#include <stdlib.h>

void summary_add(struct summary *s, const struct view_facts *f)
{
    const uint32_t at = (uint32_t)(s->frame_count++ % SUMMARY_FRAMES);
    s->missing_of[at] = 100.0f - f->latest[SERIES_SHARP];
    s->gpu_of[at] = f->latest[SERIES_GPU];
    s->host_of[at] = f->latest[SERIES_HOST];
    s->missing += (double)s->missing_of[at];
    s->peak = f->latest[SERIES_RESIDENT] > s->peak ? f->latest[SERIES_RESIDENT] : s->peak;
}

static int compare_values(const void *left, const void *right)
{
    const float a = *(const float *)left, b = *(const float *)right;
    return a < b ? -1 : a > b;
}

/* Returns the quantile `part` of the values. */
static double quantile(const struct summary *s, float *values, double part)
{
    const size_t count =
        s->frame_count < SUMMARY_FRAMES ? (size_t)s->frame_count : (size_t)SUMMARY_FRAMES;
    qsort(values, count, sizeof *values, compare_values);
    return count > 0 ? (double)values[(size_t)(part * (double)(count - 1) + 0.5)] : 0.0;
}

void view_summary_print(struct summary *s, const struct view_facts *f)
{
    const double frames = s->frame_count > 0 ? (double)s->frame_count : 1.0;
    printf("{\"name\": \"missing_percent_mean\", \"value\": %.4f, \"unit\": \"%%\"}\n"
           "{\"name\": \"missing_percent_p99\", \"value\": %.4f, \"unit\": \"%%\"}\n"
           "{\"name\": \"resident_bytes_peak\", \"value\": %.0f, \"unit\": \"B\"}\n"
           "{\"name\": \"tiles_mapped\", \"value\": %llu, \"unit\": \"\"}\n"
           "{\"name\": \"tiles_failed\", \"value\": %llu, \"unit\": \"\"}\n"
           "{\"name\": \"gpu_ms_median\", \"value\": %.4f, \"unit\": \"ms\"}\n"
           "{\"name\": \"host_ms_median\", \"value\": %.4f, \"unit\": \"ms\"}\n",
           s->missing / frames, quantile(s, s->missing_of, 0.99), 1e6 * (double)s->peak,
           (unsigned long long)f->now.tilesMapped, (unsigned long long)f->now.tilesFailed,
           quantile(s, s->gpu_of, 0.5), quantile(s, s->host_of, 0.5));
}
