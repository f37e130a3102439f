/* Memory that the host or the device refuses: less is resident, nothing is lost. */
#include "device/demand_runner.h"

#include "support/failing_allocator.h"
#include "support/test.h"

#include <string.h>

static struct harness h;

enum { SIZE = 4096, TILE = 128, TILES = SIZE / TILE };

/* Device with less memory than it reports. Used by the functions below. Tests change it only while
 * no loader calls them. */
static struct {
    PFN_vkGetDeviceProcAddr get;
    PFN_vkAllocateMemory allocate;
    uint64_t left; ///< bytes; only large allocations count
    bool refuses;  ///< everything
} poor;

static VKAPI_ATTR VkResult VKAPI_CALL allocate_memory(VkDevice device,
                                                      const VkMemoryAllocateInfo *info,
                                                      const VkAllocationCallbacks *callbacks,
                                                      VkDeviceMemory *memory)
{
    bool large = info->allocationSize >= 2u << 20;
    if (poor.refuses || (large && info->allocationSize > poor.left))
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    poor.left -= large ? info->allocationSize : 0;
    return poor.allocate(device, info, callbacks, memory);
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_of_device(VkDevice device, const char *name)
{
    PFN_vkVoidFunction function = poor.get(device, name);
    if (strcmp(name, "vkAllocateMemory") != 0)
        return function;
    poor.allocate = (PFN_vkAllocateMemory)function;
    return (PFN_vkVoidFunction)allocate_memory;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_of_instance(VkInstance instance,
                                                                const char *name)
{
    PFN_vkVoidFunction function = h.get(instance, name);
    if (strcmp(name, "vkGetDeviceProcAddr") != 0)
        return function;
    poor.get = (PFN_vkGetDeviceProcAddr)function;
    return (PFN_vkVoidFunction)get_of_device;
}

static const SluiceVulkanContextCreateInfo poor_context = {.pfnGetInstanceProcAddr =
                                                               get_of_instance};

static void a_device_without_memory_is_a_smaller_budget(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image image;
    SluiceDemandLoader *loader;
    SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info,
                                         .memoryBudget = 128u << 20,
                                         .maxTilesInFlight = 32,
                                         .maxTextureCount = 64,
                                         .pageCapacity = 1u << 16};
    poor.left = 64u << 20;
    CHECK_OK(harness_set_context(&h, &poor_context));
    runner_fill(&h, &info);
    CHECK_OK(sluiceCreateDemandLoader(&info, &loader));
    poor.left = 20u << 20;
    runner_init_with(&r, &h, loader);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE, 1);
    runner_add_tiles(&r, runner_add_texture(&r, &image), SIZE, 0, TILES);
    h.quiet = true;
    uint32_t launches = runner_load(&r, 100);
    h.quiet = false;
    print_message("# launches.poor %u launches\n", launches);
    assert_in_range(launches, 3, 60);
    assert_true(runner_all_resident(&r));
    SluiceDemandStatistics statistics = runner_statistics(&r);
    assert_true(statistics.lodBias > 0);
    assert_true(statistics.tileMemorySize <= 20u << 20);
    assert_true(statistics.residentTileCount >= 64);
    runner_finish(&r);
    CHECK_OK(harness_set_context(&h, NULL));
    runner_image_finish(&image);
}

static void a_launch_that_cannot_be_prepared_takes_nothing_with_it(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image image;
    SluiceDemandLoader *loader;
    SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info,
                                         .memoryBudget = 16u << 20,
                                         .maxTextureCount = 64,
                                         .pageCapacity = 1u << 16};
    poor.left = UINT64_MAX;
    CHECK_OK(harness_set_context(&h, &poor_context));
    runner_fill(&h, &info);
    CHECK_OK(sluiceCreateDemandLoader(&info, &loader));
    runner_init_with(&r, &h, loader);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE, 1);
    SluiceDemandTextureId id = runner_add_texture(&r, &image);
    uint32_t failures = 0;
    h.quiet = true;
    for (uint32_t rows = 1; rows < 7; rows++) {
        runner_clear(&r);
        runner_add_tiles(&r, id, SIZE, 0, rows);
        for (uint32_t i = 0; i < 5; i++) {
            poor.refuses = true;
            SluiceResult result = runner_submit(&r);
            poor.refuses = false;
            failures += result == SLUICE_ERROR_OUT_OF_DEVICE_MEMORY;
            if (result != SLUICE_SUCCESS)
                continue;
            CHECK_OK(
                sluiceProcessDemandRequests(loader, &r.launch, UINT64_MAX, &r.requests, &r.ticket));
            CHECK_OK(sluiceWaitDemandTicket(loader, r.ticket, UINT64_MAX, NULL));
        }
        runner_load(&r, 30);
        for (uint32_t i = 0; i < r.count; i++)
            runner_check_texel(&r, i, &image, 0, i % TILES * TILE + 7, i / TILES * TILE + 9);
    }
    h.quiet = false;
    assert_true(failures > 0);
    runner_finish(&r);
    CHECK_OK(harness_set_context(&h, NULL));
    runner_image_finish(&image);
}

static uint32_t hash_of(const uint8_t *bytes, uint32_t count)
{
    uint32_t sum = 2166136261u;
    for (uint32_t i = 0; i < count; i++)
        sum = (sum ^ bytes[i]) * 16777619u;
    return sum;
}

