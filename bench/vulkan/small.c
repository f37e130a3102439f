/* Measures textures of 64 x 64 RGBA8, all resident: device and host memory of each, and the time to
 * add and to load them. The streamer chooses the mode of each texture. */
#include "rig.h"

#include "../../tools/common/clock.h"

#include <stdatomic.h>
#include <stdlib.h>

#define SIZE 64u
#define TEXELS 21844.0 /* bytes of all levels */

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

/* Adds all textures except the first, which the rig has. */
static bool add_textures(struct rig *rig, uint32_t count)
{
    SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create,
                                            .source = &rig->sources[0].base};
    for (uint32_t i = 1; i < count; i++) {
        SluiceVulkanTexture texture;
        if (!check(sluiceAddVulkanTexture(rig->streamer, &create, &texture),
                   "sluiceAddVulkanTexture"))
            return false;
    }
    return true;
}

bool measure_small(const struct bench *bench)
{
    const uint32_t count = options.quick ? 1000 : 100000;
    struct host_memory host = {.callbacks = {&host, allocate, release}};
    /* The streamer chooses the mode itself when the device's best mode is measured. */
    const struct rig_info info = {.bench = bench,
                                  .context = {.pAllocator = &host.callbacks},
                                  .streamer = {.maxTextureCount = count, .tilesPerFrame = 2048},
                                  .chooses_modes = bench->mode == SLUICE_RESIDENCY_MODE_SPARSE,
                                  .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                  .texture_size = SIZE,
                                  .texture_count = 1,
                                  .anisotropy = 1.0f};
    struct rig rig;
    bool done = rig_create(&rig, &info);
    uint64_t empty = atomic_load(&host.size);
    double begin = clock_seconds();
    done = done && add_textures(&rig, count);
    double added = clock_seconds();
    uint64_t size = atomic_load(&host.size);
    done = done && rig_load(&rig, NULL);
    if (done) {
        SluiceVulkanStreamerStatistics s = rig_statistics(&rig);
        report(bench, s.mappedTileCount, "textures", "small.resident");
        report(bench, (double)s.tileMemorySize / count, "bytes", "small.tile_memory");
        report(bench, (double)s.tileMemorySize / count / TEXELS, "times", "small.of_texels");
        report(bench, s.heapCount, "heaps", "small.heaps");
        report(bench, (double)(size - empty) / count, "bytes", "small.host_added");
        report(bench, (double)(atomic_load(&host.size) - empty) / count, "bytes",
               "small.host_loaded");
        report(bench, (added - begin) / count * 1e6, "us", "small.add");
        report(bench, (clock_seconds() - added) / count * 1e6, "us", "small.load");
    }
    rig_destroy(&rig);
    return done;
}
