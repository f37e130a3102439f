#include "core/fixture.h"

#include "core/check.h"

#include <string.h>

/* A call with all its arguments, so that it can be repeated. */
struct op {
    uint32_t kind;
    SluiceTextureId a, b;
    uint32_t number, room;
    uint64_t time, retire;
    uint8_t map[64];
    uint32_t count;
    uint32_t tiles[16];
};

enum { KIND_COUNT = 19 };

static SluiceStreamedTextureDesc op_desc(uint32_t number)
{
    static const uint32_t sizes[][4] = {{256, 256, 128, 128},
                                        {1000, 600, 128, 128},
                                        {513, 513, 128, 64},
                                        {64, 64, 128, 128},
                                        {1, 700, 1, 128}};
    const uint32_t *s = sizes[number % 5];
    return full_chain(s[0], s[1], s[2], s[3]);
}

static uint64_t mix(uint64_t h, uint64_t value)
{
    h = (h ^ value) * 0x9E3779B97F4A7C15u;
    return h ^ h >> 29;
}

static uint64_t mix_tiles(uint64_t h, uint32_t count, const SluiceTile *tiles)
{
    for (uint32_t i = 0; i < count; i++) {
        h = mix(h, tiles[i].textureId);
        h = mix(h, (uint64_t)tiles[i].tileIndex << 32 | tiles[i].slot);
        h = mix(h, tiles[i].heapId);
    }
    return mix(h, count);
}

static SluiceResult feed(struct fixture *f, const struct op *op)
{
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    SluiceResult result = sluiceGetTextureLayout(f->manager, op->a, &layout);
    if (result)
        return result;
    SluiceFeedbackDesc feedback = {sizeof feedback,       op->map, layout.feedbackWidth,
                                   layout.feedbackHeight, 0,       0};
    assert_true(feedback.width * feedback.height <= sizeof op->map);
    return sluiceUpdateWithSamplerFeedback(f->manager, op->a, &feedback, op->time, 6);
}

static SluiceResult list(struct fixture *f, const struct op *op, uint64_t *out)
{
    SluiceResult result;
    SluiceTileMove moves[16];
    SluiceMinMipRect rects[16];
    uint32_t count = op->room;
    SluiceTextureId scope = op->number % 3 ? SLUICE_ALL_TEXTURES : op->a;
    switch (op->kind) {
    case 5:
    case 6:
    case 7: result = sluiceGetTilesToMap(f->manager, scope, &count, f->tiles); break;
    case 8: result = sluiceGetTilesToUnmap(f->manager, scope, op->retire, &count, f->tiles); break;
    case 9: result = sluiceGetTilesToCancel(f->manager, scope, &count, f->tiles); break;
    case 10: result = sluiceGetGivenUpTiles(f->manager, &count, f->tiles); break;
    case 11:
        result = sluiceDefragmentTiles(f->manager, op->retire, &count, moves);
        for (uint32_t i = 0; i < count && result >= 0; i++)
            *out = mix(mix_tiles(*out, 1, &moves[i].from), moves[i].slot);
        return result;
    default:
        result = sluiceGetMinMipUpdates(f->manager, &count, rects);
        for (uint32_t i = 0; i < count && result >= 0; i++)
            *out = mix(*out, rects[i].textureId ^ rects[i].x << 8 ^ rects[i].width);
        return result;
    }
    if (result >= 0)
        *out = mix_tiles(*out, count, f->tiles);
    else
        assert_int_equal(count, op->room);
    f->count = count;
    return result;
}

