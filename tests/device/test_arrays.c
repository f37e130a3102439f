/* Layers of arrays: each is streamed as a texture of its own, in every residency mode. */
#include "device/array_scene.h"

#include "base/checked.h"
#include "support/map_everything.h"
#include "support/roll.h"
#include "support/streamer_manager.h"
#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const SluiceFormat rgba8 = SLUICE_FORMAT_R8G8B8A8_UNORM;
static const struct scene_aim fine = {0, 0, 0.4, 0.4, 0, 1, 0, 0};

struct fetch {
    struct scene *scene;
    uint32_t texture, count;
};

static void record_fetch(void *user, VkCommandBuffer commands)
{
    struct fetch *fetch = user;
    prober_record(&fetch->scene->prober, commands, fetch->scene->textures[fetch->texture].probe, 0,
                  fetch->count, PROBE_FETCH);
}

static void check_texels(struct array_scene *a, uint32_t layer)
{
    const struct scene_texture *t = &a->scene.textures[layer];
    struct ProbeInput *inputs = prober_inputs(&a->scene.prober);
    struct fetch fetch = {&a->scene, layer, 0};
    for (uint32_t level = 0; level < t->info.mipLevelCount; level++)
        for (uint32_t i = 0; i < 64; i++)
            inputs[fetch.count++] = (struct ProbeInput){
                .uv = {(float)((uint32_t)roll() % slc_mip_size(t->info.width, level)),
                       (float)((uint32_t)roll() % slc_mip_size(t->info.height, level))},
                .lodBias = (float)level};
    harness_run(a->scene.h, record_fetch, &fetch);
    for (uint32_t i = 0; i < fetch.count; i++) {
        SluiceImageRegion region = {(uint32_t)inputs[i].lodBias, (uint32_t)inputs[i].uv[0],
                                    (uint32_t)inputs[i].uv[1], 1, 1};
        uint8_t expected[4];
        CHECK_OK(sluiceReadImageRegion(a->layers[layer], &region, expected, sizeof expected));
        for (uint32_t c = 0; c < 4; c++)
            assert_float_equal(prober_outputs(&a->scene.prober)[i].color[c],
                               (float)expected[c] / 255, 1e-5);
    }
}

static void layers_of_an_array_hold_their_own_texels(void **state)
{
    static const uint32_t sizes[][2] = {{1000, 600}, {16, 16}, {4096, 128}, {1, 1}};
    roll_seed(8);
    for (uint32_t s = 0; s < sizeof sizes / sizeof sizes[0]; s++) {
        struct array_scene a;
        SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                               .pDebug = &map_everything};
        if (!array_scene_init(&a, *state, info, true, sizes[s], rgba8)) {
            array_scene_finish(&a);
            continue;
        }
        scene_settle(&a.scene, 12);
        SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
        sluiceGetVulkanStreamerStatistics(a.scene.streamer, &stats);
        assert_int_equal(stats.mappedTileCount, stats.tileCount);
        for (uint32_t layer = 0; layer < ARRAY_LAYERS; layer++)
            check_texels(&a, layer);
        array_scene_finish(&a);
    }
}

static uint32_t count_mapped(struct array_scene *a, uint32_t layer)
{
    SluiceStreamedTextureManager *manager = manager_of(a->scene.streamer);
    SluiceTextureId id = a->scene.textures[layer].texture.textureId;
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    CHECK_OK(sluiceGetTextureLayout(manager, id, &layout));
    uint32_t count = 0;
    for (uint32_t tile = 0; tile < layout.regularTileCount; tile++) {
        SluiceTileState tile_state;
        CHECK_OK(sluiceGetTileState(manager, id, tile, &tile_state, NULL));
        count += tile_state == SLUICE_TILE_STATE_MAPPED;
    }
    return count;
}

/* Each layer has its own feedback. Layers are removed together, and others take their place. */
static void layers_of_an_array_are_streamed_apart_and_removed_together(void **state)
{
    static const uint32_t size[2] = {2048, 1024};
    struct array_scene a;
    roll_seed(9);
    assert_true(array_scene_init(
        &a, *state,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 100},
        false, size, rgba8));
    scene_aim(&a.scene, 1, 64, &fine);
    scene_settle(&a.scene, 14);
    scene_check_levels(&a.scene);
    assert_int_equal(scene_missing(&a.scene), 0);
    assert_int_equal(scene_non_resident(&a.scene), 0);
    assert_int_equal(count_mapped(&a, 0), 0);
    assert_true(count_mapped(&a, 1) > 8);
    assert_int_equal(count_mapped(&a, 2), 0);

    CHECK_OK(sluiceRemoveVulkanTexture(a.scene.streamer, a.scene.textures[1].texture.textureId));
    CHECK_RESULT(sluiceRemoveVulkanTexture(a.scene.streamer, a.scene.textures[0].texture.textureId),
                 SLUICE_ERROR_STALE_TEXTURE);
    uint32_t first = a.scene.textures[0].texture.tableIndex;
    for (uint32_t i = 0; i < ARRAY_LAYERS; i++)
        a.scene.textures[i] = (struct scene_texture){.used = false};
    scene_settle(&a.scene, 8);
    uint32_t t = scene_add(&a.scene, pattern_source(PATTERN_LEVEL, 700, 700, rgba8));
    assert_int_equal(a.scene.textures[t].texture.tableIndex, first);
    assert_true(a.scene.textures[t].texture.arrayView == VK_NULL_HANDLE);
    scene_aim(&a.scene, t, 64, &fine);
    scene_settle(&a.scene, 14);
    assert_int_equal(scene_missing(&a.scene), 0);
    array_scene_finish(&a);
}

