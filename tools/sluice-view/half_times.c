#include "half_times.h"

#include <stdlib.h>
#include <string.h>

void half_series_add(struct half_series *s, double seconds)
{
    s->values[s->count++ % HALF_TIMES_MOST] = (float)(1e3 * seconds);
}

static int compare_values(const void *left, const void *right)
{
    const float a = *(const float *)left, b = *(const float *)right;
    return a < b ? -1 : a > b;
}

uint32_t half_series_count(const struct half_series *s, uint32_t most)
{
    const uint32_t kept = s->count < HALF_TIMES_MOST ? (uint32_t)s->count : HALF_TIMES_MOST;
    return kept < most ? kept : most;
}

double half_series_median(const struct half_series *s, uint32_t most)
{
    float sorted[HALF_TIMES_MOST];
    const uint32_t count = half_series_count(s, most);
    if (count == 0)
        return -1;
    for (uint32_t i = 0; i < count; i++)
        sorted[i] = s->values[(s->count - 1 - i) % HALF_TIMES_MOST];
    qsort(sorted, count, sizeof *sorted, compare_values);
    return ((double)sorted[(count - 1) / 2] + (double)sorted[count / 2]) / 2;
}
