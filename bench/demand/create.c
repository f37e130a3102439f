/* Measures textures that no shader samples: the time to create them, and device memory. */
#include "rig.h"

#include "../../tools/common/clock.h"

struct counted_image {
    uint32_t opened;
};

static SluiceResult count_open(void *user, SluiceImageSource **source)
{
    ((struct counted_image *)user)->opened++;
    *source = NULL;
    return SLUICE_ERROR_FILE_NOT_FOUND;
}

static bool create_many(struct rig *rig, uint32_t count, double *seconds, uint32_t *opened)
{
    struct counted_image image = {0};
    SluiceDemandTextureCreateInfo info = {.structSize = sizeof info,
                                          .image = {.pUserData = &image, .pfnOpen = count_open}};
    struct rig_outcome outcome;
    double start = clock_seconds();
    for (uint32_t i = 0; i < count; i++) {
        SluiceDemandTextureId id;
        if (!check(sluiceAddDemandTexture(rig->loader, &info, &id), "sluiceAddDemandTexture"))
            return false;
    }
    if (!rig_launch(rig, DEMAND_BENCH_NOTHING, &outcome)) /* the table reaches the device */
        return false;
    *seconds = clock_seconds() - start;
    *opened = image.opened;
    return true;
}

bool measure_create(const struct bench *bench)
{
    uint32_t count = options.quick ? 10000 : 100000;
    double seconds = 0;
    uint32_t opened = 0;
    struct bench small = *bench;
    small.edge = 8;
    struct rig rig;
    SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info,
                                         .pageCapacity = UINT64_C(1) << 26,
                                         .memoryBudget = UINT64_C(1) << 28};
    bool done =
        rig_create(&rig, &small, &info, false) && create_many(&rig, count, &seconds, &opened);
    if (done) {
        SluiceDemandStatistics s = {.structSize = sizeof s};
        done = check(sluiceGetDemandStatistics(rig.loader, &s), "sluiceGetDemandStatistics");
        figure("create.seconds", NULL, seconds, "s");
        figure("create.textures", NULL, count, "textures");
        figure("create.opened", NULL, opened, "textures");
        figure("create.page_memory", NULL,
               (double)(s.deviceMemorySize - s.tileMemorySize) / 1048576.0, "MiB");
    }
    rig_destroy(&rig);
    return done;
}
