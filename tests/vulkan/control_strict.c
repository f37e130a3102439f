/* Makes each kind of misuse once, and checks the report of strict mode. */
#include "vulkan/control_strict.h"

#include "support/gray_source.h"
#include "vulkan/control_stage.h"

#include <sluice/vulkan_strict.h>

#include <string.h>

static struct {
    uint32_t counts[7]; ///< by kind
    SluiceMisuse last;
    char text[400];
} heard;

static void listen(void *user, const SluiceMisuse *misuse)
{
    (void)user;
    heard.counts[misuse->kind]++;
    heard.last = *misuse;
    strncpy(heard.text, misuse->pMessage, sizeof heard.text - 1);
}

static struct stage *begin(const SluiceVulkanStreamerCreateInfo *info)
{
    struct stage *s = stage_init(info);
    memset(&heard, 0, sizeof heard);
    const SluiceVulkanStrictMode strict = {.structSize = sizeof strict,
                                           .framesWithoutFeedback = 20,
                                           .refusedBegins = 5,
                                           .repeatFrames = 30,
                                           .pfnReport = listen};
    const uint64_t calls = s->memory.calls;
    CHECK_OK(sluiceSetVulkanStrictMode(s->streamer, &strict));
    assert_int_equal(s->memory.calls, calls);
    return s;
}

static SluiceResult begin_frame(struct stage *s, SluiceStreamingFrame *frame)
{
    s->fake.published = false;
    s->fake.copy_count = s->fake.bind_count = 0;
    return sluiceBeginStreamingFrame(s->streamer, fake_vulkan_commands(&s->fake), ++s->time, frame);
}

static void check_heard(SluiceMisuseKind kind, uint32_t count, uint64_t value, const char *text)
{
    assert_int_equal(heard.counts[kind], count);
    assert_true(heard.last.kind == kind && heard.last.value == value);
    assert_non_null(strstr(heard.text, text));
}

void unpaired_frames_are_reported(void **state)
{
    (void)state;
    struct stage *s = begin(&(SluiceVulkanStreamerCreateInfo){0});
    VkCommandBuffer commands = fake_vulkan_commands(&s->fake);
    SluiceStreamingFrame frame = {.structSize = sizeof frame};
    CHECK_RESULT(sluiceEndStreamingFrame(s->streamer, commands), SLUICE_ERROR_INVALID_ARGUMENT);
    check_heard(SLUICE_MISUSE_FRAME_NOT_BEGUN, 1, 0, "sluiceBeginStreamingFrame first");
    CHECK_OK(begin_frame(s, &frame));
    CHECK_RESULT(begin_frame(s, &frame), SLUICE_ERROR_INVALID_ARGUMENT);
    check_heard(SLUICE_MISUSE_FRAME_NOT_ENDED, 1, 1, "frame 1 was begun and not ended");
    CHECK_OK(sluiceEndStreamingFrame(s->streamer, commands));
    CHECK_OK(sluiceSetVulkanStrictMode(s->streamer, NULL));
    CHECK_RESULT(sluiceEndStreamingFrame(s->streamer, commands), SLUICE_ERROR_INVALID_ARGUMENT);
    assert_int_equal(heard.counts[SLUICE_MISUSE_FRAME_NOT_BEGUN], 1);
    CHECK_RESULT(
        sluiceSetVulkanStrictMode(
            s->streamer, &(SluiceVulkanStrictMode){.structSize = sizeof(SluiceVulkanStrictMode)}),
        SLUICE_ERROR_INVALID_ARGUMENT);
    s->fake.frame_semaphore = frame.semaphore;
    s->fake.frame_value = frame.signalValue;
    stage_finish(s);
}

void frames_that_are_never_signaled_are_reported_once(void **state)
{
    (void)state;
    struct stage *s = begin(&(SluiceVulkanStreamerCreateInfo){.framesInFlight = 2});
    SluiceStreamingFrame frame = {.structSize = sizeof frame};
    frames(s, 3);
    for (uint32_t i = 0; i < 2; i++) { /* frames 4 and 5 */
        CHECK_OK(begin_frame(s, &frame));
        CHECK_OK(sluiceEndStreamingFrame(s->streamer, fake_vulkan_commands(&s->fake)));
    }
    for (uint32_t i = 1; i <= 20; i++) {
        CHECK_RESULT(begin_frame(s, &frame), SLUICE_NOT_READY);
        assert_int_equal(heard.counts[SLUICE_MISUSE_FRAME_NOT_SIGNALED], i >= 5);
    }
    check_heard(SLUICE_MISUSE_FRAME_NOT_SIGNALED, 1, 4, "submit its commands with signalValue 4");
    s->fake.frame_value = 5;
    frames(s, 2);
    assert_int_equal(heard.counts[SLUICE_MISUSE_FRAME_NOT_SIGNALED], 1);
    stage_finish(s);
}