static void arrays_that_come_and_go_leave_no_memory_behind(void **state)
{
    static const uint32_t size[2] = {600, 400};
    struct array_scene a;
    SluiceVulkanStreamerStatistics first = {.structSize = sizeof first},
                                   last = {.structSize = sizeof last};
    roll_seed(10);
    SluiceVulkanStreamerCreateInfo info = {
        .structSize = sizeof info, .feedbackTimeoutTicks = 100, .maxTextureCount = 8};
    if (!array_scene_init(&a, *state, info, false, size, rgba8)) {
        array_scene_finish(&a);
        SKIP_TEST("the device binds the tails of all layers as one");
    }
    for (uint32_t round = 0; round < 6; round++) {
        for (uint32_t i = 0; i < ARRAY_LAYERS; i++)
            scene_aim(&a.scene, i, 32, &fine);
        scene_settle(&a.scene, 14);
        assert_int_equal(scene_missing(&a.scene), 0);
        scene_check_levels(&a.scene);
        sluiceGetVulkanStreamerStatistics(a.scene.streamer, round ? &last : &first);
        CHECK_OK(
            sluiceRemoveVulkanTexture(a.scene.streamer, a.scene.textures[0].texture.textureId));
        SluiceVulkanTexture textures[ARRAY_LAYERS];
        assert_true(array_scene_add(&a.scene, a.source, ARRAY_LAYERS, textures));
        for (uint32_t i = 0; i < ARRAY_LAYERS; i++) {
            struct scene_texture *t = &a.scene.textures[i];
            prober_release(&a.scene.prober, t->probe);
            t->texture = textures[i];
            t->probe = prober_texture(&a.scene.prober, &t->texture, t->u, t->v, 1);
        }
    }
    assert_int_equal(last.tileMemorySize, first.tileMemorySize);
    array_scene_finish(&a);
}

static void arrays_need_the_right_call(void **state)
{
    struct scene scene;
    scene_init(
        &scene, *state,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 100});
    SluiceImageSource *layer = pattern_source(PATTERN_LEVEL, 64, 64, rgba8), *array;
    SluiceImageSource *layers[] = {layer, layer};
    CHECK_OK(sluiceCreateArrayImageSource(layers, 2, NULL, &array));
    SluiceVulkanTextureCreateInfo info = {.structSize = sizeof info, .source = array};
    SluiceVulkanTexture textures[2];
    CHECK_RESULT(sluiceAddVulkanTexture(scene.streamer, &info, textures),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceAddVulkanTextureArray(scene.streamer, &info, 1, textures),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    if (!array_scene_add(&scene, array, 2, textures))
        print_message("# an array of 64x64 is one tail here, and refused\n");
    scene_finish(&scene);
    sluiceDestroyImageSource(array);
    sluiceDestroyImageSource(layer);
}

static void arrays_beyond_the_device_are_refused(void **state)
{
    struct harness *h = *state;
    uint32_t count = h->caps.maxImageArrayLayers + 1;
    struct scene scene;
    scene_init(&scene, h,
               (SluiceVulkanStreamerCreateInfo){
                   .structSize = sizeof(SluiceVulkanStreamerCreateInfo), .maxTextureCount = count});
    SluiceImageSource *layer = pattern_source(PATTERN_LEVEL, 256, 256, rgba8), *array;
    SluiceImageSource **layers = calloc(count, sizeof *layers);
    SluiceVulkanTexture *textures = calloc(count, sizeof *textures);
    assert_true(layers && textures);
    for (uint32_t i = 0; i < count; i++)
        layers[i] = layer;
    CHECK_OK(sluiceCreateArrayImageSource(layers, count, NULL, &array));
    SluiceVulkanTextureCreateInfo info = {.structSize = sizeof info, .source = array};
    h->quiet = true;
    CHECK_RESULT(sluiceAddVulkanTextureArray(scene.streamer, &info, count, textures),
                 SLUICE_ERROR_UNSUPPORTED);
    h->quiet = false;
    scene_add(&scene, pattern_source(PATTERN_LEVEL, 256, 256,
                                     rgba8)); /* nothing of the refused array was kept */
    scene_settle(&scene, 3);
    scene_finish(&scene);
    sluiceDestroyImageSource(array);
    sluiceDestroyImageSource(layer);
    free(layers);
    free(textures);
}

