#include "random_app.h"

#include "support/test.h"

#include <string.h>

/* The hash of docs/replay.md once more, from what an application sees. */
struct oracle {
    uint64_t hash;
};

static void add(struct oracle *o, uint64_t value, int size)
{
    for (int i = 0; i < size; i++)
        o->hash = (o->hash ^ ((value >> (8 * i)) & 255)) * UINT64_C(1099511628211);
}

static void add_call(struct oracle *o, int kind, SluiceResult result)
{
    add(o, (uint64_t)kind, 1);
    add(o, (uint64_t)(int64_t)result, 4);
}

static void add_tiles(struct oracle *o, const SluiceTile *tiles, uint32_t count)
{
    add(o, count, 4);
    for (uint32_t i = 0; i < count; i++) {
        add(o, tiles[i].textureId, 8);
        add(o, tiles[i].tileIndex, 4);
        add(o, tiles[i].mipLevel, 4);
        add(o, tiles[i].x, 4);
        add(o, tiles[i].y, 4);
        add(o, tiles[i].heapId, 4);
        add(o, tiles[i].slot, 4);
    }
}

static SluiceResult allocate_heap(void *user, uint64_t size, uint32_t *heap_id)
{
    (void)size;
    *heap_id = 77;
    add_call(user, 20, SLUICE_SUCCESS);
    add(user, 77, 4);
    return SLUICE_SUCCESS;
}

static void release_heap(void *user, uint32_t heap_id)
{
    (void)user;
    assert_int_equal(heap_id, 77);
}

static void add_minmip(struct oracle *o, SluiceStreamedTextureManager *manager)
{
    SluiceMinMipRect rects[4];
    uint32_t count = 4;
    SluiceResult result = sluiceGetMinMipUpdates(manager, &count, rects);
    add_call(o, 19, result);
    add(o, count, 4);
    assert_true(count > 0);
    for (uint32_t i = 0; i < count; i++) {
        uint8_t texels[64];
        uint32_t size = rects[i].width * rects[i].height;
        assert_in_range(size, 1, 64);
        add(o, rects[i].textureId, 8);
        add(o, rects[i].x, 4);
        add(o, rects[i].y, 4);
        add(o, rects[i].width, 4);
        add(o, rects[i].height, 4);
        CHECK_OK(sluiceWriteMinMipRect(manager, &rects[i], rects[i].width, size, texels));
        for (uint32_t t = 0; t < size; t++)
            add(o, texels[t], 1);
    }
}

static void play_scene(struct oracle *o, SluiceStreamedTextureManager *manager)
{
    const SluiceStreamedTextureDesc desc = {.width = 512,
                                            .height = 300,
                                            .mipLevelCount = 10,
                                            .regularMipCount = 3,
                                            .packedTileCount = 1,
                                            .tileWidth = 128,
                                            .tileHeight = 128};
    SluiceTextureId id;
    add_call(o, 2, sluiceAddStreamedTexture(manager, &desc, &id));
    add(o, id, 8);
    uint8_t map[12] = {0, 1, 2, 255, 255, 9, 9, 9, 255, 255, 0, 0};
    SluiceFeedbackDesc feedback = {
        .structSize = sizeof feedback, .pMinMip = map, .width = 4, .height = 3};
    add_call(o, 4, sluiceUpdateWithSamplerFeedback(manager, id, &feedback, 5, 1));
    feedback.width = 5;
    add_call(o, 4, sluiceUpdateWithSamplerFeedback(manager, id, &feedback, 5, 1));

    uint32_t queried, count = 32, indices[32];
    SluiceTile tiles[32];
    SluiceResult result = sluiceGetTilesToMap(manager, SLUICE_ALL_TEXTURES, &queried, NULL);
    add_call(o, 7, result);
    add(o, queried, 4);
    result = sluiceGetTilesToMap(manager, SLUICE_ALL_TEXTURES, &count, tiles);
    assert_int_equal(count, queried);
    add_call(o, 7, result);
    add_tiles(o, tiles, count);
    for (uint32_t i = 0; i < count; i++)
        indices[i] = tiles[i].tileIndex;
    add_call(o, 8, sluiceUpdateTilesMapping(manager, id, count, indices));
    add_minmip(o, manager);

    memset(map, 255, sizeof map);
    feedback.width = 4;
    add_call(o, 4, sluiceUpdateWithSamplerFeedback(manager, id, &feedback, 50, 1));
    count = 32;
    result = sluiceGetTilesToUnmap(manager, SLUICE_ALL_TEXTURES, 3, &count, tiles);
    assert_true(count > 0);
    add_call(o, 14, result);
    add_tiles(o, tiles, count);
    add_minmip(o, manager);
    add_call(o, 15, sluiceCompleteRetireValue(manager, 3));
    add_call(o, 18, sluiceReleaseHeap(manager, 76));
}

static void hash_is_the_one_that_the_documentation_defines(void **state)
{
    (void)state;
    struct oracle oracle = {.hash = UINT64_C(14695981039346656037)};
    const SluiceStreamedTextureManagerCreateInfo info = {
        .structSize = sizeof info,
        .heapAllocator = {&oracle, allocate_heap, release_heap},
        .heapTileCapacity = 64,
        .tileSize = 65536,
    };
    SluiceStreamedTextureManager *manager;
    SluiceRecorder *recorder;
    struct trace_buffer trace;
    const SluiceRecordWriter writer = trace_buffer_writer(&trace);
    CHECK_OK(sluiceCreateStreamedTextureManager(&info, &manager));
    CHECK_OK(sluiceBeginRecording(manager, &writer, NULL, &recorder));
    play_scene(&oracle, manager);
    CHECK_OK(sluiceEndRecording(recorder));
    sluiceDestroyStreamedTextureManager(manager);

    const SluiceReplayInfo replay = {
        .structSize = sizeof replay, .pData = trace.data, .size = trace.size};
    SluiceReplayResult result = {.structSize = sizeof result};
    CHECK_OK(sluiceReplay(&replay, &result));
    assert_true(result.recordedHash == oracle.hash);
    assert_true(result.decisionHash == oracle.hash);
    assert_int_equal(result.eventCount, 12);
    trace_buffer_free(&trace);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hash_is_the_one_that_the_documentation_defines),
    };
    return RUN_TESTS(tests);
}
