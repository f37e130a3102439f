/* Features of paged residency only: images of pages that are created and destroyed, and the page
 * table. */
#include "device/scene.h"

#include "support/roll.h"
#include "support/test.h"

#include <stdio.h>
#include <string.h>

static const struct scene_aim everything_fine = {0.01, 0.01, 0.98, 0.98, 0.2, 0.3, 0, 0};

static uint64_t device_memory(const struct scene *scene)
{
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    sluiceGetVulkanStreamerStatistics(scene->streamer, &stats);
    return stats.tileMemorySize;
}

static uint64_t generation(const struct scene *scene)
{
    SluiceVulkanPages pages = {.structSize = sizeof pages};
    sluiceGetVulkanPages(scene->streamer, &pages);
    return pages.generation;
}

/* Another texture is drawn meanwhile, in frames that are not waited for. */
static void memory_comes_back_when_no_tile_needs_it(void **state)
{
    struct scene scene;
    scene_init(
        &scene, *state,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 1000});
    uint32_t stays =
        scene_add(&scene, pattern_source(PATTERN_LEVEL, 512, 512, SLUICE_FORMAT_R8G8B8A8_UNORM));
    scene_aim(&scene, stays, 200, &everything_fine);
    scene_settle(&scene, 10);
    uint64_t before = device_memory(&scene);
    for (int round = 0; round < 2; round++) {
        uint32_t goes =
            scene_add(&scene, pattern_source(PATTERN_LEVEL, 2048, 2048, SLUICE_FORMAT_R32_SFLOAT));
        scene_aim(&scene, goes, SCENE_SAMPLES, &everything_fine);
        scene_settle(&scene, 12);
        assert_int_equal(scene_missing(&scene), 0);
        assert_true(device_memory(&scene) > before + (12 << 20)); /* 200 pages at least */
        uint64_t changes = generation(&scene);
        scene_remove(&scene, goes);
        for (int frame = 0; frame < 80; frame++)
            harness_frame(scene.h, scene.streamer, frame % 8 == 0, scene_record, &scene);
        assert_int_equal(device_memory(&scene), before);
        assert_true(generation(&scene) > changes);
        assert_int_equal(scene_missing(&scene), 0);
        scene_check_levels(&scene);
    }
    assert_int_equal(scene_non_resident(&scene), 0);
    scene_finish(&scene);
}

/* 64 pages, of which 256 are requested, and none for a second format. */
static void pages_that_run_out_leave_coarse_pictures_and_room_for_packed_levels(void **state)
{
    struct harness *h = *state;
    struct scene scene;
    h->quiet = true;
    CHECK_OK(harness_set_context(h, &(SluiceVulkanContextCreateInfo){.maxPageChunkCount = 1}));
    scene_init(
        &scene, h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 1000,
                                         .tilesPerFrame = 16,
                                         .maxLoadsInFlight = 64,
                                         .retryDelayTicks = 3});
    uint32_t first =
        scene_add(&scene, pattern_source(PATTERN_LEVEL, 2048, 2048, SLUICE_FORMAT_R8G8B8A8_UNORM));
    scene_aim(&scene, first, SCENE_SAMPLES, &everything_fine);
    scene_settle(&scene, 20);
    uint32_t second = scene_add(
        &scene, pattern_source(PATTERN_LEVEL, 1000, 1000, SLUICE_FORMAT_R16G16B16A16_SFLOAT));
    scene_aim(&scene, second, 100, &everything_fine);
    for (int i = 0; i < 20; i++) {
        scene_settle(&scene, 1);
        scene_check_levels(&scene);
    }
    assert_true(h->log_count[SLUICE_LOG_WARNING] > 0);
    assert_true(scene_missing(&scene) > 100);
    for (uint32_t i = 0; i < 100; i++)
        assert_in_range(scene_outputs(&scene, second)[i].level, 1, 6); /* packed from 4 on */
    uint32_t sharp = 0;
    for (uint32_t i = 0; i < SCENE_SAMPLES; i++)
        sharp += scene_outputs(&scene, first)[i].level < 2;
    assert_true(sharp > 0);
    assert_int_equal(scene_non_resident(&scene), 0);
    scene_finish(&scene);
    h->quiet = false;
    CHECK_OK(harness_set_context(h, NULL));
}

