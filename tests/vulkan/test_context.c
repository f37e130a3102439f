/* Contexts: refused arguments, names of objects, and lifetime beyond their children. */
#include "image/read_pool.h"
#include "vulkan/fake_vulkan.h"
#include "vulkan/streamer.h"

#include "support/failing_allocator.h"
#include "support/gray_source.h"
#include "support/test.h"

#include <sluice/demand.h>

#include <stddef.h>
#include <stdio.h>
#include <string.h>

/* Last log line, and number of lines. */
struct lines {
    uint32_t count;
    char last[512];
};

static void keep_line(void *user, SluiceLogSeverity severity, const char *message)
{
    struct lines *lines = user;
    (void)severity;
    lines->count++;
    snprintf(lines->last, sizeof lines->last, "%s", message);
}

static void check_line(struct lines *lines, const char *part)
{
    if (lines->count != 1 || !strstr(lines->last, part))
        fail_msg("%u lines, the last: \"%s\", without \"%s\"", lines->count, lines->last, part);
    *lines = (struct lines){0};
}

static struct fake_vulkan fake; /* large */
static struct lines lines;

static SluiceVulkanContextCreateInfo start(void)
{
    lines = (struct lines){0};
    fake = (struct fake_vulkan){.tail_page_count = 1, .log = {&lines, keep_line}};
    return fake_vulkan_context_info(&fake);
}

static void missing_fields_are_named(void **state)
{
    (void)state;
    static const char *const names[] = {"instance is NULL", "physicalDevice is NULL",
                                        "device is NULL", "pfnGetInstanceProcAddr is NULL",
                                        "pAllocator is NULL"};
    static const SluiceAllocationCallbacks half = {.pUserData = NULL};
    for (int i = 0; i < 5; i++) {
        SluiceVulkanContext *context;
        SluiceVulkanContextCreateInfo info = start();
        info.instance = i == 0 ? NULL : info.instance;
        info.physicalDevice = i == 1 ? NULL : info.physicalDevice;
        info.device = i == 2 ? NULL : info.device;
        info.pfnGetInstanceProcAddr = i == 3 ? NULL : info.pfnGetInstanceProcAddr;
        info.pAllocator = i == 4 ? &half : NULL;
        CHECK_RESULT(sluiceCreateVulkanContext(&info, &context), SLUICE_ERROR_NULL_POINTER);
        assert_null(context);
        check_line(&lines, names[i]);
    }
}

