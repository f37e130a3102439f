#include "core/fixture.h"

#include "base/checked.h"
#include "core/check.h"

#include <stdlib.h>
#include <string.h>

static SluiceResult allocate_heap(void *user, uint64_t size, uint32_t *heap_id)
{
    struct fake_heaps *heaps = user;
    heaps->asked++;
    heaps->size = size;
    if (heaps->answers_duplicate) {
        for (uint32_t i = 0; i < FIXTURE_HEAPS; i++) {
            if (heaps->living[i]) {
                *heap_id = i;
                return SLUICE_SUCCESS;
            }
        }
    }
    uint32_t id = 0;
    while (id < FIXTURE_HEAPS && heaps->living[id])
        id++;
    if (heaps->living_count >= heaps->limit || id == FIXTURE_HEAPS) {
        heaps->refused++;
        return SLUICE_ERROR_OUT_OF_DEVICE_MEMORY;
    }
    heaps->living[id] = true;
    heaps->living_count++;
    *heap_id = id;
    return SLUICE_SUCCESS;
}

static void release_heap(void *user, uint32_t heap_id)
{
    struct fake_heaps *heaps = user;
    assert_true(heap_id < FIXTURE_HEAPS && heaps->living[heap_id]);
    heaps->living[heap_id] = false;
    heaps->living_count--;
    heaps->released++;
}

void fixture_open(struct fixture *f, uint32_t heap_capacity, bool always_map_packed)
{
    memset(f, 0, sizeof *f);
    f->heaps.limit = FIXTURE_HEAPS;
    failing_allocator_init(&f->memory, UINT64_MAX);
    SluiceStreamedTextureManagerCreateInfo info = {
        .structSize = sizeof info,
        .heapAllocator = {&f->heaps, allocate_heap, release_heap},
        .pAllocator = &f->memory.callbacks,
        .heapTileCapacity = heap_capacity,
        .tileSize = SLUICE_DEFAULT_TILE_SIZE,
        .alwaysMapPackedTiles = always_map_packed,
    };
    CHECK_OK(sluiceCreateStreamedTextureManager(&info, &f->manager));
    /* only the timeout expires tiles, because other tests cover learning from maps */
    fixture_configure(f, 0, 0, 0, 0);
}

void fixture_close(struct fixture *f)
{
    assert_string_equal(slc_manager_check(f->manager) ? slc_manager_check(f->manager) : "", "");
    sluiceDestroyStreamedTextureManager(f->manager);
    assert_int_equal(f->memory.live_bytes, 0);
    assert_int_equal(f->memory.live_count, 0);
    assert_int_equal(f->heaps.living_count, 0);
}

SluiceStreamedTextureDesc full_chain(uint32_t width, uint32_t height, uint32_t tile_width,
                                     uint32_t tile_height)
{
    SluiceStreamedTextureDesc desc = {
        .width = width,
        .height = height,
        .mipLevelCount = slc_mip_count(slc_max_u32(width, height)),
        .tileWidth = tile_width,
        .tileHeight = tile_height,
    };
    while (desc.regularMipCount < desc.mipLevelCount &&
           width >> desc.regularMipCount >= tile_width &&
           height >> desc.regularMipCount >= tile_height)
        desc.regularMipCount++;
    desc.packedTileCount = desc.regularMipCount < desc.mipLevelCount;
    return desc;
}

SluiceStreamedTextureDesc small_texture(void)
{
    return full_chain(256, 256, 128, 128);
}

SluiceTextureId fixture_add(struct fixture *f, const SluiceStreamedTextureDesc *desc)
{
    SluiceTextureId id = SLUICE_NO_TEXTURE;
    CHECK_OK(sluiceAddStreamedTexture(f->manager, desc, &id));
    assert_true(id != SLUICE_NO_TEXTURE);
    return id;
}

SluiceTextureId fixture_add_small(struct fixture *f)
{
    SluiceStreamedTextureDesc desc = small_texture();
    return fixture_add(f, &desc);
}

void fixture_configure(struct fixture *f, uint32_t standby, uint32_t max_heaps, uint32_t attempts,
                       uint64_t retry_delay)
{
    SluiceStreamedTextureManagerConfig config = {.structSize = sizeof config,
                                                 .numExtraStandbyTiles = standby,
                                                 .maxHeapCount = max_heaps,
                                                 .maxLoadAttempts = attempts,
                                                 .retryDelayTicks = retry_delay,
                                                 .missesToExpire = 1};
    CHECK_OK(sluiceSetConfig(f->manager, &config));
}

