#include "core/fixture.h"

static uint32_t index_of(SluiceTextureId id)
{
    return (uint32_t)id;
}

static uint32_t generation_of(SluiceTextureId id)
{
    return (uint32_t)(id >> 32);
}

static void remove_texture(struct fixture *f, SluiceTextureId id)
{
    CHECK_OK(sluiceRemoveStreamedTexture(f->manager, id, 0));
}

static void indices_are_dense_and_the_lowest_comes_first(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    SluiceTextureId ids[40];
    for (uint32_t i = 0; i < 40; i++) {
        ids[i] = fixture_add_small(&f);
        assert_int_equal(index_of(ids[i]), i);
    }
    static const uint32_t removed[] = {31, 5, 39, 0, 17};
    for (uint32_t i = 0; i < 5; i++)
        remove_texture(&f, ids[removed[i]]);
    static const uint32_t expected[] = {0, 5, 17, 31, 39, 40};
    for (uint32_t i = 0; i < 6; i++)
        assert_int_equal(index_of(fixture_add_small(&f)), expected[i]);
    assert_int_equal(fixture_statistics(&f).textureCount, 41);
    assert_int_equal(fixture_statistics(&f).tileCount, 41 * 6);
    fixture_close(&f);
}

static void indices_stay_dense_whatever_is_removed(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    SluiceTextureId ids[300] = {0};
    uint64_t random = 6;
    for (uint32_t round = 0; round < 3000; round++) {
        uint32_t lowest = 0, at = next_random(&random) % 300;
        while (lowest < 300 && ids[lowest])
            lowest++;
        if (lowest < 300 && next_random(&random) % 300 > lowest / 2) {
            SluiceTextureId id = fixture_add_small(&f);
            assert_int_equal(index_of(id), lowest);
            ids[lowest] = id;
        } else if (ids[at]) {
            remove_texture(&f, ids[at]);
            ids[at] = 0;
        }
    }
    fixture_close(&f);
}

static void generations_are_never_used_again(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    SluiceTextureId old[200];
    for (uint32_t i = 0; i < 200; i++) {
        old[i] = fixture_add_small(&f);
        assert_int_equal(index_of(old[i]), 0);
        assert_true(old[i] != 0);
        for (uint32_t j = 0; j < i; j++)
            assert_int_not_equal(generation_of(old[i]), generation_of(old[j]));
        remove_texture(&f, old[i]);
    }
    fixture_add_small(&f);
    for (uint32_t i = 0; i < 200; i++)
        CHECK_RESULT(sluiceGetTileState(f.manager, old[i], 0, NULL, NULL),
                     SLUICE_ERROR_STALE_TEXTURE);
    fixture_close(&f);
}

/* Every call that takes an id; all of them must say the same about it and change nothing. */
static void check_id_refused(struct fixture *f, SluiceTextureId good, SluiceTextureId bad,
                             SluiceResult expected)
{
    SluiceStreamedTextureManager *m = f->manager;
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    const uint8_t map[4] = {0};
    uint8_t out[4];
    SluiceFeedbackDesc feedback = {sizeof feedback, map, 2, 2, 0, 0};
    SluiceTile tiles[4];
    SluiceMinMipRect rect = {bad, 0, 0, 1, 1};
    uint32_t count = 4, tile = 0;
    uint64_t digest = fixture_digest(f, 1, &good);
    CHECK_RESULT(sluiceRemoveStreamedTexture(m, bad, 0), expected);
    CHECK_RESULT(sluiceGetTextureLayout(m, bad, &layout), expected);
    CHECK_RESULT(sluiceUpdateWithSamplerFeedback(m, bad, &feedback, 5, 5), expected);
    CHECK_RESULT(sluiceMatchPrimaryTexture(m, bad, good, 5, 5), expected);
    CHECK_RESULT(sluiceMatchPrimaryTexture(m, good, bad, 5, 5), expected);
    CHECK_RESULT(sluiceUpdateTilesMapping(m, bad, 1, &tile), expected);
    CHECK_RESULT(sluiceReportFailedTiles(m, bad, 1, &tile, 5), expected);
    CHECK_RESULT(sluiceReportCanceledTiles(m, bad, 1, &tile, 0), expected);
    CHECK_RESULT(sluiceWriteMinMipData(m, bad, 2, 4, out), expected);
    CHECK_RESULT(sluiceWriteMinMipRect(m, &rect, 2, 4, out), expected);
    CHECK_RESULT(sluiceGetTileState(m, bad, 0, NULL, tiles), expected);
    CHECK_RESULT(sluiceSetPrimaryTexture(m, bad, good), expected);
    CHECK_RESULT(sluiceSetPrimaryTexture(m, good, bad),
                 bad == SLUICE_NO_TEXTURE ? SLUICE_SUCCESS : expected);
    if (bad == SLUICE_NO_TEXTURE) /* refused as an argument, not as unknown */
        expected = SLUICE_ERROR_INVALID_ARGUMENT;
    if (bad != SLUICE_ALL_TEXTURES) {
        CHECK_RESULT(sluiceGetTilesToMap(m, bad, &count, tiles), expected);
        CHECK_RESULT(sluiceGetTilesToCancel(m, bad, &count, tiles), expected);
        CHECK_RESULT(sluiceGetTilesToUnmap(m, bad, 0, &count, tiles), expected);
        CHECK_RESULT(sluiceRetryFailedTiles(m, bad), expected);
        assert_int_equal(count, 4);
    }
    assert_true(fixture_digest(f, 1, &good) == digest);
}

