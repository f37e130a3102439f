/* Buffers and images have the flags that the application asks for. */
#include "vulkan/fake_objects.h"

#include "support/test.h"

#include <string.h>

static struct fake_vulkan fake; /* large */

static SluiceVulkanStreamerCreateInfo streamer_info(SluiceResidencyMode mode)
{
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                           .residencyMode = mode,
                                           .maxTextureCount = 4,
                                           .maxRegionCount = 256,
                                           .tilesPerFrame = 16};
    fake = (struct fake_vulkan){.tail_page_count = 1};
    fake_vulkan_fill(&info);
    return info;
}

static void check_address(VkBuffer buffer, VkDeviceAddress address, uint64_t size)
{
    assert_true(buffer && address == (VkDeviceAddress)(uintptr_t)buffer);
    assert_int_equal(size, FAKE_OBJECT(buffer)->size);
}

static void buffers_have_addresses_and_sizes(void **state)
{
    (void)state;
    const SluiceResidencyMode modes[] = {SLUICE_RESIDENCY_MODE_SPARSE, SLUICE_RESIDENCY_MODE_PAGED,
                                         SLUICE_RESIDENCY_MODE_DENSE};
    for (int i = 0; i < 3; i++) {
        SluiceVulkanStreamerCreateInfo info = streamer_info(modes[i]);
        SluiceVulkanBuffers b = {.structSize = sizeof b};
        SluiceVulkanStreamer *streamer;
        fake.has_addresses = info.bufferDeviceAddress = true;
        CHECK_OK(fake_vulkan_create(&fake, &info, &streamer));
        CHECK_OK(sluiceGetVulkanBuffers(streamer, &b));
        check_address(b.textureTable, b.textureTableAddress, b.textureTableSize);
        check_address(b.feedback, b.feedbackAddress, b.feedbackSize);
        check_address(b.minMip, b.minMipAddress, b.minMipSize);
        check_address(b.feedbackTurns, b.feedbackTurnsAddress, b.feedbackTurnsSize);
        check_address(b.pageTable, b.pageTableAddress, b.pageTableSize);
        fake_vulkan_destroy(streamer);
        assert_int_equal(fake.live_objects, 0);
    }
}

static void addresses_are_0_unless_they_are_asked_for(void **state)
{
    (void)state;
    SluiceVulkanStreamerCreateInfo info = streamer_info(SLUICE_RESIDENCY_MODE_PAGED);
    SluiceVulkanBuffers b = {.structSize = sizeof b};
    SluiceVulkanStreamer *streamer;
    fake.has_addresses = true;
    CHECK_OK(fake_vulkan_create(&fake, &info, &streamer));
    CHECK_OK(sluiceGetVulkanBuffers(streamer, &b));
    assert_true(b.textureTableAddress == 0 && b.pageTableAddress == 0 && b.minMipAddress == 0);
    assert_false(FAKE_OBJECT(b.minMip)->usage & VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT);
    fake_vulkan_destroy(streamer);
}

static void addresses_that_the_device_lacks_are_refused(void **state)
{
    (void)state;
    SluiceVulkanStreamerCreateInfo info = streamer_info(SLUICE_RESIDENCY_MODE_SPARSE);
    SluiceVulkanStreamer *streamer;
    info.bufferDeviceAddress = true;
    CHECK_RESULT(fake_vulkan_create(&fake, &info, &streamer), SLUICE_ERROR_UNSUPPORTED);
    fake.has_addresses = true;
    fake.missing = "vkGetBufferDeviceAddress";
    CHECK_RESULT(fake_vulkan_create(&fake, &info, &streamer), SLUICE_ERROR_UNSUPPORTED);
    assert_int_equal(fake.live_objects, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(buffers_have_addresses_and_sizes),
        cmocka_unit_test(addresses_are_0_unless_they_are_asked_for),
        cmocka_unit_test(addresses_that_the_device_lacks_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
