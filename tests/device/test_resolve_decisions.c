/* Resolve returns changes or whole maps, through little room or much. Decisions must be equal. */
#include "device/scene.h"

#include "support/roll.h"
#include "support/streamer_manager.h"
#include "support/test.h"

#include <sluice/replay.h>

#include <stdlib.h>
#include <string.h>

enum { TEXTURES = 12, FRAMES = 60, MAPS = 4096 };

struct bytes {
    uint8_t *data;
    size_t size, capacity;
};

struct run {
    struct bytes recording;
    uint64_t decision_hash;
    uint8_t min_mip[TEXTURES][MAPS];
    SluiceVulkanStreamerStatistics stats;
};

static SluiceResult write_bytes(void *user, const void *data, size_t size)
{
    struct bytes *bytes = user;
    if (bytes->size + size > bytes->capacity) {
        bytes->capacity = 2 * (bytes->size + size);
        bytes->data = realloc(bytes->data, bytes->capacity);
        assert_non_null(bytes->data);
    }
    memcpy(bytes->data + bytes->size, data, size);
    bytes->size += size;
    return SLUICE_SUCCESS;
}

static void add_one(struct scene *scene, uint32_t i)
{
    static const uint32_t sizes[][2] = {{4096, 4096}, {2048, 1024}, {128, 128},  {1000, 700},
                                        {512, 512},   {2048, 1},    {100, 1500}, {16, 16},
                                        {640, 1280},  {1024, 1024}, {3000, 300}, {4096, 512}};
    scene_add(scene, pattern_source(PATTERN_LEVEL, sizes[i][0], sizes[i][1],
                                    SLUICE_FORMAT_R8G8B8A8_UNORM));
}

/* Windows that move, jump and rest; now and then a texture goes and another one comes. */
static void move(struct scene *scene, uint32_t frame)
{
    for (uint32_t i = 0; i < TEXTURES; i++) {
        if (frame % 3 == 2 && roll() % 2)
            continue; /* rests: the same samples again */
        struct scene_aim aim = {.left = (double)roll() / ROLL_MAX,
                                .top = 0.01 * frame,
                                .width = 0.4,
                                .height = 0.3,
                                .min_lod = roll() % 3,
                                .max_lod = 4};
        scene_aim(scene, i, roll() % 5 ? 1 + (uint32_t)roll() % SCENE_SAMPLES : 0, &aim);
    }
    if (frame % 10 == 9) {
        uint32_t gone = (uint32_t)roll() % TEXTURES;
        scene_remove(scene, gone);
        add_one(scene, gone); /* the first free place in the scene is the same */
    }
}

static void read_maps(struct scene *scene, struct run *run)
{
    for (uint32_t i = 0; i < TEXTURES; i++) {
        SluiceStreamedTextureManager *manager = manager_of(scene->streamer);
        SluiceTextureId id = scene->textures[i].texture.textureId;
        SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
        CHECK_OK(sluiceGetTextureLayout(manager, id, &layout));
        assert_true(layout.minMipWidth * layout.minMipHeight <= MAPS);
        CHECK_OK(sluiceWriteMinMipData(manager, id, layout.minMipWidth, MAPS, run->min_mip[i]));
    }
}

static void play(struct harness *h, struct run *run, SluiceVulkanStreamerCreateInfo info,
                 uint32_t rest)
{
    *run = (struct run){0};
    struct scene scene;
    h->time = 0;
    scene_init(&scene, h, info);
    SluiceRecordWriter writer = {&run->recording, write_bytes};
    SluiceRecorder *recorder;
    CHECK_OK(sluiceBeginRecording(manager_of(scene.streamer), &writer, NULL, &recorder));
    for (uint32_t i = 0; i < TEXTURES; i++)
        add_one(&scene, i);
    roll_seed(61);
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        move(&scene, frame);
        scene_settle(&scene, 1);
    }
    scene_settle(&scene, rest);
    assert_int_equal(scene_non_resident(&scene), 0);
    read_maps(&scene, run);
    run->stats.structSize = sizeof run->stats;
    sluiceGetVulkanStreamerStatistics(scene.streamer, &run->stats);
    CHECK_OK(sluiceEndRecording(recorder));
    SluiceReplayInfo replay = {
        .structSize = sizeof replay, .pData = run->recording.data, .size = run->recording.size};
    SluiceReplayResult result = {.structSize = sizeof result};
    CHECK_OK(sluiceReplay(&replay, &result));
    assert_true(result.decisionHash == result.recordedHash);
    run->decision_hash = result.decisionHash;
    scene_finish(&scene);
}

