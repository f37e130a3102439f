/* A working set larger than the memory for it: 437 MB for which there are 256. */
#include "rig.h"

#define SHARE (256.0 / 437.0)
#define MAX_LAUNCHES 200u
#define LATER 100u

static bool working_set(const struct bench *bench, uint64_t *size)
{
    struct rig rig;
    SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info};
    SluiceDemandStatistics s = {.structSize = sizeof s};
    bool done = rig_create(&rig, bench, &info, false) && rig_load(&rig, 1000) > 0 &&
                check(sluiceGetDemandStatistics(rig.loader, &s), "sluiceGetDemandStatistics");
    *size = done ? s.residentTileCount * 65536 : 0;
    rig_destroy(&rig);
    return done;
}

static bool later(struct rig *rig, uint64_t *uploaded)
{
    SluiceDemandStatistics before = {.structSize = sizeof before},
                           after = {.structSize = sizeof after};
    struct rig_outcome outcome;
    if (!check(sluiceGetDemandStatistics(rig->loader, &before), "sluiceGetDemandStatistics"))
        return false;
    for (uint32_t i = 0; i < repetitions(LATER); i++)
        if (!rig_launch(rig, DEMAND_BENCH_SAMPLED, &outcome) ||
            !check(sluiceWaitDemandTicket(rig->loader, outcome.ticket, UINT64_MAX, NULL),
                   "sluiceWaitDemandTicket"))
            return false;
    if (!check(sluiceGetDemandStatistics(rig->loader, &after), "sluiceGetDemandStatistics"))
        return false;
    *uploaded = after.bytesUploaded - before.bytesUploaded;
    return true;
}

bool measure_budget(const struct bench *bench)
{
    uint64_t wanted, uploaded = 0;
    if (!working_set(bench, &wanted))
        return false;
    struct rig rig;
    SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info,
                                         .memoryBudget = (uint64_t)((double)wanted * SHARE)};
    struct rig_outcome outcome = {0};
    SluiceDemandStatistics s = {.structSize = sizeof s};
    bool done = rig_create(&rig, bench, &info, false);
    uint32_t launches = done ? rig_load(&rig, MAX_LAUNCHES) : 0;
    rig.params.counting = 1;
    done = done && rig_launch(&rig, DEMAND_BENCH_SAMPLED, &outcome) && later(&rig, &uploaded) &&
           check(sluiceGetDemandStatistics(rig.loader, &s), "sluiceGetDemandStatistics");
    if (done) {
        figure("budget.wanted", NULL, (double)wanted * 1e-6, "MB");
        figure("budget.memory", NULL, (double)info.memoryBudget * 1e-6, "MB");
        figure("budget.used", NULL, (double)s.tileMemorySize * 1e-6, "MB");
        figure("budget.launches", NULL, launches ? launches : MAX_LAUNCHES + 1.0, "launches");
        figure("budget.missing", NULL, outcome.missing, "samples");
        figure("budget.uploads_later", NULL, (double)uploaded * 1e-6, "MB");
        figure("budget.lod_bias", NULL, s.lodBias, "levels");
    }
    rig_destroy(&rig);
    return done;
}
