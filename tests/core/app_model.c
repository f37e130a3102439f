#include "core/app_model.h"

#include <string.h>

static uint32_t below(struct app_model *a, uint32_t n)
{
    return next_random(&a->random) % n;
}

static void add_texture(struct app_model *a, uint32_t at)
{
    static const uint32_t sizes[][2] = {{257, 129}, {384, 384}, {640, 100}, {130, 515}};
    uint32_t shape = below(a, 4);
    SluiceStreamedTextureDesc desc = full_chain(sizes[shape][0], sizes[shape][1], 64, 64);
    desc.packedTileCount = 1 + below(a, 2);
    struct app_texture *t = &a->textures[at];
    memset(t, 0, sizeof *t);
    t->id = fixture_add(&a->f, &desc);
    t->tile_count = fixture_layout(&a->f, t->id).tileCount;
    assert_true(t->tile_count <= APP_TILES);
}

void app_open(struct app_model *a, uint64_t seed)
{
    memset(a, 0, sizeof *a);
    a->random = seed;
    a->time = seed % 2 ? 0 : UINT64_MAX - 50; /* wraps soon */
    fixture_open(&a->f, APP_CAPACITY, seed % 3 == 0);
    a->f.heaps.limit = seed % 2 ? 5 : APP_HEAPS;
    fixture_configure(&a->f, 6, 0, 3, 4);
    for (uint32_t i = 0; i < APP_TEXTURES; i++)
        add_texture(a, i);
}

static struct app_texture *find(struct app_model *a, SluiceTextureId id)
{
    for (uint32_t i = 0; i < APP_TEXTURES; i++)
        if (a->textures[i].id == id)
            return &a->textures[i];
    fail_msg("a list names a texture that is not there");
    return NULL;
}

static struct app_slot *slot_of(struct app_model *a, uint32_t heap, uint32_t slot)
{
    assert_true(heap < APP_HEAPS && a->f.heaps.living[heap] && slot < APP_CAPACITY);
    return &a->slots[heap][slot];
}

/* The slot must be one that nobody holds and nothing reads any more. */
static void take_slot(struct app_model *a, uint32_t heap, uint32_t slot)
{
    struct app_slot *s = slot_of(a, heap, slot);
    assert_true(!s->held && s->retire <= a->completed);
    *s = (struct app_slot){.held = true};
}

static void leave_slot(struct app_model *a, uint32_t heap, uint32_t slot, uint64_t retire)
{
    struct app_slot *s = slot_of(a, heap, slot);
    assert_true(s->held);
    *s = (struct app_slot){.retire = retire > a->completed ? retire : 0};
}

static void drop_tile(struct app_model *a, struct app_texture *t, uint32_t tile, uint64_t retire)
{
    leave_slot(a, t->heap[tile], t->slot[tile], retire);
    t->tiles[tile] = APP_NOTHING;
}

/* A new value, the last one again, or at once. */
static uint64_t any_retire(struct app_model *a)
{
    uint32_t dice = below(a, 4);
    if (dice == 0)
        return 0;
    return a->retire += dice % 2;
}

void app_feed(struct app_model *a)
{
    struct app_texture *t = &a->textures[below(a, APP_TEXTURES)];
    SluiceStreamedTextureLayout layout = fixture_layout(&a->f, t->id);
    uint8_t map[64];
    uint32_t regions = layout.feedbackWidth * layout.feedbackHeight, rare = 1 + below(a, 12);
    assert_true(regions <= sizeof map);
    for (uint32_t i = 0; i < regions; i++)
        map[i] = below(a, rare) ? SLUICE_MIP_UNTOUCHED : (uint8_t)below(a, 4);
    fixture_feed_map(&a->f, t->id, map, a->time += below(a, 3), below(a, 6));
    CHECK_SOUND(&a->f);
}

void app_read_map_list(struct app_model *a)
{
    assert_true(fixture_to_map_at_most(&a->f, SLUICE_ALL_TEXTURES, below(a, 20)) >= 0);
    CHECK_SOUND(&a->f);
    for (uint32_t i = 0; i < a->f.count; i++) {
        const SluiceTile *tile = &a->f.tiles[i];
        struct app_texture *t = find(a, tile->textureId);
        assert_true(tile->tileIndex < t->tile_count);
        assert_int_equal(t->tiles[tile->tileIndex], APP_NOTHING); /* loaded once at a time */
        take_slot(a, tile->heapId, tile->slot);
        t->tiles[tile->tileIndex] = APP_LOADING;
        t->heap[tile->tileIndex] = tile->heapId;
        t->slot[tile->tileIndex] = tile->slot;
        a->handed_out++;
    }
}

