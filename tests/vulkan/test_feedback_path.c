/* Feedback from a device that damages it, and settings that no device can fulfill. */
#include "vulkan/fake_vulkan.h"

#include "support/gray_source.h"
#include "support/test.h"

static uint8_t want_all(void *user, uint32_t region)
{
    (void)user, (void)region;
    return 0;
}

static void count_warnings(void *user, SluiceLogSeverity severity, const char *message)
{
    (void)message;
    *(uint32_t *)user += severity == SLUICE_LOG_WARNING;
}

static void frame(struct fake_vulkan *fake, SluiceVulkanStreamer *streamer, uint64_t time)
{
    SluiceStreamingFrame frame = {.structSize = sizeof frame};
    fake->published = false;
    fake->copy_count = fake->bind_count = 0;
    fake->bind_value = fake->submitted_bind_value;
    CHECK_OK(sluiceWaitVulkanStreamerIdle(streamer));
    CHECK_OK(sluiceBeginStreamingFrame(streamer, fake_vulkan_commands(fake), time, &frame));
    CHECK_OK(sluiceEndStreamingFrame(streamer, fake_vulkan_commands(fake)));
    fake->frame_semaphore = frame.semaphore;
    fake->frame_value = frame.signalValue;
}

static uint64_t maps_given(SluiceVulkanStreamer *streamer)
{
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    sluiceGetVulkanStreamerStatistics(streamer, &stats);
    return stats.feedbackMaps;
}

static void damaged_feedback_is_dropped_and_asked_for_as_a_whole(void **state)
{
    (void)state;
    static struct fake_vulkan fake; /* large */
    uint32_t warnings = 0;
    fake = (struct fake_vulkan){.tail_page_count = 1, .want = want_all};
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                           .maxTextureCount = 4,
                                           .maxRegionCount = 256,
                                           .feedbackTimeoutTicks = 100};
    fake.log = (SluiceLogCallback){&warnings, count_warnings};
    fake_vulkan_fill(&info);
    SluiceVulkanStreamer *streamer;
    CHECK_OK(fake_vulkan_create(&fake, &info, &streamer));
    SluiceVulkanTextureCreateInfo texture_info = {.structSize = sizeof texture_info,
                                                  .source = gray_source(512, 512)};
    SluiceVulkanTexture texture;
    CHECK_OK(sluiceAddVulkanTexture(streamer, &texture_info, &texture));
    for (uint64_t time = 1; time <= 5; time++) /* the first map comes with frame 2 */
        frame(&fake, streamer, time);
    assert_int_equal(maps_given(streamer), 4);
    assert_int_equal(fake.whole_count, 0);

    fake.damage_count = 1;
    frame(&fake, streamer, 6);
    frame(&fake, streamer, 7); /* reads it */
    assert_int_equal(maps_given(streamer), 5);
    assert_int_equal(warnings, 1);
    assert_int_equal(fake.whole_count, 1);
    frame(&fake, streamer, 8);
    assert_int_equal(maps_given(streamer), 6);
    frame(&fake, streamer, 9);
    assert_int_equal(fake.whole_count, 1); /* once is enough */
    assert_int_equal(warnings, 1);
    fake_vulkan_destroy(streamer);
    sluiceDestroyImageSource(texture_info.source);
    assert_int_equal(fake.live_objects, 0);
}

static void settings_beyond_the_device_are_refused(void **state)
{
    (void)state;
    static struct fake_vulkan fake; /* large; its storage buffers have at most 2^27 bytes */
    const struct {
        SluiceVulkanStreamerCreateInfo info;
        SluiceResult result;
    } cases[] = {
        {{.feedbackReadbackSize = 1u << 26}, SLUICE_ERROR_LIMIT_EXCEEDED},
        {{.feedbackReadbackSize = UINT32_MAX}, SLUICE_ERROR_LIMIT_EXCEEDED},
        {{.maxTextureCount = 1u << 20, .texturesPerFrame = 1u << 20, .framesInFlight = 16},
         SLUICE_ERROR_LIMIT_EXCEEDED},
        {{.maxRegionCount = 1u << 26}, SLUICE_ERROR_LIMIT_EXCEEDED},
        {{.maxRegionCount = 1u << 26, .feedbackEncoding = SLUICE_FEEDBACK_ENCODING_MASKS},
         SLUICE_SUCCESS},
        {{.feedbackEncoding = (SluiceFeedbackEncoding)2}, SLUICE_ERROR_INVALID_ARGUMENT},
        {{.feedbackReadbackSize = 1}, SLUICE_SUCCESS},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        fake = (struct fake_vulkan){0};
        SluiceVulkanStreamerCreateInfo info = cases[i].info;
        fake_vulkan_fill(&info);
        SluiceVulkanStreamer *streamer;
        CHECK_RESULT(fake_vulkan_create(&fake, &info, &streamer), cases[i].result);
        fake_vulkan_destroy(streamer);
        assert_int_equal(fake.live_objects, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(damaged_feedback_is_dropped_and_asked_for_as_a_whole),
        cmocka_unit_test(settings_beyond_the_device_are_refused),
    };
    return RUN_TESTS(tests);
}