static void queue_families_must_exist_and_suit(void **state)
{
    (void)state;
    static const struct {
        bool sparse; ///< with a sparse queue
        uint32_t family, sparse_family;
        const char *line; ///< NULL: valid
    } cases[] = {
        {true, 0, 0, NULL},
        {true, FAKE_COMPUTE_FAMILY, FAKE_SPARSE_FAMILY, NULL},
        {false, 0, FAKE_FAMILIES, NULL},
        {false, FAKE_COMPUTE_FAMILY, UINT32_MAX, NULL},
        {true, FAKE_FAMILIES, 0, "queueFamilyIndex is 4"},
        {false, UINT32_MAX, 0, "queueFamilyIndex is 4294967295"},
        {false, FAKE_TRANSFER_FAMILY, 0, "VK_QUEUE_COMPUTE_BIT"},
        {true, FAKE_SPARSE_FAMILY, 0, "VK_QUEUE_COMPUTE_BIT"},
        {true, 0, FAKE_FAMILIES, "sparseQueueFamilyIndex is 4"},
        {true, 0, FAKE_COMPUTE_FAMILY, "VK_QUEUE_SPARSE_BINDING_BIT"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        SluiceVulkanContext *context;
        SluiceVulkanContextCreateInfo info = start();
        info.queueFamilyIndex = cases[i].family;
        info.sparseQueueFamilyIndex = cases[i].sparse_family;
        info.sparseQueue = cases[i].sparse ? info.sparseQueue : VK_NULL_HANDLE;
        CHECK_RESULT(sluiceCreateVulkanContext(&info, &context),
                     cases[i].line ? SLUICE_ERROR_INVALID_ARGUMENT : SLUICE_SUCCESS);
        assert_true((context == NULL) == (cases[i].line != NULL));
        if (cases[i].line)
            check_line(&lines, cases[i].line);
        sluiceDestroyVulkanContext(context);
        assert_int_equal(fake.live_objects, 0);
    }
}

/* Loaders lack these functions if the instance was created for an older version. */
static void instances_of_vulkan_1_1_hear_what_to_do(void **state)
{
    (void)state;
    static const char *const newer[] = {"vkGetSemaphoreCounterValue", "vkWaitSemaphores",
                                        "vkGetPhysicalDeviceFeatures2"};
    for (size_t i = 0; i < sizeof newer / sizeof newer[0]; i++) {
        SluiceVulkanContext *context;
        const SluiceVulkanContextCreateInfo info = start();
        fake.missing = newer[i];
        CHECK_RESULT(sluiceCreateVulkanContext(&info, &context), SLUICE_ERROR_UNSUPPORTED);
        check_line(&lines, "create the instance with apiVersion 1.2");
    }
}

static void another_struct_size_is_refused(void **state)
{
    (void)state;
    SluiceVulkanContext *context;
    SluiceVulkanContextCreateInfo info = start();
    info.structSize = 0;
    CHECK_RESULT(sluiceCreateVulkanContext(&info, &context), SLUICE_ERROR_INVALID_ARGUMENT);
    info.structSize = offsetof(SluiceVulkanContextCreateInfo, minTileMemorySize);
    CHECK_RESULT(sluiceCreateVulkanContext(&info, &context), SLUICE_ERROR_INVALID_ARGUMENT);
    assert_null(context);
}

static void creation_survives_every_refused_allocation(void **state)
{
    (void)state;
    for (uint64_t n = 0;; n++) {
        struct failing_allocator memory;
        SluiceVulkanContext *context;
        SluiceVulkanContextCreateInfo info = start();
        failing_allocator_init(&memory, n);
        info.pAllocator = &memory.callbacks;
        SluiceResult result = sluiceCreateVulkanContext(&info, &context);
        assert_true((result == SLUICE_SUCCESS) == (context != NULL));
        sluiceDestroyVulkanContext(context);
        assert_int_equal(memory.live_count, 0);
        assert_int_equal(fake.live_objects, 0);
        if (result == SLUICE_SUCCESS)
            break;
        CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    }
}

static void contexts_outlive_their_children(void **state)
{
    (void)state;
    SluiceVulkanContext *context;
    SluiceVulkanStreamer *streamer, *second;
    SluiceDemandLoader *loader;
    const SluiceVulkanContextCreateInfo create = start();
    CHECK_OK(sluiceCreateVulkanContext(&create, &context));
    SluiceVulkanStreamerCreateInfo info = {
        .structSize = sizeof info, .context = context, .maxRegionCount = 256};
    const SluiceDemandLoaderCreateInfo demand = {
        .structSize = sizeof demand, .context = context, .pageCapacity = 1u << 18};
    fake_vulkan_fill(&info);
    CHECK_OK(sluiceCreateVulkanStreamer(&info, &streamer));
    CHECK_OK(sluiceCreateDemandLoader(&demand, &loader));
    CHECK_OK(sluiceCreateVulkanStreamer(&info, &second));
    sluiceDestroyVulkanContext(context);
    check_line(&lines, "3 of its streamers and demand loaders still exist");
    sluiceDestroyVulkanStreamer(streamer);
    sluiceDestroyVulkanStreamer(second);
    sluiceDestroyVulkanContext(context);
    check_line(&lines, "1 of its streamers and demand loaders still exist");
    sluiceDestroyDemandLoader(loader);
    sluiceDestroyVulkanContext(context);
    assert_int_equal(lines.count, 0);
    assert_int_equal(fake.live_objects, 0);
    assert_int_equal(fake.live_memory, 0);
}

struct block {
    struct fake_vulkan *fake;
    uint32_t live, calls;
    int mistake; ///< in the answers
};

static VkResult take_block(void *user, const SluiceDeviceMemoryRequest *request,
                           SluiceDeviceMemory *memory)
{
    struct block *b = user;
    assert_int_equal(request->structSize, sizeof *request);
    assert_true(request->size > 0 && request->alignment > 0 && request->pName);
    b->calls++;
    if (b->mistake == 4)
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    if (b->mistake == 5)
        return VK_INCOMPLETE;
    b->live++;
    *memory = (SluiceDeviceMemory){.pAllocation = b};
    memory->memory = b->mistake == 1 ? VK_NULL_HANDLE : (VkDeviceMemory)(void *)b;
    memory->offset = b->mistake == 2 ? request->alignment / 2 : 0;
    memory->pMapped = b->mistake == 3 ? NULL : (void *)b;
    return VK_SUCCESS;
}

static void give_block(void *user, const SluiceDeviceMemory *memory)
{
    struct block *b = user;
    assert_ptr_equal(memory->pAllocation, b);
    assert_true(b->live > 0);
    b->live--;
}

static void answers_of_memory_callbacks_are_checked(void **state)
{
    (void)state;
    static const struct {
        SluiceResult result;
        const char *line;
    } cases[] = {{SLUICE_ERROR_VULKAN, "memory is NULL"},
                 {SLUICE_ERROR_VULKAN, "offset is not a multiple of alignment"},
                 {SLUICE_ERROR_VULKAN, "pMapped is NULL"},
                 {SLUICE_ERROR_OUT_OF_DEVICE_MEMORY, NULL},
                 {SLUICE_ERROR_VULKAN, NULL}};
    for (int i = 0; i < 5; i++) {
        SluiceVulkanContext *context;
        SluiceVulkanContextCreateInfo create = start();
        struct block block = {.fake = &fake, .mistake = i + 1};
        const SluiceDeviceMemoryCallbacks callbacks = {&block, take_block, give_block};
        create.pDeviceMemory = &callbacks;
        CHECK_OK(sluiceCreateVulkanContext(&create, &context));
        struct slc_memory memory;
        const struct slc_memory_request request = {.size = 100,
                                                   .alignment = 8,
                                                   .purpose = SLUICE_DEVICE_MEMORY_PURPOSE_STAGING,
                                                   .mapped = true,
                                                   .name = "test"};
        VkResult result = slc_memory_allocate(&context->vk, &request, &memory);
        CHECK_RESULT(slc_vk_result(&(const struct slc_vk){0}, result, ""), cases[i].result);
        if (cases[i].line)
            check_line(&lines, cases[i].line);
        assert_int_equal(block.calls, 1);
        assert_int_equal(block.live, 0);
        assert_int_equal(context->memory.host, 0);
        sluiceDestroyVulkanContext(context);
    }
}

static void lock_without_unlock(void *user, VkQueue queue)
{
    (void)user, (void)queue;
}

static void queue_locks_must_be_whole(void **state)
{
    (void)state;
    const SluiceVulkanQueueLockCallbacks halves[] = {{NULL, lock_without_unlock, NULL},
                                                     {NULL, NULL, lock_without_unlock}};
    for (int i = 0; i < 2; i++) {
        SluiceVulkanContext *context;
        SluiceVulkanContextCreateInfo info = start();
        info.pQueueLock = &halves[i];
        CHECK_RESULT(sluiceCreateVulkanContext(&info, &context), SLUICE_ERROR_NULL_POINTER);
        check_line(&lines, "a function of pQueueLock is NULL");
    }
}

static void job_systems_need_their_function(void **state)
{
    (void)state;
    const SluiceJobSystem none = {0};
    SluiceVulkanContext *context;
    SluiceVulkanContextCreateInfo info = start();
    info.pJobSystem = &none;
    CHECK_RESULT(sluiceCreateVulkanContext(&info, &context), SLUICE_ERROR_NULL_POINTER);
    check_line(&lines, "the function of pJobSystem is NULL");
}

static void memory_callbacks_must_be_whole(void **state)
{
    (void)state;
    static const SluiceDeviceMemoryCallbacks halves[] = {{NULL, take_block, NULL},
                                                         {NULL, NULL, give_block}};
    for (int i = 0; i < 2; i++) {
        SluiceVulkanContext *context;
        SluiceVulkanContextCreateInfo info = start();
        info.pDeviceMemory = &halves[i];
        CHECK_RESULT(sluiceCreateVulkanContext(&info, &context), SLUICE_ERROR_NULL_POINTER);
        check_line(&lines, "pDeviceMemory is NULL");
    }
}

static void budgets_below_4_mib_are_refused(void **state)
{
    (void)state;
    const uint64_t least = UINT64_C(4) << 20;
    SluiceVulkanContext *context;
    SluiceVulkanContextStatistics statistics = {.structSize = sizeof statistics};
    SluiceVulkanContextCreateInfo info = start();
    info.memoryBudget = least - 1;
    CHECK_RESULT(sluiceCreateVulkanContext(&info, &context), SLUICE_ERROR_INVALID_ARGUMENT);
    check_line(&lines, "memoryBudget is 4194303");
    info.memoryBudget = least;
    CHECK_OK(sluiceCreateVulkanContext(&info, &context));
    CHECK_RESULT(sluiceSetVulkanMemoryBudget(context, 1), SLUICE_ERROR_INVALID_ARGUMENT);
    check_line(&lines, "memoryBudget is 1;");
    CHECK_OK(sluiceGetVulkanContextStatistics(context, &statistics));
    assert_true(statistics.memoryBudget == least);
    CHECK_OK(sluiceSetVulkanMemoryBudget(context, 0));
    CHECK_OK(sluiceGetVulkanContextStatistics(context, &statistics));
    assert_true(statistics.memoryBudget == UINT64_MAX);
    statistics.structSize = 4;
    CHECK_RESULT(sluiceGetVulkanContextStatistics(context, &statistics),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    sluiceDestroyVulkanContext(context);
}

static uint8_t want_all(void *user, uint32_t region)
{
    (void)user, (void)region;
    return 0;
}

static void run_frames(SluiceVulkanStreamer *streamer, uint64_t *time, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        SluiceStreamingFrame frame = {.structSize = sizeof frame};
        VkCommandBuffer commands = fake_vulkan_commands(&fake);
        fake.published = false;
        fake.copy_count = fake.bind_count = fake.destroyed_count = fake.freed_count = 0;
        fake.bind_value = fake.submitted_bind_value;
        CHECK_OK(sluiceWaitVulkanStreamerIdle(streamer));
        CHECK_OK(sluiceBeginStreamingFrame(streamer, commands, ++*time, &frame));
        CHECK_OK(sluiceEndStreamingFrame(streamer, commands));
        fake.frame_semaphore = frame.semaphore;
        fake.frame_value = frame.signalValue;
    }
}

static SluiceVulkanContextStatistics statistics_of(SluiceVulkanContext *context)
{
    SluiceVulkanContextStatistics statistics = {.structSize = sizeof statistics};
    CHECK_OK(sluiceGetVulkanContextStatistics(context, &statistics));
    return statistics;
}

static void objects_go_without_names_if_the_instance_has_no_debug_utils(void **state)
{
    (void)state;
    SluiceVulkanContext *context;
    SluiceVulkanStreamer *streamer;
    SluiceDemandLoader *loader;
    SluiceVulkanContextCreateInfo create = start();
    for (int i = 0; i < 2; i++) {
        fake.missing = i ? NULL : "vkSetDebugUtilsObjectNameEXT";
        CHECK_OK(sluiceCreateVulkanContext(&create, &context));
        SluiceVulkanStreamerCreateInfo info = {
            .structSize = sizeof info, .context = context, .maxRegionCount = 256};
        const SluiceDemandLoaderCreateInfo demand = {
            .structSize = sizeof demand, .context = context, .pageCapacity = 1u << 18};
        fake_vulkan_fill(&info);
        CHECK_OK(sluiceCreateVulkanStreamer(&info, &streamer));
        CHECK_OK(sluiceCreateDemandLoader(&demand, &loader));
        assert_true((fake.named_count > 0) == (i == 1));
        assert_true((fake.unnamed_objects == 0) == (i == 1));
        sluiceDestroyVulkanStreamer(streamer);
        sluiceDestroyDemandLoader(loader);
        sluiceDestroyVulkanContext(context);
        assert_int_equal(fake.live_objects, 0);
    }
}

/* The cache belongs to the application, and outlives the context. */
static void a_given_pipeline_cache_is_used_and_kept(void **state)
{
    (void)state;
    SluiceVulkanContext *context;
    SluiceVulkanContextCreateInfo create = start();
    create.pipelineCache = (VkPipelineCache)(void *)&fake;
    CHECK_OK(sluiceCreateVulkanContext(&create, &context));
    assert_true(context->vk.pipeline_cache == create.pipelineCache);
    assert_int_equal(fake.live_objects, 0);
    sluiceDestroyVulkanContext(context);
    create.pipelineCache = VK_NULL_HANDLE;
    CHECK_OK(sluiceCreateVulkanContext(&create, &context));
    assert_int_equal(fake.live_objects, 1);
    sluiceDestroyVulkanContext(context);
    assert_int_equal(fake.live_objects, 0);
}

/* Sparse heaps and pages; 4096 x 4096 texels are 88 MiB of tiles. */
static void two_streamers_stay_within_one_budget(void **state)
{
    (void)state;
    static const SluiceResidencyMode modes[] = {SLUICE_RESIDENCY_MODE_SPARSE,
                                                SLUICE_RESIDENCY_MODE_PAGED};
    const uint64_t mib = 1 << 20, budget = 40 * mib;
    SluiceImageSource *source = gray_source(4096, 4096);
    for (int m = 1; m < 4; m++) { /* one sparse streamer at most: the fake has one such queue */
        SluiceVulkanContext *context;
        SluiceVulkanStreamer *streamers[2];
        SluiceVulkanContextCreateInfo create = start();
        fake.want = want_all;
        fake.layer_size = 65536;
        create.memoryBudget = budget;
        CHECK_OK(sluiceCreateVulkanContext(&create, &context));
        for (int i = 0; i < 2; i++) {
            SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                                   .context = context,
                                                   .residencyMode = modes[i ? m / 2 : m % 2],
                                                   .maxTextureCount = 4,
                                                   .maxRegionCount = 1 << 12,
                                                   .feedbackTimeoutTicks = 100,
                                                   .heapTileCapacity = 64};
            const SluiceVulkanTextureCreateInfo add = {.structSize = sizeof add, .source = source};
            SluiceVulkanTexture texture;
            fake_vulkan_fill(&info);
            CHECK_OK(sluiceCreateVulkanStreamer(&info, &streamers[i]));
            CHECK_OK(sluiceAddVulkanTexture(streamers[i], &add, &texture));
        }
        uint64_t times[2] = {0, 0};
        for (int round = 0; round < 10; round++) {
            run_frames(streamers[0], &times[0], 4);
            run_frames(streamers[1], &times[1], 4);
            assert_true(statistics_of(context).tileMemorySize <= budget);
        }
        assert_int_equal(fake.unnamed_objects, 0);
        assert_true(fake.named_count > 30);
        SluiceVulkanContextStatistics full = statistics_of(context);
        assert_true(full.tileMemorySize > budget - 8 * mib);
        assert_true(full.refusedBlockCount > 0);
        assert_true(full.tileMemorySize + full.tableMemorySize + full.stagingMemorySize +
                        full.readbackMemorySize ==
                    fake.live_memory);
        CHECK_OK(sluiceSetVulkanMemoryBudget(context, 8 * mib));
        run_frames(streamers[0], &times[0], 1);
        assert_true(streamers[0]->memory_pressure.beyond > 0);
        for (int i = 0; i < 2; i++)
            sluiceDestroyVulkanStreamer(streamers[i]);
        assert_int_equal(statistics_of(context).memoryBlockCount, 0);
        sluiceDestroyVulkanContext(context);
        assert_int_equal(fake.live_objects, 0);
    }
    sluiceDestroyImageSource(source);
}

