/**
 * Sluice's manager behind the functions of the feedback-replay harness (backend.h). In the
 * harness's folder, with Sluice installed:
 *
 *     cc -std=c11 -O2 -I. replay.c SLUICE/bench/manager/backend_sluice.c \
 *         $(pkg-config --cflags --libs sluice) -lpthread -o replay
 *
 * run.sh does that and more. Uses the public API only. `allocate` fetches the lists once per frame
 * for all textures; they are then handed to the harness by texture. At most IN_FLIGHT tiles are
 * handed out at a time: tiles that wait in the manager are still reordered and dropped, tiles in a
 * queue are not.
 *
 * Environment: SLUICE_PREFETCH_LEVELS   prefetchLevels of the manager's configuration. Default: 0.
 */
#include "backend.h"

#include <sluice/manager.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { IN_FLIGHT = 768, UNMAP_ROOM = 65536 };

/** Tiles that the manager listed in this frame, and their indices grouped by texture. */
struct tile_list {
    SluiceTile *tiles;
    uint32_t *grouped;
    uint32_t count, room;
};

struct group {
    uint32_t first, count; ///< range in tile_list.grouped
};

struct per_texture {
    SluiceTextureId id;
    struct group map, unmap;
    uint32_t feedback_width, feedback_height;
    uint32_t min_mip_width, min_mip_height;
    uint32_t regular_mips;
    bool has_packed_tiles;
};

struct bench_manager {
    SluiceStreamedTextureManager *manager;
    struct per_texture *textures;
    uint32_t texture_count, texture_room;
    uint32_t *spare_heaps; ///< added by the harness, not used by the manager yet
    uint32_t spare_count, spare_room;
    uint32_t heap_tiles, in_flight;
    struct tile_list map, unmap;
    uint32_t *changed; ///< textures with tiles in map or unmap, most urgent first
    uint32_t changed_count;
};

