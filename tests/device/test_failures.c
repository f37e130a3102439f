/* Sources that fail, wait or vanish; too little memory; wrong arguments. */
#include "device/scene.h"

#include "support/failing_allocator.h"
#include "support/fault_source.h"
#include "support/map_everything.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

static const struct scene_aim fine = {0.05, 0.05, 0.9, 0.9, 0.2, 0.3, 0, 0};

/* A scene with one 1024x1024 texture behind a source that can be made to fail. */
struct faulty {
    struct scene scene;
    struct fault_source fault;
    SluiceImageSource *inner;
    uint32_t texture;
};

static void faulty_init(struct faulty *f, struct harness *h, SluiceVulkanStreamerCreateInfo info)
{
    f->inner = pattern_source(PATTERN_LEVEL, 1024, 1024, SLUICE_FORMAT_R8G8B8A8_UNORM);
    fault_source_init(&f->fault, f->inner);
    f->fault.failure = SLUICE_ERROR_IO;
    h->quiet = true;
    scene_init(&f->scene, h, info);
    f->texture = scene_add(&f->scene, &f->fault.base);
    f->scene.textures[f->texture].owns = false;
}

static void faulty_finish(struct faulty *f)
{
    f->scene.h->quiet = false;
    scene_finish(&f->scene);
    fault_source_finish(&f->fault);
    sluiceDestroyImageSource(f->inner);
}

static void check_fallback(const struct scene *scene, uint32_t texture, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        assert_int_equal(scene_outputs(scene, texture)[i].level, SLUICE_MIP_UNTOUCHED);
        assert_float_equal(scene_outputs(scene, texture)[i].color[0], 0.5f, 0);
    }
}

static void failing_tiles_leave_the_coarse_picture_until_the_source_recovers(void **state)
{
    struct faulty f;
    faulty_init(
        &f, *state,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 1000,
                                         .retryDelayTicks = 2});
    scene_settle(&f.scene, 6); /* the packed levels */
    f.fault.fail_at = atomic_load(&f.fault.read_count) + 1;
    f.fault.fails_on = true;
    scene_aim(&f.scene, f.texture, 200, &fine);
    scene_settle(&f.scene, 8);
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    sluiceGetVulkanStreamerStatistics(f.scene.streamer, &stats);
    assert_true(stats.tilesFailed > 0);
    assert_true(f.scene.h->log_count[SLUICE_LOG_WARNING] > 0);
    assert_int_equal(scene_missing(&f.scene), 200);
    for (uint32_t i = 0; i < 200; i++)
        assert_in_range(scene_outputs(&f.scene, f.texture)[i].level, 3, 4);
    scene_check_levels(&f.scene);
    f.fault.fail_at = 0; /* no read is under way */
    scene_settle(&f.scene, 30);
    assert_int_equal(scene_missing(&f.scene), 0);
    scene_check_levels(&f.scene);
    assert_int_equal(scene_non_resident(&f.scene), 0);
    faulty_finish(&f);
}

static void failing_packed_levels_show_the_fallback_until_the_source_recovers(void **state)
{
    struct faulty f;
    faulty_init(
        &f, *state,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 1000,
                                         .retryDelayTicks = 2});
    f.fault.fail_at = 1;
    f.fault.fails_on = true;
    scene_aim(&f.scene, f.texture, 100, &fine);
    scene_settle(&f.scene, 6);
    check_fallback(&f.scene, f.texture, 100);
    f.fault.fail_at = 0;
    scene_settle(&f.scene, 40);
    assert_int_equal(scene_missing(&f.scene), 0);
    assert_int_equal(scene_non_resident(&f.scene), 0);
    faulty_finish(&f);
}

