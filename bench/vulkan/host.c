/* The library's host time per frame: 1 000 textures, with a walking or resting camera. */
#include "driver_calls.h"
#include "rig.h"

#include <math.h>
#include <stdalign.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

#define WARM_FRAMES 240u /* longer than the timeout, so that tiles are loaded and dropped */
#define FRAMES 400u
#define REHEARSALS 2u
#define TIMEOUT 60u        /* frames, one second */
#define STEP 0.025f        /* meters per frame: a walk of 1.5 m/s */
#define TURN_FRAMES 300.0f /* period of looking left, right and back */
#define TURN 0.3f          /* radians to each side */
#define DEFAULT_SHARE 10u

static void *count_allocation(void *user, size_t size, size_t alignment)
{
    atomic_fetch_add((atomic_uint *)user, 1);
    if (alignment <= alignof(max_align_t))
        return malloc(size); /* malloc is faster */
    return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

static void release(void *user, void *memory, size_t size)
{
    (void)user, (void)size;
    free(memory);
}

struct walk {
    struct rig rig;
    struct rig_wants wants;
    atomic_uint allocations;
    SluiceAllocationCallbacks allocator;
    double overhead; ///< ns that timing a driver call adds to the library's time
    uint32_t steps;
};

static void place_camera(struct walk *walk)
{
    float step = (float)walk->steps;
    walk->wants.params.camera[0] = 50.0f;
    walk->wants.params.camera[1] = -4.0f + STEP * step;
    walk->wants.params.cameraAngle = TURN * sinf(6.2831853f * step / TURN_FRAMES);
}

struct host_times {
    struct samples library, driver;
    double calls;
};

/* Waits for the device if it is the host's CPU. */
static bool walk_frame(struct walk *walk, bool moves, struct host_times *times)
{
    struct rig *rig = &walk->rig;
    struct rig_work work = {.record = rig_record_wants, .user = &walk->wants};
    walk->steps += moves;
    place_camera(walk);
    if (rig->bench->wall && !rig_settle(rig))
        return false;
    driver_calls_take();
    if (!rig_frame(rig, &work))
        return false;
    struct driver_calls calls = driver_calls_take();
    if (!times)
        return true;
    double own = rig->host_seconds * 1e9 - (double)calls.ns - walk->overhead * (double)calls.count;
    samples_add(&times->library, own);
    samples_add(&times->driver, (double)calls.ns);
    times->calls += (double)calls.count;
    return true;
}

/* Repeats the walk before measuring: the history of textures grows for some turns each, and a
 * camera that jumps back to the start has the end in view for a while. */
static bool rehearse(struct walk *walk, uint32_t frames)
{
    uint32_t steps = walk->steps;
    bool done = true;
    for (uint32_t i = 0; done && i < REHEARSALS * frames; i++) {
        walk->steps = i % frames ? walk->steps : steps;
        done = walk_frame(walk, true, NULL);
    }
    walk->steps = steps;
    return done;
}

static bool walk_frames(struct walk *walk, bool moves, const char *name)
{
    const struct bench *bench = walk->rig.bench;
    uint32_t warm = options.quick ? 20 : WARM_FRAMES, frames = repetitions(FRAMES);
    struct host_times times = {.calls = 0};
    samples_init(&times.library, frames);
    samples_init(&times.driver, frames);
    bool done = moves ? rehearse(walk, warm + frames) : true;
    for (uint32_t i = 0; done && i < warm; i++)
        done = walk_frame(walk, moves, NULL);
    uint32_t allocations = atomic_load(&walk->allocations);
    SluiceVulkanStreamerStatistics before = rig_statistics(&walk->rig);
    for (uint32_t i = 0; done && i < frames; i++)
        done = walk_frame(walk, moves, &times);
    SluiceVulkanStreamerStatistics after = rig_statistics(&walk->rig);
    allocations = atomic_load(&walk->allocations) - allocations;
    if (done) {
        const char *motion = moves ? "moving" : "still";
        report(bench, median(&times.library) / 1e3, "us", "%s.%s.library", name, motion);
        report(bench, samples_mean(&times.library) / 1e3, "us", "%s.%s.library_mean", name, motion);
        report(bench, samples_quantile(&times.library, 0.99) / 1e3, "us", "%s.%s.library_p99", name,
               motion);
        report(bench, median(&times.driver) / 1e3, "us", "%s.%s.driver", name, motion);
        report(bench, times.calls / frames, "calls", "%s.%s.driver_calls", name, motion);
        report(bench, (double)allocations / frames, "allocations", "%s.%s.allocations", name,
               motion);
        report(bench, (double)(after.tilesMapped - before.tilesMapped) / frames, "tiles",
               "%s.%s.mapped", name, motion);
        report(bench, (double)(after.feedbackMaps - before.feedbackMaps) / frames, "maps",
               "%s.%s.maps", name, motion);
        report(bench, (double)(after.feedbackWords - before.feedbackWords) / frames, "words",
               "%s.%s.changes", name, motion);
    }
    samples_finish(&times.library);
    samples_finish(&times.driver);
    return done;
}

static bool walk_create(struct walk *walk, const struct bench *bench, uint32_t share,
                        float probability)
{
    uint32_t count = options.quick ? 100 : 1000;
    *walk = (struct walk){.wants.params = {.kind = BENCH_WANTS_VIEW, .probability = probability},
                          .allocator = {&walk->allocations, count_allocation, release}};
    struct rig_info info = {
        .bench = bench,
        .context = {.pfnGetInstanceProcAddr = driver_calls_get, .pAllocator = &walk->allocator},
        .streamer = {.maxTextureCount = count,
                     .texturesPerFrame = share,
                     .feedbackTimeoutTicks = TIMEOUT},
        .format = SLUICE_FORMAT_BC7_UNORM_BLOCK,
        .texture_size = options.quick ? 1024 : 4096,
        .texture_count = count,
        .anisotropy = 1.0f};
    if (!rig_create(&walk->rig, &info) || !rig_load(&walk->rig, NULL))
        return false;
    walk->overhead = driver_calls_overhead();
    walk->wants.pipeline = rig_wants_pipeline(&walk->rig);
    return walk->wants.pipeline != VK_NULL_HANDLE;
}

static bool walk(const struct bench *bench, uint32_t share, float probability, const char *name)
{
    struct walk *w = malloc(sizeof *w);
    if (!w)
        return false;
    bool done = walk_create(w, bench, share, probability) && walk_frames(w, true, name) &&
                walk_frames(w, false, name);
    if (done)
        report(bench, (double)rig_statistics(&w->rig).mappedTileCount, "tiles", "%s.tiles_in_view",
               name);
    rig_destroy(&w->rig);
    free(w);
    return done;
}

bool measure_host(const struct bench *bench)
{
    if (bench->mode == SLUICE_RESIDENCY_MODE_DENSE && !options.quick) {
        fprintf(stderr, "host: dense images of that size and number are not tried\n");
        return true;
    }
    return walk(bench, 1000, 1.0f, "host") && walk(bench, DEFAULT_SHARE, 1.0f, "host_share_10") &&
           walk(bench, 1000, 1.0f / 16, "host_quads_16");
}