void app_read_cancel_list(struct app_model *a)
{
    CHECK_OK(fixture_to_cancel(&a->f, SLUICE_ALL_TEXTURES));
    CHECK_SOUND(&a->f);
    for (uint32_t i = 0; i < a->f.count; i++) {
        const SluiceTile *tile = &a->f.tiles[i];
        struct app_texture *t = find(a, tile->textureId);
        assert_int_equal(t->tiles[tile->tileIndex], APP_LOADING); /* under way, not listed yet */
        assert_true(t->heap[tile->tileIndex] == tile->heapId);
        assert_true(t->slot[tile->tileIndex] == tile->slot);
        t->tiles[tile->tileIndex] = APP_CANCELING;
    }
}

void app_read_unmap_list(struct app_model *a)
{
    uint64_t retire = any_retire(a);
    a->f.count = 1 + below(a, 20);
    assert_true(sluiceGetTilesToUnmap(a->f.manager, SLUICE_ALL_TEXTURES, retire, &a->f.count,
                                      a->f.tiles) >= 0);
    CHECK_SOUND(&a->f);
    for (uint32_t i = 0; i < a->f.count; i++) {
        const SluiceTile *tile = &a->f.tiles[i];
        struct app_texture *t = find(a, tile->textureId);
        assert_int_equal(t->tiles[tile->tileIndex], APP_BOUND);
        assert_true(t->heap[tile->tileIndex] == tile->heapId);
        assert_true(t->slot[tile->tileIndex] == tile->slot);
        drop_tile(a, t, tile->tileIndex, retire);
        a->unbound++;
    }
}

static void answer_tile(struct app_model *a, struct app_texture *t, uint32_t tile)
{
    SluiceStreamedTextureManager *m = a->f.manager;
    uint32_t dice = below(a, 6);
    uint64_t retire = 0;
    if (dice == 0) {
        SOUND(&a->f, sluiceReportFailedTiles(m, t->id, 1, &tile, a->time));
        drop_tile(a, t, tile, 0);
    } else if (dice == 1 || t->tiles[tile] == APP_CANCELING) {
        retire = any_retire(a);
        SOUND(&a->f, sluiceReportCanceledTiles(m, t->id, 1, &tile, retire));
        drop_tile(a, t, tile, retire);
    } else {
        SOUND(&a->f, sluiceUpdateTilesMapping(m, t->id, 1, &tile));
        t->tiles[tile] = APP_BOUND;
        a->bound++;
    }
}

/* Answers for a tile that the manager did not list. All answers are refused. */
static void answer_wrongly(struct app_model *a, struct app_texture *t, uint32_t tile)
{
    SluiceStreamedTextureManager *m = a->f.manager;
    const SluiceResult refused = SLUICE_ERROR_INVALID_TILE_STATE;
    CHECK_RESULT(sluiceUpdateTilesMapping(m, t->id, 1, &tile), refused);
    CHECK_RESULT(sluiceReportFailedTiles(m, t->id, 1, &tile, a->time), refused);
    CHECK_RESULT(sluiceReportCanceledTiles(m, t->id, 1, &tile, a->retire), refused);
    CHECK_SOUND(&a->f);
}

void app_answer(struct app_model *a, uint32_t one_in)
{
    for (uint32_t i = 0; i < APP_TEXTURES; i++) {
        struct app_texture *t = &a->textures[i];
        for (uint32_t tile = 0; tile < t->tile_count; tile++) {
            bool asked = t->tiles[tile] == APP_LOADING || t->tiles[tile] == APP_CANCELING;
            if (asked && below(a, one_in) == 0)
                answer_tile(a, t, tile);
            else if (!asked && below(a, 40) == 0)
                answer_wrongly(a, t, tile);
        }
    }
}

static void remove_texture(struct app_model *a, struct app_texture *t, uint64_t retire)
{
    SOUND(&a->f, sluiceRemoveStreamedTexture(a->f.manager, t->id, retire));
    for (uint32_t tile = 0; tile < t->tile_count; tile++) {
        bool asked = t->tiles[tile] == APP_LOADING || t->tiles[tile] == APP_CANCELING;
        if (asked) /* its load ends later than its texture */
            CHECK_RESULT(sluiceUpdateTilesMapping(a->f.manager, t->id, 1, &tile),
                         SLUICE_ERROR_STALE_TEXTURE);
        if (t->tiles[tile] != APP_NOTHING)
            drop_tile(a, t, tile, retire);
    }
    a->removed++;
}

void app_replace_texture(struct app_model *a)
{
    uint32_t at = below(a, APP_TEXTURES);
    remove_texture(a, &a->textures[at], any_retire(a));
    add_texture(a, at);
    CHECK_SOUND(&a->f);
}

