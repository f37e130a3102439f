/** Memory per tile: of textures nobody looks at, of textures once seen, of resident tiles. */
#include "micro.h"

#include "figures.h"
#include "rig.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TILE = 256, MORE_TILES = 200000, ROOM = 8192 };

/* Sizes in the mixture of a heavy scene: 982 tiles per texture on average. */
static const uint32_t sizes[] = {16384, 8192, 8192, 4096, 4096, 4096, 4096, 2048, 2048, 2048};
enum { SIZES = sizeof sizes / sizeof *sizes };

struct scene {
    struct rig rig;
    SluiceTextureId *textures;
    uint32_t texture_count;
    uint8_t *map;
};

struct weight {
    uint64_t resident, host;
};

static struct weight weigh(const struct scene *scene)
{
    return (struct weight){resident_size(), rig_statistics(&scene->rig).hostMemorySize};
}

static struct weight figure_weight(const char *name, const struct scene *scene,
                                   struct weight before, double tiles)
{
    struct weight now = weigh(scene);
    figure(name, "rss", (double)(now.resident - before.resident) / tiles, "bytes/tile");
    figure(name, "host", (double)(now.host - before.host) / tiles, "bytes/tile");
    return now;
}

/** Gives texture `i` a map; the time stands still, so nothing lapses. */
static void bring_map(struct scene *scene, uint32_t i, bool coarse)
{
    SluiceStreamedTextureDesc desc = square_desc(sizes[i % SIZES], TILE);
    uint32_t width = desc.width / TILE;
    memset(scene->map, SLUICE_MIP_UNTOUCHED, region_count(&desc));
    if (coarse)
        memset(scene->map, (int)desc.regularMipCount - 1, region_count(&desc));
    for (uint32_t y = 0; !coarse && y < width / 2; y++)
        memset(scene->map + y * width, 0, width / 2);
    SluiceFeedbackDesc feedback = map_for(&desc, scene->map);
    rig_feedback(&scene->rig, scene->textures[i], &feedback, 0, TIMEOUT);
}

void bench_memory(void)
{
    uint32_t tile_target = options.quick ? 1000000 : 10000000;
    uint32_t texture_room = tile_target / 900;
    struct scene scene = {0};
    SluiceStreamedTextureManagerConfig config = {.structSize = sizeof config};
    rig_init(&scene.rig, 1024, &config, ROOM);
    scene.textures = must_allocate(texture_room * sizeof *scene.textures);
    scene.map = must_allocate(ROOM);
    if (resident_size() == 0) {
        fprintf(stderr, "no /proc/self/smaps_rollup: memory is not weighed\n");
        rig_finish(&scene.rig);
        return;
    }

    struct weight weight = weigh(&scene);
    uint64_t tiles = 0;
    while (tiles < tile_target) {
        SluiceStreamedTextureDesc desc = square_desc(sizes[scene.texture_count % SIZES], TILE);
        scene.textures[scene.texture_count++] = rig_add(&scene.rig, &desc);
        tiles = rig_statistics(&scene.rig).tileCount;
    }
    figure("memory.tiles", NULL, (double)tiles, "tiles");
    struct weight empty = weight;
    figure_weight("memory.virtual_tile", &scene, weight, (double)tiles);

    for (uint32_t i = 0; i < scene.texture_count; i++)
        bring_map(&scene, i, true);
    rig_drain(&scene.rig);
    weight = figure_weight("memory.virtual_tile_seen", &scene, empty, (double)tiles);

    /* A quarter of the finest level, texture by texture, until so many more are resident. */
    uint64_t more = 0;
    for (uint32_t i = 0; i < scene.texture_count && more < MORE_TILES; i++) {
        bring_map(&scene, i, false);
        more += rig_drain(&scene.rig);
    }
    figure("memory.more_tiles", NULL, (double)more, "tiles");
    figure_weight("memory.resident_tile", &scene, weight, (double)more);
    free(scene.textures);
    free(scene.map);
    rig_finish(&scene.rig);
}
