/* Sparse images of all kinds of sizes, and what a device says of them and can bear. */
#include "device/scene.h"

#include "base/checked.h"
#include "support/test.h"
#include "vulkan/format.h"
#include "vulkan/format_caps.h"

#include <stdio.h>
#include <stdlib.h>

static SluiceVulkanStreamerCreateInfo sparse_info(void)
{
    return (SluiceVulkanStreamerCreateInfo){.residencyMode = SLUICE_RESIDENCY_MODE_SPARSE,
                                            .feedbackTimeout = 100};
}

static const SluiceFormat rgba8 = SLUICE_FORMAT_R8G8B8A8_UNORM;

/* A corner and the opposite one, so that first and last tiles of the finest levels come. */
static void aim_at_corners(struct scene *scene, uint32_t t, const SluiceImageInfo *info)
{
    struct ProbeInput *inputs = scene_inputs(scene, t);
    double width = 60.0 / info->width, height = 60.0 / info->height;
    struct scene_aim aim = {0, 0, width < 1 ? width : 1, height < 1 ? height : 1, 0, 1, 0, 0};
    scene_aim(scene, t, 32, &aim);
    struct ProbeInput near[16];
    for (uint32_t i = 0; i < 16; i++)
        near[i] = inputs[i];
    aim.left = 1 - aim.width;
    aim.top = 1 - aim.height;
    scene_aim(scene, t, 32, &aim);
    for (uint32_t i = 0; i < 16; i++)
        inputs[i] = near[i];
}

static void check_sizes(struct harness *h, const uint32_t (*sizes)[2], uint32_t count,
                        SluiceFormat format)
{
    struct scene scene;
    SluiceVulkanStreamerCreateInfo info = sparse_info();
    info.tilesPerFrame = 64;
    scene_init(&scene, h, info);
    srand(5);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t t =
            scene_add(&scene, pattern_source(PATTERN_LEVEL, sizes[i][0], sizes[i][1], format));
        aim_at_corners(&scene, t, &scene.textures[t].info);
    }
    scene_settle(&scene, 20);
    scene_check_levels(&scene);
    assert_int_equal(scene_missing(&scene), 0);
    assert_int_equal(scene_non_resident(&scene), 0);
    scene_finish(&scene);
}

static void smallest_and_odd_sizes_are_streamed(void **state)
{
    static const uint32_t sizes[][2] = {{1, 1},     {2, 1},       {1, 3},       {127, 129},
                                        {128, 128}, {129, 127},   {255, 1023},  {1000, 1000},
                                        {1, 5000},  {4097, 3001}, {16384, 128}, {64, 8192}};
    check_sizes(*state, sizes, sizeof sizes / sizeof sizes[0], rgba8);
}

static void sizes_up_to_the_limit_are_streamed(void **state)
{
    struct harness *h = *state;
    SluiceVulkanFormatCapabilities format;
    CHECK_OK(sluiceGetVulkanFormatCapabilities(h->instance, h->physical_device, h->get,
                                               SLUICE_FORMAT_R8_UNORM, &format));
    uint32_t width = format.maxWidth, height = format.maxHeight;
    const uint32_t sizes[][2] = {
        {width, height}, {width, 1}, {1, height}, {width - 1, height / 2 + 3}};
    check_sizes(h, sizes, 4, SLUICE_FORMAT_R8_UNORM);
    struct scene scene;
    scene_init(&scene, h, sparse_info());
    h->quiet = true;
    const uint32_t beyond[][2] = {{width + 1, 1}, {1, height + 1}, {2 * width, 2 * height}};
    for (uint32_t i = 0; i < 3; i++) {
        SluiceImageSource *source =
            pattern_source(PATTERN_LEVEL, beyond[i][0], beyond[i][1], SLUICE_FORMAT_R8_UNORM);
        SluiceVulkanTexture texture;
        CHECK_RESULT(sluiceAddVulkanTexture(scene.streamer,
                                            &(SluiceVulkanTextureCreateInfo){.source = source},
                                            &texture),
                     SLUICE_ERROR_UNSUPPORTED);
        sluiceDestroyImageSource(source);
    }
    h->quiet = false;
    scene_finish(&scene);
}