static void ids_that_never_were_are_unknown(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, true);
    SluiceTextureId good = fixture_add_small(&f);
    uint64_t generation = (uint64_t)generation_of(good) << 32;
    check_id_refused(&f, good, SLUICE_NO_TEXTURE, SLUICE_ERROR_UNKNOWN_TEXTURE);
    check_id_refused(&f, good, generation | 1, SLUICE_ERROR_UNKNOWN_TEXTURE);
    check_id_refused(&f, good, generation | UINT32_MAX, SLUICE_ERROR_UNKNOWN_TEXTURE);
    check_id_refused(&f, good, UINT64_MAX, SLUICE_ERROR_UNKNOWN_TEXTURE);
    check_id_refused(&f, good, good + (UINT64_C(1) << 32), SLUICE_ERROR_UNKNOWN_TEXTURE);
    fixture_close(&f);
}

static void ids_of_removed_textures_are_stale(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, true);
    SluiceTextureId good = fixture_add_small(&f), bad = fixture_add_small(&f);
    remove_texture(&f, bad);
    check_id_refused(&f, good, bad, SLUICE_ERROR_STALE_TEXTURE);
    assert_int_equal(index_of(fixture_add_small(&f)), index_of(bad));
    check_id_refused(&f, good, bad, SLUICE_ERROR_STALE_TEXTURE);
    fixture_close(&f);
}

static SluiceResult no_heap(void *user, uint64_t size, uint32_t *id)
{
    (void)user, (void)size, (void)id;
    return SLUICE_ERROR_OUT_OF_DEVICE_MEMORY;
}

static void no_release(void *user, uint32_t id)
{
    (void)user, (void)id;
}

static void check_create_refused(const SluiceStreamedTextureManagerCreateInfo *info,
                                 SluiceResult expected)
{
    SluiceStreamedTextureManager *manager = (SluiceStreamedTextureManager *)(uintptr_t)16;
    CHECK_RESULT(sluiceCreateStreamedTextureManager(info, &manager), expected);
    assert_null(manager);
}

static void create_infos_are_validated(void **state)
{
    (void)state;
    const SluiceStreamedTextureManagerCreateInfo good = {
        .structSize = sizeof good,
        .heapAllocator = {NULL, no_heap, no_release},
        .heapTileCapacity = 1u << 20,
        .tileSize = 1};
    SluiceStreamedTextureManager *manager = NULL;
    CHECK_OK(sluiceCreateStreamedTextureManager(&good, &manager));
    sluiceDestroyStreamedTextureManager(manager);
    sluiceDestroyStreamedTextureManager(NULL);

    CHECK_RESULT(sluiceCreateStreamedTextureManager(&good, NULL), SLUICE_ERROR_NULL_POINTER);
    check_create_refused(NULL, SLUICE_ERROR_NULL_POINTER);
    SluiceStreamedTextureManagerCreateInfo info = good;
    info.heapAllocator.pfnAllocateHeap = NULL;
    check_create_refused(&info, SLUICE_ERROR_NULL_POINTER);
    info = good;
    info.heapAllocator.pfnReleaseHeap = NULL;
    check_create_refused(&info, SLUICE_ERROR_NULL_POINTER);
    info = good;
    info.heapTileCapacity = 0;
    check_create_refused(&info, SLUICE_ERROR_ZERO_HEAP_CAPACITY);
    info = good;
    info.tileSize = 0;
    check_create_refused(&info, SLUICE_ERROR_ZERO_HEAP_CAPACITY);
    info = good;
    info.heapTileCapacity = (1u << 20) + 1;
    check_create_refused(&info, SLUICE_ERROR_INVALID_ARGUMENT);
    struct failing_allocator memory;
    failing_allocator_init(&memory, UINT64_MAX);
    info = good;
    info.pAllocator = &memory.callbacks;
    memory.callbacks.pfnFree = NULL;
    check_create_refused(&info, SLUICE_ERROR_INVALID_ARGUMENT);
    failing_allocator_init(&memory, UINT64_MAX);
    memory.callbacks.pfnAllocate = NULL;
    check_create_refused(&info, SLUICE_ERROR_INVALID_ARGUMENT);
}

