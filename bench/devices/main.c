/* Cold fill of several devices with one read pool, against contexts that each read for themselves.
 */
#define _POSIX_C_SOURCE 200809L
#include "filler.h"
#include "stores.h"

#include "../../tools/common/clock.h"
#include "../../tools/common/shared_options.h"
#include "../manager/figures.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define RUNS 3

struct arguments {
    struct device_list devices;
    int residency;
    uint32_t textures, texture_size, threads;
    uint64_t cache;
    const char *store;
    bool json, quick, list, validation;
};

struct bench {
    const struct arguments *arguments;
    struct gpu gpus[DEVICE_LIST_MOST];
    uint32_t gpu_count;
    SluiceImageSource **sources;
    uint32_t source_count;
};

struct outcome {
    double seconds, cpu_seconds; ///< wall time; processor time of all threads
    uint64_t tile_count;         ///< resident on all devices together
    uint64_t bytes_read;         ///< delivered to all devices
    SluiceReadPoolStatistics pool;
};

static bool check(SluiceResult result, const char *what)
{
    if (result >= 0)
        return true;
    fprintf(stderr, "%s: %s\n", what, sluiceGetResultName(result));
    return false;
}

/* 0, 1 or 77. The first device is replaced if the list names others. */
static int create_devices(struct bench *bench)
{
    const struct arguments *a = bench->arguments;
    static const SluiceResidencyMode modes[] = {
        SLUICE_RESIDENCY_MODE_AUTO, SLUICE_RESIDENCY_MODE_SPARSE, SLUICE_RESIDENCY_MODE_PAGED,
        SLUICE_RESIDENCY_MODE_DENSE};
    struct gpu_request request = {.validation = a->validation,
                                  .modes = {modes[a->residency], SLUICE_RESIDENCY_MODE_DENSE}};
    uint32_t indices[DEVICE_LIST_MOST];
    bool unsupported = false;
    if (!gpu_create(&request, &bench->gpus[0], &unsupported))
        return unsupported ? 77 : 1;
    uint32_t wanted = gpu_list_alike(&bench->gpus[0], &a->devices, indices);
    gpu_destroy(&bench->gpus[0]);
    for (; bench->gpu_count < wanted; bench->gpu_count++) {
        struct gpu *gpu = &bench->gpus[bench->gpu_count];
        char name[16];
        snprintf(name, sizeof name, "%u", indices[bench->gpu_count]);
        request.device = name;
        if (!gpu_create(&request, gpu, &unsupported))
            return unsupported ? 77 : 1;
        gpu_choose_mode(gpu, bench->source_count);
        fprintf(stderr, "device %s: %s, %s\n", name, gpu->capabilities.deviceName,
                gpu->capabilities.driverInfo);
    }
    return wanted > 0 ? 0 : 1;
}

static double process_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static bool fill(const struct bench *bench, uint32_t count, SluiceReadPool *pool,
                 struct outcome *outcome)
{
    struct filler fillers[DEVICE_LIST_MOST] = {0};
    bool done = true;
    *outcome = (struct outcome){.pool.structSize = sizeof outcome->pool};
    for (uint32_t i = 0; i < count && done; i++) {
        const struct filler_info info = {.gpu = (struct gpu *)&bench->gpus[i],
                                         .pool = pool,
                                         .threads = bench->arguments->threads,
                                         .sources = bench->sources,
                                         .source_count = bench->source_count};
        done = filler_create(&fillers[i], &info);
    }
    double start = clock_seconds(), cpu = process_seconds();
    for (uint32_t i = 0; i < count && done; i++)
        done = filler_start(&fillers[i]);
    for (uint32_t i = 0; i < count; i++) {
        SluiceVulkanStreamerStatistics now = {.structSize = sizeof now};
        if (!filler_wait(&fillers[i])) {
            done = false;
            continue;
        }
        done = done && check(sluiceGetVulkanStreamerStatistics(fillers[i].streamer, &now),
                             "sluiceGetVulkanStreamerStatistics");
        double seconds = fillers[i].end - start;
        outcome->seconds = seconds > outcome->seconds ? seconds : outcome->seconds;
        outcome->tile_count += fillers[i].tile_count;
        outcome->bytes_read += now.bytesRead;
    }
    outcome->cpu_seconds = process_seconds() - cpu;
    if (pool)
        done = done && check(sluiceGetReadPoolStatistics(pool, &outcome->pool),
                             "sluiceGetReadPoolStatistics");
    for (uint32_t i = 0; i < count; i++)
        filler_destroy(&fillers[i]);
    return done;
}

static bool fill_pooled(const struct bench *bench, struct outcome *outcome)
{
    const SluiceReadPoolCreateInfo create = {.structSize = sizeof create,
                                             .threadCount = bench->arguments->threads,
                                             .cacheSize = bench->arguments->cache};
    SluiceReadPool *pool;
    if (!check(sluiceCreateReadPool(&create, &pool), "sluiceCreateReadPool"))
        return false;
    bool done = fill(bench, bench->gpu_count, pool, outcome);
    sluiceDestroyReadPool(pool);
    return done;
}