static void source_that_is_not_ready_is_asked_again(void **state)
{
    struct faulty f;
    faulty_init(
        &f, *state,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 1000});
    f.fault.postponed = 40;
    scene_aim(&f.scene, f.texture, 100, &fine);
    for (int i = 0; i < 200 && (i < 20 || scene_missing(&f.scene)); i++)
        scene_settle(&f.scene, 1);
    assert_int_equal(scene_missing(&f.scene), 0);
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    sluiceGetVulkanStreamerStatistics(f.scene.streamer, &stats);
    assert_int_equal(stats.tilesFailed, 0);
    faulty_finish(&f);
}

static void texture_removed_while_it_loads_leaves_the_others_alone(void **state)
{
    struct faulty f;
    faulty_init(
        &f, *state,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 1000});
    uint32_t other = scene_add(
        &f.scene, pattern_source(PATTERN_LEVEL, 1000, 500, SLUICE_FORMAT_R16G16B16A16_SFLOAT));
    scene_aim(&f.scene, f.texture, 100, &fine);
    scene_aim(&f.scene, other, 100, &fine);
    f.fault.holds = true;
    for (int i = 0; i < 3; i++)
        harness_frame(f.scene.h, f.scene.streamer, true, scene_record, &f.scene);
    fault_source_await(&f.fault, 1);
    scene_remove(&f.scene, f.texture);
    harness_frame(f.scene.h, f.scene.streamer, true, scene_record, &f.scene);
    fault_source_release(&f.fault);
    scene_settle(&f.scene, 14);
    assert_int_equal(scene_missing(&f.scene), 0);
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    sluiceGetVulkanStreamerStatistics(f.scene.streamer, &stats);
    assert_int_equal(stats.textureCount, 1);
    assert_int_equal(stats.loadsInFlight, 0);
    assert_int_equal(scene_non_resident(&f.scene), 0);
    faulty_finish(&f);
}

static void texture_can_be_removed_after_any_number_of_frames(void **state)
{
    struct scene scene;
    scene_init(
        &scene, *state,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 1000,
                                         .maxTextureCount = 3});
    for (int frames = 0; frames < 9; frames++)
        for (int waits = 0; waits < 2; waits++) {
            uint32_t t = scene_add(
                &scene, pattern_source(PATTERN_LEVEL, 900, 700, SLUICE_FORMAT_R8G8B8A8_UNORM));
            scene_aim(&scene, t, 100, &fine);
            for (int i = 0; i < frames; i++) {
                if (waits)
                    CHECK_OK(sluiceWaitVulkanStreamerIdle(scene.streamer));
                harness_frame(scene.h, scene.streamer, waits, scene_record, &scene);
            }
            scene_remove(&scene, t);
            /* its place in the table is free again when nothing uses it any more */
            scene_settle(&scene, 3);
        }
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    sluiceGetVulkanStreamerStatistics(scene.streamer, &stats);
    assert_int_equal(stats.textureCount, 0);
    assert_int_equal(stats.retiringSlotCount, 0);
    assert_int_equal(scene_non_resident(&scene), 0);
    scene_finish(&scene);
}

static void loads_nobody_wants_any_more_are_canceled(void **state)
{
    struct harness *h = *state;
    struct faulty f;
    CHECK_OK(harness_set_context(h, &(SluiceVulkanContextCreateInfo){.loaderThreadCount = 1}));
    faulty_init(
        &f, h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 2});
    const struct scene_aim left = {0.02, 0.02, 0.2, 0.96, 0.2, 0.3, 0, 0};
    const struct scene_aim right = {0.7, 0.02, 0.2, 0.96, 0.2, 0.3, 0, 0};
    scene_settle(&f.scene, 6);
    f.fault.holds = true; /* no read is under way */
    scene_aim(&f.scene, f.texture, 200, &left);
    for (int i = 0; i < 4; i++)
        harness_frame(f.scene.h, f.scene.streamer, true, scene_record, &f.scene);
    fault_source_await(&f.fault, 1);
    scene_aim(&f.scene, f.texture, 200, &right);
    for (int i = 0; i < 6; i++)
        harness_frame(f.scene.h, f.scene.streamer, true, scene_record, &f.scene);
    fault_source_release(&f.fault);
    scene_settle(&f.scene, 14);
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    sluiceGetVulkanStreamerStatistics(f.scene.streamer, &stats);
    assert_true(stats.tilesCanceled > 0);
    assert_int_equal(stats.canceledTileCount, 0);
    assert_int_equal(scene_missing(&f.scene), 0);
    assert_int_equal(scene_non_resident(&f.scene), 0);
    faulty_finish(&f);
    CHECK_OK(harness_set_context(h, NULL));
}

