/**
 * Sluice's manager behind the functions that the feedback-replay harness (backend.h) asks for. In
 * the harness's folder, with Sluice installed:
 *
 *     cc -std=c11 -O2 -I. replay.c SLUICE/bench/manager/backend_sluice.c \
 *         $(pkg-config --cflags --libs sluice) -lpthread -o replay
 *
 * Public API only. Lists are fetched once per frame for all textures, in `allocate`, and then
 * handed to the harness texture by texture. At most IN_FLIGHT tiles are out at a time: what waits
 * in the manager is still ordered by need and can still be dropped, what waits in a queue is not.
 */
#include "backend.h"

#include <sluice/manager.h>

#include <stdio.h>
#include <stdlib.h>

enum { IN_FLIGHT = 768, UNMAP_ROOM = 65536 };

struct tile_lists {
    SluiceTile *tiles;
    uint32_t count, room;
};

struct per_texture {
    SluiceTextureId id;
    uint32_t map_first, map_count, unmap_first, unmap_count;
    uint32_t regular_mips;
};

struct bench_manager {
    SluiceStreamedTextureManager *manager;
    struct per_texture *textures;
    uint32_t texture_count, texture_room;
    uint32_t *spare_heaps; ///< added by the harness, not yet taken by the manager
    uint32_t spare_count, spare_room;
    uint32_t heap_tiles, in_flight;
    struct tile_lists map, unmap;
    uint32_t *changed;
    uint32_t changed_count;
};

static void check(SluiceResult result, const char *what)
{
    if (result < 0) {
        fprintf(stderr, "%s: %s\n", what, sluiceResultString(result));
        abort();
    }
}

static void *grow(void *memory, size_t size)
{
    void *bigger = realloc(memory, size);
    if (!bigger)
        abort();
    return bigger;
}

static SluiceResult take_spare_heap(void *user, uint64_t size, uint32_t *heap_id)
{
    struct bench_manager *m = user;
    (void)size;
    if (m->spare_count == 0)
        return SLUICE_ERROR_OUT_OF_DEVICE_MEMORY;
    *heap_id = m->spare_heaps[--m->spare_count];
    return SLUICE_SUCCESS;
}

static void release_heap(void *user, uint32_t heap_id)
{
    (void)user;
    (void)heap_id;
}

static void *create(uint32_t heap_tiles, uint32_t standby_tiles)
{
    struct bench_manager *m = grow(NULL, sizeof *m);
    *m = (struct bench_manager){.heap_tiles = heap_tiles};
    m->map.room = IN_FLIGHT;
    m->map.tiles = grow(NULL, IN_FLIGHT * sizeof *m->map.tiles);
    m->unmap.room = UNMAP_ROOM;
    m->unmap.tiles = grow(NULL, UNMAP_ROOM * sizeof *m->unmap.tiles);
    SluiceStreamedTextureManagerCreateInfo info = {
        .heapAllocator = {m, take_spare_heap, release_heap},
        .heapTileCapacity = heap_tiles,
        .tileSize = SLUICE_DEFAULT_TILE_SIZE,
        .alwaysMapPackedTiles = true,
    };
    check(sluiceCreateStreamedTextureManager(&info, &m->manager), "create");
    SluiceStreamedTextureManagerConfig config = {.numExtraStandbyTiles = standby_tiles};
    check(sluiceSetConfig(m->manager, &config), "config");
    return m;
}

static void destroy(void *backend_manager)
{
    struct bench_manager *m = backend_manager;
    sluiceDestroyStreamedTextureManager(m->manager);
    free(m->textures);
    free(m->spare_heaps);
    free(m->map.tiles);
    free(m->unmap.tiles);
    free(m->changed);
    free(m);
}

