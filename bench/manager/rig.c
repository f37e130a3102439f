#include "rig.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void must(SluiceResult result, const char *what)
{
    if (result < 0) {
        fprintf(stderr, "%s: %s\n", what, sluiceGetResultName(result));
        exit(1);
    }
}

void *must_allocate(size_t size)
{
    void *memory = malloc(size);
    if (!memory)
        must(SLUICE_ERROR_OUT_OF_HOST_MEMORY, "malloc");
    memset(memory, 0, size); /* touched before anything is timed or weighed */
    return memory;
}

static SluiceResult allocate_heap(void *user, uint64_t size, uint32_t *heap_id)
{
    struct rig *rig = user;
    (void)size;
    *heap_id = rig->next_heap_id++;
    return SLUICE_SUCCESS;
}

static void release_heap(void *user, uint32_t heap_id)
{
    (void)user;
    (void)heap_id;
}

void rig_init(struct rig *rig, uint32_t heap_capacity,
              const SluiceStreamedTextureManagerConfig *config, uint32_t room)
{
    *rig = (struct rig){.room = room};
    rig->tiles = must_allocate(room * sizeof *rig->tiles);
    rig->indices = must_allocate(room * sizeof *rig->indices);
    SluiceStreamedTextureManagerCreateInfo info = {
        .structSize = sizeof info,
        .heapAllocator = {rig, allocate_heap, release_heap},
        .heapTileCapacity = heap_capacity,
        .tileSize = SLUICE_DEFAULT_TILE_SIZE,
        .alwaysMapPackedTiles = true,
    };
    must(sluiceCreateStreamedTextureManager(&info, &rig->manager), "create");
    must(sluiceSetConfig(rig->manager, config), "config");
}

void rig_finish(struct rig *rig)
{
    sluiceDestroyStreamedTextureManager(rig->manager);
    free(rig->tiles);
    free(rig->indices);
}

void rig_answer(struct rig *rig, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        rig->indices[i] = rig->tiles[i].tileIndex;
    for (uint32_t first = 0, end = 0; first < count; first = end) {
        while (end < count && rig->tiles[end].textureId == rig->tiles[first].textureId)
            end++;
        must(sluiceUpdateTilesMapping(rig->manager, rig->tiles[first].textureId, end - first,
                                      rig->indices + first),
             "mapped");
    }
}

uint64_t rig_drain(struct rig *rig)
{
    uint64_t mapped = 0;
    uint32_t to_map, to_unmap;
    do {
        to_unmap = rig->room;
        must(sluiceGetTilesToUnmap(rig->manager, SLUICE_ALL_TEXTURES, 0, &to_unmap, rig->tiles),
             "unmap");
        to_map = rig->room;
        must(sluiceGetTilesToMap(rig->manager, SLUICE_ALL_TEXTURES, &to_map, rig->tiles), "map");
        rig_answer(rig, to_map);
        mapped += to_map;
    } while (to_map > 0 || to_unmap > 0);
    return mapped;
}

SluiceStreamedTextureDesc square_desc(uint32_t size, uint32_t tile)
{
    SluiceStreamedTextureDesc desc = {.width = size,
                                      .height = size,
                                      .tileWidth = tile,
                                      .tileHeight = tile,
                                      .feedbackRegionWidth = tile,
                                      .feedbackRegionHeight = tile};
    for (uint32_t s = size; s > 0; s >>= 1) {
        desc.mipLevelCount++;
        if (s >= tile)
            desc.regularMipCount++;
    }
    desc.packedTileCount = desc.regularMipCount < desc.mipLevelCount;
    return desc;
}

SluiceTextureId rig_add(struct rig *rig, const SluiceStreamedTextureDesc *desc)
{
    SluiceTextureId id = SLUICE_NO_TEXTURE;
    must(sluiceAddStreamedTexture(rig->manager, desc, &id), "add");
    return id;
}

static uint32_t regions(uint32_t size, uint32_t region)
{
    return (size + region - 1) / region;
}

void rig_feedback(struct rig *rig, SluiceTextureId id, const SluiceFeedbackDesc *feedback,
                  uint64_t step, uint64_t timeout)
{
    rig->time += step;
    must(sluiceUpdateWithSamplerFeedback(rig->manager, id, feedback, rig->time, timeout),
         "feedback");
}

SluiceStreamedTextureStatistics rig_statistics(const struct rig *rig)
{
    SluiceStreamedTextureStatistics statistics = {.structSize = sizeof statistics};
    must(sluiceGetStatistics(rig->manager, &statistics), "statistics");
    return statistics;
}

uint32_t region_count(const SluiceStreamedTextureDesc *desc)
{
    return regions(desc->width, desc->feedbackRegionWidth) *
           regions(desc->height, desc->feedbackRegionHeight);
}

SluiceFeedbackDesc map_for(const SluiceStreamedTextureDesc *desc, const uint8_t *map)
{
    return (SluiceFeedbackDesc){.structSize = sizeof(SluiceFeedbackDesc),
                                .pMinMip = map,
                                .width = regions(desc->width, desc->feedbackRegionWidth),
                                .height = regions(desc->height, desc->feedbackRegionHeight)};
}
