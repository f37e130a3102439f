/* Frames that are begun and never submitted do not affect the picture. */
#include "device/scene.h"

#include "support/roll.h"
#include "support/streamer_manager.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

enum { TEXTURES = 4, LEGS = 5, SAMPLES = 128 };

static const SluiceFormat formats[TEXTURES] = {SLUICE_FORMAT_R8G8B8A8_UNORM,
                                               SLUICE_FORMAT_R16G16B16A16_SFLOAT,
                                               SLUICE_FORMAT_R8_UNORM, SLUICE_FORMAT_R8G8B8A8_SRGB};

/* Samples at the end of each leg, and counts of resident and wanted tiles. */
struct walk {
    struct ProbeOutput outputs[LEGS][TEXTURES][SAMPLES];
    uint32_t mapped[LEGS][TEXTURES];
    uint64_t uploaded;
};

static void add_texture(struct scene *scene, uint32_t i, uint32_t leg)
{
    uint32_t t = scene_add(
        scene, pattern_source(PATTERN_HASH, leg % 2 ? 1024 : 1500, 700 + 100 * i, formats[i]));
    assert_int_equal(t, i);
}

static uint32_t count_mapped(const struct scene *scene, uint32_t i)
{
    const SluiceStreamedTextureManager *manager = manager_of(scene->streamer);
    SluiceTextureId id = scene->textures[i].texture.textureId;
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    uint32_t count = 0;
    CHECK_OK(sluiceGetTextureLayout(manager, id, &layout));
    for (uint32_t tile = 0; tile < layout.tileCount; tile++) {
        SluiceTileState state;
        CHECK_OK(sluiceGetTileState(manager, id, tile, &state, NULL));
        count += state == SLUICE_TILE_STATE_MAPPED;
    }
    return count;
}

/* The samples of a leg do not depend on the number of frames. */
static void aim(struct scene *scene, uint32_t leg)
{
    roll_seed(100 + leg);
    for (uint32_t i = 0; i < TEXTURES; i++) {
        const struct scene_aim where = {
            roll() % 100 / 100.0, roll() % 100 / 100.0, 0.4, 0.4, -1, 4, 0, 0};
        scene_aim(scene, i, SAMPLES, &where);
    }
}

static void take_walk(struct harness *h, struct walk *walk, uint32_t abandon_one_in)
{
    struct scene scene;
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    h->abandon_one_in = abandon_one_in;
    scene_init(
        &scene, h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 6,
                                         .tilesPerFrame = 16,
                                         .texturesPerFrame = 3});
    for (uint32_t leg = 0; leg < LEGS; leg++) {
        uint32_t gone = leg % TEXTURES;
        if (leg > 0)
            scene_remove(&scene, gone);
        for (uint32_t i = 0; leg == 0 && i < TEXTURES; i++)
            add_texture(&scene, i, 0);
        if (leg > 0)
            add_texture(&scene, gone, leg);
        aim(&scene, leg);
        for (uint32_t frame = 0; frame < 6; frame++)
            harness_frame(h, scene.streamer, frame % 3 == 0, scene_record, &scene);
        scene_settle(&scene, 26);
        assert_int_equal(scene_missing(&scene), 0);
        for (uint32_t i = 0; i < TEXTURES; i++) {
            memcpy(walk->outputs[leg][i], scene_outputs(&scene, i), sizeof walk->outputs[leg][i]);
            walk->mapped[leg][i] = count_mapped(&scene, i);
        }
    }
    assert_int_equal(scene_non_resident(&scene), 0);
    sluiceGetVulkanStreamerStatistics(scene.streamer, &stats);
    walk->uploaded = stats.bytesUploaded;
    scene_finish(&scene);
    h->abandon_one_in = 0;
}