/* A small front end has 32 slots of staging memory, half a block. */
static void create_front_end(SluiceVulkanContext *context, bool demand,
                             SluiceVulkanStreamer **streamer, SluiceDemandLoader **loader)
{
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                           .context = context,
                                           .residencyMode = SLUICE_RESIDENCY_MODE_PAGED,
                                           .maxRegionCount = 256};
    const SluiceDemandLoaderCreateInfo demand_info = {.structSize = sizeof demand_info,
                                                      .context = context,
                                                      .maxTextureCount = 64,
                                                      .maxTilesInFlight = 32,
                                                      .pageCapacity = 1 << 16};
    SluiceVulkanPages pages = {.structSize = sizeof pages};
    fake_vulkan_fill(&info);
    if (demand) {
        CHECK_OK(sluiceCreateDemandLoader(&demand_info, loader));
        CHECK_OK(sluiceGetDemandPages(*loader, &pages));
    } else {
        CHECK_OK(sluiceCreateVulkanStreamer(&info, streamer));
        CHECK_OK(sluiceGetVulkanPages(*streamer, &pages));
    }
    assert_int_equal(pages.viewCount, 5);
}

static void front_ends_in_either_order_have_the_settings_of_the_context(void **state)
{
    (void)state;
    const uint64_t mib = 1 << 20;
    for (int demand_first = 0; demand_first < 2; demand_first++) {
        SluiceVulkanContextCreateInfo create = start();
        SluiceVulkanContext *context;
        SluiceVulkanStreamer *streamer;
        SluiceDemandLoader *loader;
        create.loaderThreadCount = 3;
        create.maxReadsPerSource = 2;
        create.readRetry.maxAttempts = 7;
        create.maxPageChunkCount = 5;
        create.minStagingSize = 12 * mib - 1;
        CHECK_OK(sluiceCreateVulkanContext(&create, &context));
        assert_int_equal(statistics_of(context).stagingMemorySize, 0);
        create_front_end(context, demand_first, &streamer, &loader);
        assert_true(statistics_of(context).stagingMemorySize == (demand_first ? 2 : 12) * mib);
        create_front_end(context, !demand_first, &streamer, &loader);
        assert_true(statistics_of(context).stagingMemorySize == 14 * mib);
        const struct slc_read_pool *threads = context->shared.threads;
        assert_int_equal(threads->thread_count, 3);
        assert_int_equal(threads->load.max_running_per_source, 2);
        for (const SluiceTileLoader *own = threads->loaders; own; own = own->next)
            assert_int_equal(own->retry.maxAttempts, 7);
        sluiceDestroyVulkanStreamer(streamer);
        sluiceDestroyDemandLoader(loader);
        assert_int_equal(statistics_of(context).memoryBlockCount, 0);
        sluiceDestroyVulkanContext(context);
        assert_int_equal(fake.live_objects, 0);
    }
}