/* A fence may be signaled shortly before the semaphore. */
void a_semaphore_that_is_late_by_a_moment_is_waited_for(void **state)
{
    (void)state;
    struct stage *s = begin(&(SluiceVulkanStreamerCreateInfo){.framesInFlight = 2});
    SluiceStreamingFrame frame = {.structSize = sizeof frame};
    frames(s, 3);
    for (uint32_t i = 0; i < 2; i++) {
        CHECK_OK(begin_frame(s, &frame));
        CHECK_OK(sluiceEndStreamingFrame(s->streamer, fake_vulkan_commands(&s->fake)));
    }
    uint32_t waits = s->fake.wait_count;
    CHECK_RESULT(begin_frame(s, &frame), SLUICE_NOT_READY);
    assert_int_equal(s->fake.wait_count, waits + 1);
    assert_int_equal(s->fake.waits[waits % 64].value, 4);
    assert_true(s->fake.waits[waits % 64].timeout <= 10000000);
    s->fake.waits_signal = true;
    CHECK_OK(begin_frame(s, &frame));
    CHECK_OK(sluiceEndStreamingFrame(s->streamer, fake_vulkan_commands(&s->fake)));
    s->fake.frame_value = 6;
    stage_finish(s);
}

void frames_without_feedback_are_reported(void **state)
{
    (void)state;
    struct stage *s = begin(&(SluiceVulkanStreamerCreateInfo){.feedbackTimeoutTicks = 5});
    s->seen[2][7] = 1;
    frames(s, 60);
    assert_int_equal(heard.counts[SLUICE_MISUSE_NO_FEEDBACK], 0);
    s->seen[2][7] = SLUICE_MIP_UNTOUCHED;
    frames(s, 19);
    assert_int_equal(heard.counts[SLUICE_MISUSE_NO_FEEDBACK], 0);
    frames(s, 8);
    check_heard(SLUICE_MISUSE_NO_FEEDBACK, 1, 20, "marked any of 4 textures in the last 20 frames");
    s->seen[2][7] = 1;
    frames(s, 60);
    assert_int_equal(heard.counts[SLUICE_MISUSE_NO_FEEDBACK], 1);
    stage_finish(s);
}

void exhausted_heaps_are_reported(void **state)
{
    (void)state;
    struct stage *s = begin(&(SluiceVulkanStreamerCreateInfo){
        .feedbackTimeoutTicks = 100, .heapTileCapacity = 16, .maxHeapCount = 2});
    s->seen[0][0] = 0;
    frames(s, 20);
    assert_int_equal(heard.counts[SLUICE_MISUSE_HEAPS_EXHAUSTED], 0);
    memset(s->seen[0], 0, sizeof s->seen[0]);
    frames(s, 20);
    check_heard(SLUICE_MISUSE_HEAPS_EXHAUSTED, 1, 2, "all 2 heaps of 16 tiles are in use");
    assert_non_null(strstr(heard.text, "Raise maxHeapCount"));
    frames(s, 25);
    assert_int_equal(heard.counts[SLUICE_MISUSE_HEAPS_EXHAUSTED], 2); /* repeatFrames later */
    stage_finish(s);
}

void sources_in_use_are_reported_and_kept(void **state)
{
    (void)state;
    struct stage *s = begin(&(SluiceVulkanStreamerCreateInfo){0});
    CHECK_RESULT(sluiceReleaseVulkanSource(s->streamer, &s->faults.base), SLUICE_NOT_READY);
    check_heard(SLUICE_MISUSE_SOURCE_IN_USE, 1, (uint64_t)(uintptr_t)&s->faults.base,
                "gray: the source is destroyed");
    const SluiceImageInfo info = {
        .structSize = sizeof info, .width = 8, .height = 8, .format = SLUICE_FORMAT_R8G8B8A8_UNORM};
    SluiceImageSource *unused = gray_source_with(&info);
    CHECK_OK(sluiceReleaseVulkanSource(s->streamer, unused)); /* leak checkers see the rest */
    assert_int_equal(heard.counts[SLUICE_MISUSE_SOURCE_IN_USE], 1);
    stage_finish(s);
}