void app_defragment(struct app_model *a)
{
    SluiceTileMove moves[8];
    uint32_t count = 1 + below(a, 8);
    uint64_t retire = any_retire(a);
    SOUND(&a->f, sluiceDefragmentTiles(a->f.manager, retire, &count, moves));
    for (uint32_t i = 0; i < count; i++) { /* in order: a tile may move twice */
        struct app_texture *t = find(a, moves[i].from.textureId);
        uint32_t tile = moves[i].from.tileIndex;
        assert_int_equal(t->tiles[tile], APP_BOUND);
        assert_true(t->heap[tile] == moves[i].from.heapId && t->slot[tile] == moves[i].from.slot);
        take_slot(a, moves[i].heapId, moves[i].slot);
        leave_slot(a, t->heap[tile], t->slot[tile], retire);
        t->heap[tile] = moves[i].heapId;
        t->slot[tile] = moves[i].slot;
    }
}

/* A heap is released exactly if the application knows that nothing uses a slot of it. */
void app_release_heaps(struct app_model *a)
{
    for (uint32_t h = 0; h < APP_HEAPS; h++) {
        bool in_use = false, alive = a->f.heaps.living[h];
        for (uint32_t s = 0; s < APP_CAPACITY; s++)
            in_use |= a->slots[h][s].held || a->slots[h][s].retire > a->completed;
        CHECK_RESULT(sluiceReleaseHeap(a->f.manager, h), !alive   ? SLUICE_ERROR_UNKNOWN_HEAP
                                                         : in_use ? SLUICE_ERROR_HEAP_IN_USE
                                                                  : SLUICE_SUCCESS);
        CHECK_SOUND(&a->f);
    }
}

void app_complete(struct app_model *a)
{
    uint64_t behind = a->retire - a->completed;
    a->completed += behind ? below(a, (uint32_t)behind + 1) : 0;
    SOUND(&a->f, sluiceCompleteRetireValue(a->f.manager, a->completed));
}

static void check_tile(const struct app_model *a, const struct app_texture *t, uint32_t tile)
{
    SluiceTileState s = fixture_state(&a->f, t->id, tile);
    SluiceTile place = fixture_tile(&a->f, t->id, tile);
    switch (t->tiles[tile]) {
    case APP_NOTHING:
        assert_true(s == SLUICE_TILE_STATE_FREE || s == SLUICE_TILE_STATE_REQUESTED ||
                    s == SLUICE_TILE_STATE_FAILED || s == SLUICE_TILE_STATE_GIVEN_UP);
        return;
    case APP_LOADING:
        assert_true(s == SLUICE_TILE_STATE_ALLOCATED || s == SLUICE_TILE_STATE_CANCELED);
        break;
    case APP_CANCELING: assert_int_equal(s, SLUICE_TILE_STATE_CANCELED); break;
    case APP_BOUND:
        assert_true(s == SLUICE_TILE_STATE_MAPPED || s == SLUICE_TILE_STATE_STANDBY);
        break;
    }
    assert_true(place.heapId == t->heap[tile] && place.slot == t->slot[tile]);
}

void app_check(const struct app_model *a)
{
    uint32_t retiring = 0, free_slots = 0, heaps = 0;
    for (uint32_t i = 0; i < APP_TEXTURES; i++)
        for (uint32_t tile = 0; tile < a->textures[i].tile_count; tile++)
            check_tile(a, &a->textures[i], tile);
    for (uint32_t h = 0; h < APP_HEAPS; h++) {
        heaps += a->f.heaps.living[h];
        for (uint32_t s = 0; s < APP_CAPACITY && a->f.heaps.living[h]; s++) {
            bool waits = a->slots[h][s].retire > a->completed;
            retiring += waits;
            free_slots += !waits && !a->slots[h][s].held;
        }
    }
    SluiceStreamedTextureStatistics now = fixture_statistics(&a->f);
    assert_int_equal(now.retiringSlotCount, retiring);
    assert_int_equal(now.freeSlotCount, free_slots);
    assert_int_equal(now.heapCount, heaps);
    assert_int_equal(now.handedOutTotal, a->handed_out);
    assert_int_equal(now.mappedTotal, a->bound);
    assert_int_equal(now.unmappedTotal, a->unbound);
}

void app_close(struct app_model *a)
{
    for (uint32_t i = 0; i < APP_TEXTURES; i++)
        remove_texture(a, &a->textures[i], ++a->retire);
    a->completed = a->retire;
    SOUND(&a->f, sluiceCompleteRetireValue(a->f.manager, a->completed));
    SluiceStreamedTextureStatistics now = fixture_statistics(&a->f);
    assert_int_equal(now.freeSlotCount, now.heapCount * APP_CAPACITY);
    app_release_heaps(a);
    assert_int_equal(a->f.heaps.living_count, 0);
    fixture_close(&a->f);
}