static void working_set_beyond_the_heaps_is_coarser_but_right(void **state)
{
    struct scene scene;
    scene_init(
        &scene, *state,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 1000,
                                         .heapTileCapacity = 48,
                                         .maxHeapCount = 1});
    uint32_t t =
        scene_add(&scene, pattern_source(PATTERN_LEVEL, 2048, 2048, SLUICE_FORMAT_R8G8B8A8_UNORM));
    scene_aim(&scene, t, SCENE_SAMPLES, &fine);
    for (int i = 0; i < 30; i++) {
        scene_settle(&scene, 1);
        scene_check_levels(&scene);
    }
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    sluiceGetVulkanStreamerStatistics(scene.streamer, &stats);
    assert_int_equal(stats.heapCount, 1);
    if (scene.h->mode == SLUICE_RESIDENCY_MODE_SPARSE)
        assert_in_range(stats.tileMemorySize, 48 * 65536, 49 * 65536); /* with an empty page */
    assert_true(scene_missing(&scene) > 0);
    assert_true(stats.mappedTileCount > 20);
    for (uint32_t i = 0; i < SCENE_SAMPLES; i++)
        assert_true(scene_outputs(&scene, t)[i].level <= 4);
    assert_int_equal(scene_non_resident(&scene), 0);
    scene_finish(&scene);
}

static void heap_that_the_device_cannot_have_is_smaller(void **state)
{
    struct harness *h = *state;
    uint64_t largest = 0;
    for (uint32_t i = 0; i < h->memory.memoryHeapCount; i++)
        if (h->memory.memoryHeaps[i].size > largest)
            largest = h->memory.memoryHeaps[i].size;
    const uint32_t capacity = 1u << 20;
    if (largest >= (uint64_t)capacity * 65536)
        SKIP_TEST("the device has memory for the largest heap that can be asked for");
    struct scene scene;
    uint32_t warnings = h->log_count[SLUICE_LOG_WARNING];
    h->quiet = true;
    scene_init(
        &scene, h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .heapTileCapacity = capacity});
    h->quiet = false;
    assert_int_equal(h->log_count[SLUICE_LOG_WARNING], warnings + 1);
    assert_non_null(strstr(h->last_message, "heapTileCapacity is 1048576"));
    uint32_t t =
        scene_add(&scene, pattern_source(PATTERN_LEVEL, 512, 512, SLUICE_FORMAT_R8G8B8A8_UNORM));
    scene_aim(&scene, t, 100, &fine);
    scene_settle(&scene, 6);
    assert_int_equal(scene_missing(&scene), 0);
    scene_finish(&scene);
}

static void creation_survives_every_allocation_failure(void **state)
{
    struct harness *h = *state;
    for (uint64_t n = 0;; n++) {
        struct failing_allocator a;
        failing_allocator_init(&a, n);
        SluiceVulkanStreamerCreateInfo info = {
            .structSize = sizeof info, .tilesPerFrame = 16, .pDebug = &map_everything};
        SluiceVulkanStreamer *streamer = NULL;
        SluiceResult result =
            harness_set_context(h, &(SluiceVulkanContextCreateInfo){.pAllocator = &a.callbacks});
        harness_fill(h, &info);
        if (result == SLUICE_SUCCESS)
            result = sluiceCreateVulkanStreamer(&info, &streamer);
        assert_true((result == SLUICE_SUCCESS) == (streamer != NULL));
        harness_destroy(h, streamer);
        CHECK_OK(harness_set_context(h, NULL));
        assert_int_equal(a.live_count, 0);
        if (result == SLUICE_SUCCESS)
            break;
        CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    }
    harness_check_silence(h);
}

