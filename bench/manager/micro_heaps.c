/** Mapping and unmapping where nearly every heap is full; and what copying a map costs. */
#include "micro.h"

#include "figures.h"
#include "rig.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    CAPACITY = SLUICE_DEFAULT_HEAP_TILE_CAPACITY,
    COMINGS = 64, ///< tiles that come and go: level 0 of `guest`
    FILLER_REGIONS = 4096,
    ROOM = 8192
};

struct house {
    struct rig rig;
    SluiceStreamedTextureDesc guest_desc;
    SluiceTextureId guest;
    uint8_t *map;
};

/** Describes a texture with only level 0 regular, so that a region is a tile and requests no
 * other. */
static SluiceStreamedTextureDesc filler_desc(void)
{
    SluiceStreamedTextureDesc desc = square_desc(16384, 256);
    desc.regularMipCount = 1;
    return desc;
}

/** The next tiles of one texture. */
static void take(struct house *house, SluiceTextureId texture, uint32_t count)
{
    uint32_t got = count;
    must(sluiceGetTilesToMap(house->rig.manager, texture, &got, house->rig.tiles), "map");
    if (got != count) {
        fprintf(stderr, "%u tiles listed instead of %u\n", got, count);
        exit(1);
    }
    rig_answer(&house->rig, got);
}

static void want_level(struct house *house, uint8_t level)
{
    memset(house->map, level, COMINGS);
    SluiceFeedbackDesc feedback = map_for(&house->guest_desc, house->map);
    rig_feedback(&house->rig, house->guest, &feedback, STEP, 1);
}

/** Takes `count` slots for good, with one for the guest in every `count / COMINGS`. */
static void fill(struct house *house, uint32_t count)
{
    SluiceStreamedTextureDesc desc = filler_desc();
    uint32_t done = 0, guests = 0;
    while (done < count) {
        uint32_t tiles = count - done < FILLER_REGIONS + 1 ? count - done : FILLER_REGIONS + 1;
        SluiceTextureId filler = rig_add(&house->rig, &desc);
        memset(house->map, SLUICE_MIP_UNTOUCHED, FILLER_REGIONS);
        memset(house->map, 0, tiles - 1); /* one is the packed tile */
        SluiceFeedbackDesc feedback = map_for(&desc, house->map);
        rig_feedback(&house->rig, filler, &feedback, 0, TIMEOUT);
        while (tiles > 0) {
            uint32_t due = (uint32_t)((uint64_t)(guests + 1) * count / COMINGS) - done;
            uint32_t part = due < tiles ? due : tiles;
            if (part > 0)
                take(house, filler, part);
            tiles -= part;
            done += part;
            if (part == due && guests < COMINGS) {
                take(house, house->guest, 1);
                guests++;
            }
        }
    }
}

static void house_init(struct house *house, uint32_t heap_count)
{
    SluiceStreamedTextureManagerConfig config = {
        .structSize = sizeof config, .maxHeapCount = heap_count, .missesToExpire = 1};
    rig_init(&house->rig, CAPACITY, &config, ROOM);
    house->map = must_allocate(FILLER_REGIONS);
    house->guest_desc = square_desc(2048, 256);
    house->guest = rig_add(&house->rig, &house->guest_desc);
    want_level(house, 1);
    uint32_t fixed = (uint32_t)rig_drain(&house->rig);
    want_level(house, 0);
    /* regular tiles may not take the slots that are kept for packed ones */
    uint32_t kept = heap_count * CAPACITY / 16 < 64 ? heap_count * CAPACITY / 16 : 64;
    fill(house, heap_count * CAPACITY - fixed - COMINGS - kept);
    SluiceStreamedTextureStatistics statistics = rig_statistics(&house->rig);
    if (statistics.heapCount != heap_count || statistics.reservedSlotCount != kept ||
        statistics.freeSlotCount != kept) {
        fprintf(stderr, "%u heaps with %u free slots\n", statistics.heapCount,
                statistics.freeSlotCount);
        exit(1);
    }
}

static void time_heaps(uint32_t heap_count)
{
    struct house house;
    struct samples map, all;
    house_init(&house, heap_count);
    struct rig *rig = &house.rig;
    samples_init(&map, repetitions(2000));
    samples_init(&all, map.room);
    for (uint32_t i = 0; i < map.room; i++) {
        uint32_t out = ROOM, in = COMINGS;
        want_level(&house, 1);
        uint64_t start = now_ns();
        must(sluiceGetTilesToUnmap(rig->manager, SLUICE_ALL_TEXTURES, 0, &out, rig->tiles),
             "unmap");
        uint64_t unmapped = now_ns() - start;
        want_level(&house, 0);
        start = now_ns();
        must(sluiceGetTilesToMap(rig->manager, SLUICE_ALL_TEXTURES, &in, rig->tiles), "map");
        uint64_t mapped = now_ns() - start;
        for (uint32_t k = 0; k < in; k++)
            rig->indices[k] = rig->tiles[k].tileIndex;
        start = now_ns();
        must(sluiceUpdateTilesMapping(rig->manager, house.guest, in, rig->indices), "mapped");
        uint64_t answered = now_ns() - start;
        if (out != COMINGS || in != COMINGS)
            must(SLUICE_ERROR_INVALID_ARGUMENT, "a tile did not come and go");
        samples_add(&map, (double)mapped / COMINGS);
        samples_add(&all, (double)(unmapped + mapped + answered) / COMINGS);
    }
    char name[64];
    snprintf(name, sizeof name, "heaps.%u.map", heap_count);
    figure_times(name, &map);
    snprintf(name, sizeof name, "heaps.%u.map_answer_unmap", heap_count);
    figure_times(name, &all);
    samples_finish(&map);
    samples_finish(&all);
    free(house.map);
    rig_finish(rig);
}

void bench_heaps(void)
{
    static const uint32_t counts[] = {1, 256, 1024, 4096};
    for (uint32_t i = 0; i < sizeof counts / sizeof *counts; i++)
        time_heaps(counts[i]);
}

void bench_copy(void)
{
    enum { SIZE = 4096, BATCH = 1024 };
    uint8_t *from = must_allocate(SIZE), *to = must_allocate(SIZE);
    struct samples samples;
    samples_init(&samples, repetitions(2000));
    for (uint32_t i = 0; i < samples.room; i++) {
        uint64_t start = now_ns();
        for (uint32_t k = 0; k < BATCH; k++) {
            touched(from);
            memcpy(to, from, SIZE);
            touched(to);
        }
        samples_add(&samples, (double)(now_ns() - start) / BATCH);
    }
    figure_times("copy.4096_bytes", &samples);
    samples_finish(&samples);
    free(from);
    free(to);
}