static SluiceResult apply(struct fixture *f, const struct op *op, uint64_t *out)
{
    SluiceStreamedTextureManager *m = f->manager;
    SluiceStreamedTextureDesc desc = op_desc(op->number);
    SluiceStreamedTextureManagerConfig config = {sizeof config,  op->number % 9, 0, 2, 3,
                                                 op->number % 2, op->number % 5};
    const SluiceUvTransform eight = {.scaleU = 8, .scaleV = 8, .offsetU = 0.5f};
    SluiceTextureId id = 0;
    SluiceResult result;
    switch (op->kind) {
    case 0:
        result = sluiceAddStreamedTexture(m, &desc, &id);
        *out = mix(*out, result ? 0 : id);
        return result;
    case 1:
        if (op->number % 4 == 1)
            return sluiceForgetStreamedTexture(m, op->a, op->retire);
        if (op->number % 4 == 2)
            return sluiceEvictStreamedTexture(m, op->a, op->number % 5);
        return op->number % 4 ? SLUICE_SUCCESS : sluiceRemoveStreamedTexture(m, op->a, op->retire);
    case 2:
    case 3: return feed(f, op);
    case 4: return sluiceMatchPrimaryTexture(m, op->a, op->b, op->time, 6);
    case 13:
    case 14: return sluiceUpdateTilesMapping(m, op->a, op->count, op->tiles);
    case 15: return sluiceReportFailedTiles(m, op->a, op->count, op->tiles, op->time);
    case 16: return sluiceReportCanceledTiles(m, op->a, op->count, op->tiles, op->retire);
    case 17:
        if (op->number % 3 == 0)
            return sluiceSetPrimaryTexture(m, op->a, op->number % 2 ? op->b : SLUICE_NO_TEXTURE);
        if (op->number % 12 == 5)
            return sluiceSetUvTransform(m, op->a, &eight);
        return op->number % 3 == 1 ? sluiceRetryFailedTiles(m, op->a) : sluiceSetConfig(m, &config);
    case 18:
        if (op->number % 3 == 0)
            return sluiceTrimStandbyTiles(m, op->number % 7);
        return op->number % 3 == 1 ? sluiceCompleteRetireValue(m, op->retire - 1)
                                   : sluiceReleaseHeap(m, op->number % 4);
    default: return list(f, op, out);
    }
}

/* Chooses tiles of the texture that await an answer. */
static void choose_answers(const struct fixture *f, struct op *op, uint64_t *random)
{
    uint32_t count = fixture_layout(f, op->a).tileCount;
    for (uint32_t i = 0; i < count && op->count < 16; i++) {
        SluiceTileState s = fixture_state(f, op->a, i);
        if ((s == SLUICE_TILE_STATE_ALLOCATED || s == SLUICE_TILE_STATE_CANCELED) &&
            next_random(random) % 4)
            op->tiles[op->count++] = i;
    }
}

static struct op random_op(const struct fixture *f, uint32_t id_count, const SluiceTextureId *ids,
                           uint32_t step, uint64_t *random)
{
    struct op op = {.kind = id_count ? next_random(random) % KIND_COUNT : 0,
                    .number = next_random(random) >> 3,
                    .time = UINT64_MAX - 100 + step / 3,
                    .retire = 1 + step / 5};
    if (op.kind == 0 && id_count >= 12)
        op.kind = 2;
    op.room = op.number % 17;
    if (!id_count)
        return op;
    op.a = ids[next_random(random) % id_count];
    op.b = ids[next_random(random) % id_count];
    for (uint32_t i = 0; i < sizeof op.map; i++)
        op.map[i] = next_random(random) % 4 ? SLUICE_MIP_UNTOUCHED : next_random(random) % 4;
    if (op.kind >= 13 && op.kind <= 16)
        choose_answers(f, &op, random);
    return op;
}

/* Tracks the ids of live textures, without assuming that the lowest free index comes first. */
static uint32_t update_ids(struct fixture *f, uint32_t count, SluiceTextureId *ids,
                           SluiceTextureId added)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; i++)
        if (sluiceGetTileState(f->manager, ids[i], 0, NULL, NULL) == SLUICE_SUCCESS)
            ids[kept++] = ids[i];
    if (added)
        ids[kept++] = added;
    return kept;
}

/*
 * Makes the call with 0, 1, 2, ... allowed allocations until it succeeds, and counts the refusals.
 * If memory ran out after some tiles were handed out, treats their number as the list's room.
 */
static uint32_t apply_under_pressure(struct fixture *f, struct op *op, uint32_t id_count,
                                     const SluiceTextureId *ids, uint64_t *out,
                                     SluiceResult *result)
{
    uint64_t digest = fixture_digest(f, id_count, ids);
    for (uint32_t n = 0;; n++) {
        uint64_t bytes = f->memory.live_bytes, hash = *out;
        f->memory.refuse_from = f->memory.calls + n;
        *result = apply(f, op, &hash);
        bool refused = f->memory.calls > f->memory.refuse_from;
        f->memory.refuse_from = UINT64_MAX;
        if (refused && *result == SLUICE_INCOMPLETE && op->kind >= 5 && op->kind <= 8)
            op->room = f->count;
        if (*result != SLUICE_ERROR_OUT_OF_HOST_MEMORY) {
            *out = hash;
            return n;
        }
        assert_null(slc_manager_check(f->manager));
        assert_true(fixture_digest(f, id_count, ids) == digest);
        assert_true(f->memory.live_bytes >= bytes); /* room may be kept for the next attempt */
        assert_true(fixture_statistics(f).hostMemorySize == f->memory.live_bytes);
        assert_true(n < 1000);
    }
}

