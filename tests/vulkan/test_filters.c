/* Formats that a device does not filter linearly: which sampler they get, and who refuses them. */
#include "vulkan/fake_vulkan.h"

#include "support/gray_source.h"
#include "support/test.h"

#include <stdio.h>

static void keep_error(void *user, SluiceLogSeverity severity, const char *message)
{
    if (severity == SLUICE_LOG_ERROR)
        snprintf(user, 256, "%s", message);
}

static SluiceVulkanStreamer *create(struct fake_vulkan *fake, SluiceResidencyMode mode)
{
    SluiceVulkanStreamer *streamer;
    SluiceVulkanStreamerCreateInfo info = {
        .structSize = sizeof info, .residencyMode = mode, .maxRegionCount = 256};
    fake_vulkan_fill(&info);
    CHECK_OK(fake_vulkan_create(fake, &info, &streamer));
    return streamer;
}

static void check_sampler(SluiceResidencyMode mode, bool linear)
{
    static struct fake_vulkan fake; /* large */
    fake = (struct fake_vulkan){.tail_page_count = 1, .no_linear_filter = !linear};
    SluiceVulkanStreamer *streamer = create(&fake, mode);
    SluiceVulkanTextureCreateInfo info = {
        .structSize = sizeof info, .source = gray_source(64, 64), .maxAnisotropy = 8};
    SluiceVulkanTexture texture;
    VkSampler sampler, again;
    CHECK_OK(sluiceAddVulkanTexture(streamer, &info, &texture));
    uint32_t count = fake.sampler_count;
    CHECK_OK(sluiceGetVulkanSampler(streamer, texture.textureId, &sampler));
    CHECK_OK(sluiceGetVulkanSampler(streamer, texture.textureId, &again));
    assert_ptr_equal(sampler, again);
    assert_int_equal(fake.sampler_count, count + 1);
    const VkSamplerCreateInfo *made = &fake.newest_sampler;
    assert_int_equal(made->magFilter, linear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST);
    assert_int_equal(made->minFilter, linear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST);
    assert_int_equal(made->mipmapMode,
                     linear ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST);
    assert_true(made->maxAnisotropy == texture.maxAnisotropy);
    if (!linear)
        assert_true(!made->anisotropyEnable && texture.maxAnisotropy == 1.0f);
    fake_vulkan_destroy(streamer);
    sluiceDestroyImageSource(info.source);
    assert_int_equal(fake.live_objects, 0);
}

static void samplers_are_linear_where_the_format_is(void **state)
{
    (void)state;
    check_sampler(SLUICE_RESIDENCY_MODE_SPARSE, true);
    check_sampler(SLUICE_RESIDENCY_MODE_PAGED, true);
    check_sampler(SLUICE_RESIDENCY_MODE_DENSE, true);
}

static void samplers_are_nearest_for_formats_without_linear_filters(void **state)
{
    (void)state;
    check_sampler(SLUICE_RESIDENCY_MODE_SPARSE, false);
    check_sampler(SLUICE_RESIDENCY_MODE_DENSE, false);
}

static void paged_mode_refuses_formats_without_linear_filters(void **state)
{
    (void)state;
    static struct fake_vulkan fake; /* large */
    char message[256] = "";
    fake = (struct fake_vulkan){.no_linear_filter = true, .log = {message, keep_error}};
    SluiceVulkanStreamer *streamer = create(&fake, SLUICE_RESIDENCY_MODE_PAGED);
    SluiceVulkanTextureCreateInfo info = {.structSize = sizeof info, .source = gray_source(64, 64)};
    SluiceVulkanTexture texture;
    uint64_t objects = fake.live_objects;
    CHECK_RESULT(sluiceAddVulkanTexture(streamer, &info, &texture), SLUICE_ERROR_UNSUPPORTED);
    assert_string_equal(
        message, "gray: 64x64 R8G8B8A8_UNORM has no linear filter, which paged mode requires");
    assert_int_equal(fake.live_objects, objects);
    fake.no_linear_filter = false;
    CHECK_OK(sluiceAddVulkanTexture(streamer, &info, &texture));
    fake_vulkan_destroy(streamer);
    sluiceDestroyImageSource(info.source);
    assert_int_equal(fake.live_objects, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(samplers_are_linear_where_the_format_is),
        cmocka_unit_test(samplers_are_nearest_for_formats_without_linear_filters),
        cmocka_unit_test(paged_mode_refuses_formats_without_linear_filters),
    };
    return RUN_TESTS(tests);
}
