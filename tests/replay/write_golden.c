/*
 * Writes the recordings in tests/data: write_golden FOLDER. Run it by `ninja
 * update-golden-replays`. Each scene shows one feature with a few calls.
 */
#include "feedback_scene.h"
#include "golden_demand.h"
#include "random_app.h"

#include "support/test.h"

#include <stdio.h>
#include <string.h>

struct scene {
    SluiceStreamedTextureManager *manager;
    uint32_t heap_count, heap_limit;
    SluiceTile tiles[64];
    uint32_t tile_count;
};

static SluiceResult allocate_heap(void *user, uint64_t size, uint32_t *heap_id)
{
    struct scene *scene = user;
    (void)size;
    if (scene->heap_count == scene->heap_limit)
        return SLUICE_ERROR_OUT_OF_DEVICE_MEMORY;
    *heap_id = 10 + scene->heap_count++;
    return SLUICE_SUCCESS;
}

static void release_heap(void *user, uint32_t heap_id)
{
    (void)user;
    (void)heap_id;
}

static SluiceTextureId add_texture(struct scene *scene, uint32_t width, uint32_t height)
{
    uint32_t levels = 0, regular = 0;
    for (; width >> levels || height >> levels; levels++)
        regular += width >> levels >= 64 && height >> levels >= 64;
    const SluiceStreamedTextureDesc desc = {.width = width,
                                            .height = height,
                                            .mipLevelCount = levels,
                                            .regularMipCount = regular,
                                            .packedTileCount = regular < levels,
                                            .tileWidth = 64,
                                            .tileHeight = 64};
    SluiceTextureId id;
    CHECK_OK(sluiceAddStreamedTexture(scene->manager, &desc, &id));
    return id;
}

/* Feeds one level in every region, or SLUICE_MIP_UNTOUCHED. */
static void give_feedback(struct scene *scene, SluiceTextureId id, uint8_t level, uint64_t time)
{
    uint8_t map[256];
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    CHECK_OK(sluiceGetTextureLayout(scene->manager, id, &layout));
    memset(map, level, sizeof map);
    const SluiceFeedbackDesc feedback = {.structSize = sizeof feedback,
                                         .pMinMip = map,
                                         .width = layout.feedbackWidth,
                                         .height = layout.feedbackHeight};
    assert_true(layout.feedbackWidth * layout.feedbackHeight <= sizeof map);
    CHECK_OK(sluiceUpdateWithSamplerFeedback(scene->manager, id, &feedback, time, 10));
}

static void get_tiles(struct scene *scene, uint32_t room)
{
    scene->tile_count = room;
    SluiceResult result =
        sluiceGetTilesToMap(scene->manager, SLUICE_ALL_TEXTURES, &scene->tile_count, scene->tiles);
    assert_true(result >= SLUICE_SUCCESS);
}

static void answer_tiles(struct scene *scene)
{
    for (uint32_t i = 0; i < scene->tile_count; i++)
        CHECK_OK(sluiceUpdateTilesMapping(scene->manager, scene->tiles[i].textureId, 1,
                                          &scene->tiles[i].tileIndex));
}

static void get_updates(struct scene *scene)
{
    SluiceMinMipRect rects[8];
    uint32_t count = 8;
    CHECK_OK(sluiceGetMinMipUpdates(scene->manager, &count, rects));
}

static void get_unmaps(struct scene *scene, uint64_t retire)
{
    uint32_t count = 64;
    CHECK_OK(
        sluiceGetTilesToUnmap(scene->manager, SLUICE_ALL_TEXTURES, retire, &count, scene->tiles));
    CHECK_OK(sluiceCompleteRetireValue(scene->manager, retire));
}

/* A texture from nothing to sharp, and back. */
static void play_first_light(struct scene *scene)
{
    SluiceTextureId id = add_texture(scene, 200, 130);
    get_updates(scene);
    give_feedback(scene, id, 0, 1);
    for (int frame = 0; frame < 5; frame++) {
        get_tiles(scene, 4);
        answer_tiles(scene);
        get_updates(scene);
    }
    give_feedback(scene, id, SLUICE_MIP_UNTOUCHED, 20);
    get_unmaps(scene, 1);
    get_updates(scene);
}