/* A run with refused allocations and one without must decide alike, call by call. */
static void check_run(uint64_t seed, bool always_packed, uint32_t refused[KIND_COUNT])
{
    struct fixture pressed, calm;
    fixture_open(&pressed, 5, always_packed);
    fixture_open(&calm, 5, always_packed);
    pressed.heaps.limit = calm.heaps.limit = 14;
    SluiceTextureId ids[16];
    uint32_t count = 0;
    uint64_t random = seed;
    for (uint32_t step = 0; step < 300; step++) {
        struct op op = random_op(&calm, count, ids, step, &random);
        uint64_t a = 1, b = 1;
        SluiceResult result;
        refused[op.kind] += apply_under_pressure(&pressed, &op, count, ids, &b, &result);
        CHECK_RESULT(apply(&calm, &op, &a), result);
        assert_true(a == b);
        SluiceTextureId added = 0;
        if (op.kind == 0) { /* the newest is the one of the greatest generation */
            for (uint64_t i = 0; i < 16 && !added; i++)
                for (uint64_t g = 0; g < 600 && !added; g++)
                    if (a == mix(1, g << 32 | i))
                        added = g << 32 | i;
            assert_true(added);
        }
        count = update_ids(&calm, count, ids, added);
        assert_true(fixture_digest(&calm, count, ids) == fixture_digest(&pressed, count, ids));
    }
    fixture_close(&pressed);
    fixture_close(&calm);
}

static void every_call_survives_every_refused_allocation(void **state)
{
    (void)state;
    uint32_t refused[KIND_COUNT] = {0};
    for (uint64_t seed = 1; seed <= 40; seed++)
        check_run(seed, seed % 2, refused);
    static const uint32_t allocating[] = {0, 2, 4, 7}; /* the pressure was really felt */
    for (uint32_t i = 0; i < 4; i++)
        assert_true(refused[allocating[i]] > 0);
}

static SluiceResult take_heap(void *user, uint64_t size, uint32_t *id)
{
    (void)user, (void)size;
    *id = 1;
    return SLUICE_SUCCESS;
}

static void give_heap(void *user, uint32_t id)
{
    (void)user, (void)id;
}