static void bytes_that_were_set_survive_a_launch_that_cannot_be_prepared(void **state)
{
    (void)state;
    enum { PAGES = 8, BYTES = 256 };
    if (!h.reads_bytes)
        skip();
    struct runner r;
    SluiceDemandLoader *loader;
    SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info,
                                         .memoryBudget = 16u << 20,
                                         .maxTextureCount = 64,
                                         .pageCapacity = 1u << 16};
    poor.left = UINT64_MAX;
    CHECK_OK(harness_set_context(&h, &poor_context));
    runner_fill(&h, &info);
    CHECK_OK(sluiceCreateDemandLoader(&info, &loader));
    h.runs_bytes = true;
    runner_init_with(&r, &h, loader);
    const SluiceDemandResourceCreateInfo create = {
        .structSize = sizeof create, .pageCount = PAGES, .rank = 1, .pageSize = BYTES};
    SluiceDemandResourceId id;
    uint32_t first;
    CHECK_OK(sluiceAddDemandResource(loader, &create, &id, &first));
    uint8_t bytes[PAGES][BYTES];
    h.quiet = true;
    for (uint32_t i = 0; i < PAGES; i++) {
        memset(bytes[i], (int)(7 * i + 1), BYTES);
        CHECK_OK(sluiceSetDemandPageBytes(loader, id, i, bytes[i], false));
        runner_add(&r, (struct RunnerInput){
                           .kind = RUNNER_BYTES, .index = first + i, .dx = {(float)BYTES}});
        poor.refuses = true;
        CHECK_RESULT(runner_submit(&r), SLUICE_ERROR_OUT_OF_DEVICE_MEMORY);
        poor.refuses = false;
    }
    memset(bytes[1], 200, BYTES); /* before the first bytes were copied */
    CHECK_OK(sluiceSetDemandPageBytes(loader, id, 1, bytes[1], false));
    h.quiet = false;
    runner_load(&r, 3);
    for (uint32_t i = 0; i < PAGES; i++) {
        assert_true(runner_output(&r, i).resident);
        assert_int_equal(runner_output(&r, i).value[0], hash_of(bytes[i], BYTES));
    }
    runner_finish(&r);
    h.runs_bytes = false;
    CHECK_OK(harness_set_context(&h, NULL));
}

/* A loader's life, on one thread but for the workers: OUT_OF_HOST_MEMORY, or how it should be. */
static bool live(struct failing_allocator *allocator, struct runner_image *image)
{
    SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info,
                                         .memoryBudget = 8u << 20,
                                         .maxTextureCount = 64,
                                         .pageCapacity = 1u << 16,
                                         .maxTilesInFlight = 16};
    const SluiceVulkanContextCreateInfo context = {.pAllocator = &allocator->callbacks,
                                                   .loaderThreadCount = 2};
    SluiceDemandLoader *loader = NULL;
    SluiceDemandTextureId id;
    struct runner r;
    SluiceResult result = harness_set_context(&h, &context);
    runner_fill(&h, &info);
    if (result == SLUICE_SUCCESS)
        result = sluiceCreateDemandLoader(&info, &loader);
    if (result != SLUICE_SUCCESS) {
        CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        assert_null(loader);
        return false;
    }
    const SluiceDemandTextureCreateInfo create = {.structSize = sizeof create,
                                                  .image = runner_image_desc(image),
                                                  .pSampler = &runner_nearest};
    result = sluiceAddDemandTexture(loader, &create, &id);
    if (result != SLUICE_SUCCESS) {
        CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        sluiceDestroyDemandLoader(loader);
        return false;
    }
    runner_init_with(&r, &h, loader);
    runner_add_texel(&r, id, 300, 300, 0, 299, 299);
    bool complete = false;
    for (uint32_t i = 0; i < 5 && !complete; i++) {
        result = runner_submit(&r);
        if (result == SLUICE_SUCCESS)
            result =
                sluiceProcessDemandRequests(loader, &r.launch, UINT64_MAX, &r.requests, &r.ticket);
        if (result != SLUICE_SUCCESS) {
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
            break;
        }
        complete = r.requests.missingCount == 0;
        CHECK_OK(sluiceWaitDemandTicket(loader, r.ticket, UINT64_MAX, NULL));
    }
    if (complete)
        runner_check_texel(&r, 0, image, 0, 299, 299);
    runner_finish(&r);
    return complete;
}

static void a_loader_survives_every_refused_allocation(void **state)
{
    (void)state;
    struct failing_allocator allocator;
    struct runner_image image;
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 300, 300, 1);
    h.quiet = true;
    bool complete = false;
    for (uint64_t n = 0; !complete; n++) {
        assert_true(n < 500);
        failing_allocator_init(&allocator, n);
        complete = live(&allocator, &image);
        CHECK_OK(harness_set_context(&h, NULL));
        assert_int_equal(allocator.live_count, 0);
        assert_int_equal(allocator.live_bytes, 0);
    }
    h.quiet = false;
    assert_int_equal(image.opened, image.closed);
    runner_image_finish(&image);
}

int main(void)
{
    int status = harness_init(&h);
    if (status)
        return status;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_device_without_memory_is_a_smaller_budget),
        cmocka_unit_test(a_launch_that_cannot_be_prepared_takes_nothing_with_it),
        cmocka_unit_test(bytes_that_were_set_survive_a_launch_that_cannot_be_prepared),
        cmocka_unit_test(a_loader_survives_every_refused_allocation),
    };
    return harness_finish(&h, RUN_TESTS(tests));
}