/* A tile is wanted, handed out, unwanted, and wanted again. */
static void play_cancel(struct scene *scene)
{
    SluiceTextureId id = add_texture(scene, 128, 128);
    give_feedback(scene, id, 0, 1);
    get_tiles(scene, 64);
    give_feedback(scene, id, SLUICE_MIP_UNTOUCHED, 20);
    SluiceTile canceled[64];
    uint32_t count = 3;
    assert_true(sluiceGetTilesToCancel(scene->manager, id, &count, canceled) >= SLUICE_SUCCESS);
    for (uint32_t i = 0; i < count; i++)
        CHECK_OK(sluiceReportCanceledTiles(scene->manager, id, 1, &canceled[i].tileIndex, 5));
    give_feedback(scene, id, 0, 21);
    CHECK_OK(sluiceCompleteRetireValue(scene->manager, 5));
    get_tiles(scene, 64);
    get_updates(scene);
}

/* Loads fail, wait, fail again and are given up. */
static void play_failures(struct scene *scene)
{
    const SluiceStreamedTextureManagerConfig config = {.structSize = sizeof config,
                                                       .maxLoadAttempts = 2,
                                                       .retryDelayTicks = 10,
                                                       .givenUpRetryDelayTicks = UINT64_MAX};
    CHECK_OK(sluiceSetConfig(scene->manager, &config));
    SluiceTextureId id = add_texture(scene, 64, 64);
    for (uint64_t time = 1; time < 40; time += 6) {
        give_feedback(scene, id, 0, time);
        get_tiles(scene, 1);
        if (scene->tile_count > 0)
            CHECK_OK(
                sluiceReportFailedTiles(scene->manager, id, 1, &scene->tiles[0].tileIndex, time));
        uint32_t count = 64;
        CHECK_OK(sluiceGetGivenUpTiles(scene->manager, &count, scene->tiles));
    }
    CHECK_OK(sluiceRetryFailedTiles(scene->manager, SLUICE_ALL_TEXTURES));
    get_tiles(scene, 64);
    answer_tiles(scene);
    get_updates(scene);
}

/* Two textures with room for one: the second evicts standby tiles of the first. */
static void play_budget(struct scene *scene)
{
    scene->heap_limit = 2;
    const SluiceStreamedTextureManagerConfig config = {.structSize = sizeof config,
                                                       .numExtraStandbyTiles = 100};
    CHECK_OK(sluiceSetConfig(scene->manager, &config));
    SluiceTextureId first = add_texture(scene, 128, 128), second = add_texture(scene, 128, 192);
    give_feedback(scene, first, 0, 1);
    get_tiles(scene, 64);
    answer_tiles(scene);
    give_feedback(scene, first, SLUICE_MIP_UNTOUCHED, 20);
    give_feedback(scene, second, 0, 20);
    for (uint64_t frame = 1; frame < 4; frame++) {
        get_tiles(scene, 64);
        answer_tiles(scene);
        get_unmaps(scene, frame);
        get_updates(scene);
    }
}

/* A follower of half the size, a match by hand, and a texture removed during loads. */
static void play_sets(struct scene *scene)
{
    SluiceTextureId primary = add_texture(scene, 256, 128), follower = add_texture(scene, 128, 64);
    SluiceTextureId third = add_texture(scene, 512, 256);
    CHECK_OK(sluiceSetPrimaryTexture(scene->manager, follower, primary));
    give_feedback(scene, primary, 1, 1);
    CHECK_OK(sluiceMatchPrimaryTexture(scene->manager, primary, third, 1, 10));
    get_tiles(scene, 64);
    CHECK_OK(sluiceRemoveStreamedTexture(scene->manager, third, 1));
    for (uint32_t i = 0; i < scene->tile_count; i++)
        CHECK_RESULT(sluiceUpdateTilesMapping(scene->manager, scene->tiles[i].textureId, 1,
                                              &scene->tiles[i].tileIndex),
                     scene->tiles[i].textureId == third ? SLUICE_ERROR_STALE_TEXTURE
                                                        : SLUICE_SUCCESS);
    get_updates(scene);
    add_texture(scene, 64, 64); /* takes the index, not the id */
    CHECK_OK(sluiceCompleteRetireValue(scene->manager, 1));
}