static void adding_and_streaming_survive_every_allocation_failure(void **state)
{
    struct harness *h = *state;
    struct failing_allocator a;
    failing_allocator_init(&a, UINT64_MAX);
    SluiceImageSource *source =
        pattern_source(PATTERN_LEVEL, 1024, 1024, SLUICE_FORMAT_R8G8B8A8_UNORM);
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info, .feedbackTimeoutTicks = 1000};
    CHECK_OK(harness_set_context(h, &(SluiceVulkanContextCreateInfo){.pAllocator = &a.callbacks}));
    harness_fill(h, &info);
    h->quiet = true;
    SluiceVulkanStreamer *streamer;
    CHECK_OK(sluiceCreateVulkanStreamer(&info, &streamer));
    SluiceVulkanTextureCreateInfo texture_info = {.structSize = sizeof texture_info,
                                                  .source = source};
    SluiceVulkanTexture texture;
    for (uint64_t n = 0;; n++) {
        a.refuse_from = a.calls + n;
        SluiceResult result = sluiceAddVulkanTexture(streamer, &texture_info, &texture);
        a.refuse_from = UINT64_MAX;
        if (result == SLUICE_SUCCESS)
            break;
        CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
        sluiceGetVulkanStreamerStatistics(streamer, &stats);
        assert_int_equal(stats.textureCount, 0);
    }
    struct prober prober;
    prober_init(&prober, h, streamer);
    struct scene scene = {.h = h, .streamer = streamer, .prober = prober};
    scene.textures[0] = (struct scene_texture){.used = true,
                                               .texture = texture,
                                               .anisotropy = 1,
                                               .probe = prober_texture(&prober, &texture, 0, 0, 1)};
    scene.prober = prober; /* with the samplers */
    scene.textures[0].info.structSize = sizeof scene.textures[0].info;
    CHECK_OK(sluiceGetImageInfo(source, &scene.textures[0].info));
    scene_aim(&scene, 0, 200, &fine);
    for (uint64_t n = 0; n < 30; n++) {
        a.refuse_from = a.calls + n / 6;
        scene_settle(&scene, 1);
        scene_check_levels(&scene);
    }
    a.refuse_from = UINT64_MAX;
    scene_settle(&scene, 14);
    assert_int_equal(scene_missing(&scene), 0);
    h->quiet = false;
    scene_finish(&scene);
    CHECK_OK(harness_set_context(h, NULL));
    assert_int_equal(a.live_count, 0);
    sluiceDestroyImageSource(source);
}

