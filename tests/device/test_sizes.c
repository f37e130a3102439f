/* Textures of all kinds of sizes, in every residency mode. */
#include "device/scene.h"

#include "support/roll.h"
#include "support/test.h"

/* Samples a corner and the opposite one, so that first and last tiles of the finest levels are
 * loaded. */
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
    scene_init(
        &scene, h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 100,
                                         .tilesPerFrame = 64});
    roll_seed(5);
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
    static const uint32_t sizes[][2] = {{1, 1},       {2, 1},       {1, 3},       {127, 129},
                                        {128, 128},   {129, 127},   {255, 1023},  {1000, 1000},
                                        {1, 5000},    {4097, 3001}, {16384, 128}, {128, 16384},
                                        {16384, 127}, {64, 8192},   {16381, 1},   {1, 16384}};
    check_sizes(*state, sizes, sizeof sizes / sizeof sizes[0], SLUICE_FORMAT_R8G8B8A8_UNORM);
    check_sizes(*state, sizes, sizeof sizes / sizeof sizes[0], SLUICE_FORMAT_R16G16B16A16_SFLOAT);
}

static SluiceVulkanFormatCapabilities r8_limits(struct harness *h)
{
    SluiceVulkanFormatCapabilities format = {.structSize = sizeof format};
    CHECK_OK(sluiceGetVulkanFormatCapabilities(h->instance, h->physical_device, h->get,
                                               SLUICE_FORMAT_R8_UNORM, &format));
    return format;
}

static void sizes_up_to_the_limit_are_streamed(void **state)
{
    struct harness *h = *state;
    SluiceVulkanFormatCapabilities format = r8_limits(h);
    uint32_t width = format.maxWidth, height = format.maxHeight;
    /* dense images have memory for all of their texels */
    bool dense = h->mode == SLUICE_RESIDENCY_MODE_DENSE;
    const uint32_t sizes[][2] = {{width, 1},
                                 {1, height},
                                 {width, dense ? 256 : height},
                                 {width - 1, dense ? 259 : height / 2 + 3}};
    check_sizes(h, sizes, 4, SLUICE_FORMAT_R8_UNORM);
}

static void images_beyond_the_limit_are_refused(void **state)
{
    struct harness *h = *state;
    if (h->mode == SLUICE_RESIDENCY_MODE_PAGED)
        SKIP_TEST("pages are small whatever the texture's size");
    SluiceVulkanFormatCapabilities format = r8_limits(h);
    uint32_t width = format.maxWidth, height = format.maxHeight;
    struct scene scene;
    scene_init(
        &scene, h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .feedbackTimeoutTicks = 100});
    h->quiet = true;
    const uint32_t beyond[][2] = {{width + 1, 1}, {1, height + 1}, {2 * width, 2 * height}};
    for (uint32_t i = 0; i < 3; i++) {
        SluiceImageSource *source =
            pattern_source(PATTERN_LEVEL, beyond[i][0], beyond[i][1], SLUICE_FORMAT_R8_UNORM);
        SluiceVulkanTexture texture;
        CHECK_RESULT(sluiceAddVulkanTexture(
                         scene.streamer,
                         &(SluiceVulkanTextureCreateInfo){
                             .structSize = sizeof(SluiceVulkanTextureCreateInfo), .source = source},
                         &texture),
                     SLUICE_ERROR_UNSUPPORTED);
        sluiceDestroyImageSource(source);
    }
    h->quiet = false;
    scene_finish(&scene);
}

/* Only the packed levels are an image of the texture. */
static void pages_may_be_of_textures_beyond_the_limit_of_images(void **state)
{
    struct harness *h = *state;
    if (h->mode != SLUICE_RESIDENCY_MODE_PAGED)
        SKIP_TEST("only pages are not images of the texture's size");
    SluiceVulkanFormatCapabilities format = r8_limits(h);
    const uint32_t sizes[][2] = {{2 * format.maxWidth, 2 * format.maxHeight},
                                 {format.maxWidth + 1, 1},
                                 {3, 2 * format.maxHeight - 1}};
    check_sizes(h, sizes, 3, SLUICE_FORMAT_R8_UNORM);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(smallest_and_odd_sizes_are_streamed),
        cmocka_unit_test(sizes_up_to_the_limit_are_streamed),
        cmocka_unit_test(images_beyond_the_limit_are_refused),
        cmocka_unit_test(pages_may_be_of_textures_beyond_the_limit_of_images),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
