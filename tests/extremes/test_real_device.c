/* Streamer and demand loader on a real device. Each call fails once, or permanently from some call
 * on. */
#include "device/demand_runner.h"
#include "device/pattern.h"
#include "extremes/failing_layer.h"
#include "extremes/note.h"
#include "support/failing_allocator.h"
#include "support/map_everything.h"

static struct harness h;
static const SluiceVulkanContextCreateInfo failing = {.pfnGetInstanceProcAddr = failing_layer_get,
                                                      .loaderThreadCount = 1};
static bool is_long_run;

enum { FRAMES = 5, LAUNCHES = 6 };

static SluiceResult create_streamer(SluiceVulkanStreamer **streamer)
{
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                           .tilesPerFrame = 16,
                                           .maxTextureCount = 4,
                                           .maxRegionCount = 256,
                                           .pDebug = &map_everything};
    *streamer = NULL;
    SluiceResult result = harness_set_context(&h, &failing);
    harness_fill(&h, &info);
    return result == SLUICE_SUCCESS ? sluiceCreateVulkanStreamer(&info, streamer) : result;
}

static void wait_for(VkSemaphore semaphore, uint64_t value)
{
    VkSemaphoreWaitInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                .semaphoreCount = 1,
                                .pSemaphores = &semaphore,
                                .pValues = &value};
    assert_int_equal(h.WaitSemaphores(h.device, &info, UINT64_MAX), VK_SUCCESS);
}

static void submit(VkCommandBuffer commands, VkSemaphore semaphore, uint64_t value)
{
    VkTimelineSemaphoreSubmitInfo timeline = {.sType =
                                                  VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
                                              .signalSemaphoreValueCount = 1,
                                              .pSignalSemaphoreValues = &value};
    VkSubmitInfo info = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                         .pNext = &timeline,
                         .commandBufferCount = 1,
                         .pCommandBuffers = &commands,
                         .signalSemaphoreCount = 1,
                         .pSignalSemaphores = &semaphore};
    assert_int_equal(h.QueueSubmit(h.queue, 1, &info, VK_NULL_HANDLE), VK_SUCCESS);
}

static SluiceResult frame(SluiceVulkanStreamer *streamer)
{
    VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    SluiceStreamingFrame frame = {.structSize = sizeof frame};
    VkCommandBuffer commands = h.commands[0];
    SluiceResult result = sluiceWaitVulkanStreamerIdle(streamer);
    if (result != SLUICE_SUCCESS)
        return result;
    assert_int_equal(h.ResetCommandBuffer(commands, 0), VK_SUCCESS);
    assert_int_equal(h.BeginCommandBuffer(commands, &begin), VK_SUCCESS);
    result = sluiceBeginStreamingFrame(streamer, commands, ++h.time, &frame);
    if (result == SLUICE_SUCCESS)
        result = sluiceEndStreamingFrame(streamer, commands);
    assert_int_equal(h.EndCommandBuffer(commands), VK_SUCCESS);
    if (result != SLUICE_SUCCESS)
        return result; /* never submitted */
    submit(commands, frame.semaphore, frame.signalValue);
    wait_for(frame.semaphore, frame.signalValue);
    return SLUICE_SUCCESS;
}

/* Streams, and returns the first error. */
static SluiceResult live_streaming(SluiceImageSource *source)
{
    SluiceVulkanStreamer *streamer;
    SluiceVulkanTexture texture;
    SluiceVulkanTextureCreateInfo info = {.structSize = sizeof info, .source = source};
    SluiceResult result = create_streamer(&streamer);
    if (result == SLUICE_SUCCESS)
        result = sluiceAddVulkanTexture(streamer, &info, &texture);
    for (uint32_t i = 0; i < FRAMES && result == SLUICE_SUCCESS; i++)
        result = frame(streamer);
    if (streamer) { /* a program that shuts down waits: the wait must return */
        SluiceResult idle = sluiceWaitVulkanStreamerIdle(streamer);
        assert_true(idle == SLUICE_SUCCESS || idle == SLUICE_ERROR_DEVICE_LOST);
        SluiceVulkanStreamerStatistics statistics = {.structSize = sizeof statistics};
        sluiceGetVulkanStreamerStatistics(streamer, &statistics);
        sluiceDestroyVulkanStreamer(streamer);
    }
    return result;
}