static uint32_t add_texture(void *backend_manager, const slt_texture *t)
{
    struct bench_manager *m = backend_manager;
    if (m->texture_count == m->texture_room) {
        m->texture_room = m->texture_room ? m->texture_room * 2 : 1024;
        m->textures = grow(m->textures, m->texture_room * sizeof *m->textures);
        m->changed = grow(m->changed, m->texture_room * sizeof *m->changed);
    }
    SluiceStreamedTextureDesc desc = {
        .width = t->width,
        .height = t->height,
        .mipLevelCount = t->mipCount,
        .regularMipCount = t->regularMips,
        .packedTileCount = t->packedTiles,
        .tileWidth = t->tileW,
        .tileHeight = t->tileH,
        .feedbackRegionWidth = t->fbRegionW,
        .feedbackRegionHeight = t->fbRegionH,
    };
    struct per_texture *texture = &m->textures[m->texture_count];
    *texture = (struct per_texture){.regular_mips = t->regularMips};
    check(sluiceAddStreamedTexture(m->manager, &desc, &texture->id), "add");
    return m->texture_count++; /* ids are dense from 0 as long as nothing is removed */
}

static void feedback(void *backend_manager, uint32_t id, uint8_t *map, double seconds,
                     double timeout)
{
    struct bench_manager *m = backend_manager;
    SluiceStreamedTextureLayout layout;
    check(sluiceGetTextureLayout(m->manager, m->textures[id].id, &layout), "layout");
    SluiceFeedbackDesc desc = {
        .pMinMip = map, .width = layout.feedbackWidth, .height = layout.feedbackHeight};
    check(sluiceUpdateWithSamplerFeedback(m->manager, m->textures[id].id, &desc,
                                          (uint64_t)(seconds * 1e6), (uint64_t)(timeout * 1e6)),
          "feedback");
}

static void follow(void *backend_manager, uint32_t primary, uint32_t follower, double seconds,
                   double timeout)
{
    struct bench_manager *m = backend_manager;
    check(sluiceMatchPrimaryTexture(m->manager, m->textures[primary].id, m->textures[follower].id,
                                    (uint64_t)(seconds * 1e6), (uint64_t)(timeout * 1e6)),
          "follow");
}

static uint32_t desired_heaps(void *backend_manager)
{
    struct bench_manager *m = backend_manager;
    SluiceStreamedTextureStatistics s;
    check(sluiceGetStatistics(m->manager, &s), "statistics");
    uint64_t used = (uint64_t)s.heapCount * m->heap_tiles - s.freeSlotCount;
    return (uint32_t)((used + s.requestedTileCount + m->heap_tiles - 1) / m->heap_tiles);
}

static void add_heap(void *backend_manager, uint32_t heap_id)
{
    struct bench_manager *m = backend_manager;
    if (m->spare_count == m->spare_room) {
        m->spare_room = m->spare_room ? m->spare_room * 2 : 64;
        m->spare_heaps = grow(m->spare_heaps, m->spare_room * sizeof *m->spare_heaps);
    }
    m->spare_heaps[m->spare_count++] = heap_id;
}

static int by_texture(const void *a, const void *b)
{
    const SluiceTile *x = a, *y = b;
    if (x->textureId != y->textureId)
        return (uint32_t)x->textureId < (uint32_t)y->textureId ? -1 : 1;
    /* coarse first within a texture, as the manager listed them */
    if (x->mipLevel != y->mipLevel)
        return x->mipLevel > y->mipLevel ? -1 : 1;
    return x->tileIndex < y->tileIndex ? -1 : x->tileIndex > y->tileIndex;
}

static struct per_texture *note_changed(struct bench_manager *m, uint32_t index)
{
    struct per_texture *texture = &m->textures[index];
    if (texture->map_count == 0 && texture->unmap_count == 0)
        m->changed[m->changed_count++] = index;
    return texture;
}

static void group_by_texture(struct bench_manager *m)
{
    qsort(m->map.tiles, m->map.count, sizeof *m->map.tiles, by_texture);
    qsort(m->unmap.tiles, m->unmap.count, sizeof *m->unmap.tiles, by_texture);
    for (uint32_t i = 0; i < m->map.count; i++) {
        struct per_texture *texture = note_changed(m, (uint32_t)m->map.tiles[i].textureId);
        if (texture->map_count++ == 0)
            texture->map_first = i;
    }
    for (uint32_t i = 0; i < m->unmap.count; i++) {
        struct per_texture *texture = note_changed(m, (uint32_t)m->unmap.tiles[i].textureId);
        if (texture->unmap_count++ == 0)
            texture->unmap_first = i;
    }
}

