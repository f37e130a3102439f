/* A texture uses the address modes that its source records, unless the caller overrides them. */
#include "vulkan/fake_vulkan.h"

#include "support/gray_source.h"
#include "support/test.h"

#include <string.h>

static void count_warnings(void *user, SluiceLogSeverity severity, const char *message)
{
    if (severity != SLUICE_LOG_WARNING || !strstr(message, "address modes"))
        return;
    ++*(uint32_t *)user;
    assert_non_null(strstr(message, "repeat (u), clamp to edge (v)"));
    assert_non_null(strstr(message, "for clamp to edge, clamp to edge: seams"));
}

static const struct mode_case {
    SluiceImageAddressMode recorded[2];
    VkSamplerAddressMode given[2];
    bool is_explicit;
    VkSamplerAddressMode used[2];
    uint32_t warnings; ///< so far
} cases[] = {
    {{0, 0}, {0, 0}, false, {0, 0}, 0},
    {{SLUICE_IMAGE_ADDRESS_MODE_CLAMP_TO_EDGE, SLUICE_IMAGE_ADDRESS_MODE_MIRRORED_REPEAT},
     {0, 0},
     false,
     {VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT},
     0},
    {{SLUICE_IMAGE_ADDRESS_MODE_REPEAT, SLUICE_IMAGE_ADDRESS_MODE_CLAMP_TO_BORDER},
     {0, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER},
     true,
     {VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER},
     0},
    {{SLUICE_IMAGE_ADDRESS_MODE_CLAMP_TO_EDGE, SLUICE_IMAGE_ADDRESS_MODE_CLAMP_TO_EDGE},
     {0, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE},
     true,
     {VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE},
     1},
    {{SLUICE_IMAGE_ADDRESS_MODE_REPEAT, SLUICE_IMAGE_ADDRESS_MODE_REPEAT},
     {0, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE},
     false,
     {VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE},
     1}, /* reported once */
};

static void the_source_decides_unless_the_caller_does_and_a_mismatch_is_logged_once(void **state)
{
    (void)state;
    static struct fake_vulkan fake; /* large */
    uint32_t warnings = 0;
    fake = (struct fake_vulkan){.tail_page_count = 1, .log = {&warnings, count_warnings}};
    SluiceVulkanStreamerCreateInfo info = {
        .structSize = sizeof info, .maxTextureCount = 8, .maxRegionCount = 256};
    fake_vulkan_fill(&info);
    SluiceVulkanStreamer *streamer;
    SluiceImageSource *sources[sizeof cases / sizeof cases[0]];
    CHECK_OK(fake_vulkan_create(&fake, &info, &streamer));
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const struct mode_case *c = &cases[i];
        SluiceImageInfo gray = {.structSize = sizeof gray,
                                .width = 64,
                                .height = 64,
                                .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                .addressModeU = c->recorded[0],
                                .addressModeV = c->recorded[1]};
        sources[i] = gray_source_with(&gray);
        SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create,
                                                .source = sources[i],
                                                .addressModeU = c->given[0],
                                                .addressModeV = c->given[1],
                                                .explicitAddressModes = c->is_explicit};
        SluiceVulkanTexture texture;
        CHECK_OK(sluiceAddVulkanTexture(streamer, &create, &texture));
        assert_int_equal(texture.addressModeU, c->used[0]);
        assert_int_equal(texture.addressModeV, c->used[1]);
        assert_int_equal(warnings, c->warnings);
    }
    fake_vulkan_destroy(streamer);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        sluiceDestroyImageSource(sources[i]);
    assert_int_equal(fake.live_objects, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_source_decides_unless_the_caller_does_and_a_mismatch_is_logged_once),
    };
    return RUN_TESTS(tests);
}
