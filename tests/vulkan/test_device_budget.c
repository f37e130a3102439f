/* VK_EXT_memory_budget: tile memory follows the device's budget in steps. Without the extension it
 * does not. */
#include "vulkan/fake_vulkan.h"

#include "core/observer.h"
#include "support/streamer_manager.h"
#include "support/gray_source.h"
#include "support/test.h"

#define MIB (UINT64_C(1) << 20)
#define HEAP (256 * MIB) /* memory heap of the device; a step is 4 MiB */
#define STEP (4 * MIB)

enum { FRAMES_PER_POLL = 256 };

static struct fake_vulkan fake; /* large */
static SluiceVulkanContext *context;
static SluiceVulkanStreamer *streamer;
static SluiceImageSource *source;
static uint64_t now;

static uint8_t want_all(void *user, uint32_t region)
{
    (void)user, (void)region;
    return 0;
}

static SluiceVulkanContextStatistics statistics(void)
{
    SluiceVulkanContextStatistics s = {.structSize = sizeof s};
    CHECK_OK(sluiceGetVulkanContextStatistics(context, &s));
    return s;
}

static void run_frames(uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        SluiceStreamingFrame frame = {.structSize = sizeof frame};
        VkCommandBuffer commands = fake_vulkan_commands(&fake);
        fake.published = false;
        fake.copy_count = fake.bind_count = fake.destroyed_count = fake.freed_count = 0;
        fake.bind_value = fake.submitted_bind_value;
        CHECK_OK(sluiceWaitVulkanStreamerIdle(streamer));
        CHECK_OK(sluiceBeginStreamingFrame(streamer, commands, ++now, &frame));
        CHECK_OK(sluiceEndStreamingFrame(streamer, commands));
        fake.frame_semaphore = frame.semaphore;
        fake.frame_value = frame.signalValue;
    }
}

/* Opens a streamer with 4096x4096 texels, all requested: 87 MiB in heaps of 4 MiB. */
static void open_streamer(bool has_extension, bool ignored, uint64_t used_by_others)
{
    fake = (struct fake_vulkan){.tail_page_count = 1,
                                .want = want_all,
                                .layer_size = 65536,
                                .heap_size = HEAP,
                                .has_memory_budget = has_extension,
                                .used_by_others = used_by_others};
    SluiceVulkanContextCreateInfo create = fake_vulkan_context_info(&fake);
    create.noDeviceBudget = ignored;
    CHECK_OK(sluiceCreateVulkanContext(&create, &context));
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                           .context = context,
                                           .residencyMode = SLUICE_RESIDENCY_MODE_SPARSE,
                                           .maxTextureCount = 4,
                                           .maxLoadsInFlight = 64, /* staging never grows */
                                           .maxRegionCount = 1 << 12,
                                           .feedbackTimeoutTicks = 100,
                                           .heapTileCapacity = 64};
    fake_vulkan_fill(&info);
    CHECK_OK(sluiceCreateVulkanStreamer(&info, &streamer));
    source = gray_source(4096, 4096);
    const SluiceVulkanTextureCreateInfo add = {.structSize = sizeof add, .source = source};
    SluiceVulkanTexture texture;
    CHECK_OK(sluiceAddVulkanTexture(streamer, &add, &texture));
    now = 0;
    run_frames(8 * FRAMES_PER_POLL);
}

static void close_streamer(void)
{
    sluiceDestroyVulkanStreamer(streamer);
    sluiceDestroyVulkanContext(context);
    sluiceDestroyImageSource(source);
    assert_int_equal(fake.live_objects, 0);
    assert_int_equal(fake.live_memory, 0);
}

/* Returns the tile memory that fits into the heap beside other programs, other memory of the
 * context, and a step. */
static uint64_t spare(void)
{
    SluiceVulkanContextStatistics s = statistics();
    return HEAP - fake.used_by_others - (fake.live_memory - s.tileMemorySize) - STEP;
}

static void tile_memory_follows_the_budget_down_and_up(void **state)
{
    (void)state;
    open_streamer(true, false, 0);
    uint64_t all = statistics().tileMemorySize;
    assert_in_range(all, 85 * MIB, 96 * MIB);
    fake.used_by_others = HEAP - 80 * MIB;
    run_frames(FRAMES_PER_POLL + 8);
    assert_true(statistics().tileMemorySize <= spare());
    assert_true(statistics().tileMemorySize + 2 * STEP >
                spare()); /* and not by more than it must */
    assert_true(fake.live_memory + fake.used_by_others <= HEAP);
    uint64_t less = statistics().tileMemorySize;
    run_frames(2 * FRAMES_PER_POLL);
    assert_in_range(statistics().tileMemorySize, less - STEP, less); /* it rests */
    fake.used_by_others = HEAP - 60 * MIB;
    run_frames(FRAMES_PER_POLL + 8);
    assert_true(statistics().tileMemorySize <= spare());
    fake.used_by_others = 0;
    run_frames(4 * FRAMES_PER_POLL);
    assert_true(statistics().tileMemorySize >= all - STEP);
    close_streamer();
}

