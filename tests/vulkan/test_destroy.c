/* Destruction waits for submitted work of the streamer or loader, and for no other work. */
#include "vulkan/fake_vulkan.h"

#include "support/gray_source.h"
#include "support/test.h"

#include <sluice/demand.h>

#include <string.h>

enum { MODES = 3 };
static const SluiceResidencyMode modes[MODES] = {
    SLUICE_RESIDENCY_MODE_SPARSE, SLUICE_RESIDENCY_MODE_PAGED, SLUICE_RESIDENCY_MODE_DENSE};

struct stage {
    struct fake_vulkan fake;
    SluiceVulkanContext *context;
    SluiceVulkanStreamer *streamer;
    SluiceDemandLoader *loader;
    SluiceImageSource *source;
    uint64_t time;
    uint32_t warnings;
};

static uint8_t want_all(void *user, uint32_t region)
{
    (void)user, (void)region;
    return 0;
}

static void count_warnings(void *user, SluiceLogSeverity severity, const char *message)
{
    (void)message;
    ((struct stage *)user)->warnings += severity == SLUICE_LOG_WARNING;
}

static struct stage *stage_of_streamer(SluiceResidencyMode mode)
{
    static struct stage s; /* large */
    s = (struct stage){.fake = {.tail_page_count = 1, .want = want_all, .user = &s}};
    s.source = gray_source(1024, 1024);
    SluiceVulkanStreamerCreateInfo info = {
        .structSize = sizeof info, .maxRegionCount = 1 << 10, .maxTextureCount = 4};
    s.fake.log = (SluiceLogCallback){&s, count_warnings};
    fake_vulkan_fill(&info);
    info.residencyMode = mode;
    CHECK_OK(fake_vulkan_create(&s.fake, &info, &s.streamer));
    SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create, .source = s.source};
    SluiceVulkanTexture texture;
    CHECK_OK(sluiceAddVulkanTexture(s.streamer, &create, &texture));
    s.fake.waits_time_out = true;
    return &s;
}

static SluiceStreamingFrame begin(struct stage *s)
{
    SluiceStreamingFrame frame = {.structSize = sizeof frame};
    s->fake.published = false;
    s->fake.bind_count = s->fake.copy_count = 0;
    CHECK_OK(
        sluiceBeginStreamingFrame(s->streamer, fake_vulkan_commands(&s->fake), ++s->time, &frame));
    s->fake.frame_semaphore = frame.semaphore;
    return frame;
}

static SluiceStreamingFrame whole_frame(struct stage *s)
{
    SluiceStreamingFrame frame = begin(s);
    CHECK_OK(sluiceEndStreamingFrame(s->streamer, fake_vulkan_commands(&s->fake)));
    return frame;
}

/* Returns how often it waited for the semaphore of frames or launches. */
static uint32_t frame_waits(const struct stage *s)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < s->fake.wait_count; i++)
        count += s->fake.waits[i].semaphore == s->fake.frame_semaphore;
    return count;
}

static void destroy(struct stage *s)
{
    s->fake.wait_count = s->fake.device_waits = s->warnings = 0;
    fake_vulkan_destroy(s->streamer);
    sluiceDestroyImageSource(s->source);
    assert_int_equal(s->fake.live_objects, 0);
    assert_int_equal(s->fake.live_memory, 0);
}

static void streamer_waits_for_its_last_frame_before_anything_goes(void **state)
{
    (void)state;
    for (int i = 0; i < MODES; i++) {
        struct stage *s = stage_of_streamer(modes[i]);
        whole_frame(s);
        SluiceStreamingFrame last = whole_frame(s);
        uint64_t objects = s->fake.live_objects;
        s->fake.waits_time_out = false; /* the GPU makes progress as soon as it is waited for */
        destroy(s);
        assert_true(s->fake.waits[0].semaphore == last.semaphore);
        assert_int_equal(s->fake.waits[0].value, last.signalValue);
        assert_int_equal(s->fake.waits[0].live_objects, objects);
        assert_int_equal(frame_waits(s), 1);
        assert_int_equal(s->fake.device_waits, 0);
        assert_int_equal(s->warnings, 0);
    }
}

