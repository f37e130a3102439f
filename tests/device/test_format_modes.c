/* sluice-info --formats says of every format what adding a texture of that format answers. */
#include "device/demand_runner.h"

#include "support/test.h"
#include "vulkan/format.h"

#include "../../tools/sluice-info/format_modes.h"

#include <string.h>

static struct harness h;

enum { SIZE = 1024 };

/* Texels of zeros are good in every format. */
struct zeros {
    SluiceImageSource base;
    SluiceFormat format;
};

static SluiceResult get_info(SluiceImageSource *source, SluiceImageInfo *info)
{
    SluiceFormat format = ((struct zeros *)source)->format;
    *info = (SluiceImageInfo){sizeof *info, SIZE, SIZE, 11, format, sluiceGetFormatName(format)};
    return SLUICE_SUCCESS;
}

static SluiceResult read_region(SluiceImageSource *source, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch)
{
    SluiceFormatInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceGetFormatInfo(((struct zeros *)source)->format, &info));
    uint32_t rows = (region->height + info.blockHeight - 1) / info.blockHeight;
    uint32_t columns = (region->width + info.blockWidth - 1) / info.blockWidth;
    for (uint32_t y = 0; y < rows; y++)
        memset((char *)texels + y * row_pitch, 0, (size_t)columns * info.blockSize);
    return SLUICE_SUCCESS;
}

static void destroy(SluiceImageSource *source)
{
    (void)source;
}

static const SluiceImageSourceInterface interface = {sizeof interface, get_info, read_region,
                                                     destroy};
static struct zeros sources[SLUICE_FORMAT_COUNT];

static SluiceImageSource *source_of(SluiceFormat format)
{
    sources[format] = (struct zeros){{.pInterface = &interface}, format};
    return &sources[format].base;
}

static SluiceVulkanFormatCapabilities caps_of(SluiceFormat format)
{
    SluiceVulkanFormatCapabilities caps = {.structSize = sizeof caps};
    CHECK_OK(
        sluiceGetVulkanFormatCapabilities(h.instance, h.physical_device, h.get, format, &caps));
    return caps;
}

static bool has_mode(enum format_mode mode)
{
    VkPhysicalDeviceFeatures features = {0};
    VkPhysicalDeviceVulkan12Features vulkan12 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    return sluiceRequireVulkanFeatures(h.instance, h.physical_device, h.get,
                                       format_mode_residency(mode), NULL, &features,
                                       &vulkan12) == SLUICE_SUCCESS;
}

static const char *answer_of(enum format_mode mode, SluiceFormat format)
{
    SluiceVulkanFormatCapabilities caps = caps_of(format);
    return format_mode_answer(mode, has_mode(mode), format, &caps);
}

static void check_streamer(enum format_mode mode)
{
    SluiceVulkanStreamer *streamer = NULL;
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                           .residencyMode = format_mode_residency(mode)};
    uint32_t count = 0;
    harness_fill(&h, &info);
    h.quiet = true;
    if (!has_mode(mode)) {
        CHECK_RESULT(sluiceCreateVulkanStreamer(&info, &streamer), SLUICE_ERROR_UNSUPPORTED);
        h.quiet = false;
        return;
    }
    CHECK_OK(sluiceCreateVulkanStreamer(&info, &streamer));
    for (uint32_t f = 1; f < SLUICE_FORMAT_COUNT; f++) {
        const char *answer = answer_of(mode, (SluiceFormat)f);
        SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create,
                                                .source = source_of((SluiceFormat)f)};
        SluiceVulkanTexture texture;
        SluiceResult result = sluiceAddVulkanTexture(streamer, &create, &texture);
        bool streamed = format_mode_is_streamed(answer);
        if (result != (streamed ? SLUICE_SUCCESS : SLUICE_ERROR_UNSUPPORTED))
            fail_msg("%s, %s: \"%s\", but adding a texture answers %s", format_mode_names[mode],
                     sluiceGetFormatName((SluiceFormat)f), answer, sluiceGetResultName(result));
        count += streamed;
    }
    h.quiet = false;
    harness_destroy(&h, streamer);
    print_message("# formats.%s %u\n", format_mode_names[mode], count);
    assert_true(count >= 10);
}

static void streamers_take_the_formats_that_the_table_says(void **state)
{
    (void)state;
    check_streamer(FORMAT_MODE_SPARSE);
    check_streamer(FORMAT_MODE_PAGED);
    check_streamer(FORMAT_MODE_DENSE);
}