static void a_streamer_on_a_device_that_is_lost_can_be_destroyed(void **state)
{
    (void)state;
    SluiceImageSource *source =
        pattern_source(PATTERN_LEVEL, 1024, 1024, SLUICE_FORMAT_R8G8B8A8_UNORM);
    uint64_t cases = 0, untold = 0;
    h.quiet = true;
    for (uint64_t n = 1;; n += is_long_run ? 1 : 4) {
        failing_layer_set(&h, n, true, VK_ERROR_DEVICE_LOST);
        SluiceResult result = live_streaming(source);
        if (failing_layer.calls < n) {
            CHECK_OK(result);
            break;
        }
        /* the last frame makes no calls after these; three of them are waits */
        untold += result == SLUICE_SUCCESS && failing_layer.calls > n + 3;
        assert_true(result == SLUICE_SUCCESS || result == SLUICE_ERROR_DEVICE_LOST);
        cases++;
    }
    h.quiet = false;
    note("a real device that is lost: calls at which nobody was told", cases, (double)untold, 0);
    assert_int_equal(untold, 0);
    assert_true(cases > 8);
    sluiceDestroyImageSource(source);
}

static SluiceResult create_loader(SluiceDemandLoader **loader)
{
    SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info,
                                         .memoryBudget = 8u << 20,
                                         .maxTextureCount = 64,
                                         .pageCapacity = 1u << 16,
                                         .maxTilesInFlight = 16};
    *loader = NULL;
    SluiceResult result = harness_set_context(&h, &failing);
    runner_fill(&h, &info);
    return result == SLUICE_SUCCESS ? sluiceCreateDemandLoader(&info, loader) : result;
}

/* Launches until nothing is missing, and continues after errors that lose nothing. Returns the
 * first error. */
static SluiceResult launch(struct runner *r, bool *is_complete)
{
    SluiceResult first = SLUICE_SUCCESS;
    *is_complete = false;
    for (uint32_t i = 0; i < LAUNCHES && !*is_complete; i++) {
        SluiceResult result = runner_submit(r);
        if (result == SLUICE_SUCCESS)
            result = sluiceProcessDemandRequests(r->loader, &r->launch, UINT64_MAX, &r->requests,
                                                 &r->ticket);
        first = first == SLUICE_SUCCESS ? result : first;
        if (result == SLUICE_ERROR_DEVICE_LOST || result == SLUICE_ERROR_VULKAN)
            break;
        if (result != SLUICE_SUCCESS)
            continue;
        *is_complete = r->requests.missingCount == 0;
        CHECK_OK(sluiceWaitDemandTicket(r->loader, r->ticket, UINT64_MAX, NULL));
    }
    return first;
}

/* Runs a loader, and returns the first error. */
static SluiceResult live_on_demand(struct runner_image *image, bool *is_complete)
{
    SluiceDemandLoader *loader;
    *is_complete = false;
    SluiceResult result = create_loader(&loader);
    if (result != SLUICE_SUCCESS) {
        assert_null(loader);
        return result;
    }
    struct runner r;
    runner_init_with(&r, &h, loader);
    runner_add_texel(&r, runner_add_texture(&r, image), 300, 300, 0, 299, 299);
    result = launch(&r, is_complete);
    if (*is_complete)
        runner_check_texel(&r, 0, image, 0, 299, 299);
    CHECK_OK(sluiceAbortDemandLoader(loader));
    runner_finish(&r);
    return result;
}

static uint64_t fail_every_call(struct runner_image *image, bool fails_on, VkResult from,
                                SluiceResult to)
{
    uint64_t cases = 0;
    for (uint64_t n = 1;; n += is_long_run ? 1 : 5) {
        bool is_complete;
        failing_layer_set(&h, n, fails_on, from);
        SluiceResult result = live_on_demand(image, &is_complete);
        if (failing_layer.calls < n) {
            CHECK_OK(result);
            assert_true(is_complete);
            return cases;
        }
        assert_true(result == SLUICE_SUCCESS || result == to);
        assert_true(failing_layer.waited_in_vain < 10);
        cases++;
    }
}

static void a_demand_loader_survives_every_failing_call(void **state)
{
    (void)state;
    struct runner_image image;
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 300, 300, 1);
    h.quiet = true;
    uint64_t lost = fail_every_call(&image, true, VK_ERROR_DEVICE_LOST, SLUICE_ERROR_DEVICE_LOST);
    uint64_t memory = fail_every_call(&image, false, VK_ERROR_OUT_OF_DEVICE_MEMORY,
                                      SLUICE_ERROR_OUT_OF_DEVICE_MEMORY);
    h.quiet = false;
    uint64_t left = image.opened - image.closed;
    note("demand loader: images left open by failing calls", lost + memory, (double)left, 0);
    assert_int_equal(left, 0);
    assert_true(lost > 8 && memory > 8);
    runner_image_finish(&image);
}

int main(int argc, char **argv)
{
    is_long_run = is_long(argc, argv);
    int status = harness_init(&h);
    if (status)
        return status;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_streamer_on_a_device_that_is_lost_can_be_destroyed),
        cmocka_unit_test(a_demand_loader_survives_every_failing_call),
    };
    return harness_finish(&h, RUN_TESTS(tests));
}