void fixture_feed_map(struct fixture *f, SluiceTextureId id, const uint8_t *map, uint64_t time,
                      uint64_t timeout)
{
    SluiceStreamedTextureLayout layout = fixture_layout(f, id);
    SluiceFeedbackDesc feedback = {sizeof feedback,       map, layout.feedbackWidth,
                                   layout.feedbackHeight, 0,   0};
    CHECK_OK(sluiceUpdateWithSamplerFeedback(f->manager, id, &feedback, time, timeout));
}

static uint8_t *new_map(const struct fixture *f, SluiceTextureId id, uint8_t level)
{
    SluiceStreamedTextureLayout layout = fixture_layout(f, id);
    size_t size = (size_t)layout.feedbackWidth * layout.feedbackHeight;
    uint8_t *map = malloc(size);
    assert_non_null(map);
    memset(map, level, size);
    return map;
}

void fixture_feed(struct fixture *f, SluiceTextureId id, uint8_t level, uint64_t time,
                  uint64_t timeout)
{
    uint8_t *map = new_map(f, id, level);
    fixture_feed_map(f, id, map, time, timeout);
    free(map);
}

void fixture_feed_region(struct fixture *f, SluiceTextureId id, uint32_t region, uint8_t level,
                         uint64_t time, uint64_t timeout)
{
    uint8_t *map = new_map(f, id, SLUICE_MIP_UNTOUCHED);
    map[region] = level;
    fixture_feed_map(f, id, map, time, timeout);
    free(map);
}

SluiceResult fixture_to_map_at_most(struct fixture *f, SluiceTextureId id, uint32_t room)
{
    assert_true(room <= FIXTURE_ROOM);
    f->count = room;
    return sluiceGetTilesToMap(f->manager, id, &f->count, f->tiles);
}

SluiceResult fixture_to_map(struct fixture *f, SluiceTextureId id)
{
    return fixture_to_map_at_most(f, id, FIXTURE_ROOM);
}

SluiceResult fixture_to_unmap(struct fixture *f, SluiceTextureId id, uint64_t retire_value)
{
    f->count = FIXTURE_ROOM;
    return sluiceGetTilesToUnmap(f->manager, id, retire_value, &f->count, f->tiles);
}

SluiceResult fixture_to_cancel(struct fixture *f, SluiceTextureId id)
{
    f->count = FIXTURE_ROOM;
    return sluiceGetTilesToCancel(f->manager, id, &f->count, f->tiles);
}

void fixture_answer_mapped(struct fixture *f)
{
    for (uint32_t i = 0; i < f->count; i++)
        CHECK_OK(
            sluiceUpdateTilesMapping(f->manager, f->tiles[i].textureId, 1, &f->tiles[i].tileIndex));
}

void fixture_load(struct fixture *f)
{
    do {
        SluiceResult result = fixture_to_map(f, SLUICE_ALL_TEXTURES);
        assert_true(result >= 0);
        fixture_answer_mapped(f);
    } while (f->count);
}

bool fixture_listed(const struct fixture *f, SluiceTextureId id, uint32_t count,
                    const uint32_t *tiles)
{
    bool same = f->count == count;
    for (uint32_t i = 0; same && i < count; i++)
        same = f->tiles[i].textureId == id && f->tiles[i].tileIndex == tiles[i];
    for (uint32_t i = 0; !same && i < f->count; i++)
        print_error("listed[%u]: texture %#llx, tile %u\n", (unsigned)i,
                    (unsigned long long)f->tiles[i].textureId, (unsigned)f->tiles[i].tileIndex);
    return same;
}

SluiceTileState fixture_state(const struct fixture *f, SluiceTextureId id, uint32_t tile)
{
    SluiceTileState state = (SluiceTileState)-1;
    CHECK_OK(sluiceGetTileState(f->manager, id, tile, &state, NULL));
    return state;
}

SluiceTile fixture_tile(const struct fixture *f, SluiceTextureId id, uint32_t tile)
{
    SluiceTile out = {0};
    CHECK_OK(sluiceGetTileState(f->manager, id, tile, NULL, &out));
    return out;
}

SluiceStreamedTextureStatistics fixture_statistics(const struct fixture *f)
{
    SluiceStreamedTextureStatistics statistics = {.structSize = sizeof statistics};
    CHECK_OK(sluiceGetStatistics(f->manager, &statistics));
    return statistics;
}

