#include "history.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SHORTEST_SPAN 10.0

bool history_create(uint32_t series_count, struct history *h)
{
    static const double spans[HISTORY_SPANS] = {SHORTEST_SPAN, 60.0, SHORTEST_SPAN};
    bool created = true;
    *h = (struct history){.series_count = series_count};
    for (int i = 0; i < HISTORY_SPANS; i++) {
        h->rings[i].step = spans[i] / HISTORY_POINTS;
        h->rings[i].values =
            calloc((size_t)HISTORY_POINTS * series_count + 1, sizeof *h->rings[i].values);
        created = h->rings[i].values && created;
    }
    h->frames = calloc(HISTORY_FRAMES, sizeof *h->frames);
    h->sorted = calloc(HISTORY_FRAMES, sizeof *h->sorted);
    if (created && h->frames && h->sorted)
        return true;
    history_destroy(h);
    return false;
}

void history_destroy(struct history *h)
{
    for (int i = 0; i < HISTORY_SPANS; i++)
        free(h->rings[i].values);
    free(h->frames);
    free(h->sorted);
    *h = (struct history){0};
}

static float *point_at(const struct history *h, const struct history_ring *ring, uint64_t number)
{
    return ring->values + (size_t)(number % HISTORY_POINTS) * h->series_count;
}

/* Merges pairs of points, so that the whole time fits. The first point has number 0. */
static void halve(const struct history *h, struct history_ring *ring)
{
    for (uint64_t to = 0; to <= ring->last / 2; to++)
        for (uint32_t i = 0; i < h->series_count; i++) {
            const float value = point_at(h, ring, 2 * to)[i];
            point_at(h, ring, to)[i] =
                2 * to < ring->last ? fmaxf(value, point_at(h, ring, 2 * to + 1)[i]) : value;
        }
    ring->last /= 2;
    ring->count = (uint32_t)ring->last + 1;
    ring->step *= 2;
}

static void put(const struct history *h, struct history_ring *ring, uint64_t number,
                const float *values)
{
    if (ring->count == 0)
        ring->last = number;
    /* A frame longer than a step fills the points that it passes. */
    for (uint64_t next = ring->count == 0 ? number : ring->last + 1; next <= number; next++) {
        if (number - next >= HISTORY_POINTS)
            continue;
        memcpy(point_at(h, ring, next), values, h->series_count * sizeof *values);
        ring->last = next;
        ring->count += ring->count < HISTORY_POINTS;
    }
    for (uint32_t i = 0; i < h->series_count; i++)
        point_at(h, ring, ring->last)[i] = fmaxf(point_at(h, ring, ring->last)[i], values[i]);
}

void history_add(struct history *h, double seconds, const float *values)
{
    for (int i = 0; i < HISTORY_SPANS; i++) {
        struct history_ring *ring = &h->rings[i];
        uint64_t number = (uint64_t)(h->seconds / ring->step);
        while (i == HISTORY_ALL && number >= HISTORY_POINTS) {
            halve(h, ring);
            number = (uint64_t)(h->seconds / ring->step);
        }
        put(h, ring, number, values);
    }
    h->frames[h->frame_count++ % HISTORY_FRAMES] = (float)seconds;
    h->seconds += seconds;
}

uint32_t history_count(const struct history *h, enum history_span span)
{
    return h->rings[span].count;
}

float history_value(const struct history *h, enum history_span span, uint32_t series, uint32_t age)
{
    const struct history_ring *ring = &h->rings[span];
    return age < ring->count ? point_at(h, ring, ring->last - age)[series] : 0.0f;
}

uint32_t history_read(const struct history *h, enum history_span span, uint32_t series,
                      float *values)
{
    const struct history_ring *ring = &h->rings[span];
    uint32_t slot = (uint32_t)(ring->last % HISTORY_POINTS);
    for (uint32_t age = 0; age < ring->count; age++) {
        values[age] = ring->values[(size_t)slot * h->series_count + series];
        slot = slot > 0 ? slot - 1 : HISTORY_POINTS - 1;
    }
    return ring->count;
}

uint32_t history_age_of(const struct history *h, enum history_span span, double seconds)
{
    const struct history_ring *ring = &h->rings[span];
    const uint64_t number = (uint64_t)(seconds / ring->step);
    const bool known = number <= ring->last && ring->last - number < ring->count;
    return known ? (uint32_t)(ring->last - number) : UINT32_MAX;
}

double history_time_of(const struct history *h, enum history_span span, uint32_t age)
{
    const struct history_ring *ring = &h->rings[span];
    return ((double)(ring->last - age) + 0.5) * ring->step;
}

static int compare(const void *left, const void *right)
{
    const float *a = left, *b = right;
    return *a < *b ? -1 : *a > *b;
}

void history_frame_times(struct history *h, enum history_span span, const double *parts,
                         uint32_t count, double *seconds)
{
    const double length = h->rings[span].step * HISTORY_POINTS;
    double sum = 0;
    uint32_t frames = 0;
    while (frames < HISTORY_FRAMES && frames < h->frame_count && sum < length) {
        h->sorted[frames] = h->frames[(h->frame_count - 1 - frames) % HISTORY_FRAMES];
        sum += (double)h->sorted[frames++];
    }
    qsort(h->sorted, frames, sizeof *h->sorted, compare);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t at = (uint32_t)ceil(parts[i] * frames);
        seconds[i] = frames > 0 ? (double)h->sorted[at > 0 ? at - 1 : 0] : 0.0;
    }
}