static void wrong_arguments_are_refused_and_change_nothing(void **state)
{
    struct harness *h = *state;
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info};
    SluiceVulkanStreamer *streamer;
    CHECK_RESULT(sluiceCreateVulkanStreamer(NULL, &streamer), SLUICE_ERROR_NULL_POINTER);
    CHECK_RESULT(sluiceCreateVulkanStreamer(&info, &streamer), SLUICE_ERROR_NULL_POINTER);
    assert_null(streamer);
    harness_fill(h, &info);
    CHECK_RESULT(sluiceCreateVulkanStreamer(&info, NULL), SLUICE_ERROR_NULL_POINTER);
    info.tilesPerFrame = 1u << 15;
    CHECK_RESULT(sluiceCreateVulkanStreamer(&info, &streamer), SLUICE_ERROR_INVALID_ARGUMENT);
    info.tilesPerFrame = 0;
    info.residencyMode = (SluiceResidencyMode)77;
    CHECK_RESULT(sluiceCreateVulkanStreamer(&info, &streamer), SLUICE_ERROR_INVALID_ARGUMENT);
    info.residencyMode = h->mode;
    info.maxTextureCount = 2;
    info.maxRegionCount = 100;
    h->quiet = true;
    CHECK_OK(sluiceCreateVulkanStreamer(&info, &streamer));

    SluiceImageSource *small =
        pattern_source(PATTERN_LEVEL, 512, 512, SLUICE_FORMAT_R8G8B8A8_UNORM);
    SluiceImageSource *wide =
        pattern_source(PATTERN_LEVEL, 2048, 2048, SLUICE_FORMAT_R8G8B8A8_UNORM);
    SluiceVulkanTextureCreateInfo texture = {.structSize = sizeof texture};
    SluiceVulkanTexture first, second;
    CHECK_RESULT(sluiceAddVulkanTexture(streamer, &texture, &first), SLUICE_ERROR_NULL_POINTER);
    texture.source = wide; /* 256 regions */
    CHECK_RESULT(sluiceAddVulkanTexture(streamer, &texture, &first), SLUICE_ERROR_LIMIT_EXCEEDED);
    texture.source = small;
    texture.addressModeU = (VkSamplerAddressMode)9;
    CHECK_RESULT(sluiceAddVulkanTexture(streamer, &texture, &first), SLUICE_ERROR_INVALID_ARGUMENT);
    texture.addressModeU = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    texture.primaryId = 12345;
    assert_true(sluiceAddVulkanTexture(streamer, &texture, &first) < 0);
    texture.primaryId = SLUICE_NO_TEXTURE;
    CHECK_OK(sluiceAddVulkanTexture(streamer, &texture, &first));
    texture.primaryId = first.textureId;
    CHECK_OK(sluiceAddVulkanTexture(streamer, &texture, &second));
    CHECK_RESULT(sluiceAddVulkanTexture(streamer, &texture, &second), SLUICE_ERROR_LIMIT_EXCEEDED);
    assert_true(sluiceRemoveVulkanTexture(streamer, 12345) < 0);
    CHECK_OK(sluiceRemoveVulkanTexture(streamer, first.textureId));
    CHECK_RESULT(sluiceRemoveVulkanTexture(streamer, first.textureId), SLUICE_ERROR_STALE_TEXTURE);
    h->quiet = false;
    harness_destroy(h, streamer);
    sluiceDestroyImageSource(small);
    sluiceDestroyImageSource(wide);
    harness_check_silence(h);
}

static void storage_buffers_beyond_the_device_limit_are_refused(void **state)
{
    struct harness *h = *state;
    VkPhysicalDeviceProperties properties;
    h->GetPhysicalDeviceProperties(h->physical_device, &properties);
    if (properties.limits.maxStorageBufferRange >= 1u << 30)
        SKIP_TEST("the device has room for the largest buffer that can be asked for");
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                           .maxRegionCount =
                                               properties.limits.maxStorageBufferRange / 4 + 4};
    harness_fill(h, &info);
    SluiceVulkanStreamer *streamer;
    h->quiet = true;
    CHECK_RESULT(sluiceCreateVulkanStreamer(&info, &streamer), SLUICE_ERROR_LIMIT_EXCEEDED);
    info.maxRegionCount = 1 << 10;
    info.maxTextureCount = properties.limits.maxStorageBufferRange / 64 + 1;
    SluiceResult result = sluiceCreateVulkanStreamer(&info, &streamer);
    assert_true(result == SLUICE_ERROR_LIMIT_EXCEEDED || result == SLUICE_ERROR_INVALID_ARGUMENT);
    h->quiet = false;
    harness_check_silence(h);
}