static void check(SluiceResult result, const char *what)
{
    if (result < 0) {
        fprintf(stderr, "%s: %s\n", what, sluiceGetResultName(result));
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

static void init_list(struct tile_list *list, uint32_t room)
{
    list->room = room;
    list->tiles = grow(NULL, room * sizeof *list->tiles);
    list->grouped = grow(NULL, room * sizeof *list->grouped);
}

static void finish_list(struct tile_list *list)
{
    free(list->tiles);
    free(list->grouped);
}

static uint32_t levels_to_prefetch(void)
{
    const char *text = getenv("SLUICE_PREFETCH_LEVELS");
    if (!text)
        return 0;
    char *end;
    unsigned long levels = strtoul(text, &end, 10);
    if (*text < '0' || *text > '9' || *end || levels > UINT32_MAX) {
        fprintf(stderr, "SLUICE_PREFETCH_LEVELS: %s is no number of levels\n", text);
        exit(2);
    }
    return (uint32_t)levels;
}

static void *create(uint32_t heap_tiles, uint32_t standby_tiles)
{
    struct bench_manager *m = grow(NULL, sizeof *m);
    *m = (struct bench_manager){.heap_tiles = heap_tiles};
    init_list(&m->map, IN_FLIGHT);
    init_list(&m->unmap, UNMAP_ROOM);
    SluiceStreamedTextureManagerCreateInfo info = {
        .structSize = sizeof info,
        .heapAllocator = {m, take_spare_heap, release_heap},
        .heapTileCapacity = heap_tiles,
        .tileSize = SLUICE_DEFAULT_TILE_SIZE,
        .alwaysMapPackedTiles = true,
    };
    check(sluiceCreateStreamedTextureManager(&info, &m->manager), "create");
    SluiceStreamedTextureManagerConfig config = {.structSize = sizeof config,
                                                 .numExtraStandbyTiles = standby_tiles,
                                                 .prefetchLevels = levels_to_prefetch()};
    check(sluiceSetConfig(m->manager, &config), "config");
    return m;
}

static void destroy(void *backend_manager)
{
    struct bench_manager *m = backend_manager;
    sluiceDestroyStreamedTextureManager(m->manager);
    free(m->textures);
    free(m->spare_heaps);
    finish_list(&m->map);
    finish_list(&m->unmap);
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
    *texture = (struct per_texture){
        .feedback_width = t->fbW,
        .feedback_height = t->fbH,
        .min_mip_width = 1,
        .min_mip_height = 1,
        .regular_mips = t->regularMips,
        .has_packed_tiles = t->packedTiles > 0,
    };
    if (t->regularMips > 0)
        slt_mip_tiles(t, 0, &texture->min_mip_width, &texture->min_mip_height);
    check(sluiceAddStreamedTexture(m->manager, &desc, &texture->id), "add");
    /* the harness's ids and its `primary` are indices in the trace */
    if (t->primary < m->texture_count)
        check(sluiceSetPrimaryTexture(m->manager, texture->id, m->textures[t->primary].id), "set");
    return m->texture_count++; /* ids count up from 0 while nothing is removed */
}

static void feedback(void *backend_manager, uint32_t id, uint8_t *map, double seconds,
                     double timeout)
{
    struct bench_manager *m = backend_manager;
    const struct per_texture *t = &m->textures[id];
    SluiceFeedbackDesc desc = {.structSize = sizeof desc,
                               .pMinMip = map,
                               .width = t->feedback_width,
                               .height = t->feedback_height};
    check(sluiceUpdateWithSamplerFeedback(m->manager, t->id, &desc, (uint64_t)(seconds * 1e6),
                                          (uint64_t)(timeout * 1e6)),
          "feedback");
}

/** Does nothing: followers follow their primary automatically. */
static void follow(void *backend_manager, uint32_t primary, uint32_t follower, double seconds,
                   double timeout)
{
    (void)backend_manager;
    (void)primary;
    (void)follower;
    (void)seconds;
    (void)timeout;
}

static uint32_t desired_heaps(void *backend_manager)
{
    struct bench_manager *m = backend_manager;
    SluiceStreamedTextureStatistics s = {.structSize = sizeof s};
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

static struct per_texture *note_changed(struct bench_manager *m, const SluiceTile *tile)
{
    uint32_t index = (uint32_t)tile->textureId;
    struct per_texture *texture = &m->textures[index];
    if (texture->map.count == 0 && texture->unmap.count == 0)
        m->changed[m->changed_count++] = index;
    return texture;
}

/** Sets a group's position, and empties it. `put` fills it. */
static uint32_t place(struct group *group, uint32_t first)
{
    uint32_t next = first + group->count;
    *group = (struct group){.first = first};
    return next;
}

static void put(struct tile_list *list, struct group *group, uint32_t tile_index)
{
    list->grouped[group->first + group->count++] = tile_index;
}

/** Groups tiles by texture, and keeps the manager's order, coarse levels first. */
static void group_by_texture(struct bench_manager *m)
{
    for (uint32_t i = 0; i < m->map.count; i++)
        note_changed(m, &m->map.tiles[i])->map.count++;
    for (uint32_t i = 0; i < m->unmap.count; i++)
        note_changed(m, &m->unmap.tiles[i])->unmap.count++;
    uint32_t map_next = 0, unmap_next = 0;
    for (uint32_t i = 0; i < m->changed_count; i++) {
        struct per_texture *texture = &m->textures[m->changed[i]];
        map_next = place(&texture->map, map_next);
        unmap_next = place(&texture->unmap, unmap_next);
    }
    for (uint32_t i = 0; i < m->map.count; i++) {
        const SluiceTile *tile = &m->map.tiles[i];
        put(&m->map, &m->textures[(uint32_t)tile->textureId].map, tile->tileIndex);
    }
    for (uint32_t i = 0; i < m->unmap.count; i++) {
        const SluiceTile *tile = &m->unmap.tiles[i];
        put(&m->unmap, &m->textures[(uint32_t)tile->textureId].unmap, tile->tileIndex);
    }
}

static void forget_changed(struct bench_manager *m)
{
    for (uint32_t i = 0; i < m->changed_count; i++) {
        m->textures[m->changed[i]].map.count = 0;
        m->textures[m->changed[i]].unmap.count = 0;
    }
    m->changed_count = 0;
}

static void allocate(void *backend_manager)
{
    struct bench_manager *m = backend_manager;
    forget_changed(m);
    m->unmap.count = m->unmap.room;
    check(
        sluiceGetTilesToUnmap(m->manager, SLUICE_ALL_TEXTURES, 0, &m->unmap.count, m->unmap.tiles),
        "unmap");
    m->map.count = m->map.room - m->in_flight;
    check(sluiceGetTilesToMap(m->manager, SLUICE_ALL_TEXTURES, &m->map.count, m->map.tiles), "map");
    m->in_flight += m->map.count;
    group_by_texture(m);
}

/* The harness only reads its lists, so they may point here until the next `allocate`. */

static void to_unmap(void *backend_manager, uint32_t id, be_list *list)
{
    struct bench_manager *m = backend_manager;
    const struct group *group = &m->textures[id].unmap;
    *list = (be_list){.v = m->unmap.grouped + group->first, .n = group->count};
}

static void to_map(void *backend_manager, uint32_t id, be_list *list)
{
    struct bench_manager *m = backend_manager;
    const struct group *group = &m->textures[id].map;
    *list = (be_list){.v = m->map.grouped + group->first, .n = group->count};
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
    const struct per_texture *t = &m->textures[id];
    *width = t->min_mip_width;
    *height = t->min_mip_height;
    size_t size = (size_t)*width * *height;
    check(sluiceWriteMinMipData(m->manager, t->id, *width, size, out), "minmip");
    /* The harness counts levels: no level at all is one more. With packed tiles a map has this
     * value everywhere or nowhere. */
    uint8_t nothing = (uint8_t)(t->regular_mips + 1);
    if (t->has_packed_tiles && out[0] == SLUICE_MIP_UNTOUCHED)
        memset(out, nothing, size);
    for (size_t i = 0; !t->has_packed_tiles && i < size; i++)
        if (out[i] == SLUICE_MIP_UNTOUCHED)
            out[i] = nothing;
}

static be_stats stats(void *backend_manager)
{
    struct bench_manager *m = backend_manager;
    SluiceStreamedTextureStatistics s = {.structSize = sizeof s};
    check(sluiceGetStatistics(m->manager, &s), "statistics");
    return (be_stats){(uint32_t)s.tileCount, s.heapCount * m->heap_tiles - s.freeSlotCount,
                      s.standbyTileCount, s.freeSlotCount};
}

static void changed(void *backend_manager, be_list *ids)
{
    struct bench_manager *m = backend_manager;
    *ids = (be_list){.v = m->changed, .n = m->changed_count};
}

const backend BACKEND = {"sluice", create,        destroy,  add_texture, feedback,
                         follow,   desired_heaps, add_heap, allocate,    to_unmap,
                         to_map,   mapped,        minmip,   stats,       changed};
