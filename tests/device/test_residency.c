/* Residency: for any resident tiles, no sample touches others, and the shown level is allowed. */
#include "device/scene.h"

#include "support/fault_source.h"
#include "support/roll.h"
#include "support/test.h"

#include <math.h>

static double draw(void)
{
    return (double)roll() / ROLL_MAX;
}

static struct scene_aim random_aim(float anisotropy)
{
    struct scene_aim aim = {draw() * 1.5 - 0.5,
                            draw() * 1.5 - 0.5,
                            0.05 + draw() * 0.4,
                            0.05 + draw() * 0.4,
                            -1,
                            0,
                            0,
                            0};
    aim.min_lod = draw() * 5 - 1;
    aim.max_lod = aim.min_lod + draw() * 3;
    aim.max_ratio = anisotropy > 1 ? 30 : roll() % 2 ? 3 : 0;
    aim.bias = roll() % 4 ? 0.0f : (float)(draw() * 2 - 1);
    return aim;
}

static uint32_t add_random(struct scene *scene, float anisotropy)
{
    const uint32_t sizes[][2] = {{1024, 1024}, {1000, 1500}, {2048, 300}, {129, 2000}, {700, 700}};
    const SluiceFormat formats[] = {SLUICE_FORMAT_R8G8B8A8_UNORM, SLUICE_FORMAT_R16G16B16A16_SFLOAT,
                                    SLUICE_FORMAT_R32_SFLOAT, SLUICE_FORMAT_R32G32B32A32_SFLOAT};
    /* no border: its color would look like texels that are not resident */
    const VkSamplerAddressMode modes[] = {
        VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT,
        VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
        scene->h->mirror_clamp ? VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE
                               : VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE};
    const uint32_t *size = sizes[roll() % 5];
    uint32_t t =
        scene_add_as(scene, pattern_source(PATTERN_LEVEL, size[0], size[1], formats[roll() % 4]),
                     modes[roll() % 4], modes[roll() % 4], anisotropy, SLUICE_NO_TEXTURE);
    struct scene_aim aim = random_aim(anisotropy);
    scene_aim(scene, t, 128, &aim);
    return t;
}

static void churn(struct harness *h, float anisotropy, uint32_t frame_count)
{
    struct scene scene;
    scene_init(
        &scene, h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 4,
                                         .tilesPerFrame = 32,
                                         .heapTileCapacity = 64,
                                         .maxHeapCount = 5,
                                         .texturesPerFrame = 4});
    for (uint32_t i = 0; i < 8; i++)
        add_random(&scene, anisotropy);
    for (uint32_t frame = 0; frame < frame_count; frame++) {
        uint32_t t = (uint32_t)roll() % 8;
        if (frame % 3 == 0) {
            /* inputs may only change while no frame reads them */
            assert_int_equal(h->DeviceWaitIdle(h->device), VK_SUCCESS);
            if (frame)
                scene_check_levels(&scene);
            struct scene_aim aim = random_aim(anisotropy);
            scene_aim(&scene, t, 128, &aim);
        }
        if (frame % 40 == 39) {
            assert_int_equal(h->DeviceWaitIdle(h->device), VK_SUCCESS);
            scene_remove(&scene, t);
            add_random(&scene, anisotropy);
        }
        harness_frame(h, scene.streamer, roll() % 4 == 0, scene_record, &scene);
    }
    assert_int_equal(h->DeviceWaitIdle(h->device), VK_SUCCESS);
    scene_check_levels(&scene);
    assert_int_equal(scene_non_resident(&scene), 0);
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    sluiceGetVulkanStreamerStatistics(scene.streamer, &stats);
    assert_true(stats.tilesMapped > frame_count);
    assert_true(stats.tilesUnmapped > frame_count / 4);
    if (h->mode == SLUICE_RESIDENCY_MODE_PAGED) /* and the texels of these are right, too */
        assert_true(stats.tilesRestored > frame_count / 10);
    assert_in_range(stats.heapCount, 1, 5);
    scene_finish(&scene);
}

static void far_coordinates_touch_nothing_that_is_not_there(void **state)
{
    const float far[] = {1e3f, 262144.0f, 1e6f, -1e6f, 1e7f, 1e9f, -1e18f, 1e30f, 3e38f};
    const VkSamplerAddressMode modes[] = {VK_SAMPLER_ADDRESS_MODE_REPEAT,
                                          VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT,
                                          VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE};
    const struct scene_aim corner = {0.01, 0.01, 0.02, 0.02, 0.2, 0.3, 0, 0};
    struct scene scene;
    scene_init(
        &scene, *state,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 1000});
    uint32_t textures[6];
    for (uint32_t i = 0; i < 6; i++) {
        uint32_t size = i < 3 ? 2048 : 1500;
        textures[i] = scene_add_as(
            &scene, pattern_source(PATTERN_LEVEL, size, size, SLUICE_FORMAT_R8G8B8A8_UNORM),
            modes[i % 3], modes[i % 3], 1, SLUICE_NO_TEXTURE);
        scene_aim(&scene, textures[i], 64, &corner);
    }
    scene_settle(&scene, 14);
    assert_int_equal(scene_missing(&scene), 0);
    for (uint32_t f = 0; f < sizeof far / sizeof far[0]; f++) {
        for (uint32_t i = 0; i < 6; i++) {
            scene.textures[textures[i]].no_feedback = true; /* only the corner stays resident */
            scene_aim(&scene, textures[i], 64, &corner);
            struct ProbeInput *inputs = scene_inputs(&scene, textures[i]);
            for (uint32_t j = 0; j < 64; j++)
                inputs[j].uv[0] += far[f], inputs[j].uv[1] += far[f];
            /* A driver's coordinates of ordinary images overflow there where they are clamped. */
            if (scene.h->mode == SLUICE_RESIDENCY_MODE_DENSE && fabsf(far[f]) > 1e3f &&
                modes[i % 3] == VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE)
                scene.textures[textures[i]].sample_count = 0;
        }
        scene_settle(&scene, 1);
        scene_check_levels(&scene);
        assert_int_equal(scene_non_resident(&scene), 0);
    }
    scene_finish(&scene);
}

static void thousand_trilinear_frames_touch_nothing_that_is_not_there(void **state)
{
    roll_seed(21);
    churn(*state, 1.0f, 1000);
}

static void anisotropic_frames_touch_nothing_that_is_not_there(void **state)
{
    struct harness *h = *state;
    if (!h->anisotropy)
        SKIP_TEST("the device has no anisotropic filtering");
    roll_seed(22);
    churn(h, 16.0f, 400);
    churn(h, 2.0f, 200);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(far_coordinates_touch_nothing_that_is_not_there),
        cmocka_unit_test(thousand_trilinear_frames_touch_nothing_that_is_not_there),
        cmocka_unit_test(anisotropic_frames_touch_nothing_that_is_not_there),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
