/* Tiles per second from nothing, with a source that costs nothing. */
#include "rig.h"

#include "../../samples/common/clock.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#define MAX_LAUNCHES 100000u

/* As renderers do that never wait for reads: two launches are under way, until one misses nothing.
 */
static bool fill(struct rig *rig, double *seconds, uint32_t *launches)
{
    struct rig_outcome outcome;
    double start = clock_seconds();
    bool done = rig_begin(rig, DEMAND_BENCH_SAMPLED), all = false;
    for (*launches = 0; done && !all && *launches < MAX_LAUNCHES; (*launches)++) {
        done = rig_begin(rig, DEMAND_BENCH_SAMPLED) && rig_end(rig, &outcome);
        all = done && outcome.requests.missingCount == 0;
    }
    *seconds = clock_seconds() - start;
    return done && rig_end(rig, &outcome) && all;
}

static bool fill_once(const struct bench *bench, const SluiceDemandLoaderCreateInfo *info,
                      double *rate, SluiceDemandStatistics *statistics, uint32_t *launches)
{
    struct rig rig;
    double seconds;
    bool done =
        rig_create(&rig, bench, info, false) && rig_warm_up(&rig) &&
        check(sluiceGetDemandStatistics(rig.loader, statistics), "sluiceGetDemandStatistics");
    uint64_t before = done ? statistics->residentTileCount : 0;
    done = done && fill(&rig, &seconds, launches) &&
           check(sluiceGetDemandStatistics(rig.loader, statistics), "sluiceGetDemandStatistics");
    if (done)
        *rate = (double)(statistics->residentTileCount - before) / seconds;
    rig_destroy(&rig);
    return done;
}

bool measure_fill(const struct bench *bench)
{
    double best = 0;
    for (uint32_t tiles = 512; tiles <= (options.quick ? 512u : 8192u); tiles *= 4) {
        SluiceDemandLoaderCreateInfo info = {.maxTilesInFlight = tiles};
        SluiceDemandStatistics s;
        double rate = 0;
        uint32_t launches;
        for (uint32_t i = 0; i < (options.quick ? 1u : 3u); i++) {
            double once;
            if (!fill_once(bench, &info, &once, &s, &launches))
                return false;
            rate = fmax(rate, once);
        }
        char name[64];
        snprintf(name, sizeof name, "fill.%u_in_flight", tiles);
        figure(name, "rate", rate, "tiles/s");
        figure(name, "launches", launches, "launches");
        best = fmax(best, rate);
        if (tiles == 512)
            figure("fill.tiles", NULL, (double)s.residentTileCount, "tiles");
    }
    figure("fill.rate", NULL, best, "tiles/s");
    return true;
}
