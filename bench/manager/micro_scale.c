/** Costs of many textures, many tiles and many heaps. */
#include "micro.h"

#include "figures.h"
#include "rig.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const SluiceStreamedTextureManagerConfig no_standby = {.structSize = sizeof no_standby};

/** Makes the calls of a frame in which nothing happens. */
static void idle_frame(struct rig *rig, SluiceMinMipRect *rects, uint64_t frame)
{
    uint32_t canceled = rig->room, unmapped = rig->room, mapped = rig->room, changed = rig->room;
    must(sluiceCompleteRetireValue(rig->manager, frame), "complete");
    must(sluiceGetTilesToCancel(rig->manager, SLUICE_ALL_TEXTURES, &canceled, rig->tiles),
         "cancel");
    must(sluiceGetTilesToUnmap(rig->manager, SLUICE_ALL_TEXTURES, frame + 3, &unmapped, rig->tiles),
         "unmap");
    must(sluiceGetTilesToMap(rig->manager, SLUICE_ALL_TEXTURES, &mapped, rig->tiles), "map");
    must(sluiceGetMinMipUpdates(rig->manager, &changed, rects), "MinMip");
    if (canceled + unmapped + mapped + changed > 0) {
        fprintf(stderr, "an idle frame listed something\n");
        exit(1);
    }
}

void bench_idle(void)
{
    enum { TEXTURES = 100000, BATCH = 64, ROOM = 4096 };
    struct rig rig;
    struct samples samples;
    rig_init(&rig, 1024, &no_standby, ROOM);
    SluiceMinMipRect *rects = must_allocate(ROOM * sizeof *rects);
    SluiceStreamedTextureDesc desc = square_desc(4096, 256);
    for (uint32_t i = 0; i < TEXTURES; i++)
        rig_add(&rig, &desc);
    rig_drain(&rig);
    uint32_t changed;
    do {
        changed = ROOM;
        must(sluiceGetMinMipUpdates(rig.manager, &changed, rects), "MinMip");
    } while (changed > 0);
    samples_init(&samples, repetitions(1000));
    for (uint64_t i = 0, frame = 1; i < samples.room; i++) {
        uint64_t start = now_ns();
        for (uint32_t k = 0; k < BATCH; k++)
            idle_frame(&rig, rects, frame++);
        samples_add(&samples, (double)(now_ns() - start) / BATCH);
    }
    figure_times("idle.100000_textures", &samples);
    samples_finish(&samples);
    free(rects);
    rig_finish(&rig);
}

/**
 * Stalls of the machine vary between runs, so shows the run whose worst call is fastest.
 */
void bench_add(void)
{
    enum { TEXTURES = 100000 };
    SluiceStreamedTextureDesc desc = square_desc(4096, 256);
    double median = 0, mean = 0, worst = 0;
    for (uint32_t run = 0; run < (options.quick ? 2 : 5); run++) {
        struct rig rig;
        struct samples samples;
        rig_init(&rig, 1024, &no_standby, 1);
        samples_init(&samples, TEXTURES);
        for (uint32_t i = 0; i < TEXTURES; i++) {
            uint64_t start = now_ns();
            rig_add(&rig, &desc);
            samples_add(&samples, (double)(now_ns() - start));
        }
        double most = samples_quantile(&samples, 1);
        if (run == 0 || most < worst) {
            worst = most;
            median = samples_quantile(&samples, 0.5);
            mean = samples_mean(&samples);
        }
        samples_finish(&samples);
        rig_finish(&rig);
    }
    figure("add", "median", median / 1e3, "us");
    figure("add", "mean", mean / 1e3, "us");
    figure("add", "worst", worst / 1e3, "us");
}