enum { ALONE, OWN, POOL, VARIANTS };

/* The variants take turns; the fastest run of each counts. */
static bool measure(const struct bench *bench, struct outcome best[VARIANTS])
{
    for (int run = 0; run < (options.quick ? 1 : RUNS); run++)
        for (int variant = 0; variant < VARIANTS; variant++) {
            struct outcome now;
            bool done = variant == POOL
                            ? fill_pooled(bench, &now)
                            : fill(bench, variant == ALONE ? 1 : bench->gpu_count, NULL, &now);
            if (!done)
                return false;
            if (run == 0 || now.seconds < best[variant].seconds)
                best[variant] = now;
        }
    return true;
}

static void print(const struct bench *bench, const struct outcome best[VARIANTS])
{
    static const char *const names[VARIANTS] = {"alone", "own", "pool"};
    double rates[VARIANTS];
    figure("devices", NULL, bench->gpu_count, "devices");
    figure("tiles_per_device", NULL, (double)best[ALONE].tile_count, "tiles");
    for (int i = 0; i < VARIANTS; i++) {
        rates[i] = (double)best[i].tile_count / best[i].seconds;
        figure(names[i], "seconds", best[i].seconds, "s");
        figure(names[i], "rate", rates[i], "tiles/s");
        figure(names[i], "cpu", 1e6 * best[i].cpu_seconds / (double)best[i].tile_count,
               "us per tile");
    }
    const SluiceReadPoolStatistics *pool = &best[POOL].pool;
    figure("own", "read", (double)best[OWN].bytes_read / 1e6, "MB");
    figure("pool", "read", (double)pool->readSize / 1e6, "MB");
    figure("pool", "joined", (double)pool->joinedCount, "regions");
    figure("pool", "cached", (double)pool->cachedCount, "regions");
    figure("pool", "kept_peak", (double)pool->keptPeakSize / 1e6, "MB");
    figure("pool", "gain", rates[POOL] / rates[OWN], "times own");
}

static int run(const struct arguments *a, const char *store)
{
    struct bench bench = {.arguments = a, .source_count = a->textures};
    struct outcome best[VARIANTS];
    bench.sources = stores_open(store, a->textures);
    int status = bench.sources ? create_devices(&bench) : 1;
    if (status == 0)
        status = !measure(&bench, best);
    if (status == 0)
        print(&bench, best);
    for (uint32_t i = 0; i < bench.gpu_count; i++) {
        if (atomic_load(&bench.gpus[i].validation_messages) > 0)
            status = 1;
        gpu_destroy(&bench.gpus[i]);
    }
    stores_close(bench.sources, bench.source_count);
    return status;
}

int main(int argc, char **argv)
{
    struct arguments a = {0};
    struct option devices = option_devices(&a.devices);
    devices.initial = "all";
    const struct option rows[] = {
        devices,
        {OPTION_CHOICE, "residency", "auto|sparse|paged|dense", "auto", &a.residency,
         "mode of the streamers"},
        {OPTION_UINT, "textures", "N", "4", &a.textures, "textures, each of all devices", 1, 4096},
        {OPTION_UINT, "texture-size", "N", "4096", &a.texture_size,
         "width and height of the textures in texels", 256, 16384},
        {OPTION_TEXT, "store", "FILE", "(a new one)", &a.store,
         "tile store that all textures are read from, instead of a new one"},
        {OPTION_BYTES, "pool-cache", "SIZE", "256M", &a.cache,
         "texels that the pool keeps for devices that come later", 1, 1099511627776.0},
        option_threads(&a.threads),
        {OPTION_FLAG, "quick", .value = &a.quick,
         .help = "small and once: to see that everything works"},
        option_validation(&a.validation),
        option_json(&a.json),
        option_list_devices(&a.list),
    };
    const struct option_table table = {
        "devices_figures",
        "usage: devices_figures [options]\n"
        "Fills devices from a tile store: one alone, all with threads of their own, and all with\n"
        "one read pool. Prints a figure per line.\n",
        NULL, rows, sizeof rows / sizeof *rows};
    switch (options_parse(&table, argc, argv)) {
    case OPTIONS_HELP: return 0;
    case OPTIONS_ERROR: return 2;
    case OPTIONS_RUN: break;
    }
    if (a.list)
        return gpu_list_devices() > 0 ? 0 : 77;
    options.json = a.json;
    options.quick = a.quick;
    if (a.quick && a.texture_size == 4096)
        a.texture_size = 1024;
    if (a.store)
        return run(&a, a.store);
    char path[] = "/tmp/sluice-devices-XXXXXX";
    int descriptor = mkstemp(path);
    if (descriptor < 0) {
        perror(path);
        return 1;
    }
    close(descriptor);
    unlink(path); /* the writer wants no file there */
    int status = stores_write(path, a.texture_size) ? run(&a, path) : 1;
    unlink(path);
    return status;
}