static void streamer_waits_for_its_bindings(void **state)
{
    (void)state;
    struct stage *s = stage_of_streamer(SLUICE_RESIDENCY_MODE_SPARSE);
    for (int i = 0; i < 3; i++) {
        s->fake.frame_value = whole_frame(s).signalValue;
        CHECK_OK(sluiceWaitVulkanStreamerIdle(s->streamer));
    }
    assert_true(s->fake.submitted_bind_value > s->fake.bind_value);
    uint64_t objects = s->fake.live_objects, value = s->fake.submitted_bind_value;
    VkSemaphore semaphore = s->fake.bind_semaphore;
    destroy(s);
    const struct fake_wait *wait = &s->fake.waits[s->fake.wait_count - 1];
    assert_true(wait->semaphore == semaphore);
    assert_int_equal(wait->value, value);
    assert_int_equal(wait->timeout, UINT64_MAX);
    assert_int_equal(wait->live_objects, objects);
    assert_int_equal(s->fake.device_waits, 0);
}

static void streamer_does_not_wait_for_frames_that_cannot_be_under_way(void **state)
{
    (void)state;
    for (int i = 0; i < MODES; i++) {
        struct stage *s = stage_of_streamer(modes[i]); /* no frame */
        destroy(s);
        assert_int_equal(frame_waits(s), 0);

        s = stage_of_streamer(modes[i]); /* complete */
        s->fake.frame_value = whole_frame(s).signalValue;
        s->fake.frame_value = whole_frame(s).signalValue;
        begin(s); /* begun, not ended */
        destroy(s);
        assert_int_equal(frame_waits(s), 0);
        assert_int_equal(s->fake.device_waits + s->warnings, 0);

        s = stage_of_streamer(modes[i]); /* abandoned */
        s->fake.frame_value = whole_frame(s).signalValue;
        begin(s);
        CHECK_OK(sluiceEndStreamingFrame(s->streamer, fake_vulkan_commands(&s->fake)));
        SluiceStreamingFrame abandoned = {sizeof abandoned, s->fake.frame_value + 1,
                                          s->fake.frame_semaphore, 0};
        CHECK_OK(sluiceAbandonStreamingFrame(s->streamer, &abandoned));
        destroy(s);
        assert_int_equal(frame_waits(s), 0);
        assert_int_equal(s->fake.device_waits + s->warnings, 0);
    }
}

static void frame_that_could_not_be_begun_is_not_waited_for(void **state)
{
    (void)state;
    struct stage *s = stage_of_streamer(SLUICE_RESIDENCY_MODE_SPARSE);
    s->fake.frame_value = whole_frame(s).signalValue;
    s->fake.frame_value = whole_frame(s).signalValue;
    CHECK_OK(sluiceWaitVulkanStreamerIdle(s->streamer));
    SluiceStreamingFrame frame = {.structSize = sizeof frame,
                                  .frameIndex = s->fake.frame_value + 1};
    s->fake.published = false;
    s->fake.fails_on = true;
    s->fake.failure = VK_ERROR_OUT_OF_DEVICE_MEMORY;
    s->fake.failing_call = s->fake.calls + 2; /* after the query of the semaphore */
    SluiceResult result =
        sluiceBeginStreamingFrame(s->streamer, fake_vulkan_commands(&s->fake), ++s->time, &frame);
    s->fake.failing_call = 0;
    assert_true(result < 0);
    destroy(s);
    for (uint32_t i = 0; i < s->fake.wait_count; i++)
        assert_true(s->fake.waits[i].value < frame.frameIndex ||
                    s->fake.waits[i].semaphore != s->fake.frame_semaphore);
    assert_int_equal(s->fake.device_waits, 0);
}

/* The streamer cannot know whether the frame was submitted. The wait is bounded, and the calls
 * after it are safe. */
static void ended_frame_that_was_not_submitted_does_not_hang_destruction(void **state)
{
    (void)state;
    for (int i = 0; i < MODES; i++) {
        struct stage *s = stage_of_streamer(modes[i]);
        whole_frame(s);
        destroy(s);
        assert_int_equal(frame_waits(s), 5);
        assert_int_equal(s->fake.device_waits, 1);
        assert_int_equal(s->warnings, 1);
        assert_int_equal(s->fake.lock_depth, 0);
        assert_true(s->fake.lock_count >= 1);
    }
}

static void destruction_of_a_lost_device_does_not_wait(void **state)
{
    (void)state;
    for (int i = 0; i < MODES; i++) {
        struct stage *s = stage_of_streamer(modes[i]);
        whole_frame(s);
        s->fake.failure = VK_ERROR_DEVICE_LOST;
        s->fake.fails_on = true;
        s->fake.failing_call = s->fake.calls + 1;
        destroy(s);
        assert_int_equal(s->fake.device_waits, 0);
    }
}

