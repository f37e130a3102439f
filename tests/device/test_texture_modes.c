/* Textures of other modes than their streamer's, and thousands of small ones. */
#include "device/scene.h"

#include "support/test.h"

#include <stdio.h>
#include <stdlib.h>

#define COUNT 3000u
#define SMALL_TEXELS 21844u /* bytes of all levels of 64 x 64 RGBA8 */

static const SluiceFormat rgba8 = SLUICE_FORMAT_R8G8B8A8_UNORM;

static SluiceVulkanStreamerCreateInfo settings(void)
{
    return (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                            .feedbackTimeoutTicks = 100,
                                            .heapTileCapacity = 64,
                                            .tilesPerFrame = 64};
}

static uint32_t add_aimed(struct scene *scene, uint32_t width, uint32_t height, SluiceFormat format)
{
    uint32_t t = scene_add(scene, pattern_source(PATTERN_LEVEL, width, height, format));
    scene_aim(scene, t, 64, &(struct scene_aim){0, 0, 1, 1, 0, 3, 0, 0});
    return t;
}

static void check_picture(struct scene *scene)
{
    scene_settle(scene, 20);
    scene_check_levels(scene);
    assert_int_equal(scene_missing(scene), 0);
    assert_int_equal(scene_non_resident(scene), 0);
}

static SluiceVulkanStreamerStatistics statistics(const SluiceVulkanStreamer *streamer)
{
    SluiceVulkanStreamerStatistics s = {.structSize = sizeof s};
    CHECK_OK(sluiceGetVulkanStreamerStatistics(streamer, &s));
    return s;
}

/* A streamer that chooses holds all of these but the last as images with all levels. */
static void small_textures_are_dense(void **state)
{
    static const struct {
        uint32_t width, height;
        SluiceFormat format;
    } small[] = {
        {64, 64, SLUICE_FORMAT_R8G8B8A8_UNORM}, {128, 128, SLUICE_FORMAT_R8G8B8A8_UNORM},
        {127, 3, SLUICE_FORMAT_R8G8B8A8_UNORM}, {1, 1, SLUICE_FORMAT_R8G8B8A8_UNORM},
        {256, 256, SLUICE_FORMAT_R8_UNORM},     {64, 64, SLUICE_FORMAT_R16G16B16A16_SFLOAT}};
    struct harness *h = *state;
    if (h->mode != SLUICE_RESIDENCY_MODE_SPARSE)
        SKIP_TEST("a streamer that chooses its mode is sparse on this device");
    struct scene scene;
    h->leaves_auto = true;
    scene_init(&scene, h, settings());
    h->leaves_auto = false;
    for (uint32_t i = 0; i < sizeof small / sizeof small[0]; i++) {
        uint32_t t = add_aimed(&scene, small[i].width, small[i].height, small[i].format);
        assert_int_equal(scene.textures[t].texture.residencyMode, SLUICE_RESIDENCY_MODE_DENSE);
    }
    check_picture(&scene);
    assert_int_equal(statistics(scene.streamer).heapCount, 0);
    uint32_t large = add_aimed(&scene, 129, 128, rgba8);
    assert_int_equal(scene.textures[large].texture.residencyMode, SLUICE_RESIDENCY_MODE_SPARSE);
    check_picture(&scene);
    assert_true(statistics(scene.streamer).heapCount > 0);
    for (uint32_t i = 0; i < 3; i++)
        scene_remove(&scene, i);
    add_aimed(&scene, 100, 77, rgba8);
    check_picture(&scene);
    scene_finish(&scene);
}

static void dense_textures_stand_beside_those_of_the_streamer(void **state)
{
    struct harness *h = *state;
    struct scene scene;
    scene_init(&scene, h, settings());
    uint32_t own = add_aimed(&scene, 700, 300, rgba8);
    scene.texture_mode = SLUICE_RESIDENCY_MODE_DENSE;
    uint32_t dense = add_aimed(&scene, 1000, 333, rgba8);
    uint32_t wide = add_aimed(&scene, 1024, 1024, SLUICE_FORMAT_R16G16B16A16_SFLOAT);
    assert_int_equal(scene.textures[own].texture.residencyMode, h->mode);
    assert_int_equal(scene.textures[dense].texture.residencyMode, SLUICE_RESIDENCY_MODE_DENSE);
    assert_int_equal(scene.textures[wide].texture.residencyMode, SLUICE_RESIDENCY_MODE_DENSE);
    check_picture(&scene);
    if (h->mode != SLUICE_RESIDENCY_MODE_DENSE) { /* resident as a whole, whatever is sampled */
        SluiceStreamedTextureManager *manager;
        SluiceTileState tile;
        CHECK_OK(sluiceGetVulkanStreamerManager(scene.streamer, &manager));
        CHECK_OK(
            sluiceGetTileState(manager, scene.textures[dense].texture.textureId, 0, &tile, NULL));
        assert_int_equal(tile, SLUICE_TILE_STATE_MAPPED);
    }
    scene_finish(&scene);
}