SluiceStreamedTextureLayout fixture_layout(const struct fixture *f, SluiceTextureId id)
{
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    CHECK_OK(sluiceGetTextureLayout(f->manager, id, &layout));
    return layout;
}

void check_state(const struct fixture *f, SluiceTextureId id, uint32_t tile,
                 SluiceTileState expected, int line)
{
    static const char *const names[] = {"FREE",    "REQUESTED", "ALLOCATED", "MAPPED",
                                        "STANDBY", "CANCELED",  "FAILED",    "GIVEN_UP"};
    SluiceTileState state = fixture_state(f, id, tile);
    if (state != expected)
        fail_msg("line %d: tile %u is %s, not %s", line, (unsigned)tile,
                 (unsigned)state < 8 ? names[state] : "?", names[expected]);
}

static void hash(uint64_t *h, const void *data, size_t size)
{
    for (const uint8_t *p = data; size--; p++)
        *h = (*h ^ *p) * 0x100000001b3u; /* FNV-1a */
}

/* Field by field: padding has no fixed value. */
static void hash_number(uint64_t *h, uint64_t value)
{
    hash(h, &value, sizeof value);
}

static void hash_texture(uint64_t *h, const struct fixture *f, SluiceTextureId id)
{
    SluiceStreamedTextureLayout layout = fixture_layout(f, id);
    for (uint32_t i = 0; i < layout.tileCount; i++) {
        SluiceTileState state = fixture_state(f, id, i);
        hash_number(h, state);
        if (state >= SLUICE_TILE_STATE_ALLOCATED && state <= SLUICE_TILE_STATE_CANCELED) {
            SluiceTile tile = fixture_tile(f, id, i);
            hash_number(h, (uint64_t)tile.heapId << 32 | tile.slot);
        }
    }
    size_t size = (size_t)layout.minMipWidth * layout.minMipHeight;
    uint8_t *minmip = malloc(size);
    assert_non_null(minmip);
    CHECK_OK(sluiceWriteMinMipData(f->manager, id, layout.minMipWidth, size, minmip));
    hash(h, minmip, size);
    free(minmip);
}

static void hash_lists(uint64_t *h, const struct fixture *f)
{
    uint32_t count = 0;
    CHECK_OK(sluiceGetTilesToMap(f->manager, SLUICE_ALL_TEXTURES, &count, NULL));
    hash_number(h, count);
    CHECK_OK(sluiceGetTilesToCancel(f->manager, SLUICE_ALL_TEXTURES, &count, NULL));
    hash_number(h, count);
    CHECK_OK(sluiceGetTilesToUnmap(f->manager, SLUICE_ALL_TEXTURES, 0, &count, NULL));
    hash_number(h, count);
    CHECK_OK(sluiceGetGivenUpTiles(f->manager, &count, NULL));
    hash_number(h, count);
    CHECK_OK(sluiceGetMinMipUpdates(f->manager, &count, NULL));
    hash_number(h, count);
    CHECK_OK(sluiceGetEmptyHeaps(f->manager, &count, NULL));
    hash_number(h, count);
}

uint64_t fixture_digest(const struct fixture *f, uint32_t id_count, const SluiceTextureId *ids)
{
    const char *wrong = slc_manager_check(f->manager);
    assert_string_equal(wrong ? wrong : "", "");
    SluiceStreamedTextureStatistics s = fixture_statistics(f);
    const uint64_t numbers[] = {
        s.textureCount,     s.tileCount,        s.requestedTileCount, s.allocatedTileCount,
        s.mappedTileCount,  s.standbyTileCount, s.canceledTileCount,  s.failedTileCount,
        s.givenUpTileCount, s.heapCount,        s.retiringSlotCount,  s.freeSlotCount,
        s.handedOutTotal,   s.mappedTotal,      s.unmappedTotal,      s.canceledTotal,
        s.failedTotal,      s.restoredTotal,    s.movedTotal,         f->heaps.living_count,
    };
    uint64_t h = 0xcbf29ce484222325u;
    hash(&h, numbers, sizeof numbers);
    hash_lists(&h, f);
    for (uint32_t i = 0; i < id_count; i++)
        hash_texture(&h, f, ids[i]);
    return h;
}

uint32_t next_random(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(*state >> 33);
}