static struct stage *stage_of_loader(void)
{
    static struct stage s; /* large */
    s = (struct stage){.fake = {.no_resolve = true, .waits_time_out = true}};
    s.fake.log = (SluiceLogCallback){&s, count_warnings};
    const SluiceVulkanContextCreateInfo context = fake_vulkan_context_info(&s.fake);
    CHECK_OK(sluiceCreateVulkanContext(&context, &s.context));
    SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info,
                                         .context = s.context,
                                         .maxTextureCount = 64,
                                         .pageCapacity = 1 << 16,
                                         .launchesInFlight = 3,
                                         .memoryBudget = 4 << 20};
    CHECK_OK(sluiceCreateDemandLoader(&info, &s.loader));
    return &s;
}

static SluiceDemandLaunch prepare(struct stage *s)
{
    SluiceDemandLaunch launch = {.structSize = sizeof launch};
    s->fake.published = false;
    CHECK_OK(sluiceBeginDemandLaunch(s->loader, fake_vulkan_commands(&s->fake), &launch));
    s->fake.frame_semaphore = launch.semaphore;
    return launch;
}

static SluiceDemandLaunch whole_launch(struct stage *s)
{
    SluiceDemandLaunch launch = prepare(s);
    CHECK_OK(sluiceEndDemandLaunch(s->loader, fake_vulkan_commands(&s->fake)));
    return launch;
}

static void destroy_loader(struct stage *s)
{
    s->fake.wait_count = s->fake.device_waits = s->warnings = 0;
    sluiceDestroyDemandLoader(s->loader);
    sluiceDestroyVulkanContext(s->context);
    assert_int_equal(s->fake.live_objects, 0);
    assert_int_equal(s->fake.live_memory, 0);
}

static void loader_waits_for_its_last_launch_before_anything_goes(void **state)
{
    (void)state;
    struct stage *s = stage_of_loader();
    whole_launch(s);
    SluiceDemandLaunch last = whole_launch(s);
    uint64_t objects = s->fake.live_objects;
    s->fake.waits_time_out = false;
    destroy_loader(s);
    assert_int_equal(s->fake.wait_count, 1);
    assert_true(s->fake.waits[0].semaphore == last.semaphore);
    assert_int_equal(s->fake.waits[0].value, last.signalValue);
    assert_int_equal(s->fake.waits[0].live_objects, objects);
    assert_int_equal(s->fake.device_waits, 0);
}

static void loader_does_not_wait_for_launches_that_cannot_be_under_way(void **state)
{
    (void)state;
    struct stage *s = stage_of_loader();
    destroy_loader(s);
    assert_int_equal(s->fake.wait_count, 0);

    s = stage_of_loader();
    SluiceDemandLaunch launch = whole_launch(s);
    SluiceDemandRequests requests = {.structSize = sizeof requests};
    s->fake.frame_value = launch.signalValue;
    CHECK_OK(sluiceProcessDemandRequests(s->loader, &launch, 0, &requests, NULL));
    launch = whole_launch(s);
    CHECK_OK(sluiceAbandonDemandLaunch(s->loader, &launch));
    prepare(s); /* begun, not ended */
    destroy_loader(s);
    assert_int_equal(s->fake.wait_count + s->fake.device_waits + s->warnings, 0);
}

static void ended_launch_that_was_not_submitted_does_not_hang_destruction(void **state)
{
    (void)state;
    struct stage *s = stage_of_loader();
    whole_launch(s);
    destroy_loader(s);
    assert_int_equal(frame_waits(s), 5);
    assert_int_equal(s->fake.device_waits, 1);
    assert_int_equal(s->warnings, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(streamer_waits_for_its_last_frame_before_anything_goes),
        cmocka_unit_test(streamer_waits_for_its_bindings),
        cmocka_unit_test(streamer_does_not_wait_for_frames_that_cannot_be_under_way),
        cmocka_unit_test(frame_that_could_not_be_begun_is_not_waited_for),
        cmocka_unit_test(ended_frame_that_was_not_submitted_does_not_hang_destruction),
        cmocka_unit_test(destruction_of_a_lost_device_does_not_wait),
        cmocka_unit_test(loader_waits_for_its_last_launch_before_anything_goes),
        cmocka_unit_test(loader_does_not_wait_for_launches_that_cannot_be_under_way),
        cmocka_unit_test(ended_launch_that_was_not_submitted_does_not_hang_destruction),
    };
    return RUN_TESTS(tests);
}