static void questions_take_no_memory(void **state)
{
    (void)state;
    struct failing_allocator memory;
    SluiceVulkanContext *context;
    SluiceVulkanContextCreateInfo create = start();
    failing_allocator_init(&memory, UINT64_MAX);
    create.pAllocator = &memory.callbacks;
    CHECK_OK(sluiceCreateVulkanContext(&create, &context));
    uint64_t calls = memory.calls;
    memory.refuse_from = 0;
    (void)statistics_of(context);
    SluiceVulkanContextStatistics statistics = {.structSize = sizeof statistics};
    CHECK_OK(sluiceGetVulkanContextStatistics(context, &statistics));
    CHECK_OK(sluiceSetVulkanMemoryBudget(context, UINT64_C(8) << 20));
    assert_int_equal(memory.calls, calls);
    sluiceDestroyVulkanContext(context);
    assert_int_equal(memory.live_count, 0);
}

/* Children whose creation failed do not count. */
static void creation_that_fails_leaves_no_child(void **state)
{
    (void)state;
    struct failing_allocator memory;
    SluiceVulkanContextCreateInfo create = start();
    SluiceVulkanContext *context = NULL;
    failing_allocator_init(&memory, UINT64_MAX);
    create.pAllocator = &memory.callbacks;
    CHECK_OK(sluiceCreateVulkanContext(&create, &context));
    SluiceVulkanStreamerCreateInfo info = {
        .structSize = sizeof info, .context = context, .maxRegionCount = 256};
    const SluiceDemandLoaderCreateInfo demand = {
        .structSize = sizeof demand, .context = context, .pageCapacity = 1u << 18};
    fake_vulkan_fill(&info);
    for (uint64_t n = 0; n < 20; n++) {
        SluiceVulkanStreamer *streamer;
        SluiceDemandLoader *loader;
        memory.refuse_from = memory.calls + n;
        CHECK_RESULT(sluiceCreateVulkanStreamer(&info, &streamer), SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        memory.refuse_from = memory.calls + n;
        SluiceResult result = sluiceCreateDemandLoader(&demand, &loader);
        memory.refuse_from = UINT64_MAX;
        if (result != SLUICE_SUCCESS)
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        sluiceDestroyDemandLoader(loader);
    }
    lines = (struct lines){0};
    sluiceDestroyVulkanContext(context);
    assert_int_equal(lines.count, 0);
    assert_int_equal(memory.live_count, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(missing_fields_are_named),
        cmocka_unit_test(queue_families_must_exist_and_suit),
        cmocka_unit_test(instances_of_vulkan_1_1_hear_what_to_do),
        cmocka_unit_test(another_struct_size_is_refused),
        cmocka_unit_test(creation_survives_every_refused_allocation),
        cmocka_unit_test(contexts_outlive_their_children),
        cmocka_unit_test(answers_of_memory_callbacks_are_checked),
        cmocka_unit_test(job_systems_need_their_function),
        cmocka_unit_test(memory_callbacks_must_be_whole),
        cmocka_unit_test(queue_locks_must_be_whole),
        cmocka_unit_test(budgets_below_4_mib_are_refused),
        cmocka_unit_test(objects_go_without_names_if_the_instance_has_no_debug_utils),
        cmocka_unit_test(a_given_pipeline_cache_is_used_and_kept),
        cmocka_unit_test(two_streamers_stay_within_one_budget),
        cmocka_unit_test(front_ends_in_either_order_have_the_settings_of_the_context),
        cmocka_unit_test(questions_take_no_memory),
        cmocka_unit_test(creation_that_fails_leaves_no_child),
    };
    return RUN_TESTS(tests);
}
