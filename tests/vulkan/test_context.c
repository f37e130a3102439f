/* Contexts: what they refuse and name, and that their children keep them alive. */
#include "vulkan/fake_vulkan.h"

#include "support/failing_allocator.h"
#include "support/test.h"

#include <sluice/demand.h>

#include <stdio.h>
#include <string.h>

/* The last line and how many there were. */
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
        const char *line; ///< NULL: good
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

/* As loaders do when the instance was created for an older version. */
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
    info.structSize = sizeof info - 1;
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
    SluiceVulkanStreamerCreateInfo info = {.context = context, .maxRegionCount = 256};
    const SluiceDemandLoaderCreateInfo demand = {.context = context, .pageCapacity = 1u << 18};
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

/* Those that could not be created are none. */
static void creation_that_fails_leaves_no_child(void **state)
{
    (void)state;
    struct failing_allocator memory;
    SluiceVulkanContextCreateInfo create = start();
    SluiceVulkanContext *context = NULL;
    failing_allocator_init(&memory, UINT64_MAX);
    create.pAllocator = &memory.callbacks;
    CHECK_OK(sluiceCreateVulkanContext(&create, &context));
    SluiceVulkanStreamerCreateInfo info = {.context = context, .maxRegionCount = 256};
    const SluiceDemandLoaderCreateInfo demand = {.context = context, .pageCapacity = 1u << 18};
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
        cmocka_unit_test(creation_that_fails_leaves_no_child),
    };
    return RUN_TESTS(tests);
}