/* Changes of less than a step, up and down around the budget. */
static void small_changes_are_ignored(void **state)
{
    (void)state;
    open_streamer(true, false, HEAP - 90 * MIB);
    fake.used_by_others =
        HEAP - 80 * MIB; /* more than a step: the limit becomes the current size */
    run_frames(4 * FRAMES_PER_POLL);
    SluiceVulkanContextStatistics before = statistics();
    assert_true(before.deviceMemoryBudget < 80 * MIB);
    assert_true(before.memoryBudget == before.deviceMemoryBudget);
    for (uint32_t i = 0; i < 10; i++) {
        fake.used_by_others = HEAP - 80 * MIB + (i % 2 ? -(STEP / 2) : STEP / 2);
        run_frames(FRAMES_PER_POLL);
        assert_true(statistics().deviceMemoryBudget == before.deviceMemoryBudget);
        assert_true(statistics().tileMemorySize == before.tileMemorySize);
    }
    close_streamer();
}

static void the_smaller_of_both_budgets_counts(void **state)
{
    (void)state;
    open_streamer(true, false, 0);
    CHECK_OK(sluiceSetVulkanMemoryBudget(context, 32 * MIB));
    assert_true(statistics().memoryBudget == 32 * MIB);
    run_frames(16);
    assert_true(statistics().tileMemorySize <= 32 * MIB);
    fake.used_by_others = HEAP - 40 * MIB;
    run_frames(FRAMES_PER_POLL + 8);
    assert_true(statistics().memoryBudget < 32 * MIB);
    assert_true(statistics().tileMemorySize <= spare());
    close_streamer();
}

static SluiceStreamedTextureManagerConfig config(void)
{
    return *slc_manager_config(manager_of(streamer));
}

/* The application sets the heap count that memory pressure has just set, or settings without it. */
static void a_target_of_the_application_stays_when_the_pressure_is_over(void **state)
{
    (void)state;
    for (uint32_t own = 0; own < 2; own++) {
        open_streamer(false, false, 0);
        CHECK_OK(sluiceSetVulkanMemoryBudget(context, 64 * MIB));
        run_frames(1);
        SluiceStreamedTextureManagerConfig set = config();
        assert_in_range(set.targetHeapCount, 8, 16);
        SluiceVulkanStreamerSettings settings = {.structSize = sizeof settings};
        CHECK_OK(sluiceGetVulkanStreamerSettings(streamer, &settings));
        if (own)
            CHECK_OK(sluiceSetConfig(manager_of(streamer), &set));
        CHECK_OK(sluiceSetVulkanStreamerSettings(streamer, &settings));
        run_frames(FRAMES_PER_POLL);
        assert_true(statistics().tileMemorySize <= 64 * MIB);
        CHECK_OK(sluiceSetVulkanMemoryBudget(context, UINT64_MAX));
        run_frames(4 * FRAMES_PER_POLL);
        assert_int_equal(config().targetHeapCount, own ? set.targetHeapCount : 0);
        assert_int_equal(statistics().tileMemorySize <= 64 * MIB, own);
        close_streamer();
    }
}

static void the_device_is_asked_now_and_then(void **state)
{
    (void)state;
    open_streamer(true, false, 0);
    uint32_t before = fake.budget_calls;
    run_frames(10 * FRAMES_PER_POLL);
    assert_int_equal(fake.budget_calls, before + 10);
    assert_int_equal(fake.extension_calls, 2); /* how many, and which */
    close_streamer();
}

static void without_the_extension_nothing_is_asked(void **state)
{
    (void)state;
    open_streamer(false, false, HEAP - 30 * MIB);
    assert_int_equal(fake.budget_calls, 0);
    assert_true(statistics().memoryBudget == UINT64_MAX);
    assert_true(statistics().deviceMemoryBudget == UINT64_MAX);
    assert_true(statistics().tileMemorySize >= 85 * MIB);
    close_streamer();
    open_streamer(true, true, HEAP - 30 * MIB);
    assert_int_equal(fake.budget_calls, 0);
    assert_int_equal(fake.extension_calls, 0);
    assert_true(statistics().memoryBudget == UINT64_MAX);
    close_streamer();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tile_memory_follows_the_budget_down_and_up),
        cmocka_unit_test(small_changes_are_ignored),
        cmocka_unit_test(the_smaller_of_both_budgets_counts),
        cmocka_unit_test(a_target_of_the_application_stays_when_the_pressure_is_over),
        cmocka_unit_test(the_device_is_asked_now_and_then),
        cmocka_unit_test(without_the_extension_nothing_is_asked),
    };
    return RUN_TESTS(tests);
}
