/* Measures the memory of textures that no shader samples, and how many frames a texture shows its
 * fallback color at first sight: with packed levels always resident, and on demand. */
#include "rig.h"

#include <stdio.h>

#define SIGHTS 8u
#define MAX_FRAMES 1000u

static const char *const names[2] = {"always", "on_demand"};

static struct rig_info unseen_info(const struct bench *bench, uint32_t count, bool on_demand)
{
    return (struct rig_info){.bench = bench,
                             .streamer = {.maxTextureCount = count,
                                          .maxRegionCount = 1u << 20,
                                          .feedbackTimeoutTicks = UINT64_MAX / 4,
                                          .packedLevelsOnDemand = on_demand},
                             .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                             .texture_size = 4096,
                             .texture_count = count,
                             .anisotropy = 1.0f};
}

static bool measure_memory(const struct bench *bench, bool on_demand)
{
    /* Dense images have all their memory: four, of 89 MB each. */
    bool dense = bench->mode == SLUICE_RESIDENCY_MODE_DENSE;
    uint32_t count = dense ? 4 : options.quick ? 20 : 1000;
    struct rig_info info = unseen_info(bench, count, on_demand);
    struct rig rig;
    bool done = rig_create(&rig, &info) && rig_load(&rig, NULL);
    if (done) {
        SluiceVulkanStreamerStatistics s = rig_statistics(&rig);
        const char *name = names[on_demand];
        report(bench, (double)s.tileMemorySize * 1e-6, "MB", "unseen.%s.tile_memory", name);
        report(bench, (double)s.deviceMemorySize * 1e-6, "MB", "unseen.%s.device_memory", name);
        report(bench, (double)s.hostVisibleMemorySize * 1e-6, "MB", "unseen.%s.host_visible", name);
        report(bench, (double)s.bytesRead * 1e-6, "MB", "unseen.%s.read", name);
    }
    rig_destroy(&rig);
    return done;
}

/* Frames, one after the other, from the first that samples a texture to the one that shows it. */
static bool first_sight(const struct bench *bench, bool on_demand, uint32_t *frames)
{
    struct rig_info info = unseen_info(bench, 1, on_demand);
    struct rig rig;
    bool done = rig_create(&rig, &info) && rig_load(&rig, NULL);
    struct rig_wants wants = {.params = {.kind = BENCH_WANTS_PATCH, .level = 6}};
    if (done)
        wants.pipeline = rig_wants_pipeline(&rig);
    done = done && wants.pipeline;
    struct rig_work work = {.record = rig_record_wants, .user = &wants};
    *frames = 0;
    while (done && rig_statistics(&rig).mappedTileCount == 0 && *frames < MAX_FRAMES) {
        done = rig_frame(&rig, &work) && rig_finish(&rig);
        ++*frames;
    }
    rig_destroy(&rig);
    return done;
}

bool measure_unseen(const struct bench *bench)
{
    for (int on_demand = 0; on_demand < 2; on_demand++) {
        if (!measure_memory(bench, on_demand))
            return false;
        uint32_t most = 0;
        for (uint32_t i = 0; i < SIGHTS; i++) {
            uint32_t frames;
            if (!first_sight(bench, on_demand, &frames))
                return false;
            most = frames > most ? frames : most;
        }
        report(bench, most, "frames", "unseen.%s.first_sight", names[on_demand]);
    }
    return true;
}
