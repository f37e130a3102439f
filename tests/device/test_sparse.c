/* Sparse images: the device's reports, and its limits. */
#include "device/scene.h"

#include "support/roll.h"
#include "support/streamer_manager.h"
#include "support/test.h"

#include <stdio.h>

static SluiceVulkanStreamerCreateInfo sparse_info(void)
{
    return (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                            .residencyMode = SLUICE_RESIDENCY_MODE_SPARSE,
                                            .feedbackTimeoutTicks = 100};
}

static const SluiceFormat rgba8 = SLUICE_FORMAT_R8G8B8A8_UNORM;

/* An image has the layout that the format reports. The arithmetic of tails must always hold. */
static void layouts_agree_with_formats(void **state)
{
    struct harness *h = *state;
    static const uint32_t sizes[][2] = {{1, 1}, {1024, 1024}, {1000, 600}, {8192, 64}};
    uint32_t sparse_count = 0;
    for (uint32_t f = 1; f < SLUICE_FORMAT_COUNT; f++) {
        SluiceVulkanFormatCapabilities format = {.structSize = sizeof format};
        CHECK_OK(sluiceGetVulkanFormatCapabilities(h->instance, h->physical_device, h->get,
                                                   (SluiceFormat)f, &format));
        sparse_count += format.sparse;
        for (uint32_t s = 0; s < 4 && format.sparse; s++) {
            SluiceImageInfo info = {sizeof info, sizes[s][0],     sizes[s][1],
                                    0,           (SluiceFormat)f, "probe"};
            SluiceVulkanSparseImageLayout layout = {.structSize = sizeof layout};
            CHECK_OK(sluiceGetVulkanSparseImageLayout(h->instance, h->physical_device, h->device,
                                                      h->get, NULL, &info, &layout));
            assert_int_equal(layout.tileWidth, format.tileWidth);
            assert_int_equal(layout.tileHeight, format.tileHeight);
            assert_int_equal(
                sluiceGetFormatRegionSize((SluiceFormat)f, layout.tileWidth, layout.tileHeight),
                65536);
            assert_true(layout.regularMipCount <= layout.mipLevelCount);
            assert_true(layout.packedTileCount > 0 ||
                        layout.regularMipCount == layout.mipLevelCount);
            if (layout.driverTail)
                assert_true(layout.tailSize <= layout.packedTileCount * 65536ull);
            else
                assert_int_equal(layout.packedTileCount,
                                 layout.mipLevelCount - layout.regularMipCount);
        }
    }
    assert_true(sparse_count >=
                6); /* minimum that Vulkan requires of a device with sparse residency */
    harness_check_silence(h);
}

static void capabilities_make_sense(void **state)
{
    struct harness *h = *state;
    const SluiceVulkanDeviceCapabilities *caps = &h->caps;
    assert_true(caps->sparse && caps->timelineSemaphore && caps->fragmentStoresAndAtomics);
    assert_true(caps->maxImageExtent >= 4096 && caps->maxImageArrayLayers >= 256);
    assert_true(caps->sparseQueueCount >= 1);
    assert_true(caps->deviceLocalMemorySize > 0);
    assert_true(caps->driverName[0] != '\0');
    assert_true(caps->shaderResourceResidency || !caps->residencyCodesExact);
    if (caps->deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU) {
        assert_false(caps->residencyCodesExact);
        assert_in_range(caps->maxTouchedTiles, 1, UINT32_MAX);
    } else {
        assert_int_equal(caps->maxTouchedTiles, 0);
    }
}

/* Maps as many tiles as the limit allows. The rest stays coarse, and nothing waits. */
static void textures_stay_coarse_where_no_more_tiles_are_borne(void **state)
{
    struct harness *h = *state;
    struct scene scene;
    SluiceVulkanStreamerCreateInfo info = sparse_info();
    info.maxTouchedTiles = 40;
    scene_init(&scene, h, info);
    roll_seed(6);
    h->quiet = true;
    const struct scene_aim everywhere = {0, 0, 1, 1, 0, 3, 0, 0};
    uint32_t t = scene_add(&scene, pattern_source(PATTERN_LEVEL, 2048, 2048, rgba8));
    scene_aim(&scene, t, 128, &everywhere);
    scene_settle(&scene, 30);
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    sluiceGetVulkanStreamerStatistics(scene.streamer, &stats);
    assert_in_range(stats.mappedTileCount, 30, 40);
    assert_int_equal(stats.loadsInFlight, 0);
    assert_true(stats.tilesFailed > 0);
    assert_true(scene_missing(&scene) > 0);
    scene_check_levels(&scene);
    assert_int_equal(scene_non_resident(&scene), 0);

    SluiceImageSource *source = pattern_source(PATTERN_LEVEL, 64, 64, rgba8);
    SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create, .source = source};
    SluiceVulkanTexture texture;
    CHECK_RESULT(sluiceAddVulkanTexture(scene.streamer, &create, &texture),
                 SLUICE_ERROR_LIMIT_EXCEEDED);
    scene_remove(&scene, t);
    scene_settle(&scene, 8);
    CHECK_OK(sluiceAddVulkanTexture(scene.streamer, &create, &texture)); /* there is room again */
    h->quiet = false;
    scene_finish(&scene);
    sluiceDestroyImageSource(source);
}

/* Unmapped tiles that return with no other change in between cost no unbind. */
static void tiles_that_come_back_to_their_pages_need_no_unbind(void **state)
{
    struct scene scene;
    SluiceVulkanStreamerCreateInfo info = sparse_info();
    info.feedbackTimeoutTicks = 3;
    scene_init(&scene, *state, info);
    roll_seed(7);
    uint32_t t = scene_add(&scene, pattern_source(PATTERN_LEVEL, 2048, 2048, rgba8));
    const struct scene_aim fine = {0, 0, 0.5, 0.5, 0, 0.5, 0, 0}, coarse = {0, 0, 1, 1, 3, 4, 0, 0};
    for (uint32_t round = 0; round < 4; round++) {
        scene_aim(&scene, t, 64, round % 2 ? &coarse : &fine);
        scene_settle(&scene, 20);
        CHECK_OK(sluiceTrimStandbyTiles(manager_of(scene.streamer), 0));
        scene_settle(&scene, 6);
        scene_check_levels(&scene);
        assert_int_equal(scene_missing(&scene), 0);
    }
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    sluiceGetVulkanStreamerStatistics(scene.streamer, &stats);
    assert_true(stats.tilesUnmapped > 40);
    assert_true(stats.unbindsSaved > 40);
    assert_true(stats.tilesRestored > 40); /* restored with their texels */
    assert_true(stats.unbinds + stats.unbindsSaved <= stats.tilesUnmapped);
    assert_int_equal(scene_non_resident(&scene), 0);
    scene_finish(&scene);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    if (h.mode != SLUICE_RESIDENCY_MODE_SPARSE) {
        printf("1..0 # SKIP only sparse residency has sparse images\n");
        return harness_finish(&h, 77);
    }
    struct CMUnitTest tests[] = {
        cmocka_unit_test(capabilities_make_sense),
        cmocka_unit_test(layouts_agree_with_formats),
        cmocka_unit_test(textures_stay_coarse_where_no_more_tiles_are_borne),
        cmocka_unit_test(tiles_that_come_back_to_their_pages_need_no_unbind),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