static void null_managers_are_refused(void **state)
{
    (void)state;
    const SluiceStreamedTextureDesc desc = small_texture();
    const SluiceStreamedTextureManagerConfig config = {.structSize = sizeof config};
    const uint8_t map[4] = {0};
    const SluiceFeedbackDesc feedback = {sizeof feedback, map, 2, 2, 0, 0};
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    SluiceStreamedTextureStatistics statistics = {.structSize = sizeof statistics};
    SluiceTextureId id = 1;
    SluiceTile tile;
    SluiceTileMove move;
    SluiceMinMipRect rect = {1, 0, 0, 1, 1};
    uint32_t n = 1;
    uint8_t out[4];
    const SluiceResult results[] = {
        sluiceSetConfig(NULL, &config),
        sluiceAddStreamedTexture(NULL, &desc, &id),
        sluiceRemoveStreamedTexture(NULL, id, 0),
        sluiceGetTextureLayout(NULL, id, &layout),
        sluiceUpdateWithSamplerFeedback(NULL, id, &feedback, 0, 0),
        sluiceMatchPrimaryTexture(NULL, id, id, 0, 0),
        sluiceSetPrimaryTexture(NULL, id, id),
        sluiceGetTilesToMap(NULL, id, &n, &tile),
        sluiceUpdateTilesMapping(NULL, id, 1, &n),
        sluiceReportFailedTiles(NULL, id, 1, &n, 0),
        sluiceRetryFailedTiles(NULL, id),
        sluiceGetGivenUpTiles(NULL, &n, &tile),
        sluiceGetTilesToCancel(NULL, id, &n, &tile),
        sluiceReportCanceledTiles(NULL, id, 1, &n, 0),
        sluiceGetTilesToUnmap(NULL, id, 0, &n, &tile),
        sluiceCompleteRetireValue(NULL, 0),
        sluiceTrimStandbyTiles(NULL, 0),
        sluiceDefragmentTiles(NULL, 0, &n, &move),
        sluiceGetEmptyHeaps(NULL, &n, &n),
        sluiceReleaseHeap(NULL, 0),
        sluiceWriteMinMipData(NULL, id, 2, 4, out),
        sluiceWriteMinMipRect(NULL, &rect, 2, 4, out),
        sluiceGetMinMipUpdates(NULL, &n, &rect),
        sluiceGetTileState(NULL, id, 0, NULL, &tile),
        sluiceGetStatistics(NULL, &statistics),
    };
    for (size_t i = 0; i < sizeof results / sizeof *results; i++)
        assert_int_equal(results[i], SLUICE_ERROR_NULL_POINTER);
}

static void null_arguments_are_refused_and_change_nothing(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, true);
    SluiceTextureId id = fixture_add_small(&f), other;
    SluiceStreamedTextureManager *m = f.manager;
    const SluiceStreamedTextureDesc desc = small_texture();
    const SluiceFeedbackDesc no_map = {sizeof no_map, NULL, 2, 2, 0, 0};
    const SluiceMinMipRect rect = {id, 0, 0, 1, 1};
    SluiceTile tile;
    SluiceTileMove move;
    SluiceMinMipRect update;
    uint32_t n = 1;
    uint8_t out[4];
    uint64_t digest = fixture_digest(&f, 1, &id);
    const SluiceResult results[] = {
        sluiceSetConfig(m, NULL),
        sluiceGetStreamedTextureLayout(&desc, NULL),
        sluiceGetStreamedTextureLayout(NULL, NULL),
        sluiceAddStreamedTexture(m, &desc, NULL),
        sluiceAddStreamedTexture(m, NULL, &other),
        sluiceGetTextureLayout(m, id, NULL),
        sluiceUpdateWithSamplerFeedback(m, id, NULL, 5, 5),
        sluiceUpdateWithSamplerFeedback(m, id, &no_map, 5, 5),
        sluiceGetTilesToMap(m, id, NULL, &tile),
        sluiceUpdateTilesMapping(m, id, 1, NULL),
        sluiceReportFailedTiles(m, id, 1, NULL, 5),
        sluiceGetGivenUpTiles(m, NULL, &tile),
        sluiceGetTilesToCancel(m, id, NULL, &tile),
        sluiceReportCanceledTiles(m, id, 1, NULL, 0),
        sluiceGetTilesToUnmap(m, id, 0, NULL, &tile),
        sluiceDefragmentTiles(m, 0, NULL, &move),
        sluiceDefragmentTiles(m, 0, &n, NULL),
        sluiceGetEmptyHeaps(m, NULL, &n),
        sluiceWriteMinMipData(m, id, 2, 4, NULL),
        sluiceWriteMinMipRect(m, &rect, 2, 4, NULL),
        sluiceWriteMinMipRect(m, NULL, 2, 4, out),
        sluiceGetMinMipUpdates(m, NULL, &update),
        sluiceGetStatistics(m, NULL),
    };
    for (size_t i = 0; i < sizeof results / sizeof *results; i++)
        assert_int_equal(results[i], SLUICE_ERROR_NULL_POINTER);
    assert_true(fixture_digest(&f, 1, &id) == digest);
    /* no time stamp was taken over: an earlier one is still the first */
    fixture_feed(&f, id, 0, 1, 1);
    CHECK_OK(sluiceGetTileState(m, id, 0, NULL, NULL)); /* documented: each may be NULL */
    fixture_close(&f);
}

