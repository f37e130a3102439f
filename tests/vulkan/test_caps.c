/* Device capabilities from answers of a driver that the tests control. */
#include "vulkan/caps.h"

#include "support/test.h"

#include <string.h>

static struct {
    VkQueueFlags families[4];
    uint32_t family_count;
    VkPhysicalDeviceProperties properties;
    VkPhysicalDeviceFeatures features;
    VkBool32 timeline;
} driver; /* Vulkan 1.0 functions have no user pointer */

static VKAPI_ATTR void VKAPI_CALL get_families(VkPhysicalDevice device, uint32_t *count,
                                               VkQueueFamilyProperties *families)
{
    (void)device;
    *count = driver.family_count;
    for (uint32_t i = 0; families && i < driver.family_count; i++)
        families[i] =
            (VkQueueFamilyProperties){.queueFlags = driver.families[i], .queueCount = i + 1};
}

static VKAPI_ATTR void VKAPI_CALL get_features(VkPhysicalDevice device,
                                               VkPhysicalDeviceFeatures2 *features)
{
    (void)device;
    features->features = driver.features;
    ((VkPhysicalDeviceVulkan12Features *)features->pNext)->timelineSemaphore = driver.timeline;
}

static VKAPI_ATTR void VKAPI_CALL get_properties(VkPhysicalDevice device,
                                                 VkPhysicalDeviceProperties2 *properties)
{
    (void)device;
    properties->properties = driver.properties;
}

static VKAPI_ATTR void VKAPI_CALL get_memory(VkPhysicalDevice device,
                                             VkPhysicalDeviceMemoryProperties *memory)
{
    (void)device;
    *memory = (VkPhysicalDeviceMemoryProperties){
        .memoryHeapCount = 3,
        .memoryHeaps = {{1ull << 40, 0},
                        {1ull << 28, VK_MEMORY_HEAP_DEVICE_LOCAL_BIT},
                        {1ull << 33, VK_MEMORY_HEAP_DEVICE_LOCAL_BIT}}};
}

static SluiceVulkanDeviceCapabilities ask(void)
{
    struct slc_vk vk = {.GetPhysicalDeviceQueueFamilyProperties = get_families,
                        .GetPhysicalDeviceFeatures2 = get_features,
                        .GetPhysicalDeviceProperties2 = get_properties,
                        .GetPhysicalDeviceMemoryProperties = get_memory};
    struct slc_caps caps;
    slc_caps_init(&caps, &vk);
    return caps.public;
}

/* Resets the driver to a discrete device that can stream. */
static int reset(void **state)
{
    (void)state;
    memset(&driver, 0, sizeof driver);
    driver.families[0] = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT | VK_QUEUE_SPARSE_BINDING_BIT;
    driver.family_count = 1;
    driver.properties.apiVersion = VK_API_VERSION_1_2;
    driver.properties.deviceType = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
    driver.features.sparseBinding = driver.features.sparseResidencyImage2D = VK_TRUE;
    driver.features.shaderResourceResidency = VK_TRUE;
    driver.timeline = VK_TRUE;
    return 0;
}

static void queue_that_does_nothing_else_binds(void **state)
{
    (void)state;
    const VkQueueFlags sparse = VK_QUEUE_SPARSE_BINDING_BIT, draws = VK_QUEUE_GRAPHICS_BIT;
    driver.families[1] = VK_QUEUE_COMPUTE_BIT | sparse;
    driver.families[2] = VK_QUEUE_TRANSFER_BIT | sparse;
    driver.families[3] = VK_QUEUE_TRANSFER_BIT;
    driver.family_count = 4;
    SluiceVulkanDeviceCapabilities caps = ask();
    assert_int_equal(caps.sparseQueueFamilyIndex, 2);
    assert_int_equal(caps.sparseQueueCount, 3);
    assert_true(caps.dedicatedSparseQueue && caps.sparse);
    driver.family_count = 2;
    caps = ask();
    assert_int_equal(caps.sparseQueueFamilyIndex, 1);
    assert_false(caps.dedicatedSparseQueue);
    driver.family_count = 1;
    assert_int_equal(ask().sparseQueueFamilyIndex, 0);
    driver.families[0] = draws;
    assert_false(ask().sparse);
}