static void creating_a_locked_manager_without_memory_leaks_nothing(void **state)
{
    (void)state;
    const bool locked = true;
    struct failing_allocator memory;
    SluiceStreamedTextureManagerCreateInfo info = {
        .structSize = sizeof info,
        .heapAllocator = {NULL, take_heap, give_heap},
        .pAllocator = &memory.callbacks,
        .heapTileCapacity = 256,
        .tileSize = 65536,
        .pLocked = &locked,
    };
    SluiceStreamedTextureManager *manager;
    failing_allocator_init(&memory, 1); /* the manager, and nothing for its heaps */
    CHECK_RESULT(sluiceCreateStreamedTextureManager(&info, &manager),
                 SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    assert_int_equal(memory.live_count, 0);
}

static void creation_survives_every_refused_allocation(void **state)
{
    (void)state;
    struct failing_allocator memory;
    SluiceStreamedTextureManagerCreateInfo info = {
        .structSize = sizeof info,
        .heapAllocator = {NULL, take_heap, give_heap},
        .pAllocator = &memory.callbacks,
        .heapTileCapacity = 256,
        .tileSize = 65536,
    };
    SluiceStreamedTextureManager *manager = NULL;
    uint64_t n = 0;
    SluiceResult result;
    do {
        failing_allocator_init(&memory, n++);
        manager = (SluiceStreamedTextureManager *)(uintptr_t)16;
        result = sluiceCreateStreamedTextureManager(&info, &manager);
        if (result) {
            assert_null(manager);
            assert_int_equal(memory.live_count, 0);
        }
    } while (result == SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    CHECK_OK(result);
    assert_true(n > 1);
    sluiceDestroyStreamedTextureManager(manager);
    assert_int_equal(memory.live_count, 0);
}

/* If no memory is left to track a new heap's slots, the heap is released or stays usable. */
static void a_heap_is_never_lost_for_lack_of_memory(void **state)
{
    (void)state;
    for (uint32_t n = 0;; n++) {
        struct fixture f;
        fixture_open(&f, 64, false);
        SluiceTextureId id = fixture_add_small(&f);
        fixture_feed(&f, id, 0, 0, 0);
        f.memory.refuse_from = f.memory.calls + n;
        SluiceResult result = fixture_to_map(&f, id);
        assert_int_equal(fixture_statistics(&f).heapCount, f.heaps.living_count);
        f.memory.refuse_from = UINT64_MAX;
        if (result == SLUICE_ERROR_OUT_OF_HOST_MEMORY) {
            assert_int_equal(f.heaps.living_count, 0);
            CHECK_OK(fixture_to_map(&f, id));
        } else {
            CHECK_OK(result);
        }
        assert_int_equal(f.count, 6);
        fixture_close(&f);
        if (!result)
            break;
    }
}

/* 32 slots hold fine tiles, one coarser tile is requested, and every node is used. */
static SluiceTextureId open_with_a_displaced_tile(struct fixture *f)
{
    fixture_open(f, 16, true);
    fixture_configure(f, 0, 2, 0, 0);
    SluiceStreamedTextureDesc desc = full_chain(512, 512, 128, 128), last = {0};
    SluiceTextureId ids[3];
    for (uint32_t i = 0; i < 3; i++)
        ids[i] = fixture_add(f, &desc);
    fixture_feed(f, ids[0], 0, 1, 100);
    fixture_feed(f, ids[1], 0, 1, 100);
    CHECK_RESULT(fixture_to_map(f, SLUICE_ALL_TEXTURES), SLUICE_BUDGET_REACHED);
    fixture_answer_mapped(f);
    f->count = 0;
    for (uint64_t time = 2; f->count == 0; time++) { /* until the coarse request has waited */
        assert_true(time < 10);
        for (uint32_t i = 0; i < 3; i++)
            fixture_feed(f, ids[i], i == 2 ? 2 : 0, time, 100);
        CHECK_RESULT(fixture_to_map(f, SLUICE_ALL_TEXTURES), SLUICE_BUDGET_REACHED);
        CHECK_OK(sluiceGetTilesToUnmap(f->manager, SLUICE_ALL_TEXTURES, 0, &f->count, NULL));
    }
    SluiceStreamedTextureStatistics s = fixture_statistics(f);
    last = (SluiceStreamedTextureDesc){
        .width = 1, .height = 1, .mipLevelCount = 1, .tileWidth = 1, .tileHeight = 1};
    last.packedTileCount = 1023 - (s.requestedTileCount + s.allocatedTileCount + s.mappedTileCount +
                                   s.standbyTileCount);
    fixture_add(f, &last);
    return ids[0];
}

static void a_displaced_tile_is_unmapped_once_there_is_memory_for_its_request(void **state)
{
    (void)state;
    for (uint64_t retire = 0; retire < 2; retire++) {
        struct fixture f;
        SluiceTextureId id = open_with_a_displaced_tile(&f);
        uint64_t digest = fixture_digest(&f, 1, &id);
        f.memory.refuse_from = f.memory.calls;
        if (retire) {
            f.count = FIXTURE_ROOM;
            CHECK_RESULT(
                sluiceGetTilesToUnmap(f.manager, SLUICE_ALL_TEXTURES, retire, &f.count, f.tiles),
                SLUICE_ERROR_OUT_OF_HOST_MEMORY);
            assert_int_equal(f.count, FIXTURE_ROOM);
            assert_true(fixture_digest(&f, 1, &id) == digest);
            assert_null(slc_manager_check(f.manager));
            f.memory.refuse_from = UINT64_MAX;
        }
        CHECK_OK(fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, retire));
        assert_true(f.count > 0);
        check_state(&f, f.tiles[0].textureId, f.tiles[0].tileIndex, SLUICE_TILE_STATE_REQUESTED,
                    __LINE__);
        f.memory.refuse_from = UINT64_MAX;
        fixture_close(&f);
    }
}

/* A retiring slot needs a node. 1023 nodes are available without an allocation. */
static void unmapping_ends_where_memory_does_and_goes_on_later(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 850, false);
    f.heaps.limit = 1;
    SluiceStreamedTextureDesc fine = {850 * 16, 16, 1, 1, 0, 16, 16, 0, 0};
    SluiceStreamedTextureDesc packed = {1, 1, 1, 0, 160, 1, 1, 0, 0};
    SluiceTextureId a = fixture_add(&f, &fine), b = fixture_add(&f, &packed);
    fixture_feed(&f, a, 0, 1, 100);
    CHECK_RESULT(fixture_to_map(&f, SLUICE_ALL_TEXTURES), SLUICE_BUDGET_REACHED);
    assert_int_equal(f.count, 850 - 53); /* the reserve is a sixteenth */
    fixture_answer_mapped(&f);
    fixture_feed(&f, b, 0, 1, 100);
    CHECK_RESULT(fixture_to_map(&f, SLUICE_ALL_TEXTURES), SLUICE_BUDGET_REACHED);
    const uint32_t left = 1023 - 850 - 160;
    f.memory.refuse_from = f.memory.calls;
    CHECK_RESULT(fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 1), SLUICE_INCOMPLETE);
    assert_int_equal(f.count, left);
    assert_null(slc_manager_check(f.manager));
    CHECK_RESULT(fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 2), SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    f.memory.refuse_from = UINT64_MAX;
    CHECK_OK(fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, 1)); /* the refused call brought no value */
    assert_int_equal(f.count, 160 - left);
    assert_int_equal(fixture_statistics(&f).retiringSlotCount, 160);
    assert_int_equal(fixture_statistics(&f).unmappedTotal, 160);
    fixture_close(&f);
}