static void modes_that_the_streamer_has_not_are_refused(void **state)
{
    struct harness *h = *state;
    struct scene scene;
    scene_init(&scene, h, settings());
    SluiceImageSource *source = pattern_source(PATTERN_LEVEL, 64, 64, rgba8);
    SluiceVulkanTextureCreateInfo info = {.structSize = sizeof info, .source = source};
    SluiceVulkanTexture texture;
    h->quiet = true;
    info.residencyMode = h->mode == SLUICE_RESIDENCY_MODE_SPARSE ? SLUICE_RESIDENCY_MODE_PAGED
                                                                 : SLUICE_RESIDENCY_MODE_SPARSE;
    CHECK_RESULT(sluiceAddVulkanTexture(scene.streamer, &info, &texture), SLUICE_ERROR_UNSUPPORTED);
    info.residencyMode = (SluiceResidencyMode)99;
    CHECK_RESULT(sluiceAddVulkanTexture(scene.streamer, &info, &texture),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    h->quiet = false;
    scene_finish(&scene);
    sluiceDestroyImageSource(source);
}

static void streamers_of_all_modes_take_integers_that_are_dense(void **state)
{
    struct harness *h = *state;
    struct scene scene;
    scene_init(&scene, h, settings());
    static const uint32_t texels[300 * 200];
    const SluiceImageInfo image = {
        .structSize = sizeof image, .width = 300, .height = 200, .format = SLUICE_FORMAT_R32_UINT};
    SluiceImageSource *source;
    CHECK_OK(sluiceCreateMemoryImageSource(texels, &image, NULL, &source));
    SluiceVulkanTextureCreateInfo info = {.structSize = sizeof info, .source = source};
    SluiceVulkanTexture texture;
    h->quiet = true;
    CHECK_RESULT(sluiceAddVulkanTexture(scene.streamer, &info, &texture),
                 h->mode == SLUICE_RESIDENCY_MODE_PAGED ? SLUICE_ERROR_UNSUPPORTED
                                                        : SLUICE_SUCCESS);
    h->quiet = false;
    info.residencyMode = SLUICE_RESIDENCY_MODE_DENSE;
    CHECK_OK(sluiceAddVulkanTexture(scene.streamer, &info, &texture));
    assert_int_equal(texture.residencyMode, SLUICE_RESIDENCY_MODE_DENSE);
    harness_settle(h, scene.streamer, 20, NULL, NULL);
    scene_finish(&scene);
    sluiceDestroyImageSource(source);
}

/* A slot of 64 KiB for each would be three times their texels. */
static void thousands_of_small_textures_take_what_their_images_take(void **state)
{
    struct harness *h = *state;
    SluiceVulkanStreamerCreateInfo info = settings();
    info.maxTextureCount = 1u << 12;
    info.maxHeapCount = 1;
    h->leaves_auto = h->mode == SLUICE_RESIDENCY_MODE_SPARSE;
    harness_fill(h, &info);
    h->leaves_auto = false;
    if (h->mode == SLUICE_RESIDENCY_MODE_SPARSE && h->caps.maxTouchedTiles &&
        info.maxTextureCount > h->caps.maxTouchedTiles / 16)
        info.maxTextureCount = h->caps.maxTouchedTiles / 16; /* more would be paged */
    SluiceVulkanStreamer *streamer;
    CHECK_OK(sluiceCreateVulkanStreamer(&info, &streamer));
    uint64_t before = statistics(streamer).tileMemorySize;
    SluiceImageSource *source = pattern_source(PATTERN_LEVEL, 64, 64, rgba8);
    SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create, .source = source};
    SluiceVulkanTexture *textures = calloc(COUNT, sizeof *textures);
    assert_non_null(textures);
    for (uint32_t i = 0; i < COUNT; i++)
        CHECK_OK(sluiceAddVulkanTexture(streamer, &create, &textures[i]));
    harness_settle(h, streamer, 100, NULL, NULL);
    SluiceVulkanStreamerStatistics s = statistics(streamer);
    assert_int_equal(s.mappedTileCount, COUNT);
    assert_int_equal(s.heapCount, 0);
    assert_int_equal(s.globalMipBias, 0);
    double each = (double)(s.tileMemorySize - before) / COUNT;
    printf("# %.0f bytes per texture, %.3f of its texels\n", each, each / SMALL_TEXELS);
    assert_true(each <= 1.2 * SMALL_TEXELS);
    for (uint32_t i = 0; i < COUNT; i += 2)
        CHECK_OK(sluiceRemoveVulkanTexture(streamer, textures[i].textureId));
    harness_settle(h, streamer, 10, NULL, NULL);
    for (uint32_t i = 0; i < COUNT; i += 2)
        CHECK_OK(sluiceAddVulkanTexture(streamer, &create, &textures[i]));
    harness_settle(h, streamer, 100, NULL, NULL);
    assert_int_equal(statistics(streamer).mappedTileCount, COUNT);
    assert_true(statistics(streamer).tileMemorySize == s.tileMemorySize);
    harness_destroy(h, streamer);
    harness_check_silence(h);
    sluiceDestroyImageSource(source);
    free(textures);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(small_textures_are_dense),
        cmocka_unit_test(dense_textures_stand_beside_those_of_the_streamer),
        cmocka_unit_test(modes_that_the_streamer_has_not_are_refused),
        cmocka_unit_test(streamers_of_all_modes_take_integers_that_are_dense),
        cmocka_unit_test(thousands_of_small_textures_take_what_their_images_take),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
