/*
 * Measures textures of 64 x 64 RGBA8: memory with all of them resident, and time to sample each
 * once when only some fit.
 */
#include "rig.h"

#include "../../tools/common/clock.h"

#include <stdatomic.h>
#include <stdlib.h>

#define SIZE 64u
#define TEXELS 21844.0 /* bytes of all levels */
#define PAGE 65536.0
#define BATCH 500u
#define MAX_LAUNCHES 200u

struct host_memory {
    _Atomic uint64_t size;
    SluiceAllocationCallbacks callbacks;
};

static void *allocate(void *user, size_t size, size_t alignment)
{
    atomic_fetch_add(&((struct host_memory *)user)->size, size);
    return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

static void release(void *user, void *memory, size_t size)
{
    atomic_fetch_sub(&((struct host_memory *)user)->size, size);
    free(memory);
}

struct small {
    struct rig rig;
    struct bench bench;
    struct host_memory host;
    struct free_source source;
    SluiceDemandTextureId *ids;
    uint32_t count;
};

static SluiceResult open_image(void *user, SluiceImageSource **source)
{
    struct small *small = user;
    *source = &small->source.base;
    return SLUICE_SUCCESS;
}

static void close_image(void *user, SluiceImageSource *source)
{
    (void)user, (void)source;
}

static bool start(struct small *small, const struct bench *bench, uint64_t budget, uint32_t count)
{
    *small = (struct small){.bench = *bench, .count = count};
    small->host.callbacks = (SluiceAllocationCallbacks){&small->host, allocate, release};
    small->bench.allocator = &small->host.callbacks;
    small->bench.edge = 32;
    free_source_init(&small->source, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE);
    SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info, .memoryBudget = budget};
    small->ids = malloc(count * sizeof *small->ids);
    return small->ids && rig_create(&small->rig, &small->bench, &info, false);
}

static void stop(struct small *small)
{
    rig_destroy(&small->rig);
    free(small->ids);
}

static bool add_textures(struct small *small)
{
    SluiceDemandTextureCreateInfo info = {
        .structSize = sizeof info,
        .image = {.pUserData = small, .pfnOpen = open_image, .pfnClose = close_image}};
    for (uint32_t i = 0; i < small->count; i++)
        if (!check(sluiceAddDemandTexture(small->rig.loader, &info, &small->ids[i]),
                   "sluiceAddDemandTexture"))
            return false;
    return true;
}

static bool get(struct small *small, SluiceDemandStatistics *s)
{
    *s = (SluiceDemandStatistics){.structSize = sizeof *s};
    return check(sluiceGetDemandStatistics(small->rig.loader, s), "sluiceGetDemandStatistics");
}

/* Loads the mip tails of some textures, which is all they have. */
static bool load(struct small *small, uint32_t first, uint32_t count)
{
    static SluiceDemandTicket tickets[BATCH];
    for (uint32_t i = 0; i < count; i++)
        if (!check(sluicePreloadDemandTexture(small->rig.loader, small->ids[first + i], 0,
                                              &tickets[i]),
                   "sluicePreloadDemandTexture"))
            return false;
    uint32_t done = 0;
    for (uint32_t launch = 0; launch < MAX_LAUNCHES && done < count; launch++) {
        struct rig_outcome outcome;
        if (!rig_launch(&small->rig, DEMAND_BENCH_NOTHING, &outcome))
            return false;
        SluiceDemandTicketStatus status = {.structSize = sizeof status};
        while (done < count) {
            if (!check(
                    sluiceWaitDemandTicket(small->rig.loader, tickets[done], UINT64_MAX, &status),
                    "sluiceWaitDemandTicket"))
                return false;
            if (status.remainingCount)
                break;
            done++;
        }
    }
    struct rig_outcome outcome;
    return rig_launch(&small->rig, DEMAND_BENCH_NOTHING, &outcome);
}

static bool load_all(struct small *small)
{
    for (uint32_t first = 0; first < small->count; first += BATCH)
        if (!load(small, first, small->count - first < BATCH ? small->count - first : BATCH))
            return false;
    return true;
}

/* Measures with all textures resident. */
static bool measure_resident(const struct bench *bench, uint32_t count)
{
    struct small small;
    SluiceDemandStatistics s;
    uint64_t empty = 0, added = 0;
    double begin = clock_seconds();
    bool done = start(&small, bench, (uint64_t)(count * 1.2 * TEXELS) + (8u << 20), count);
    empty = atomic_load(&small.host.size);
    done = done && add_textures(&small);
    added = atomic_load(&small.host.size);
    done = done && load_all(&small) && get(&small, &s);
    if (done) {
        double n = count;
        figure("small.textures", NULL, n, "textures");
        figure("small.resident", NULL, (double)s.residentTileCount, "textures");
        figure("small.pages", NULL, (double)s.tailPageCount * PAGE / n, "bytes");
        figure("small.tile_memory", NULL, (double)s.tileMemorySize / n, "bytes");
        figure("small.of_texels", NULL, (double)s.tileMemorySize / n / TEXELS, "times");
        figure("small.host_added", NULL, (double)(added - empty) / n, "bytes");
        figure("small.host_open", NULL, (double)(atomic_load(&small.host.size) - added) / n,
               "bytes");
        figure("small.seconds", NULL, clock_seconds() - begin, "s");
    }
    stop(&small);
    return done;
}

/* Samples each texture once, DEMAND_BENCH_TEXTURES at a time, in memory for some of them. */
static bool measure_once(const struct bench *bench, uint32_t count, uint64_t budget)
{
    struct small small;
    struct bench samples = *bench;
    SluiceDemandStatistics s;
    samples.columns = 4; /* DEMAND_BENCH_TEXTURES */
    samples.texture_size = SIZE;
    bool done = start(&small, &samples, budget, count) && add_textures(&small);
    uint32_t launches = 0, steps = 0;
    double begin = clock_seconds();
    small.rig.params.edge = 32;
    for (uint32_t i = 0; done && i + DEMAND_BENCH_TEXTURES <= count; i += DEMAND_BENCH_TEXTURES) {
        for (uint32_t j = 0; j < DEMAND_BENCH_TEXTURES; j++)
            small.rig.params.textures[j] = (uint32_t)small.ids[i + j];
        uint32_t needed = rig_load(&small.rig, MAX_LAUNCHES);
        done = needed > 0;
        launches += needed;
        steps++;
    }
    done = done && get(&small, &s);
    if (done) {
        figure("small.once.textures", NULL, steps * (double)DEMAND_BENCH_TEXTURES, "textures");
        figure("small.once.memory", NULL, (double)s.tileMemorySize * 1e-6, "MB");
        figure("small.once.forgotten", NULL, (double)s.texturesForgotten, "textures");
        figure("small.once.refused", NULL, (double)s.refusedCount, "pages");
        figure("small.once.lod_bias", NULL, s.lodBias, "levels");
        figure("small.once.launches", NULL, (double)launches / steps, "launches");
        figure("small.once.seconds", NULL, clock_seconds() - begin, "s");
    }
    stop(&small);
    return done;
}

bool measure_small(const struct bench *bench)
{
    bool quick = options.quick;
    return measure_resident(bench, quick ? 3000 : 100000) &&
           measure_once(bench, quick ? 480 : 100000, quick ? 4u << 20 : 512u << 20);
}
