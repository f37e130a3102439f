#include "needs_wait.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sluice/shared/texture_table.h"

bool needs_is_shown(uint16_t shown, uint8_t level)
{
    return shown <= level * SLUICE_SHOWN_STEPS + (level ? SLUICE_SHOWN_MARGIN : 0);
}

bool needs_wait_begin(struct needs_wait *wait, size_t region_count)
{
    *wait = (struct needs_wait){.region_count = region_count, .before = malloc(region_count + 1)};
    if (wait->before)
        memset(wait->before, SLUICE_MIP_UNTOUCHED, region_count + 1);
    return wait->before != NULL;
}

void needs_wait_finish(struct needs_wait *wait)
{
    free(wait->before);
    free(wait->open);
    free(wait->lengths);
    *wait = (struct needs_wait){0};
}

static bool end_wait(struct needs_wait *wait, uint64_t length, bool met)
{
    if (length >= wait->length_capacity) {
        size_t capacity = 2 * (size_t)length + 64;
        uint64_t *lengths = realloc(wait->lengths, capacity * sizeof *lengths);
        if (!lengths)
            return false;
        memset(lengths + wait->length_capacity, 0,
               (capacity - wait->length_capacity) * sizeof *lengths);
        wait->lengths = lengths;
        wait->length_capacity = capacity;
    }
    wait->lengths[length]++;
    wait->count++;
    wait->unmet += !met;
    return true;
}

static bool begin_wait(struct needs_wait *wait, size_t region, uint8_t level)
{
    if (wait->open_count == wait->open_capacity) {
        size_t capacity = 2 * wait->open_capacity + 256;
        struct needs_wait_event *open = realloc(wait->open, capacity * sizeof *open);
        if (!open)
            return false;
        wait->open = open;
        wait->open_capacity = capacity;
    }
    wait->open[wait->open_count++] = (struct needs_wait_event){region, wait->frame, level};
    return true;
}

/* Ends waits that are met or no longer needed. A region that needs a finer level still needs this
 * one. */
static bool end_waits(struct needs_wait *wait, const uint8_t *levels, const uint16_t *shown)
{
    size_t kept = 0;
    bool done = true;
    for (size_t i = 0; i < wait->open_count; i++) {
        const struct needs_wait_event event = wait->open[i];
        bool needed = levels[event.region] <= event.level;
        bool met = needed && needs_is_shown(shown[event.region], event.level);
        if (needed && !met)
            wait->open[kept++] = event;
        else
            done = end_wait(wait, wait->frame - event.since, met) && done;
    }
    wait->open_count = kept;
    return done;
}

bool needs_wait_add_frame(struct needs_wait *wait, const uint8_t *levels, const uint16_t *shown)
{
    bool done = end_waits(wait, levels, shown);
    for (size_t i = 0; i < wait->region_count; i++)
        if (levels[i] < wait->before[i])
            done = (needs_is_shown(shown[i], levels[i]) ? end_wait(wait, 0, true)
                                                        : begin_wait(wait, i, levels[i])) &&
                   done;
    memcpy(wait->before, levels, wait->region_count);
    wait->frame++;
    return done;
}

bool needs_wait_end(struct needs_wait *wait)
{
    bool done = true;
    for (size_t i = 0; i < wait->open_count; i++)
        done = end_wait(wait, wait->frame - wait->open[i].since, false) && done;
    wait->open_count = 0;
    return done;
}

double needs_wait_quantile(const struct needs_wait *wait, double share)
{
    uint64_t seen = 0;
    for (size_t length = 0; length < wait->length_capacity; length++) {
        seen += wait->lengths[length];
        if (seen > 0 && (double)seen >= share * (double)wait->count)
            return (double)length;
    }
    return NAN;
}

double needs_wait_mean(const struct needs_wait *wait)
{
    double frames = 0;
    for (size_t length = 0; length < wait->length_capacity; length++)
        frames += (double)length * (double)wait->lengths[length];
    return wait->count > 0 ? frames / (double)wait->count : NAN;
}
