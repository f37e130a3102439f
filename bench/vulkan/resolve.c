/* Time to resolve all feedback maps of 1 000 textures in one frame, and to read them back. */
#include "rig.h"

#include <stdio.h>

#define FRAMES 101u
/* A packed level, so that no tile is requested and nothing is loaded meanwhile. */
#define PACKED_LEVEL 6u

struct pattern {
    const char *name;
    bool alternates;   ///< true: every region changes in every frame
    float probability; ///< probability of one level more, drawn in every frame
};

static bool run_pattern(struct rig *rig, VkPipeline pipeline, const struct pattern *pattern)
{
    const struct bench *bench = rig->bench;
    struct rig_wants wants = {.pipeline = pipeline,
                              .params = {.kind = BENCH_WANTS_RANDOM,
                                         .level = PACKED_LEVEL,
                                         .probability = pattern->probability}};
    uint32_t frames = repetitions(FRAMES), warm = 2 * RIG_FRAMES;
    struct samples gpu, host;
    samples_init(&gpu, frames);
    samples_init(&host, frames);
    struct rig_work work = {.record = rig_record_wants, .user = &wants};
    uint64_t words = 0;
    bool done = true;
    for (uint32_t i = 0; done && i < warm + frames; i++) {
        wants.params.level = PACKED_LEVEL + (pattern->alternates ? i & 1 : 0);
        if (i == warm)
            words = rig_statistics(rig).feedbackWords;
        work.samples.end = i < warm ? NULL : &gpu;
        done = rig_frame(rig, &work);
        if (done && i >= warm)
            samples_add(&host, rig->host_seconds * 1e9);
    }
    done = done && rig_finish(rig);
    if (done) {
        words = rig_statistics(rig).feedbackWords - words;
        report(bench, typical(bench, &gpu) / 1e3, "us", "resolve.%s.gpu", pattern->name);
        report(bench, samples_quantile(&gpu, 0.99) / 1e3, "us", "resolve.%s.gpu_p99",
               pattern->name);
        report(bench, (double)words * 4 / frames / 1024, "KiB", "resolve.%s.readback",
               pattern->name);
        report(bench, median(&host) / 1e3, "us", "resolve.%s.host", pattern->name);
    }
    samples_finish(&gpu);
    samples_finish(&host);
    return done;
}

static bool run_patterns(struct rig *rig)
{
    static const struct pattern patterns[] = {
        {"still", false, 0.0f}, {"moving", false, 0.05f}, {"all_changed", true, 0.0f}};
    VkPipeline pipeline = rig_wants_pipeline(rig);
    for (uint32_t i = 0; pipeline && i < 3; i++)
        if (!run_pattern(rig, pipeline, &patterns[i]))
            return false;
    return pipeline != VK_NULL_HANDLE;
}

/* Loads all packed levels, so that only feedback is pending. */
static bool load_packed(struct rig *rig)
{
    return rig_load(rig, NULL);
}

bool measure_resolve(const struct bench *bench)
{
    uint32_t size = options.quick ? 1024 : 4096, count = options.quick ? 100 : 1000;
    if (bench->mode == SLUICE_RESIDENCY_MODE_DENSE && !options.quick) {
        fprintf(stderr, "resolve: dense images of that size and number are not tried\n");
        return true;
    }
    struct rig_info info = {.bench = bench,
                            .streamer = {.maxTextureCount = count,
                                         .texturesPerFrame = count,
                                         .feedbackTimeoutTicks = UINT64_MAX / 4},
                            .format = SLUICE_FORMAT_BC7_UNORM_BLOCK,
                            .texture_size = size,
                            .texture_count = count,
                            .anisotropy = 1.0f};
    struct rig rig;
    bool done = rig_create(&rig, &info) && load_packed(&rig) && run_patterns(&rig);
    if (done) {
        report(bench, count, "textures", "resolve.textures");
        report(bench, rig.map_width * rig.map_height, "regions", "resolve.regions_each");
    }
    rig_destroy(&rig);
    return done;
}