static void streaming_needs_every_feature_and_vulkan_1_2(void **state)
{
    (void)state;
    assert_true(ask().sparse && ask().timelineSemaphore);
    driver.features.sparseResidencyImage2D = VK_FALSE;
    assert_false(ask().sparse);
    reset(NULL);
    driver.features.sparseBinding = VK_FALSE;
    assert_false(ask().sparse);
    reset(NULL);
    driver.properties.apiVersion = VK_API_VERSION_1_1;
    assert_false(ask().sparse || ask().timelineSemaphore);
    reset(NULL);
    driver.timeline = VK_FALSE;
    assert_false(ask().timelineSemaphore);
}

static void software_devices_bear_few_tiles_and_their_codes_are_not_trusted(void **state)
{
    (void)state;
    assert_int_equal(ask().maxTouchedTiles, 0);
    assert_true(ask().residencyCodesExact);
    driver.properties.deviceType = VK_PHYSICAL_DEVICE_TYPE_CPU;
    SluiceVulkanDeviceCapabilities caps = ask();
    assert_in_range(caps.maxTouchedTiles, 1, UINT32_MAX);
    assert_false(caps.residencyCodesExact);
    reset(NULL);
    driver.features.shaderResourceResidency = VK_FALSE;
    assert_false(ask().residencyCodesExact);
}

static SluiceResidencyMode choose(const SluiceVulkanDeviceCapabilities *caps,
                                  SluiceResidencyMode mode, uint32_t texture_count)
{
    SluiceResidencyMode chosen;
    CHECK_OK(sluiceChooseVulkanResidencyMode(caps, mode, texture_count, &chosen));
    return chosen;
}

static void auto_is_paged_where_a_software_device_cannot_bear_the_textures(void **state)
{
    (void)state;
    const SluiceResidencyMode any = SLUICE_RESIDENCY_MODE_AUTO;
    SluiceVulkanDeviceCapabilities caps = {.structSize = sizeof caps, .sparse = true};
    assert_int_equal(choose(&caps, any, 1u << 20), SLUICE_RESIDENCY_MODE_SPARSE);
    caps.maxTouchedTiles = 49147;
    assert_int_equal(choose(&caps, any, 0), SLUICE_RESIDENCY_MODE_SPARSE);
    assert_int_equal(choose(&caps, any, 3071), SLUICE_RESIDENCY_MODE_SPARSE);
    assert_int_equal(choose(&caps, any, 3072), SLUICE_RESIDENCY_MODE_PAGED);
    assert_int_equal(choose(&caps, SLUICE_RESIDENCY_MODE_SPARSE, 5000),
                     SLUICE_RESIDENCY_MODE_SPARSE);
    caps.sparse = false;
    assert_int_equal(choose(&caps, any, 1), SLUICE_RESIDENCY_MODE_PAGED);
}

static void time_stamps_need_queues_that_write_them(void **state)
{
    (void)state;
    driver.properties.limits.timestampPeriod = 2.5f;
    assert_true(ask().timestampPeriod == 0.0f);
    driver.properties.limits.timestampComputeAndGraphics = VK_TRUE;
    assert_true(ask().timestampPeriod == 2.5f);
}

static void largest_device_local_heap_is_told(void **state)
{
    (void)state;
    assert_true(ask().deviceLocalMemorySize == 1ull << 33);
}

/* Memory types of an H200: the first type allowed for sparse images is plain system memory. */
static void memory_is_device_local_although_another_type_comes_first(void **state)
{
    (void)state;
    const VkMemoryPropertyFlags local = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT,
                                visible = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT;
    const VkPhysicalDeviceMemoryProperties memory = {
        .memoryTypeCount = 4,
        .memoryTypes = {{0, 0}, {local, 0}, {visible, 0}, {local | visible, 0}}};
    assert_int_equal(slc_find_memory_type(&memory, 0x3, local, 0), 1);
    assert_int_equal(slc_find_memory_type(&memory, 0x9, local, 0), 3);
    assert_int_equal(slc_find_memory_type(&memory, 0xF, visible, local), 3);
    assert_int_equal(slc_find_memory_type(&memory, 0x7, visible, local), 2);
    assert_true(slc_find_memory_type(&memory, 0x5, local, 0) == UINT32_MAX);
}

#define TEST(name) cmocka_unit_test_setup(name, reset)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(queue_that_does_nothing_else_binds),
        TEST(streaming_needs_every_feature_and_vulkan_1_2),
        TEST(software_devices_bear_few_tiles_and_their_codes_are_not_trusted),
        TEST(auto_is_paged_where_a_software_device_cannot_bear_the_textures),
        TEST(time_stamps_need_queues_that_write_them),
        TEST(largest_device_local_heap_is_told),
        TEST(memory_is_device_local_although_another_type_comes_first),
    };
    return RUN_TESTS(tests);
}
