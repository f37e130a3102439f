/* Tiles per second when filling from nothing, with a source that takes no time. */
#include "rig.h"

#include "../../tools/common/clock.h"
#include "../vulkan/copy_floor.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#define MAX_LAUNCHES 100000u
#define MEMORY_AHEAD (UINT64_C(768) << 20) /* bytes; more than the tiles take */

struct fill_times {
    double seconds;
    double begin, wait, process, gpu_prepare; ///< totals over all launches
    uint32_t launches;
};

static void add_times(struct fill_times *times, const struct rig_outcome *outcome)
{
    times->begin += outcome->host_parts[0];
    times->wait += outcome->host_parts[1];
    times->process += outcome->host_parts[2];
    times->gpu_prepare += outcome->gpu_parts[0];
    times->launches++;
}

/* Fills like a renderer that never waits for reads: two launches in flight, until one misses
 * nothing. */
static bool fill(struct rig *rig, struct fill_times *times)
{
    struct rig_outcome outcome;
    *times = (struct fill_times){0};
    rig->timed = !rig->bench->wall;
    double start = clock_seconds();
    bool done = rig_begin(rig, DEMAND_BENCH_SAMPLED), all = false;
    while (done && !all && times->launches < MAX_LAUNCHES) {
        done = rig_begin(rig, DEMAND_BENCH_SAMPLED) && rig_end(rig, &outcome);
        all = done && outcome.requests.missingCount == 0;
        add_times(times, &outcome);
    }
    times->seconds = clock_seconds() - start;
    return done && rig_end(rig, &outcome) && all;
}

static bool forget(struct rig *rig)
{
    for (uint32_t i = 0; i < rig->texture_count; i++)
        if (!check(sluiceInvalidateDemandTexture(rig->loader, rig->ids[i]),
                   "sluiceInvalidateDemandTexture"))
            return false;
    return true;
}

/* Fills once from nothing, and again into memory that the device has allocated by then. */
static bool fill_twice(const struct bench *bench, const SluiceDemandLoaderCreateInfo *info,
                       struct fill_times times[2], SluiceDemandStatistics *statistics)
{
    struct rig rig;
    bool done =
        rig_create(&rig, bench, info, false) && rig_warm_up(&rig) && fill(&rig, &times[0]) &&
        forget(&rig) && fill(&rig, &times[1]) &&
        check(sluiceGetDemandStatistics(rig.loader, statistics), "sluiceGetDemandStatistics");
    rig_destroy(&rig);
    return done;
}

struct fill_rates {
    double cold, again; ///< tiles per second; the best run
    double tiles;
};

/* Counts tiles except tails. Warming up has loaded one tail. */
static double tile_count(const SluiceDemandStatistics *s)
{
    return (double)(s->residentTileCount - s->texturesOpened);
}

static void report(const char *name, const struct fill_times *times, double rate)
{
    figure(name, "rate", rate, "tiles/s");
    figure(name, "launches", times->launches, "launches");
    figure(name, "host_begin", 100 * times->begin / times->seconds, "% of the time");
    figure(name, "host_wait", 100 * times->wait / times->seconds, "% of the time");
    figure(name, "host_process", 100 * times->process / times->seconds, "% of the time");
    if (!isnan(times->gpu_prepare))
        figure(name, "gpu_copies", 100 * times->gpu_prepare / times->seconds, "% of the time");
}

/* Reports the best of three runs under `name`. */
static bool fill_with(const struct bench *bench, const SluiceDemandLoaderCreateInfo *info,
                      const char *name, struct fill_rates *rates)
{
    SluiceDemandStatistics s = {.structSize = sizeof s};
    struct fill_times times = {.seconds = INFINITY}, again = times, both[2];
    for (uint32_t i = 0; i < (options.quick ? 1u : 3u); i++) {
        if (!fill_twice(bench, info, both, &s))
            return false;
        if (both[0].seconds < times.seconds)
            times = both[0];
        if (both[1].seconds < again.seconds)
            again = both[1];
    }
    rates->tiles = tile_count(&s);
    report(name, &times, rates->tiles / times.seconds);
    char again_name[64];
    snprintf(again_name, sizeof again_name, "%s.again", name);
    report(again_name, &again, rates->tiles / again.seconds);
    rates->again = fmax(rates->again, rates->tiles / again.seconds);
    rates->cold = fmax(rates->cold, rates->tiles / times.seconds);
    return true;
}

bool measure_fill(const struct bench *bench)
{
    struct fill_rates rates = {0}, growing = {0};
    for (uint32_t tiles = 512; tiles <= (options.quick ? 512u : 8192u); tiles *= 2) {
        struct bench staged = *bench;
        const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info,
                                                   .maxTilesInFlight = tiles};
        staged.min_staging_size = UINT64_MAX;
        staged.min_tile_memory_size = MEMORY_AHEAD;
        char name[64];
        snprintf(name, sizeof name, "fill.%u_in_flight", tiles);
        if (!fill_with(&staged, &info, name, &rates))
            return false;
    }
    const SluiceDemandLoaderCreateInfo defaults = {.structSize = sizeof defaults};
    if (!fill_with(bench, &defaults, "fill.defaults", &growing))
        return false;
    double copy;
    if (!measure_copy_floor(&bench->gpu, (uint32_t)rates.tiles, &copy))
        return false;
    figure("fill.tiles", NULL, rates.tiles, "tiles");
    figure("fill.rate", NULL, rates.cold, "tiles/s");
    figure("fill.again.rate", NULL, rates.again, "tiles/s");
    figure("fill.floor.copy", NULL, copy, "tiles/s");
    figure("fill.of_copy", NULL, rates.cold / copy, "of the copy alone");
    return true;
}