/* What the format says is what an image gets; and the arithmetic of tails holds everywhere. */
static void layouts_agree_with_formats(void **state)
{
    struct harness *h = *state;
    static const uint32_t sizes[][2] = {{1, 1}, {1024, 1024}, {1000, 600}, {8192, 64}};
    uint32_t sparse_count = 0;
    for (uint32_t f = 1; f < SLUICE_FORMAT_COUNT; f++) {
        SluiceVulkanFormatCapabilities format;
        CHECK_OK(sluiceGetVulkanFormatCapabilities(h->instance, h->physical_device, h->get,
                                                   (SluiceFormat)f, &format));
        sparse_count += format.sparse;
        for (uint32_t s = 0; s < 4 && format.sparse; s++) {
            SluiceImageInfo info = {sizes[s][0], sizes[s][1], 0, (SluiceFormat)f, "probe"};
            SluiceVulkanSparseImageLayout layout;
            CHECK_OK(sluiceGetVulkanSparseImageLayout(h->instance, h->physical_device, h->device,
                                                      h->get, NULL, &info, &layout));
            assert_int_equal(layout.tileWidth, format.tileWidth);
            assert_int_equal(layout.tileHeight, format.tileHeight);
            assert_int_equal(
                sluiceFormatRegionSize((SluiceFormat)f, layout.tileWidth, layout.tileHeight),
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
    assert_true(sparse_count >= 6); /* what Vulkan demands of a device with sparse residency */
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

/* As many tiles as the device bears, and no more; the rest stays coarse, and nothing waits. */
static void textures_stay_coarse_where_no_more_tiles_are_borne(void **state)
{
    struct harness *h = *state;
    struct scene scene;
    SluiceVulkanStreamerCreateInfo info = sparse_info();
    info.maxTouchedTiles = 40;
    scene_init(&scene, h, info);
    srand(6);
    h->quiet = true;
    const struct scene_aim everywhere = {0, 0, 1, 1, 0, 3, 0, 0};
    uint32_t t = scene_add(&scene, pattern_source(PATTERN_LEVEL, 2048, 2048, rgba8));
    scene_aim(&scene, t, 128, &everywhere);
    scene_settle(&scene, 30);
    SluiceVulkanStreamerStatistics stats;
    sluiceGetVulkanStreamerStatistics(scene.streamer, &stats);
    assert_in_range(stats.manager.mappedTileCount, 30, 40);
    assert_int_equal(stats.loadsInFlight, 0);
    assert_true(stats.tilesFailed > 0);
    assert_true(scene_missing(&scene) > 0);
    scene_check_levels(&scene);
    assert_int_equal(scene_non_resident(&scene), 0);

    SluiceImageSource *source = pattern_source(PATTERN_LEVEL, 64, 64, rgba8);
    SluiceVulkanTextureCreateInfo create = {.source = source};
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

/* Unmapped tiles that come back, with nothing else in between, cost no unbind. */
static void tiles_that_come_back_to_their_pages_need_no_unbind(void **state)
{
    struct scene scene;
    SluiceVulkanStreamerCreateInfo info = sparse_info();
    info.feedbackTimeout = 3;
    scene_init(&scene, *state, info);
    srand(7);
    uint32_t t = scene_add(&scene, pattern_source(PATTERN_LEVEL, 2048, 2048, rgba8));
    const struct scene_aim fine = {0, 0, 0.5, 0.5, 0, 0.5, 0, 0}, coarse = {0, 0, 1, 1, 3, 4, 0, 0};
    for (uint32_t round = 0; round < 4; round++) {
        scene_aim(&scene, t, 64, round % 2 ? &coarse : &fine);
        scene_settle(&scene, 20);
        CHECK_OK(sluiceTrimStandbyTiles(sluiceGetVulkanStreamerManager(scene.streamer), 0));
        scene_settle(&scene, 6);
        scene_check_levels(&scene);
        assert_int_equal(scene_missing(&scene), 0);
    }
    SluiceVulkanStreamerStatistics stats;
    sluiceGetVulkanStreamerStatistics(scene.streamer, &stats);
    assert_true(stats.tilesUnmapped > 40);
    assert_true(stats.unbindsSaved > 8);
    assert_true(stats.unbinds + stats.unbindsSaved <= stats.tilesUnmapped);
    assert_int_equal(scene_non_resident(&scene), 0);
    scene_finish(&scene);
}

#define LAYERS 3u

/* Two patterns, so that neighbouring layers differ. */
static enum pattern_kind kind_of(uint32_t layer)
{
    return layer % 2 ? PATTERN_HASH : PATTERN_LEVEL;
}

struct array {
    struct scene scene;
    SluiceImageSource *layers[LAYERS], *source;
    uint32_t textures[LAYERS]; ///< of the scene
};

/* What the device itself says of the tails of an array. */
static bool layers_share_tail(struct harness *h, const SluiceImageInfo *info, uint32_t layer_count)
{
    PFN_vkGetImageSparseMemoryRequirements get =
        (PFN_vkGetImageSparseMemoryRequirements)h->GetDeviceProcAddr(
            h->device, "vkGetImageSparseMemoryRequirements");
    VkImageCreateInfo create = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                .flags = SLC_IMAGE_SPARSE_FLAGS,
                                .imageType = VK_IMAGE_TYPE_2D,
                                .format = slc_vk_format(info->format),
                                .extent = {info->width, info->height, 1},
                                .mipLevels = info->mipLevelCount,
                                .arrayLayers = layer_count,
                                .samples = VK_SAMPLE_COUNT_1_BIT,
                                .usage = SLC_IMAGE_USAGE};
    VkImage image;
    assert_int_equal(h->CreateImage(h->device, &create, NULL, &image), VK_SUCCESS);
    VkSparseImageMemoryRequirements aspects[4];
    uint32_t count = 4;
    get(h->device, image, &count, aspects);
    h->DestroyImage(h->device, image, NULL);
    bool shared = false;
    for (uint32_t i = 0; i < count; i++)
        if (aspects[i].formatProperties.aspectMask & VK_IMAGE_ASPECT_COLOR_BIT)
            shared = aspects[i].imageMipTailSize > 0 &&
                     aspects[i].imageMipTailFirstLod < info->mipLevelCount &&
                     aspects[i].formatProperties.flags & VK_SPARSE_IMAGE_FORMAT_SINGLE_MIPTAIL_BIT;
    return shared;
}

/* True, or false where it is refused, as is right if and only if its layers share a tail. */
static bool add_array(struct scene *scene, SluiceImageSource *source, uint32_t layer_count,
                      SluiceVulkanTexture *textures)
{
    struct harness *h = scene->h;
    SluiceVulkanTextureCreateInfo create = {.source = source};
    SluiceImageInfo info;
    CHECK_OK(sluiceGetImageInfo(source, &info));
    bool shared = layers_share_tail(h, &info, layer_count);
    h->quiet = shared;
    SluiceResult result =
        sluiceAddVulkanTextureArray(scene->streamer, &create, layer_count, textures);
    h->quiet = false;
    if (shared)
        CHECK_RESULT(result, SLUICE_ERROR_UNSUPPORTED);
    else
        CHECK_OK(result);
    return !shared;
}

/* False if the device has one tail for all layers of an array that is nothing but tail. */
static bool array_init(struct array *a, struct harness *h, SluiceVulkanStreamerCreateInfo info,
                       bool mixed, const uint32_t size[2], SluiceFormat format)
{
    scene_init(&a->scene, h, info);
    for (uint32_t i = 0; i < LAYERS; i++)
        a->layers[i] = pattern_source(mixed ? kind_of(i) : PATTERN_LEVEL, size[0], size[1], format);
    CHECK_OK(sluiceCreateArrayImageSource(a->layers, LAYERS, NULL, &a->source));
    SluiceVulkanTexture textures[LAYERS];
    if (!add_array(&a->scene, a->source, LAYERS, textures))
        return false;
    for (uint32_t i = 0; i < LAYERS; i++) {
        struct scene_texture *t = &a->scene.textures[i];
        a->textures[i] = i;
        assert_int_equal(textures[i].tableIndex, textures[0].tableIndex + i);
        assert_int_equal(textures[i].arrayLayer, i);
        assert_ptr_equal(textures[i].image, textures[0].image);
        assert_true(textures[i].arrayView != VK_NULL_HANDLE);
        *t = (struct scene_texture){
            .used = true, .source = a->layers[i], .texture = textures[i], .anisotropy = 1};
        CHECK_OK(sluiceGetImageInfo(a->layers[i], &t->info));
        t->probe = prober_texture(&a->scene.prober, &t->texture, t->u, t->v, 1);
    }
    return true;
}

static void array_finish(struct array *a)
{
    scene_finish(&a->scene);
    sluiceDestroyImageSource(a->source);
    for (uint32_t i = 0; i < LAYERS; i++)
        sluiceDestroyImageSource(a->layers[i]);
}

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

static void check_layer(struct array *a, uint32_t layer)
{
    const struct scene_texture *t = &a->scene.textures[a->textures[layer]];
    struct ProbeInput *inputs = prober_inputs(&a->scene.prober);
    struct fetch fetch = {&a->scene, a->textures[layer], 0};
    for (uint32_t level = 0; level < t->info.mipLevelCount; level++)
        for (uint32_t i = 0; i < 64; i++)
            inputs[fetch.count++] = (struct ProbeInput){
                .uv = {(float)((uint32_t)rand() % slc_mip_size(t->info.width, level)),
                       (float)((uint32_t)rand() % slc_mip_size(t->info.height, level))},
                .lodBias = (float)level};
    harness_run(a->scene.h, record_fetch, &fetch);
    for (uint32_t i = 0; i < fetch.count; i++) {
        float expected[4];
        pattern_texel(kind_of(layer), (uint32_t)inputs[i].lodBias, (uint32_t)inputs[i].uv[0],
                      (uint32_t)inputs[i].uv[1], expected);
        for (uint32_t c = 0; c < 4; c++)
            assert_float_equal(prober_outputs(&a->scene.prober)[i].color[c], expected[c], 0.003);
    }
}

static void layers_of_an_array_hold_their_own_texels(void **state)
{
    static const uint32_t sizes[][2] = {{1000, 600}, {16, 16}, {4096, 128}};
    srand(8);
    for (uint32_t s = 0; s < 3; s++) {
        struct array a;
        SluiceVulkanStreamerCreateInfo info = {.residencyMode = SLUICE_RESIDENCY_MODE_SPARSE,
                                               .mapEverything = true};
        if (!array_init(&a, *state, info, true, sizes[s], rgba8)) {
            array_finish(&a);
            continue;
        }
        scene_settle(&a.scene, 12);
        SluiceVulkanStreamerStatistics stats;
        sluiceGetVulkanStreamerStatistics(a.scene.streamer, &stats);
        assert_int_equal(stats.manager.mappedTileCount, stats.manager.tileCount);
        for (uint32_t layer = 0; layer < LAYERS; layer++)
            check_layer(&a, layer);
        array_finish(&a);
    }
}

/* Each layer has feedback of its own; they go together, and others take their place. */
static void layers_of_an_array_are_streamed_apart_and_removed_together(void **state)
{
    static const uint32_t size[2] = {2048, 1024};
    struct array a;
    srand(9);
    assert_true(array_init(&a, *state, sparse_info(), false, size, rgba8));
    const struct scene_aim fine = {0, 0, 0.4, 0.4, 0, 1, 0, 0};
    scene_aim(&a.scene, 1, 64, &fine);
    scene_settle(&a.scene, 14);
    scene_check_levels(&a.scene);
    assert_int_equal(scene_missing(&a.scene), 0);
    assert_int_equal(scene_non_resident(&a.scene), 0);
    SluiceStreamedTextureManager *manager = sluiceGetVulkanStreamerManager(a.scene.streamer);
    uint32_t mapped[LAYERS] = {0};
    for (uint32_t i = 0; i < LAYERS; i++) {
        SluiceTextureId id = a.scene.textures[i].texture.textureId;
        SluiceStreamedTextureLayout layout;
        CHECK_OK(sluiceGetTextureLayout(manager, id, &layout));
        for (uint32_t tile = 0; tile < layout.regularTileCount; tile++) {
            SluiceTileState tile_state;
            CHECK_OK(sluiceGetTileState(manager, id, tile, &tile_state, NULL));
            mapped[i] += tile_state == SLUICE_TILE_STATE_MAPPED;
        }
    }
    assert_int_equal(mapped[0], 0);
    assert_true(mapped[1] > 8);
    assert_int_equal(mapped[2], 0);

    CHECK_OK(sluiceRemoveVulkanTexture(a.scene.streamer, a.scene.textures[1].texture.textureId));
    CHECK_RESULT(sluiceRemoveVulkanTexture(a.scene.streamer, a.scene.textures[0].texture.textureId),
                 SLUICE_ERROR_STALE_TEXTURE);
    uint32_t first = a.scene.textures[0].texture.tableIndex;
    for (uint32_t i = 0; i < LAYERS; i++)
        a.scene.textures[i] = (struct scene_texture){.used = false};
    scene_settle(&a.scene, 8);
    uint32_t t = scene_add(&a.scene, pattern_source(PATTERN_LEVEL, 700, 700, rgba8));
    assert_int_equal(a.scene.textures[t].texture.tableIndex, first);
    assert_true(a.scene.textures[t].texture.arrayView == VK_NULL_HANDLE);
    scene_aim(&a.scene, t, 64, &fine);
    scene_settle(&a.scene, 14);
    assert_int_equal(scene_missing(&a.scene), 0);
    array_finish(&a);
}

static void arrays_need_the_right_call(void **state)
{
    struct scene scene;
    scene_init(&scene, *state, sparse_info());
    SluiceImageSource *layer = pattern_source(PATTERN_LEVEL, 64, 64, rgba8), *array;
    SluiceImageSource *layers[] = {layer, layer};
    CHECK_OK(sluiceCreateArrayImageSource(layers, 2, NULL, &array));
    SluiceVulkanTextureCreateInfo info = {.source = array};
    SluiceVulkanTexture textures[2];
    CHECK_RESULT(sluiceAddVulkanTexture(scene.streamer, &info, textures),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceAddVulkanTextureArray(scene.streamer, &info, 1, textures),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    if (!add_array(&scene, array, 2, textures))
        print_message("# an array of 64x64 is one tail here, and refused\n");
    scene_finish(&scene);
    sluiceDestroyImageSource(array);
    sluiceDestroyImageSource(layer);
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
        cmocka_unit_test(smallest_and_odd_sizes_are_streamed),
        cmocka_unit_test(sizes_up_to_the_limit_are_streamed),
        cmocka_unit_test(textures_stay_coarse_where_no_more_tiles_are_borne),
        cmocka_unit_test(tiles_that_come_back_to_their_pages_need_no_unbind),
        cmocka_unit_test(layers_of_an_array_hold_their_own_texels),
        cmocka_unit_test(layers_of_an_array_are_streamed_apart_and_removed_together),
        cmocka_unit_test(arrays_need_the_right_call),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
