/* Cold fill, and a working set larger than the memory for it. */
#include "fill.h"

#include "floors.h"

#include "../../tools/common/clock.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define TILE_BYTES 65536.0
#define TIME_LIMIT 120.0 /* seconds */
#define LEVEL 2u         /* wanted everywhere; one finer in a patch */
#define WARM_FRAMES 100u
#define MEASURED_FRAMES 100u
#define MEMORY_AHEAD (UINT64_C(512) << 20) /* bytes; 434 MB of tiles are wanted */

/* 437 MB are wanted, for which there are 256 MB. */
#define BUDGET_HEAPS 16u
#define BUDGET_SHARE (256.0 / 437.0)

struct fill {
    struct rig rig;
    struct rig_wants wants;
    uint64_t tile_count; ///< wanted: regular and packed ones
};

struct rig_info fill_info(const struct bench *bench, uint32_t tiles_per_frame)
{
    uint32_t size = options.quick ? 4096 : 8192, count = options.quick ? 4 : 16;
    return (struct rig_info){
        .bench = bench,
        .context = {.minStagingSize = UINT64_MAX, .minTileMemorySize = MEMORY_AHEAD},
        .streamer = {.maxTextureCount = count,
                     .texturesPerFrame = count,
                     .tilesPerFrame = tiles_per_frame,
                     .feedbackTimeoutTicks = UINT64_MAX / 4},
        .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
        .texture_size = size,
        .texture_count = count,
        .output_words = BENCH_COUNT_WORDS,
        .anisotropy = 1.0f};
}

/* Tiles of one texture: of LEVEL and coarser, packed ones, and of LEVEL - 1 in the patch. */
static uint64_t wanted_tiles(const SluiceStreamedTextureLayout *layout, const uint32_t patch[2])
{
    uint64_t count = layout->desc.packedTileCount + (uint64_t)(patch[0] / 2) * (patch[1] / 2);
    for (uint32_t i = LEVEL; i < layout->desc.regularMipCount; i++)
        count += (uint64_t)layout->levelWidthInTiles[i] * layout->levelHeightInTiles[i];
    return count;
}

static bool fill_create(struct fill *fill, const struct rig_info *info)
{
    *fill = (struct fill){.wants.params = {.kind = BENCH_WANTS_PATCH, .level = LEVEL}};
    if (!rig_create(&fill->rig, info))
        return false;
    struct rig *rig = &fill->rig;
    uint32_t *patch = fill->wants.params.patchSize;
    patch[0] = rig->map_width / 4;
    patch[1] = rig->map_height * 9 / 32 / 2 * 2; /* in whole tiles of LEVEL - 1 */
    fill->wants.pipeline = rig_wants_pipeline(rig);
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    if (!fill->wants.pipeline ||
        !check(sluiceGetTextureLayout(rig->manager, rig->textures[0].textureId, &layout),
               "sluiceGetTextureLayout"))
        return false;
    fill->tile_count = wanted_tiles(&layout, patch) * rig->texture_count;
    return true;
}

static bool fill_run(struct fill *fill, struct fill_times *times)
{
    struct rig *rig = &fill->rig;
    struct samples gpu;
    samples_init(&gpu, 65536);
    struct rig_work work = {.record = rig_record_wants, .user = &fill->wants};
    if (!rig->bench->wall)
        work.samples.begin = &gpu;
    *times = (struct fill_times){0};
    double start = clock_seconds();
    bool done = true, all = false;
    while (done && !all && clock_seconds() - start < TIME_LIMIT && gpu.count + 8 < gpu.room) {
        done = rig_frame(rig, &work);
        times->host_seconds += rig->host_seconds;
        times->host_cpu_seconds += rig->host_cpu_seconds;
        all = rig_statistics(rig).tilesMapped >= fill->tile_count;
    }
    done = done && rig_finish(rig);
    times->seconds = clock_seconds() - start;
    SluiceVulkanStreamerStatistics s = rig_statistics(rig);
    times->frames = rig->frame;
    times->binds = s.bindRuns;
    times->gpu_seconds = gpu.count ? samples_mean(&gpu) * 1e-9 * gpu.count : NAN;
    samples_finish(&gpu);
    if (done && s.tilesMapped != fill->tile_count) {
        fprintf(stderr, "%" PRIu64 " of %" PRIu64 " tiles were mapped\n", s.tilesMapped,
                fill->tile_count);
        return false;
    }
    return done;
}