static void errors_are_named_in_the_documented_order(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    SluiceTextureId id = fixture_add_small(&f), stale = fixture_add_small(&f);
    remove_texture(&f, stale);
    fixture_feed(&f, id, 0, 100, 10);
    CHECK_OK(fixture_to_map(&f, id));
    CHECK_OK(sluiceReportCanceledTiles(f.manager, id, 1, &(uint32_t){0}, 50));
    const uint8_t map[4] = {0};
    const SluiceFeedbackDesc none = {sizeof none, NULL, 7, 7, 0, 0},
                             wrong = {sizeof wrong, map, 2, 1, 0, 0};
    const uint32_t beyond[] = {1, 6}, twice[] = {1, 1};
    SluiceStreamedTextureManager *m = f.manager;
    CHECK_RESULT(sluiceUpdateWithSamplerFeedback(m, stale, &none, 1, 1), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceUpdateWithSamplerFeedback(m, stale, &wrong, 1, 1),
                 SLUICE_ERROR_STALE_TEXTURE);
    CHECK_RESULT(sluiceUpdateWithSamplerFeedback(m, id, &wrong, 1, 1), SLUICE_ERROR_SIZE_MISMATCH);
    CHECK_RESULT(sluiceMatchPrimaryTexture(m, stale, stale, 1, 1), SLUICE_ERROR_STALE_TEXTURE);
    CHECK_RESULT(sluiceReportFailedTiles(m, stale, 1, NULL, 1), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceReportFailedTiles(m, id, 2, beyond, 1), SLUICE_ERROR_UNKNOWN_TILE);
    CHECK_RESULT(sluiceReportFailedTiles(m, id, 2, twice, 1), SLUICE_ERROR_INVALID_TILE_STATE);
    CHECK_RESULT(sluiceReportFailedTiles(m, id, 1, twice, 1), SLUICE_ERROR_TIME_BACKWARDS);
    CHECK_RESULT(sluiceReportCanceledTiles(m, id, 2, twice, 1), SLUICE_ERROR_INVALID_TILE_STATE);
    CHECK_RESULT(sluiceReportCanceledTiles(m, id, 1, twice, 1), SLUICE_ERROR_TIME_BACKWARDS);
    CHECK_RESULT(sluiceRemoveStreamedTexture(m, stale, 1), SLUICE_ERROR_STALE_TEXTURE);
    SluiceStreamedTextureDesc desc = {.width = 1u << 21, .mipLevelCount = 3, .regularMipCount = 4};
    SluiceTextureId out;
    CHECK_RESULT(sluiceAddStreamedTexture(m, &desc, &out), SLUICE_ERROR_ZERO_TILES);
    desc.height = desc.tileWidth = desc.tileHeight = 1;
    CHECK_RESULT(sluiceAddStreamedTexture(m, &desc, &out), SLUICE_ERROR_INVALID_PACKED_MIPS);
    desc.regularMipCount = 3;
    CHECK_RESULT(sluiceAddStreamedTexture(m, &desc, &out), SLUICE_ERROR_INVALID_ARGUMENT);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(indices_are_dense_and_the_lowest_comes_first),
        cmocka_unit_test(generations_are_never_used_again),
        cmocka_unit_test(ids_that_never_were_are_unknown),
        cmocka_unit_test(ids_of_removed_textures_are_stale),
        cmocka_unit_test(create_infos_are_validated),
        cmocka_unit_test(null_managers_are_refused),
        cmocka_unit_test(null_arguments_are_refused_and_change_nothing),
        cmocka_unit_test(indices_stay_dense_whatever_is_removed),
        cmocka_unit_test(errors_are_named_in_the_documented_order),
    };
    return RUN_TESTS(tests);
}