static void allocate(void *backend_manager)
{
    struct bench_manager *m = backend_manager;
    for (uint32_t i = 0; i < m->changed_count; i++)
        m->textures[m->changed[i]].map_count = m->textures[m->changed[i]].unmap_count = 0;
    m->changed_count = 0;
    m->unmap.count = m->unmap.room;
    check(
        sluiceGetTilesToUnmap(m->manager, SLUICE_ALL_TEXTURES, 0, &m->unmap.count, m->unmap.tiles),
        "unmap");
    m->map.count = IN_FLIGHT - m->in_flight;
    check(sluiceGetTilesToMap(m->manager, SLUICE_ALL_TEXTURES, &m->map.count, m->map.tiles), "map");
    m->in_flight += m->map.count;
    group_by_texture(m);
}

static void copy_list(be_list *list, const SluiceTile *tiles, uint32_t count)
{
    if (list->cap < count) {
        list->cap = count;
        list->v = grow(list->v, count * sizeof *list->v);
    }
    for (uint32_t i = 0; i < count; i++)
        list->v[i] = tiles[i].tileIndex;
    list->n = count;
}

static void to_unmap(void *backend_manager, uint32_t id, be_list *list)
{
    struct bench_manager *m = backend_manager;
    const struct per_texture *t = &m->textures[id];
    copy_list(list, m->unmap.tiles + t->unmap_first, t->unmap_count);
}

static void to_map(void *backend_manager, uint32_t id, be_list *list)
{
    struct bench_manager *m = backend_manager;
    const struct per_texture *t = &m->textures[id];
    copy_list(list, m->map.tiles + t->map_first, t->map_count);
}

static void mapped(void *backend_manager, uint32_t id, const uint32_t *tiles, uint32_t count)
{
    struct bench_manager *m = backend_manager;
    check(sluiceUpdateTilesMapping(m->manager, m->textures[id].id, count, tiles), "mapped");
    m->in_flight -= count;
}

static void minmip(void *backend_manager, uint32_t id, uint8_t *out, uint32_t *width,
                   uint32_t *height)
{
    struct bench_manager *m = backend_manager;
    SluiceStreamedTextureLayout layout;
    check(sluiceGetTextureLayout(m->manager, m->textures[id].id, &layout), "layout");
    *width = layout.minMipWidth;
    *height = layout.minMipHeight;
    size_t size = (size_t)*width * *height;
    check(sluiceWriteMinMipData(m->manager, m->textures[id].id, *width, size, out), "minmip");
    for (size_t i = 0; i < size; i++) /* the harness counts levels: nothing there is one more */
        if (out[i] == SLUICE_MIP_UNTOUCHED)
            out[i] = (uint8_t)(m->textures[id].regular_mips + 1);
}

static be_stats stats(void *backend_manager)
{
    struct bench_manager *m = backend_manager;
    SluiceStreamedTextureStatistics s;
    check(sluiceGetStatistics(m->manager, &s), "statistics");
    return (be_stats){(uint32_t)s.tileCount, s.heapCount * m->heap_tiles - s.freeSlotCount,
                      s.standbyTileCount, s.freeSlotCount};
}

static void changed(void *backend_manager, be_list *ids)
{
    struct bench_manager *m = backend_manager;
    if (ids->cap < m->changed_count) {
        ids->cap = m->changed_count;
        ids->v = grow(ids->v, ids->cap * sizeof *ids->v);
    }
    for (uint32_t i = 0; i < m->changed_count; i++)
        ids->v[i] = m->changed[i];
    ids->n = m->changed_count;
}

const backend BACKEND = {"sluice", create,        destroy,  add_texture, feedback,
                         follow,   desired_heaps, add_heap, allocate,    to_unmap,
                         to_map,   mapped,        minmip,   stats,       changed};