/* Returns the part that is busy most of the time. If neither is, reads and bindings between them
 * take the time. */
static const char *bound_of(const struct fill_times *times)
{
    if (times->gpu_seconds > 0.7 * times->seconds)
        return "bound by copies on the device";
    if (times->host_seconds > 0.7 * times->seconds)
        return "bound by begin and end on the host";
    return isnan(times->gpu_seconds) ? "without time stamps it is not known what bounds it"
                                     : "bound by reads, bindings and frames in flight";
}

bool fill_best(const struct rig_info *info, struct fill_times *times, uint64_t *tile_count)
{
    bool done = true;
    *times = (struct fill_times){.seconds = INFINITY};
    for (uint32_t i = 0; done && i < (options.quick ? 1u : 3u); i++) {
        struct fill fill;
        struct fill_times run;
        done = fill_create(&fill, info) && fill_run(&fill, &run);
        if (done && run.seconds < times->seconds)
            *times = run;
        *tile_count = fill.tile_count;
        rig_destroy(&fill.rig);
    }
    return done;
}

/* Defaults: memory for staging and tiles grows with the loads. */
static bool fill_growing(const struct bench *bench)
{
    struct rig_info info = fill_info(bench, 256);
    info.context = (SluiceVulkanContextCreateInfo){0};
    struct fill_times times;
    uint64_t tile_count;
    if (!fill_best(&info, &times, &tile_count))
        return false;
    report(bench, (double)tile_count / times.seconds, "tiles/s", "fill.growing.rate");
    return true;
}

static bool fill_with(const struct bench *bench, uint32_t tiles_per_frame, double *best,
                      uint64_t *tile_count)
{
    struct rig_info info = fill_info(bench, tiles_per_frame);
    struct fill_times times;
    if (!fill_best(&info, &times, tile_count))
        return false;
    double rate = (double)*tile_count / times.seconds;
    *best = rate > *best ? rate : *best;
    fprintf(stderr, "%s: %u tiles per frame: %s\n", bench->mode_name, tiles_per_frame,
            bound_of(&times));
    report(bench, rate, "tiles/s", "fill.%u_per_frame.rate", tiles_per_frame);
    report(bench, (double)times.frames, "frames", "fill.%u_per_frame.frames", tiles_per_frame);
    report(bench, 100 * times.host_seconds / times.seconds, "% of the time",
           "fill.%u_per_frame.host", tiles_per_frame);
    report(bench, 1e6 * times.host_cpu_seconds / (double)*tile_count, "us per tile",
           "fill.%u_per_frame.host_cpu", tiles_per_frame);
    if (!bench->wall)
        report(bench, 100 * times.gpu_seconds / times.seconds, "% of the time",
               "fill.%u_per_frame.gpu_copies", tiles_per_frame);
    if (bench->mode == SLUICE_RESIDENCY_MODE_SPARSE)
        report(bench, (double)*tile_count / (double)times.binds, "tiles",
               "fill.%u_per_frame.bind_run", tiles_per_frame);
    return true;
}