/* Memory for the nodes of a texture that is too large is freed. */
static void a_texture_that_is_too_large_leaves_nothing_behind(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, true);
    fixture_add_small(&f);
    uint64_t before = f.memory.live_bytes;
    SluiceStreamedTextureDesc d = {
        .width = 1, .height = 1, .mipLevelCount = 1, .tileWidth = 1, .tileHeight = 1};
    d.packedTileCount = 100000;
    SluiceTextureId id;
    f.memory.refuse_from = f.memory.calls + 50;
    CHECK_RESULT(sluiceAddStreamedTexture(f.manager, &d, &id), SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    f.memory.refuse_from = UINT64_MAX;
    assert_true(f.memory.live_bytes < before + 4096); /* memory of the table of chunks */
    fixture_close(&f);
}

/* Fills two heaps of two slots while a fifth tile waits. Returns the heap of the fifth tile after
 * one tile of each heap was freed. */
static uint32_t heap_of_the_fifth_tile(bool fails_before)
{
    struct fixture f;
    SluiceTextureId ids[5];
    const SluiceStreamedTextureDesc desc = full_chain(64, 64, 128, 128); /* one packed tile */
    fixture_open(&f, 2, true);
    for (uint32_t i = 0; i < 4; i++)
        ids[i] = fixture_add(&f, &desc);
    fixture_load(&f);
    assert_int_equal(fixture_statistics(&f).heapCount, 2);
    ids[4] = fixture_add(&f, &desc);
    if (fails_before) {
        f.memory.refuse_from = f.memory.calls;
        CHECK_RESULT(fixture_to_map(&f, SLUICE_ALL_TEXTURES), SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        f.memory.refuse_from = UINT64_MAX;
    }
    CHECK_OK(sluiceRemoveStreamedTexture(f.manager, ids[0], 0));
    CHECK_OK(sluiceRemoveStreamedTexture(f.manager, ids[2], 0));
    CHECK_OK(fixture_to_map(&f, SLUICE_ALL_TEXTURES));
    assert_true(LISTED(&f, ids[4], 0));
    uint32_t heap = f.tiles[0].heapId;
    fixture_close(&f);
    return heap;
}

static void a_failed_hand_out_keeps_equal_heaps_in_order(void **state)
{
    (void)state;
    assert_int_equal(heap_of_the_fifth_tile(true), heap_of_the_fifth_tile(false));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_call_survives_every_refused_allocation),
        cmocka_unit_test(creation_survives_every_refused_allocation),
        cmocka_unit_test(creating_a_locked_manager_without_memory_leaks_nothing),
        cmocka_unit_test(a_heap_is_never_lost_for_lack_of_memory),
        cmocka_unit_test(a_displaced_tile_is_unmapped_once_there_is_memory_for_its_request),
        cmocka_unit_test(unmapping_ends_where_memory_does_and_goes_on_later),
        cmocka_unit_test(a_texture_that_is_too_large_leaves_nothing_behind),
        cmocka_unit_test(a_failed_hand_out_keeps_equal_heaps_in_order),
    };
    return RUN_TESTS(tests);
}
