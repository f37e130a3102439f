/* A real device runs out of memory while streaming: the picture is coarser, but correct. */
#include "device/scene.h"
#include "extremes/failing_layer.h"
#include "extremes/note.h"

enum { SIZE = 1024, RECOVERY = 150 };

static const struct scene_aim fine = {0.05, 0.05, 0.9, 0.9, 0.2, 0.3, 0, 0};

/* Streams with memory for a number of bytes of tiles. Returns the number of samples that are
 * coarser than requested. */
static uint32_t stream_with(struct harness *h, uint64_t memory, uint32_t *frames)
{
    struct scene scene;
    scene_init(
        &scene, h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 1000,
                                         .heapTileCapacity = 32});
    uint32_t t =
        scene_add(&scene, pattern_source(PATTERN_LEVEL, SIZE, SIZE, SLUICE_FORMAT_R8G8B8A8_UNORM));
    failing_layer.memory_left = memory;
    scene_aim(&scene, t, SCENE_SAMPLES, &fine);
    for (uint32_t i = 0; i < 20; i++) {
        scene_settle(&scene, 1);
        scene_check_levels(&scene); /* every texel must belong to the level it claims */
    }
    uint32_t missing = scene_missing(&scene);
    SluiceVulkanStreamerStatistics s = {.structSize = sizeof s};
    sluiceGetVulkanStreamerStatistics(scene.streamer, &s);
    assert_int_equal(s.givenUpTileCount + s.failedTileCount, 0);
    failing_layer.memory_left = UINT64_MAX;
    for (*frames = 0; *frames < RECOVERY && scene_missing(&scene) > 0; ++*frames)
        scene_settle(&scene, 1);
    scene_check_levels(&scene);
    assert_int_equal(scene_non_resident(&scene), 0);
    scene_finish(&scene);
    return missing;
}

static void memory_that_ends_is_a_coarser_picture_until_there_is_more(void **state)
{
    struct harness *h = *state;
    uint32_t slowest = 0, coarse = 0, cases = 0;
    failing_layer_set(h, 0, false, VK_SUCCESS);
    CHECK_OK(harness_set_context(
        h, &(SluiceVulkanContextCreateInfo){.pfnGetInstanceProcAddr = failing_layer_get}));
    h->quiet = true;
    static const uint64_t sizes[] = {0, 3u << 20, 16u << 20}; /* for 85 tiles, 5.6 MB */
    for (; cases < 3; cases++) {
        uint32_t frames;
        coarse += stream_with(h, sizes[cases], &frames) > 0;
        slowest = frames > slowest ? frames : slowest;
    }
    h->quiet = false;
    CHECK_OK(harness_set_context(h, NULL));
    note("a real device whose memory ends: frames until all is sharp again", cases, slowest,
         RECOVERY - 1);
    assert_true(slowest < RECOVERY && coarse == 2);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(memory_that_ends_is_a_coarser_picture_until_there_is_more),
    };
    tests[0].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