static void pages_found_by_a_loop_are_those_found_by_an_index(void **state)
{
    static struct ProbeOutput outputs[2][PROBE_CAPACITY];
    struct harness *h = *state;
    for (int loop = 0; loop < 2; loop++) {
        h->page_loop = loop;
        struct scene scene;
        scene_init(
            &scene, h,
            (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                             .feedbackTimeoutTicks = 1000});
        roll_seed(41);
        for (uint32_t i = 0; i < 4; i++) {
            const SluiceFormat formats[] = {SLUICE_FORMAT_R8G8B8A8_UNORM, SLUICE_FORMAT_R8_UNORM,
                                            SLUICE_FORMAT_R16_SFLOAT, SLUICE_FORMAT_R32_SFLOAT};
            uint32_t t = scene_add(&scene, pattern_source(PATTERN_HASH, 1000, 1100, formats[i]));
            const struct scene_aim aim = {-0.5, -0.5, 2, 2, -1, 4, 0, 0};
            scene_aim(&scene, t, SCENE_SAMPLES, &aim);
        }
        scene_settle(&scene, 12);
        assert_int_equal(scene_missing(&scene), 0);
        memcpy(outputs[loop], prober_outputs(&scene.prober), sizeof outputs[loop]);
        scene_finish(&scene);
    }
    h->page_loop = false;
    assert_memory_equal(outputs[0], outputs[1], sizeof outputs[0]);
}

/* Unwanted tiles of one format occupy all pages: their image is destroyed, and another one
 * created. */
static void standby_tiles_make_room_for_those_of_another_format(void **state)
{
    struct harness *h = *state;
    struct scene scene;
    const struct scene_aim fine = {0, 0, 0.6, 0.6, 0.1, 0.2, 0, 0};
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    h->quiet = true; /* the shortage of pages is expected */
    CHECK_OK(harness_set_context(h, &(SluiceVulkanContextCreateInfo){.maxPageChunkCount = 2}));
    scene_init(
        &scene, h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 4,
                                         .numExtraStandbyTiles = 1024});
    uint32_t first =
        scene_add(&scene, pattern_source(PATTERN_LEVEL, 2048, 2048, SLUICE_FORMAT_R8G8B8A8_UNORM));
    uint32_t second = scene_add(
        &scene, pattern_source(PATTERN_LEVEL, 1024, 1024, SLUICE_FORMAT_R16G16B16A16_SFLOAT));
    scene_aim(&scene, first, 200, &fine);
    scene_settle(&scene, 20);
    assert_int_equal(scene_missing(&scene), 0);
    sluiceGetVulkanStreamerStatistics(scene.streamer, &stats);
    assert_int_equal(stats.pageChunkCount, 2); /* 65 to 128 tiles */
    scene.textures[first].sample_count = 0;
    scene_aim(&scene, second, 100, &fine);
    scene_settle(&scene, 90);
    assert_int_equal(scene_missing(&scene), 0);
    scene_check_levels(&scene);
    h->quiet = false;
    scene_finish(&scene);
    CHECK_OK(harness_set_context(h, NULL));
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    if (h.mode != SLUICE_RESIDENCY_MODE_PAGED) {
        printf("1..0 # SKIP only paged residency has pages\n");
        return harness_finish(&h, 77);
    }
    struct CMUnitTest tests[] = {
        cmocka_unit_test(memory_comes_back_when_no_tile_needs_it),
        cmocka_unit_test(pages_that_run_out_leave_coarse_pictures_and_room_for_packed_levels),
        cmocka_unit_test(standby_tiles_make_room_for_those_of_another_format),
        cmocka_unit_test(pages_found_by_a_loop_are_those_found_by_an_index),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