/* Half-empty heaps are merged and released. */
static void play_defragment(struct scene *scene)
{
    SluiceTextureId ids[3];
    for (int i = 0; i < 3; i++) {
        ids[i] = add_texture(scene, 128, 128);
        give_feedback(scene, ids[i], 0, 1);
    }
    get_tiles(scene, 64);
    answer_tiles(scene);
    give_feedback(scene, ids[0], SLUICE_MIP_UNTOUCHED, 20);
    give_feedback(scene, ids[1], 1, 20);
    get_unmaps(scene, 1);
    SluiceTileMove moves[16];
    uint32_t count = 16, heaps[8];
    CHECK_OK(sluiceDefragmentTiles(scene->manager, 2, &count, moves));
    CHECK_OK(sluiceCompleteRetireValue(scene->manager, 2));
    count = 8;
    CHECK_OK(sluiceGetEmptyHeaps(scene->manager, &count, heaps));
    for (uint32_t i = 0; i < count; i++)
        CHECK_OK(sluiceReleaseHeap(scene->manager, heaps[i]));
    CHECK_OK(sluiceTrimStandbyTiles(scene->manager, 0));
}

static void record(const char *folder, const char *name, void (*play)(struct scene *scene),
                   uint32_t capacity, bool always_map_packed)
{
    char path[1024];
    struct scene scene = {.heap_limit = 8};
    SluiceRecorder *recorder;
    const SluiceStreamedTextureManagerCreateInfo info = {
        .structSize = sizeof info,
        .heapAllocator = {&scene, allocate_heap, release_heap},
        .heapTileCapacity = capacity,
        .tileSize = 65536,
        .alwaysMapPackedTiles = always_map_packed,
    };
    snprintf(path, sizeof path, "%s/%s.trace", folder, name);
    CHECK_OK(sluiceCreateStreamedTextureManager(&info, &scene.manager));
    CHECK_OK(sluiceBeginRecordingToFile(scene.manager, path, NULL, &recorder));
    play(&scene);
    CHECK_OK(sluiceEndRecording(recorder));
    sluiceDestroyStreamedTextureManager(scene.manager);
}

static void record_random(const char *folder)
{
    char path[1024];
    struct random_app app;
    SluiceRecorder *recorder;
    snprintf(path, sizeof path, "%s/random_application.trace", folder);
    /* No allocation fails: the failing call would depend on how often the manager allocates. */
    random_app_init(&app, 2024, false);
    CHECK_OK(sluiceBeginRecordingToFile(app.manager, path, NULL, &recorder));
    random_app_run(&app, 400);
    CHECK_OK(sluiceEndRecording(recorder));
    random_app_finish(&app);
}

/* Writes the only scene with feedback. */
static void write_feedback_scene(const char *folder)
{
    char path[1024];
    struct trace_buffer trace;
    make_feedback_scene(&trace);
    snprintf(path, sizeof path, "%s/frame_loop.trace", folder);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(trace.data, 1, trace.size, file), trace.size);
    assert_int_equal(fclose(file), 0);
    trace_buffer_free(&trace);
}

static const char *folder_argument;

static void write_all(void **state)
{
    (void)state;
    record(folder_argument, "first_light", play_first_light, 16, false);
    record(folder_argument, "cancel", play_cancel, 16, true);
    record(folder_argument, "failures", play_failures, 16, false);
    record(folder_argument, "budget", play_budget, 4, true);
    record(folder_argument, "sets", play_sets, 16, true);
    record(folder_argument, "defragment", play_defragment, 4, false);
    record_random(folder_argument);
    write_feedback_scene(folder_argument);
    write_golden_demand(folder_argument);
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: write_golden FOLDER\n");
        return 2;
    }
    folder_argument = argv[1];
    const struct CMUnitTest tests[] = {cmocka_unit_test(write_all)};
    return RUN_TESTS(tests);
}
