#include "slowness.h"

#include <assert.h>
#include <stdlib.h>

static uint64_t newest_frame(void *user_data)
{
    return atomic_load((atomic_uint_least64_t *)user_data);
}

bool slowness_begin(struct slowness *slowness, const struct settings *settings, uint32_t capacity)
{
    struct slow_line_info info = {.latency = 1e3 * settings->source_latency,
                                  .bandwidth = settings->source_bandwidth,
                                  .clock = newest_frame,
                                  .user_data = &slowness->now};
    if (info.latency == 0.0 && info.bandwidth == 0.0)
        return true;
    atomic_init(&slowness->now, 0);
    slowness->sources = calloc(capacity, sizeof *slowness->sources);
    slowness->capacity = capacity;
    slowness->on = slowness->sources && slow_line_init(&slowness->line, &info);
    return slowness->on;
}

SluiceImageSource *slowness_wrap(struct slowness *slowness, SluiceImageSource *source)
{
    SluiceImageSource *slow;
    if (!slowness->on)
        return source;
    assert(slowness->count < slowness->capacity);
    if (slow_source_create(&slowness->line, source, &slow) != SLUICE_SUCCESS)
        return NULL;
    return slowness->sources[slowness->count++] = slow;
}

void slowness_set_time(struct slowness *slowness, uint64_t now)
{
    if (slowness->on)
        atomic_store(&slowness->now, now);
}

void slowness_finish(struct slowness *slowness)
{
    for (uint32_t i = 0; i < slowness->count; i++)
        sluiceDestroyImageSource(slowness->sources[i]);
    if (slowness->on)
        slow_line_finish(&slowness->line);
    free(slowness->sources);
    slowness->sources = NULL;
    slowness->count = 0;
    slowness->on = false;
}
