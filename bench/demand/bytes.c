/* Cold fill with byte pages of 64 KiB, in turns with tiles of the same size. */
#include "rig.h"

#include "../../tools/common/clock.h"

#include <math.h>
#include <stdio.h>

#define MAX_LAUNCHES 100000u
#define PAGE_SIZE 65536u

/* Writes nothing, like the source of the tiles. */
static SluiceResult read_page(void *pUserData, uint32_t page, uint32_t size, void *pBytes)
{
    (void)pUserData, (void)page, (void)size, (void)pBytes;
    return SLUICE_SUCCESS;
}

/* Returns the seconds until a launch misses nothing, with two launches under way; -1 on failure. */
static double fill(struct rig *rig, uint32_t kind)
{
    struct rig_outcome outcome;
    double start = clock_seconds();
    bool done = rig_begin(rig, kind), all = false;
    for (uint32_t i = 0; done && !all && i < MAX_LAUNCHES; i++) {
        done = rig_begin(rig, kind) && rig_end(rig, &outcome);
        all = done && outcome.requests.missingCount == 0;
    }
    double seconds = clock_seconds() - start;
    return done && rig_end(rig, &outcome) && all ? seconds : -1;
}

/* Returns the pages per second of a new loader; 0 on failure. */
static double fill_pages(const struct bench *bench, uint32_t pages, uint32_t kind)
{
    struct rig rig;
    const SluiceDemandLoaderCreateInfo info = {
        .structSize = sizeof info, .byteMemoryBudget = (uint64_t)(pages + 32) * PAGE_SIZE};
    const SluiceDemandResourceCreateInfo resource = {.structSize = sizeof resource,
                                                     .pageCount = pages,
                                                     .pageSize = PAGE_SIZE,
                                                     .pfnRead = read_page};
    SluiceDemandResourceId id;
    SluiceDemandStatistics s = {.structSize = sizeof s};
    bool done = rig_create(&rig, bench, &info, false) && rig_warm_up(&rig);
    if (done && kind == DEMAND_BENCH_BYTES)
        done = check(sluiceAddDemandResource(rig.loader, &resource, &id, &rig.params.firstPage),
                     "sluiceAddDemandResource");
    rig.params.pageCount = pages;
    double seconds = done ? fill(&rig, kind) : -1;
    done = seconds > 0 &&
           check(sluiceGetDemandStatistics(rig.loader, &s), "sluiceGetDemandStatistics");
    double loaded = kind == DEMAND_BENCH_BYTES ? (double)s.residentBytePageCount
                                               : (double)(s.residentTileCount - s.texturesOpened);
    rig_destroy(&rig);
    return done ? loaded / seconds : 0;
}

bool measure_bytes(const struct bench *bench)
{
    uint32_t pages = options.quick ? 256 : bench->wall ? 1024 : 4096;
    double bytes = 0, tiles = 0;
    for (uint32_t i = 0; i < (options.quick ? 1u : 3u); i++) { /* the best of each counts */
        double rates[2] = {fill_pages(bench, pages, DEMAND_BENCH_BYTES),
                           fill_pages(bench, pages, DEMAND_BENCH_SAMPLED)};
        if (!(rates[0] > 0) || !(rates[1] > 0))
            return false;
        bytes = fmax(bytes, rates[0]);
        tiles = fmax(tiles, rates[1]);
    }
    figure("bytes.rate", NULL, bytes, "pages/s");
    figure("bytes.tiles.rate", NULL, tiles, "tiles/s");
    figure("bytes.of_tiles", NULL, bytes / tiles, "of tiles");
    return true;
}