#define SAMPLES 256u

/* Draws equal samples of an array, or of as many textures, once all requested tiles are
 * resident. */
static bool draw_layers(struct harness *h, SluiceResidencyMode mode, bool array,
                        const uint32_t size[2], const struct scene_aim *aim,
                        struct ProbeOutput out[ARRAY_LAYERS][SAMPLES])
{
    struct array_scene a = {0};
    SluiceVulkanStreamerCreateInfo info = {
        .structSize = sizeof info, .residencyMode = mode, .feedbackTimeoutTicks = 100};
    bool drawn = true;
    if (array)
        drawn = array_scene_init(&a, h, info, true, size, rgba8);
    else
        scene_init(&a.scene, h, info);
    roll_seed(11);
    for (uint32_t i = 0; i < ARRAY_LAYERS && drawn; i++) {
        if (!array)
            scene_add(&a.scene, pattern_source(array_scene_kind(i), size[0], size[1], rgba8));
        scene_aim(&a.scene, i, SAMPLES, aim);
    }
    if (drawn)
        scene_settle(&a.scene, 12);
    assert_int_equal(scene_missing(&a.scene), 0);
    assert_int_equal(scene_non_resident(&a.scene), 0);
    for (uint32_t i = 0; i < ARRAY_LAYERS && drawn; i++)
        memcpy(out[i], scene_outputs(&a.scene, i), sizeof out[i]);
    if (array)
        array_scene_finish(&a);
    else
        scene_finish(&a.scene);
    return drawn;
}

static double psnr(const struct ProbeOutput *a, const struct ProbeOutput *b)
{
    double sum = 0;
    for (uint32_t i = 0; i < SAMPLES; i++)
        for (uint32_t k = 0; k < 4; k++) {
            double d = (double)a[i].color[k] - (double)b[i].color[k];
            assert_true(isfinite(d));
            sum += d * d;
        }
    return sum > 0 ? -10 * log10(sum / (SAMPLES * 4.0)) : 999;
}

/* In dB, as in test_modes.c. Samplers of GPUs use another LOD than the formula. */
static double least_psnr(const struct harness *h, bool magnified)
{
    if (h->caps.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU || magnified)
        return 45;
    return h->mode == SLUICE_RESIDENCY_MODE_PAGED ? 25 : 45;
}

static void pictures_of_layers_are_those_of_single_dense_textures(void **state)
{
    static struct ProbeOutput truth[ARRAY_LAYERS][SAMPLES], layers[ARRAY_LAYERS][SAMPLES];
    static const uint32_t sizes[][2] = {{1000, 600}, {2048, 100}, {30, 17}};
    static const struct scene_aim aims[] = {{-0.3, 0.2, 0.9, 0.5, -3, -1, 0, 0},
                                            {0.1, -0.4, 1, 1, 0, 5, 0, 0}};
    struct harness *h = *state;
    uint32_t drawn = 0;
    for (uint32_t s = 0; s < 3; s++)
        for (uint32_t aim = 0; aim < 2; aim++) {
            if (!draw_layers(h, h->mode, true, sizes[s], &aims[aim], layers))
                continue;
            drawn++;
            draw_layers(h, SLUICE_RESIDENCY_MODE_DENSE, false, sizes[s], &aims[aim], truth);
            assert_true(psnr(truth[0], truth[1]) < 20 && psnr(truth[1], truth[2]) < 20 &&
                        psnr(truth[0], truth[2]) < 20);
            for (uint32_t i = 0; i < ARRAY_LAYERS; i++) {
                double db = psnr(layers[i], truth[i]);
                if (db < least_psnr(h, aim == 0))
                    fail_msg("layer %u of %ux%u, aim %u: %.1f dB", i, sizes[s][0], sizes[s][1], aim,
                             db);
            }
        }
    assert_true(drawn >= 2);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(layers_of_an_array_hold_their_own_texels),
        cmocka_unit_test(layers_of_an_array_are_streamed_apart_and_removed_together),
        cmocka_unit_test(arrays_that_come_and_go_leave_no_memory_behind),
        cmocka_unit_test(arrays_need_the_right_call),
        cmocka_unit_test(arrays_beyond_the_device_are_refused),
        cmocka_unit_test(pictures_of_layers_are_those_of_single_dense_textures),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
