/* Memory types of staging buffers: the GPU's own memory if the host sees all of it. */
#include "vulkan/buffer.h"

#include "vulkan/context.h"
#include "vulkan/fake_vulkan.h"

#include "support/test.h"

#define GIB (1ull << 30)
#define LOCAL VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT
#define VISIBLE (VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT)
#define CACHED VK_MEMORY_PROPERTY_HOST_CACHED_BIT

static struct fake_vulkan fake; /* large */
static PFN_vkAllocateMemory fake_allocate;
static uint32_t refused_types, asked_types; ///< bits
static VkResult refusal;

static VKAPI_ATTR VkResult VKAPI_CALL allocate(VkDevice device, const VkMemoryAllocateInfo *info,
                                               const VkAllocationCallbacks *callbacks,
                                               VkDeviceMemory *memory)
{
    asked_types |= 1u << info->memoryTypeIndex;
    if (refused_types >> info->memoryTypeIndex & 1)
        return refusal;
    return fake_allocate(device, info, callbacks, memory);
}

static VKAPI_ATTR void VKAPI_CALL requirements(VkDevice device, VkBuffer buffer,
                                               VkMemoryRequirements *memory)
{
    (void)device, (void)buffer;
    *memory = (VkMemoryRequirements){4096, 64, 0xF};
}

/* Memory of GPUs with a resizable BAR (H200, GeForce), of one without, and of an integrated one. */
static const VkPhysicalDeviceMemoryProperties
    resizable =
        {.memoryTypeCount = 4,
         .memoryTypes = {{LOCAL, 0}, {VISIBLE, 1}, {VISIBLE | CACHED, 1}, {LOCAL | VISIBLE, 0}},
         .memoryHeapCount = 2,
         .memoryHeaps = {{16 * GIB, 0}, {32 * GIB, 0}}},
    window =
        {.memoryTypeCount = 4,
         .memoryTypes = {{LOCAL, 0}, {VISIBLE, 1}, {VISIBLE | CACHED, 1}, {LOCAL | VISIBLE, 2}},
         .memoryHeapCount = 3,
         .memoryHeaps = {{16 * GIB, 0}, {32 * GIB, 0}, {GIB / 4, 0}}},
    integrated = {.memoryTypeCount = 2,
                  .memoryTypes = {{LOCAL | VISIBLE | CACHED, 0}, {LOCAL | VISIBLE, 0}},
                  .memoryHeapCount = 1,
                  .memoryHeaps = {{16 * GIB, 0}}};

static SluiceResult make(const VkPhysicalDeviceMemoryProperties *memory, enum slc_buffer_kind kind)
{
    SluiceVulkanContext *context;
    fake = (struct fake_vulkan){.tail_page_count = 1};
    const SluiceVulkanContextCreateInfo info = fake_vulkan_context_info(&fake);
    CHECK_OK(sluiceCreateVulkanContext(&info, &context));
    struct slc_vk vk = context->vk;
    struct slc_caps caps = context->caps;
    struct slc_buffer buffer;
    fake_allocate = vk.AllocateMemory;
    vk.AllocateMemory = allocate;
    vk.GetBufferMemoryRequirements = requirements;
    caps.memory = *memory;
    asked_types = 0;
    SluiceResult result =
        slc_buffer_init(&buffer, &vk, &caps, 4096, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, kind);
    assert_true(result != SLUICE_SUCCESS || buffer.mapped);
    slc_buffer_finish(&buffer, &vk);
    sluiceDestroyVulkanContext(context);
    assert_true(fake.live_objects == 0 && fake.live_memory == 0);
    return result;
}

static void staging_memory_is_the_gpus_if_the_host_sees_all_of_it(void **state)
{
    (void)state;
    refused_types = 0;
    CHECK_OK(make(&resizable, SLC_BUFFER_STAGING));
    assert_int_equal(asked_types, 1u << 3);
    CHECK_OK(make(&window, SLC_BUFFER_STAGING));
    assert_int_equal(asked_types, 1u << 1);
    CHECK_OK(make(&integrated, SLC_BUFFER_STAGING));
    assert_int_equal(asked_types, 1u << 0);
    CHECK_OK(make(&resizable, SLC_BUFFER_UPLOAD));
    assert_int_equal(asked_types, 1u << 1);
}

static void staging_memory_is_the_hosts_if_the_gpus_is_full(void **state)
{
    (void)state;
    refused_types = 1u << 3;
    refusal = VK_ERROR_OUT_OF_DEVICE_MEMORY;
    CHECK_OK(make(&resizable, SLC_BUFFER_STAGING));
    assert_int_equal(asked_types, 1u << 3 | 1u << 1);
    refused_types = 0xF;
    assert_int_equal(make(&resizable, SLC_BUFFER_STAGING), SLUICE_ERROR_OUT_OF_DEVICE_MEMORY);
    refusal = VK_ERROR_DEVICE_LOST;
    assert_int_equal(make(&resizable, SLC_BUFFER_STAGING), SLUICE_ERROR_DEVICE_LOST);
    assert_int_equal(asked_types, 1u << 3);
    refusal = VK_ERROR_OUT_OF_DEVICE_MEMORY; /* there is no other type */
    assert_int_equal(make(&integrated, SLC_BUFFER_STAGING), SLUICE_ERROR_OUT_OF_DEVICE_MEMORY);
    assert_int_equal(asked_types, 1u << 0);
    refused_types = 0;
}

static void the_gpus_memory_is_slow_to_read_unless_it_is_cached(void **state)
{
    (void)state;
    struct slc_caps caps = {.memory = resizable};
    assert_true(slc_staging_is_uncached(&caps));
    caps.memory = window;
    assert_false(slc_staging_is_uncached(&caps));
    caps.memory = integrated;
    assert_false(slc_staging_is_uncached(&caps));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(staging_memory_is_the_gpus_if_the_host_sees_all_of_it),
        cmocka_unit_test(staging_memory_is_the_hosts_if_the_gpus_is_full),
        cmocka_unit_test(the_gpus_memory_is_slow_to_read_unless_it_is_cached),
    };
    return RUN_TESTS(tests);
}