bool measure_fill(const struct bench *bench)
{
    double best = 0;
    uint64_t tile_count = 0;
    for (uint32_t tiles = 256; tiles <= (options.quick ? 256u : 4096u); tiles *= 4)
        if (!fill_with(bench, tiles, &best, &tile_count))
            return false;
    if (!fill_growing(bench))
        return false;
    report(bench, (double)tile_count, "tiles", "fill.tiles");
    report(bench, best, "tiles/s", "fill.rate");
    struct floors floors;
    if (!measure_floors(bench, (uint32_t)tile_count, &floors))
        return false;
    report(bench, floors.copy, "tiles/s", "fill.floor.copy");
    report(bench, best / floors.copy, "of the copy alone", "fill.of_copy");
    if (bench->mode == SLUICE_RESIDENCY_MODE_SPARSE) {
        report(bench, floors.bind, "tiles/s", "fill.floor.bind");
        report(bench, floors.bind_runs, "tiles/s", "fill.floor.bind_runs_of_16");
    }
    return true;
}

static void count_after_wants(struct rig *rig, VkCommandBuffer commands, void *user)
{
    struct rig_wants count = *(struct rig_wants *)user;
    rig_record_wants(rig, commands, user);
    count.params.kind = BENCH_WANTS_COUNT;
    rig_record_wants(rig, commands, &count);
}

static bool run_frames(struct fill *fill, rig_record *record, uint32_t count, uint64_t *most)
{
    struct rig_work work = {.record = record, .user = &fill->wants};
    *most = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint64_t before = rig_statistics(&fill->rig).bytesUploaded;
        if (!rig_frame(&fill->rig, &work))
            return false;
        uint64_t uploaded = rig_statistics(&fill->rig).bytesUploaded - before;
        *most = uploaded > *most ? uploaded : *most;
    }
    return rig_finish(&fill->rig);
}

static bool run_budget(struct fill *fill, uint32_t cache_tiles)
{
    struct rig *rig = &fill->rig;
    const struct bench *bench = rig->bench;
    uint64_t most;
    if (!run_frames(fill, rig_record_wants, WARM_FRAMES, &most))
        return false;
    memset(rig->outputs.mapped, 0, BENCH_COUNT_WORDS * 4);
    uint64_t before = rig_statistics(rig).bytesUploaded;
    if (!run_frames(fill, count_after_wants, MEASURED_FRAMES, &most))
        return false;
    double uploaded = (double)(rig_statistics(rig).bytesUploaded - before) / MEASURED_FRAMES;
    double cache = cache_tiles * TILE_BYTES;
    const uint32_t *counts = rig->outputs.mapped;
    double samples = counts[BENCH_COUNT_SAMPLES];
    report(bench, (double)fill->tile_count * TILE_BYTES / 1e6, "MB", "budget.wanted");
    report(bench, cache / 1e6, "MB", "budget.cache");
    report(bench, samples, "samples", "budget.samples");
    report(bench, counts[BENCH_COUNT_NOTHING], "samples", "budget.missing");
    report(bench, 100.0 * counts[BENCH_COUNT_COARSER] / samples, "% of samples", "budget.coarser");
    report(bench, counts[BENCH_COUNT_LEVELS] / samples, "levels", "budget.levels_too_coarse");
    report(bench, 100 * uploaded / cache, "% of cache", "budget.uploads_per_frame");
    report(bench, 100 * (double)most / cache, "% of cache", "budget.uploads_worst_frame");
    return true;
}

bool measure_budget(const struct bench *bench)
{
    struct rig_info info = fill_info(bench, 256);
    info.context.minTileMemorySize = 0;
    struct fill fill;
    bool done = fill_create(&fill, &info);
    double wanted = (double)fill.tile_count;
    rig_destroy(&fill.rig);
    if (!done)
        return false;
    info.streamer.heapTileCapacity = (uint32_t)ceil(wanted * BUDGET_SHARE / BUDGET_HEAPS);
    info.streamer.maxHeapCount = BUDGET_HEAPS;
    done = fill_create(&fill, &info) &&
           run_budget(&fill, BUDGET_HEAPS * info.streamer.heapTileCapacity);
    rig_destroy(&fill.rig);
    return done;
}