static void changes_and_whole_maps_decide_the_same(void **state)
{
    static struct run changes, whole;
    const uint32_t shares[] = {3, TEXTURES};
    for (size_t i = 0; i < 2; i++) {
        SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                               .texturesPerFrame = shares[i],
                                               .feedbackTimeoutTicks = 5,
                                               .maxHeapCount = 2};
        play(*state, &changes, info, 0);
        info.pDebug = &(const SluiceVulkanStreamerDebugInfo){.structSize = sizeof *info.pDebug,
                                                             .wholeFeedbackMaps = true};
        play(*state, &whole, info, 0);
        assert_true(changes.stats.feedbackMaps > FRAMES && changes.stats.tilesMapped > 100);
        assert_true(changes.stats.tilesUnmapped > 10);
        assert_int_equal(changes.stats.feedbackMaps, whole.stats.feedbackMaps);
        assert_true(changes.stats.feedbackWords < whole.stats.feedbackWords);
        assert_true(changes.decision_hash == whole.decision_hash);
        assert_int_equal(changes.recording.size, whole.recording.size);
        assert_memory_equal(changes.recording.data, whole.recording.data, whole.recording.size);
        assert_memory_equal(changes.min_mip, whole.min_mip, sizeof whole.min_mip);
        free(changes.recording.data);
        free(whole.recording.data);
    }
}

static void little_room_delays_but_loses_nothing(void **state)
{
    static struct run wide, narrow;
    SluiceVulkanStreamerCreateInfo info = {
        .structSize = sizeof info, .texturesPerFrame = TEXTURES, .feedbackTimeoutTicks = 40};
    play(*state, &wide, info, 100);
    info.feedbackReadbackSize = 1024; /* the map of the largest one */
    play(*state, &narrow, info, 100);
    assert_int_equal(wide.stats.feedbackPostponed, 0);
    assert_true(narrow.stats.feedbackPostponed > 20);
    assert_memory_equal(narrow.min_mip, wide.min_mip, sizeof wide.min_mip);
    free(wide.recording.data);
    free(narrow.recording.data);
}

static void a_texture_that_no_slot_could_hold_is_refused(void **state)
{
    struct scene scene;
    scene_init(
        &scene, *state,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackReadbackSize = 60});
    struct SluiceImageSource *source =
        pattern_source(PATTERN_LEVEL, 1024, 1024, SLUICE_FORMAT_R8G8B8A8_UNORM);
    SluiceVulkanTextureCreateInfo info = {.structSize = sizeof info, .source = source};
    SluiceVulkanTexture texture;
    scene.h->quiet = true;
    CHECK_RESULT(sluiceAddVulkanTexture(scene.streamer, &info, &texture),
                 SLUICE_ERROR_LIMIT_EXCEEDED);
    scene.h->quiet = false;
    scene_add(&scene, pattern_source(PATTERN_LEVEL, 512, 512, SLUICE_FORMAT_R8G8B8A8_UNORM));
    sluiceDestroyImageSource(source);
    scene_finish(&scene);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(changes_and_whole_maps_decide_the_same),
        cmocka_unit_test(little_room_delays_but_loses_nothing),
        cmocka_unit_test(a_texture_that_no_slot_could_hold_is_refused),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    /* reads arrive in the same order every time */
    CHECK_OK(harness_set_context(&h, &(SluiceVulkanContextCreateInfo){.loaderThreadCount = 1}));
    return harness_finish(&h, RUN_TESTS(tests));
}