static void image_beyond_the_sparse_address_space_is_refused(void **state)
{
    struct harness *h = *state;
    const uint64_t size = 16384ull * 16384 * 16 * 4 / 3;
    if (h->mode != SLUICE_RESIDENCY_MODE_SPARSE)
        SKIP_TEST("only sparse images have an address space");
    if (h->caps.sparseAddressSpaceSize >= size)
        SKIP_TEST("the device has room for the largest image that there is");
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info};
    harness_fill(h, &info);
    SluiceVulkanStreamer *streamer;
    CHECK_OK(sluiceCreateVulkanStreamer(&info, &streamer));
    SluiceImageSource *source =
        pattern_source(PATTERN_LEVEL, 16384, 16384, SLUICE_FORMAT_R32G32B32A32_SFLOAT);
    SluiceVulkanTextureCreateInfo texture = {.structSize = sizeof texture, .source = source};
    SluiceVulkanTexture added;
    h->quiet = true;
    CHECK_RESULT(sluiceAddVulkanTexture(streamer, &texture, &added), SLUICE_ERROR_UNSUPPORTED);
    h->quiet = false;
    harness_destroy(h, streamer);
    sluiceDestroyImageSource(source);
    harness_check_silence(h);
}

static void begin_refuses_time_that_goes_back_and_too_many_frames(void **state)
{
    struct harness *h = *state;
    struct scene scene;
    scene_init(
        &scene, h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo)});
    harness_frame(h, scene.streamer, true, NULL, NULL);
    SluiceStreamingFrame frame = {.structSize = sizeof frame};
    VkCommandBuffer commands = h->commands[1];
    CHECK_RESULT(sluiceBeginStreamingFrame(scene.streamer, commands, h->time - 1, &frame),
                 SLUICE_ERROR_TIME_BACKWARDS);
    CHECK_RESULT(sluiceBeginStreamingFrame(scene.streamer, NULL, h->time, &frame),
                 SLUICE_ERROR_NULL_POINTER);
    VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    assert_int_equal(h->BeginCommandBuffer(commands, &begin), VK_SUCCESS);
    for (uint32_t i = 0; i < HARNESS_FRAMES; i++) {
        CHECK_OK(sluiceBeginStreamingFrame(scene.streamer, commands, ++h->time, &frame));
        assert_int_equal(frame.frameIndex, 2 + i);
        CHECK_OK(sluiceEndStreamingFrame(scene.streamer, commands));
        CHECK_RESULT(sluiceEndStreamingFrame(scene.streamer, commands),
                     SLUICE_ERROR_INVALID_ARGUMENT);
    }
    CHECK_RESULT(sluiceBeginStreamingFrame(scene.streamer, commands, ++h->time, &frame),
                 SLUICE_NOT_READY);
    assert_int_equal(h->EndCommandBuffer(commands), VK_SUCCESS); /* and is never submitted */
    scene_finish(&scene);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(failing_tiles_leave_the_coarse_picture_until_the_source_recovers),
        cmocka_unit_test(failing_packed_levels_show_the_fallback_until_the_source_recovers),
        cmocka_unit_test(source_that_is_not_ready_is_asked_again),
        cmocka_unit_test(texture_removed_while_it_loads_leaves_the_others_alone),
        cmocka_unit_test(texture_can_be_removed_after_any_number_of_frames),
        cmocka_unit_test(loads_nobody_wants_any_more_are_canceled),
        cmocka_unit_test(working_set_beyond_the_heaps_is_coarser_but_right),
        cmocka_unit_test(heap_that_the_device_cannot_have_is_smaller),
        cmocka_unit_test(creation_survives_every_allocation_failure),
        cmocka_unit_test(adding_and_streaming_survive_every_allocation_failure),
        cmocka_unit_test(wrong_arguments_are_refused_and_change_nothing),
        cmocka_unit_test(storage_buffers_beyond_the_device_limit_are_refused),
        cmocka_unit_test(image_beyond_the_sparse_address_space_is_refused),
        cmocka_unit_test(begin_refuses_time_that_goes_back_and_too_many_frames),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