/* A texture that is refused shows its failure color. */
static void demand_loaders_take_the_formats_that_the_table_says(void **state)
{
    (void)state;
    struct runner r;
    SluiceDemandTextureId id;
    uint32_t count = 0;
    runner_init(&r, &h, NULL);
    h.quiet = true;
    for (uint32_t f = 1; f < SLUICE_FORMAT_COUNT; f++) {
        const SluiceDemandTextureCreateInfo info = {.structSize = sizeof info,
                                                    .image.source = source_of((SluiceFormat)f),
                                                    .pSampler = &runner_nearest,
                                                    .failureColor = {5, 6, 7, 8}};
        CHECK_OK(sluiceAddDemandTexture(r.loader, &info, &id));
        runner_add_texel(&r, id, SIZE, SIZE, 0, f, f);
    }
    runner_load(&r, 20);
    h.quiet = false;
    for (uint32_t f = 1; f < SLUICE_FORMAT_COUNT; f++) {
        const char *answer = answer_of(FORMAT_MODE_DEMAND, (SluiceFormat)f);
        struct RunnerOutput out = runner_output(&r, f - 1);
        bool streamed = out.color[0] < 5;
        if (streamed != format_mode_is_streamed(answer))
            fail_msg("demand, %s: \"%s\", but a texture shows %g",
                     sluiceGetFormatName((SluiceFormat)f), answer, (double)out.color[0]);
        count += streamed;
    }
    runner_finish(&r);
    print_message("# formats.demand %u\n", count);
    assert_true(count >= 10);
}

/* Compares with Vulkan's own answers. */
static void answers_agree_with_the_format_properties_of_the_device(void **state)
{
    (void)state;
#define GET(name) PFN_vk##name name = (PFN_vk##name)(void (*)(void))h.get(h.instance, "vk" #name)
    GET(GetPhysicalDeviceFormatProperties);
    GET(GetPhysicalDeviceSparseImageFormatProperties);
#undef GET
    const VkImageUsageFlags usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    for (uint32_t f = 1; f < SLUICE_FORMAT_COUNT; f++) {
        const char *dense = answer_of(FORMAT_MODE_DENSE, (SluiceFormat)f);
        const char *paged = answer_of(FORMAT_MODE_PAGED, (SluiceFormat)f);
        const char *sparse = answer_of(FORMAT_MODE_SPARSE, (SluiceFormat)f);
        VkFormat format = slc_vk_format((SluiceFormat)f);
        VkFormatProperties properties;
        uint32_t aspects = 0;
        GetPhysicalDeviceFormatProperties(h.physical_device, format, &properties);
        GetPhysicalDeviceSparseImageFormatProperties(h.physical_device, format, VK_IMAGE_TYPE_2D,
                                                     VK_SAMPLE_COUNT_1_BIT, usage,
                                                     VK_IMAGE_TILING_OPTIMAL, &aspects, NULL);
        VkFormatFeatureFlags has = properties.optimalTilingFeatures;
        bool sampled = has & VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT;
        bool linear = has & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
        assert_string_equal(dense, !sampled ? "no sampled image" : linear ? "yes" : "nearest only");
        if (sampled && has_mode(FORMAT_MODE_PAGED))
            assert_string_equal(paged, linear ? "yes" : "no linear filter");
        if (sampled && has_mode(FORMAT_MODE_SPARSE) && aspects == 0)
            assert_string_equal(sparse, "no sparse image");
        if (format_mode_is_streamed(sparse))
            assert_string_equal(sparse, dense);
    }
}

/* Devices that this one is not. */
static void refusals_say_what_is_missing(void **state)
{
    (void)state;
    static const struct {
        SluiceVulkanFormatCapabilities caps;
        SluiceFormat format;
        const char *answers[FORMAT_MODES];
    } cases[] = {
        {{.sampled = true, .linearFilter = true, .sparse = true, .tileWidth = 128},
         SLUICE_FORMAT_R8G8B8A8_UNORM,
         {"yes", "yes", "yes", "yes"}},
        {{.sampled = true, .sparse = true, .tileWidth = 128},
         SLUICE_FORMAT_R32_SFLOAT,
         {"nearest only", "no linear filter", "nearest only", "no linear filter"}},
        {{.sampled = true, .linearFilter = true},
         SLUICE_FORMAT_ASTC_4x4_UNORM_BLOCK,
         {"no sparse image", "yes", "yes", "yes"}},
        {{.sampled = true, .linearFilter = true, .tileWidth = 64},
         SLUICE_FORMAT_ASTC_8x8_UNORM_BLOCK,
         {"tile not 64 KiB", "yes", "yes", "blocks above 4x4"}},
        {{.linearFilter = true},
         SLUICE_FORMAT_R8_UNORM,
         {"no sampled image", "no sampled image", "no sampled image", "no sampled image"}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        for (uint32_t m = 0; m < FORMAT_MODES; m++) {
            assert_string_equal(
                format_mode_answer((enum format_mode)m, true, cases[i].format, &cases[i].caps),
                cases[i].answers[m]);
            assert_string_equal(
                format_mode_answer((enum format_mode)m, false, cases[i].format, &cases[i].caps),
                "no such mode");
        }
}

int main(void)
{
    int status = harness_init(&h);
    if (status)
        return status;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(streamers_take_the_formats_that_the_table_says),
        cmocka_unit_test(demand_loaders_take_the_formats_that_the_table_says),
        cmocka_unit_test(answers_agree_with_the_format_properties_of_the_device),
        cmocka_unit_test(refusals_say_what_is_missing),
    };
    return harness_finish(&h, RUN_TESTS(tests));
}