static void a_walk_with_frames_given_up_ends_as_one_without(void **state)
{
    struct harness *h = *state;
    struct walk *plain = calloc(1, sizeof *plain), *given_up = calloc(1, sizeof *given_up);
    assert_true(plain && given_up);
    uint32_t before = h->abandoned_count;
    take_walk(h, plain, 0);
    take_walk(h, given_up, 2);
    assert_true(h->abandoned_count - before > 80);
    for (uint32_t leg = 0; leg < LEGS; leg++)
        for (uint32_t i = 0; i < TEXTURES; i++) {
            if (plain->mapped[leg][i] != given_up->mapped[leg][i])
                fail_msg("leg %u, texture %u: %u tiles are mapped, not %u", leg, i,
                         given_up->mapped[leg][i], plain->mapped[leg][i]);
            for (uint32_t s = 0; s < SAMPLES; s++)
                if (memcmp(&plain->outputs[leg][i][s], &given_up->outputs[leg][i][s],
                           sizeof(struct ProbeOutput)))
                    fail_msg("leg %u, texture %u: sample %u is another", leg, i, s);
        }
    free(plain);
    free(given_up);
}

/* Abandons more frames than may be in flight, from the first one on, as while a window is
 * minimized. */
static void any_number_of_frames_in_a_row_can_be_given_up(void **state)
{
    struct harness *h = *state;
    struct scene scene;
    const struct scene_aim fine = {0, 0, 1, 1, 0.1, 0.2, 0, 0};
    VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    scene_init(
        &scene, h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 1000});
    for (uint32_t round = 0; round < 2; round++) {
        scene_add(&scene, pattern_source(PATTERN_LEVEL, 1024, 1024, SLUICE_FORMAT_R8G8B8A8_UNORM));
        scene_aim(&scene, round, SAMPLES, &fine);
        for (uint32_t i = 0; i < 40; i++) {
            SluiceStreamingFrame frame = {.structSize = sizeof frame};
            VkCommandBuffer commands = h->commands[i % HARNESS_FRAMES];
            assert_int_equal(h->DeviceWaitIdle(h->device), VK_SUCCESS);
            assert_int_equal(h->ResetCommandBuffer(commands, 0), VK_SUCCESS);
            assert_int_equal(h->BeginCommandBuffer(commands, &begin), VK_SUCCESS);
            CHECK_OK(sluiceWaitVulkanStreamerIdle(scene.streamer));
            CHECK_OK(sluiceBeginStreamingFrame(scene.streamer, commands, ++h->time, &frame));
            if (i % 2)
                CHECK_OK(sluiceEndStreamingFrame(scene.streamer, commands));
            assert_int_equal(h->EndCommandBuffer(commands), VK_SUCCESS);
            CHECK_OK(sluiceAbandonStreamingFrame(scene.streamer, &frame));
        }
        /* packed levels were read and bound meanwhile, and are shown at once */
        scene_settle(&scene, 1);
        for (uint32_t s = 0; s < SAMPLES; s++)
            assert_true(scene_outputs(&scene, round)[s].level != SLUICE_MIP_UNTOUCHED);
        scene_settle(&scene, 14);
        assert_int_equal(scene_missing(&scene), 0);
    }
    scene_check_levels(&scene);
    assert_int_equal(h->log_count[SLUICE_LOG_WARNING], 0);
    scene_finish(&scene);
}

static void a_frame_is_given_up_once_and_not_after_it_was_submitted(void **state)
{
    struct harness *h = *state;
    struct scene scene;
    SluiceStreamingFrame none = {.structSize = sizeof none};
    scene_init(
        &scene, h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo)});
    harness_frame(h, scene.streamer, true, NULL, NULL);
    h->quiet = true;
    SluiceStreamingFrame submitted = h->last[(h->frame_count - 1) % HARNESS_FRAMES];
    CHECK_RESULT(sluiceAbandonStreamingFrame(scene.streamer, &submitted),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceAbandonStreamingFrame(scene.streamer, &none), SLUICE_ERROR_INVALID_ARGUMENT);
    h->quiet = false;
    harness_frame(h, scene.streamer, true, NULL, NULL);
    scene_finish(&scene);
}

static void an_upload_queue_copied_tiles(void **state)
{
    const struct harness *h = *state;
    assert_true(!h->upload_queue || h->upload_queue_copies > 100);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(a_walk_with_frames_given_up_ends_as_one_without),
        cmocka_unit_test(any_number_of_frames_in_a_row_can_be_given_up),
        cmocka_unit_test(a_frame_is_given_up_once_and_not_after_it_was_submitted),
        cmocka_unit_test(an_upload_queue_copied_tiles), /* after all other tests */
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
